"""The vehicle to scale in the plane of two opposite legs, with its dimensions named."""

from __future__ import annotations

from pathlib import Path
from string import ascii_uppercase
from typing import TYPE_CHECKING, NamedTuple

from ..parameters import PARAMETER_QUANTITIES, Parameters
from ..quantities import DISPLAY_UNITS, TRIPOD
from ..touchdown import footpad_at_rest
from .plots import save_whole
from .style import AREA, AUXILIARY, BODY, INK, MAIN

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Point = tuple[float, float]
# what the table says beside the lengths
UNDRAWN = (
    *("vehicle.legs", "vehicle.mass", "vehicle.footpad_mass", "vehicle.inertia"),
    *("main_strut.stroke_max", "main_strut.area_upper", "main_strut.area_lower"),
    *("main_strut.volume_upper", "main_strut.volume_lower", "main_strut.charge_pressure"),
    *("main_strut.orifice_area_compression", "main_strut.orifice_area_rebound"),
)


class Dimension(NamedTuple):
    """A length in the drawing.

    Attributes:
        name: The parameter, or what it is in words.
        start: Where it begins, from the CG, x outward and y up [m].
        end: Where it ends [m].
        column: 0 where its line joins the points; else it is measured along x (above 0) or y
            (below 0), and the number counts the lines outward.
        across: How far the ends are apart across the drawing [m].
    """

    name: str
    start: Point
    end: Point
    column: int
    across: float = 0.0

    @property
    def length(self) -> float:
        """The length that is named [m]."""
        (x1, y1), (x2, y2) = self.start, self.end
        if self.column == 0:
            return float(((x2 - x1) ** 2 + (y2 - y1) ** 2 + self.across**2) ** 0.5)
        return abs(x2 - x1) if self.column > 0 else abs(y2 - y1)


def dimensions(parameters: Parameters) -> list[Dimension]:
    """The lengths of the drawing, in the order of their letters."""
    main, auxiliary, foot = _leg(parameters)
    cg, top = (0.0, 0.0), (0.0, parameters.vehicle.top_height)
    opposite = (-foot[0], foot[1])
    spread = parameters.auxiliary_strut.joint_spread if parameters.leg.kind == TRIPOD else 0.0
    odd = int(parameters.vehicle.legs) % 2 == 1
    across = "diameter of the footpads' circle" if odd else "distance of opposite footpads"
    return [
        Dimension("main_strut.length", main, foot, 0),
        Dimension("auxiliary_strut.length", auxiliary, foot, 0, spread),
        Dimension("main_strut.joint_depth", cg, main, -1),
        Dimension("auxiliary_strut.joint_depth", cg, auxiliary, -2),
        Dimension("footpads below the CG", cg, foot, -3),
        Dimension("vehicle.top_height", cg, top, -3),
        Dimension("main_strut.joint_radius", cg, main, 1),
        Dimension("auxiliary_strut.joint_radius", cg, auxiliary, 2),
        Dimension("radius of the footpads", cg, foot, 3),
        Dimension(across, opposite, foot, 4),
    ]


def save_drawing(parameters: Parameters, path: Path, title: str) -> None:
    """Write the drawing of a vehicle to `path`.

    Args:
        parameters: The vehicle.
        path: The file; its ending chooses the format: .svg, .png or .pdf.
        title: The title.

    Raises:
        OSError: The disk refuses.
    """
    save_whole(vehicle_drawing(parameters, title), path, dpi=150)


