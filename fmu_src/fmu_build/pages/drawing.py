"""Draws the vehicle on its legs, for the FMU's icon and its documentation."""

from __future__ import annotations

from math import atan2, cos, pi, radians, sin
from typing import TYPE_CHECKING, Any

from rlv_landing.figures.style import (
    AUXILIARY,
    BODY,
    INK,
    MAIN,
    SOLID,
    SOLID_EDGE,
    SOLID_GROUND,
    SOLID_GROUND_EDGE,
    SOLID_TOP,
)
from rlv_landing.parameters import Parameters
from rlv_landing.quantities import TRIPOD
from rlv_landing.touchdown import footpad_at_rest, leg_directions

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# direction of view: azimuth, so that no leg hides another, and elevation
VIEW_AZIMUTH, VIEW_ELEVATION = radians(20.0), radians(12.0)


def vehicle_figure(parameters: Parameters, *, named: bool = False) -> Figure:
    """Draw the upright vehicle with extended legs, the footpads on the ground.

    Args:
        parameters: Dimensions and drop mode.
        named: Write names of parts, axes and signs beside it.
    """
    from matplotlib.figure import Figure

    v, m, a = parameters.vehicle, parameters.main_strut, parameters.auxiliary_strut
    radius, height = footpad_at_rest(parameters)
    sides = (a.joint_spread, -a.joint_spread) if parameters.leg.kind == TRIPOD else (0.0,)
    figure = Figure(figsize=(6.4, 5.4) if named else (4.0, 4.0))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.fill(*_ring(1.35 * radius, height), color=SOLID_GROUND, zorder=0)
    ax.plot(*_ring(1.35 * radius, height), color=SOLID_GROUND_EDGE, linewidth=0.8, zorder=0)
    points = {}
    for leg, azimuth in _azimuths(parameters).items():
        foot = _project(radius, height, azimuth)
        points[leg] = foot
        near = 4 if sin(azimuth + VIEW_AZIMUTH) > 0.0 else 1
        for joint, colour, width in (
            (_project(m.joint_radius, -m.joint_depth, azimuth), MAIN, 4.0),
            *(
                (_project(a.joint_radius, -a.joint_depth, azimuth, side), AUXILIARY, 2.2)
                for side in sides
            ),
        ):
            ax.plot(
                *zip(joint, foot),
                color=colour,
                linewidth=width,
                solid_capstyle="round",
                zorder=near,
            )
        ax.fill(*_ring(0.11 * radius, height, foot), color=INK, zorder=near + 1)
    _body(ax, min(m.joint_radius, a.joint_radius), -max(m.joint_depth, a.joint_depth), v.top_height)
    if named:
        _name_parts(ax, parameters, points)
        _number_legs(ax, points)
        _draw_axes(ax, parameters, max(x for x, _ in points.values()))
    return figure


def _azimuths(parameters: Parameters) -> dict[int, float]:
    """Azimuth [rad] of each leg, by its number."""
    return {leg: atan2(sine, cosine) for leg, (sine, cosine) in leg_directions(parameters).items()}


def _project(r: float, h: float, azimuth: float, across: float = 0.0) -> tuple[float, float]:
    """Drawing coordinates [m] of a point of the body, in parallel projection.

    Args:
        r: Radius about the body's axis [m].
        h: Height above the CG [m].
        azimuth: Azimuth [rad]; z points towards the viewer.
        across: Place across the plane of that azimuth [m].
    """
    angle = azimuth + VIEW_AZIMUTH
    x, z = r * cos(angle) - across * sin(angle), r * sin(angle) + across * cos(angle)
    return x, h * cos(VIEW_ELEVATION) - z * sin(VIEW_ELEVATION)


def _ring(
    r: float, h: float, centre: tuple[float, float] | None = None
) -> tuple[list[float], list[float]]:
    x, y = centre if centre is not None else _project(0.0, h, 0.0)
    angles = [2.0 * pi * i / 96 for i in range(97)]
    return [x + r * cos(t) for t in angles], [y + r * sin(t) * sin(VIEW_ELEVATION) for t in angles]


def _body(ax: Any, r: float, bottom: float, top: float) -> None:
    low, high = _project(0.0, bottom, 0.0)[1], _project(0.0, top, 0.0)[1]
    ax.fill(*_ring(r, bottom), color=SOLID, zorder=3)
    ax.fill((-r, r, r, -r), (low, low, high, high), color=SOLID, zorder=3)
    ax.fill(*_ring(r, top), color=SOLID_TOP, zorder=3)
    ax.plot(*_ring(r, top), color=SOLID_EDGE, linewidth=0.8, zorder=3)
    ax.plot(0.0, 0.0, "o", color=INK, markersize=6, zorder=5)


def _name_parts(ax: Any, parameters: Parameters, feet: dict[int, tuple[float, float]]) -> None:
    m, a = parameters.main_strut, parameters.auxiliary_strut
    right = max(feet, key=lambda leg: feet[leg][0])
    azimuth = _azimuths(parameters)[right]
    span = feet[right][0]

    def name(text: str, to: tuple[float, float], at: tuple[float, float]) -> None:
        ax.annotate(
            text,
            to,
            at,
            fontsize=10,
            va="center",
            arrowprops={"arrowstyle": "-", "color": BODY, "linewidth": 0.8},
            zorder=6,
        )

    def middle(r: float, depth: float) -> tuple[float, float]:
        x, y = _project(r, -depth, azimuth)
        return 0.5 * (x + span), 0.5 * (y + feet[right][1])

    name(
        "main strut with damper",
        middle(m.joint_radius, m.joint_depth),
        (0.75 * span, -0.55 * m.joint_depth),
    )
    name(
        "auxiliary strut",
        middle(a.joint_radius, a.joint_depth),
        (0.62 * span, feet[right][1] - 0.62 * span),
    )
    name("footpad", feet[right], (1.02 * span, feet[right][1] - 0.42 * span))
    name("CG of the upper mass", (0.0, 0.0), (0.55 * span, 0.3 * span))
    top = _project(0.0, parameters.vehicle.top_height, 0.0)[1]
    ax.set_ylim(feet[right][1] - 0.8 * span, top + 0.5 * span)


def _number_legs(ax: Any, feet: dict[int, tuple[float, float]]) -> None:
    span = max(x for x, _ in feet.values())
    for leg, (x, y) in feet.items():
        ax.text(
            x + (0.12 if x > 0.0 else -0.12) * span,
            y + 0.05 * span,
            str(leg),
            fontsize=10,
            ha="center",
            color=BODY,
            zorder=6,
        )


def _draw_axes(ax: Any, parameters: Parameters, span: float) -> None:
    arrow = {"arrowstyle": "->", "color": INK, "linewidth": 1.2}
    origin = (-1.25 * span, 0.1 * span)
    for text, (dx, dy) in (("x", (0.35 * span, 0.0)), ("y", (0.0, 0.35 * span))):
        ax.annotate("", (origin[0] + dx, origin[1] + dy), origin, arrowprops=arrow)
        ax.text(
            origin[0] + 1.15 * dx,
            origin[1] + 1.15 * dy,
            text,
            ha="center",
            va="center",
            fontsize=10,
        )
    curved = {**arrow, "connectionstyle": "arc3,rad=-0.5"}
    top = _project(0.0, parameters.vehicle.top_height, 0.0)[1]
    ax.annotate(
        "", (0.3 * span, top + 0.22 * span), (-0.3 * span, top + 0.22 * span), arrowprops=curved
    )
    ax.text(0.36 * span, top + 0.24 * span, "pitch ψ, moments", fontsize=10, va="center")
