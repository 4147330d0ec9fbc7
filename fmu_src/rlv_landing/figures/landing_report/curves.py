"""The pictures of the report: vehicle, movement, and curves over time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from ...quantities import SPACE
from ..drawing import vehicle_drawing
from ..plots import (
    AUXILIARY_FORCE,
    MAIN_FORCE,
    MAIN_STROKE,
    TOP_ACCELERATION,
    draw_peaks,
    drawn_legs,
)
from ..report_movement import movement_in_space, sequence
from ..style import COLOURS, plain_axes
from ..top_view import top_view
from .sections import Landed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GROUND_FORCE = ("contact.force", 1e-3, "force on the footpad [kN]")
UPPER = ("main_strut.pressure_upper", 1e-6, "upper chamber [MPa]")
LOWER = ("main_strut.pressure_lower", 1e-6, "lower chamber [MPa]")
PITCH = ("body.pitch", 57.29577951308232, "pitch [deg], clockwise positive")
MARGIN = ("status.stability_margin", 1.0, "stability margin [m]")
# of the energies, those that are drawn
ENERGIES = ("kinetic", "liquid", "dissipated_orifice", "dissipated_seal", "dissipated_friction")
# how long after the first contact curves are drawn [s]; rest comes slowly
SHOWN_AFTER = 1.5


class Picture(NamedTuple):
    """A figure of the report with its title and what is to know of it."""

    title: str
    note: str
    figure: Figure


def pictures(found: Landed) -> list[Picture]:
    """The pictures of a landing."""
    in_space = found.parameters.drop.mode == SPACE
    each = "a curve for each leg" if in_space else "one curve for legs that are mirror images"
    legs = f"{each}; triangles: true peaks"
    liquid = found.parameters.main_strut.kind == "liquid-spring"
    pairs = [
        ("Main struts", f"compression negative; {legs}", (MAIN_FORCE, MAIN_STROKE)),
        ("Auxiliary struts and ground", legs, (AUXILIARY_FORCE, GROUND_FORCE)),
        *([("Pressures in the dampers", "absolute", (UPPER, LOWER))] if liquid else []),
    ]
    drawn = "struts at full length, to scale"
    if found.parameters.vehicle.leg_overrides:
        drawn += ", a leg without values for itself"
    return [
        Picture("The vehicle", drawn, vehicle_drawing(found.parameters, "")),
        Picture("Movement", "light to dark in time", _movement(found)),
        *([_from_above(found)] if in_space else []),
        *(Picture(title, note, _pair(found, _of_legs, *each)) for title, note, each in pairs),
        Picture("Body", "", _pair(found, _of_body, TOP_ACCELERATION, MARGIN)),
        Picture("Energies over time", "", _energies(found)),
    ]


def _movement(found: Landed) -> Figure:
    if found.parameters.drop.mode == SPACE:
        return movement_in_space(found.history, _end(found))
    return sequence(found.history, _end(found))[0]


def _from_above(found: Landed) -> Picture:
    note = "thick where the ground bears a footpad; polygon: dashed at the start, solid at the end"
    return Picture("Footpads from above", note, top_view(found.history, _end(found)))


def _end(found: Landed) -> float:
    """The last time that is drawn [s]."""
    return min(float(found.history.time[-1]), found.parameters.drop.contact_time + SHOWN_AFTER)


Column = tuple[str, float, str]


def _pair(
    found: Landed, draw: Callable[[Axes, Landed, Column], None], left: Column, right: Column
) -> Figure:
    figure, axes = _panels(2)
    for ax, column in zip(axes, (left, right)):
        draw(ax, found, column)
        ax.set_ylabel(column[2])
        _finish(ax, found)
    if axes[0].get_legend_handles_labels()[1]:
        figure.legend(
            *axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=8, frameon=False
        )
    return figure


def _panels(count: int) -> tuple[Figure, list[Axes]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    return figure, list(figure.subplots(1, count, squeeze=False)[0])


def _finish(ax: Axes, found: Landed) -> None:
    ax.set_xlabel("time [s]")
    ax.set_xlim(0.0, _end(found))
    plain_axes(ax)


def _of_legs(ax: Axes, found: Landed, column: Column) -> None:
    name, factor, _ = column
    history = found.history
    for legs, colour in zip(drawn_legs(history), COLOURS):
        of_leg = f"leg[{legs[0]}].{name}"
        label = "leg " + "/".join(map(str, legs))
        ax.plot(history.time, factor * history[of_leg], color=colour, label=label, linewidth=1.2)
        draw_peaks(ax, history, of_leg, factor, colour)


def _of_body(ax: Axes, found: Landed, column: Column) -> None:
    name, factor, _ = column
    ax.plot(found.history.time, factor * found.history[name], color=COLOURS[0], linewidth=1.2)
    draw_peaks(ax, found.history, name, factor, COLOURS[0])


def _energies(found: Landed) -> Figure:
    figure, (ax,) = _panels(1)
    for name, colour in zip(ENERGIES, COLOURS):
        label = name.replace("dissipated_", "dissipated: ")
        values = found.history[f"energy.{name}"]
        ax.plot(found.history.time, values, color=colour, label=label, linewidth=1.2)
    ax.set_ylabel("energy [J]")
    _finish(ax, found)
    figure.legend(loc="outside right upper", frameon=False)
    return figure