def vehicle_drawing(parameters: Parameters, title: str) -> Figure:
    """The vehicle, struts at full length, to scale, with letters for a table of its lengths.

    The body is drawn from its lowest joint to `vehicle.top_height`, as wide as its joints.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 7.5), layout="constrained")
    drawing, table = figure.subplots(1, 2, width_ratios=(3, 2))
    _draw_vehicle(drawing, parameters)
    _draw_dimensions(drawing, parameters)
    drawing.set_aspect("equal")
    drawing.set_axis_off()
    table.set_axis_off()
    table.text(
        0.0, 0.5, _table(parameters), transform=table.transAxes, va="center", color=INK,
        fontsize=9, family="monospace", linespacing=1.5,
    )  # fmt: skip
    figure.suptitle(title, color=INK)
    return figure


def _leg(parameters: Parameters) -> tuple[Point, Point, Point]:
    """Main joint, auxiliary joint and footpad of the leg towards +x."""
    m, a = parameters.main_strut, parameters.auxiliary_strut
    return (
        (m.joint_radius, -m.joint_depth),
        (a.joint_radius, -a.joint_depth),
        footpad_at_rest(parameters),
    )


def _table(parameters: Parameters) -> str:
    rows = [
        (letter, d.name, f"{d.length:.4g} m")
        for letter, d in zip(ascii_uppercase, dimensions(parameters))
    ]
    spread = ("leg.kind", "auxiliary_strut.joint_spread")
    for name in (*UNDRAWN, *(spread if parameters.leg.kind == TRIPOD else ())):
        q = PARAMETER_QUANTITIES[name]
        unit = q.display_unit or q.unit
        _, factor = DISPLAY_UNITS.get(unit, (q.unit, 1.0))
        value = parameters[name]
        told = value if isinstance(value, str) else f"{value / factor:.4g} {unit}"
        rows.append(("", name, told))
    width = max(len(name) for _, name, _ in rows)
    lines = (f"{letter:1s}  {name:{width}s}  {value}" for letter, name, value in rows)
    # pages join spaces of an SVG, but not these
    return "\n".join(lines).replace("  ", 2 * "\N{NO-BREAK SPACE}")


def _draw_vehicle(ax: Axes, parameters: Parameters) -> None:
    main, auxiliary, foot = _leg(parameters)
    half = min(main[0], auxiliary[0])
    bottom, top = min(main[1], auxiliary[1]), parameters.vehicle.top_height
    ax.fill((-half, half, half, -half), (bottom, bottom, top, top), facecolor=AREA, edgecolor=BODY)
    for side in (-1.0, 1.0):
        for joint, colour in ((main, MAIN), (auxiliary, AUXILIARY)):
            ax.plot(
                (side * joint[0], side * foot[0]), (joint[1], foot[1]), color=colour, linewidth=3.0
            )
            ax.plot(side * joint[0], joint[1], "o", color=colour, markersize=5)
        ax.plot(side * foot[0], foot[1], "s", color=INK, markersize=8)
    ax.plot(0.0, 0.0, "o", markersize=9, markerfacecolor="white", color=INK)
    ax.plot(0.0, 0.0, "+", markersize=9, color=INK)
    ax.annotate("CG", (0.0, 0.0), (6, 6), textcoords="offset points", color=INK)


def _draw_dimensions(ax: Axes, parameters: Parameters) -> None:
    _, _, foot = _leg(parameters)
    step = 0.07 * max(2.0 * foot[0], parameters.vehicle.top_height - foot[1])
    for letter, d in zip(ascii_uppercase, dimensions(parameters)):
        if d.column == 0:
            (x1, y1), (x2, y2) = d.start, d.end
            _letter(ax, 0.5 * (x1 + x2), 0.5 * (y1 + y2), letter)
            continue
        if d.column < 0:
            x = -foot[0] + d.column * step
            ends = [(x, y) for y in sorted((d.start[1], d.end[1]))]
            edges = [(x, d.start[1], -abs(d.start[0])), (x, d.end[1], -abs(d.end[0]))]
            for at, y, to in edges:
                ax.plot((at, to), (y, y), color=BODY, linewidth=0.5, linestyle=":")
        else:
            y = foot[1] - d.column * step
            ends = [(x, y) for x in sorted((d.start[0], d.end[0]))]
            for x, to in ((d.start[0], d.start[1]), (d.end[0], d.end[1])):
                ax.plot((x, x), (y, to), color=BODY, linewidth=0.5, linestyle=":")
        arrow = {"arrowstyle": "<->", "color": INK, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", ends[1], ends[0], arrowprops=arrow)
        (x1, y1), (x2, y2) = ends
        _letter(ax, 0.5 * (x1 + x2), 0.5 * (y1 + y2), letter)


def _letter(ax: Axes, x: float, y: float, letter: str) -> None:
    box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none"}
    ax.text(x, y, letter, ha="center", va="center", fontsize=9, color=INK, bbox=box)
