"""The vehicle on its four legs, drawn from its parameters: the FMU's icon `model.png` and the
picture of its documentation.
"""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import TYPE_CHECKING, Any

from rlv_landing.parameters import Parameters
from rlv_landing.quantities import MODES
from rlv_landing.touchdown import footpad_at_rest

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# seen from the side, turned so that no leg hides another, and from a little above
TURN, ABOVE = radians(20.0), radians(12.0)
BODY, MAIN, AUXILIARY, PAD, GROUND = "#c3ccd2", "#0b6e99", "#c8553d", "#1d2830", "#eef1e6"


def vehicle_figure(parameters: Parameters, named: bool = False) -> Figure:
    """The upright vehicle with its legs fully extended, the footpads on the ground; `named` writes
    parts, axes and signs beside it.
    """
    from matplotlib.figure import Figure

    v, m, a = parameters.vehicle, parameters.main_strut, parameters.auxiliary_strut
    radius, height = footpad_at_rest(parameters)
    figure = Figure(figsize=(6.4, 5.4) if named else (4.0, 4.0))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.fill(*_ring(1.35 * radius, height), color=GROUND, zorder=0)
    ax.plot(*_ring(1.35 * radius, height), color="#b9c0a8", linewidth=0.8, zorder=0)
    turns = {
        leg: radians(g.azimuth * side) for g in MODES[parameters.drop.mode] for leg, side in g.legs
    }
    points = {}
    for leg, turn in turns.items():
        foot = _seen(radius, height, turn)
        points[leg] = foot
        near = 4 if sin(turn + TURN) > 0.0 else 1
        for joint, colour, width in (
            (_seen(m.joint_radius, -m.joint_depth, turn), MAIN, 4.0),
            (_seen(a.joint_radius, -a.joint_depth, turn), AUXILIARY, 2.2),
        ):
            ax.plot(
                *zip(joint, foot),
                color=colour,
                linewidth=width,
                solid_capstyle="round",
                zorder=near,
            )
        ax.fill(*_ring(0.11 * radius, height, foot), color=PAD, zorder=near + 1)
    _body(ax, min(m.joint_radius, a.joint_radius), -max(m.joint_depth, a.joint_depth), v.top_height)
    if named:
        _names(ax, parameters, points)
    return figure


def _seen(r: float, h: float, turn: float) -> tuple[float, float]:
    """Where a point at radius `r`, height `h` [m] and azimuth `turn` [rad] of the body is drawn; z
    comes towards the eye.
    """
    return r * cos(turn + TURN), h * cos(ABOVE) - r * sin(turn + TURN) * sin(ABOVE)


def _ring(
    r: float, h: float, centre: tuple[float, float] | None = None
) -> tuple[list[float], list[float]]:
    x, y = centre if centre is not None else _seen(0.0, h, 0.0)
    angles = [2.0 * pi * i / 96 for i in range(97)]
    return [x + r * cos(t) for t in angles], [y + r * sin(t) * sin(ABOVE) for t in angles]


def _body(ax: Any, r: float, bottom: float, top: float) -> None:
    low, high = _seen(0.0, bottom, 0.0)[1], _seen(0.0, top, 0.0)[1]
    ax.fill(*_ring(r, bottom), color=BODY, zorder=3)
    ax.fill((-r, r, r, -r), (low, low, high, high), color=BODY, zorder=3)
    ax.fill(*_ring(r, top), color="#dde4e8", zorder=3)
    ax.plot(*_ring(r, top), color="#8d99a1", linewidth=0.8, zorder=3)
    ax.plot(0.0, 0.0, "o", color="#1d2830", markersize=6, zorder=5)


def _names(ax: Any, parameters: Parameters, feet: dict[int, tuple[float, float]]) -> None:
    m, a = parameters.main_strut, parameters.auxiliary_strut
    right = max(feet, key=lambda leg: feet[leg][0])
    turn = {
        leg: radians(g.azimuth * side) for g in MODES[parameters.drop.mode] for leg, side in g.legs
    }[right]
    span = feet[right][0]

    def name(text: str, to: tuple[float, float], at: tuple[float, float]) -> None:
        ax.annotate(
            text,
            to,
            at,
            fontsize=10,
            va="center",
            arrowprops={"arrowstyle": "-", "color": "#5b6a74", "linewidth": 0.8},
            zorder=6,
        )

    def middle(r: float, depth: float) -> tuple[float, float]:
        x, y = _seen(r, -depth, turn)
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
    for leg, (x, y) in feet.items():
        ax.text(
            x + (0.12 if x > 0.0 else -0.12) * span,
            y + 0.05 * span,
            str(leg),
            fontsize=10,
            ha="center",
            color="#5b6a74",
            zorder=6,
        )
    arrow = {"arrowstyle": "->", "color": "#1d2830", "linewidth": 1.2}
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
    top = _seen(0.0, parameters.vehicle.top_height, 0.0)[1]
    ax.annotate(
        "", (0.3 * span, top + 0.22 * span), (-0.3 * span, top + 0.22 * span), arrowprops=curved
    )
    ax.text(0.36 * span, top + 0.24 * span, "pitch ψ, moments", fontsize=10, va="center")
    ax.set_ylim(feet[right][1] - 0.8 * span, top + 0.5 * span)
