"""The counterparts of the paper's Figs. 7 to 18, drawn from a validation.

The printed scalars are marked on the curves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..history import History
from ..quantities import touchdown_groups
from .plots import draw_peaks
from .report_marks import ACCELERATION, PAPER, Curve, draw_marks, marks
from .style import BEHIND, COLOURS, FAINT, MEASURED, TEST

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..validation.validate import Validation

ORDINALS = ("first", "second", "third")
# each mode's figure numbers in the paper, in this order: force, stroke, loop, auxiliary force,
# acceleration, movement
NUMBERS = {"2-2": (7, 8, 9, 10, 11, 12), "1-2-1": (13, 14, 15, 16, 17, 18)}


def curve_figure(found: Validation, mode: str, curve: Curve) -> tuple[Figure, dict[str, str]]:
    """A quantity of the struts over time, a panel for each touchdown.

    It is the counterpart of Figs. 7, 8, 10, 13, 14 and 16.
    """
    figure, axes = _panels(len(touchdown_groups(mode)))
    history, measured, tooltips = found.histories[mode], found.measured.get(mode), {}
    for i, (ax, legs) in enumerate(zip(axes, touchdown_groups(mode))):
        ax.plot(
            history.time,
            history[curve.column.format(legs[0])] * curve.factor,
            color=COLOURS[i],
            linewidth=1.4,
            label="this landing",
        )
        draw_peaks(ax, history, curve.column.format(legs[0]), curve.factor, COLOURS[i])
        _draw_measured(ax, measured, [curve.column.format(leg) for leg in legs], curve.factor)
        tooltips.update(draw_marks(ax, marks(curve, legs, history, found.comparisons[mode])))
        _set_up(ax, _title(i, legs), "time [s]", curve.label if i == 0 else "")
    _legend(figure, axes[0], measured=measured is not None)
    return figure, tooltips


def loop_figure(found: Validation, mode: str) -> tuple[Figure, dict[str, str]]:
    """Damper force over damper stroke, as Figs. 9 and 15; compression positive.

    The shaded area is the energy absorbed in the first compression.
    """
    figure, axes = _panels(len(touchdown_groups(mode)))
    history, measured = found.sensed[mode], found.measured.get(mode)
    for i, (ax, legs) in enumerate(zip(axes, touchdown_groups(mode))):
        stroke, force = (history[f"leg[{legs[0]}].main_strut.{w}"] for w in ("stroke", "force"))
        ax.plot(
            1e3 * stroke,
            -1e-3 * force,
            color=COLOURS[i],
            linewidth=1.2,
            label="this landing, through the sensor chain",
        )
        work = found.work[mode].get(legs[0])
        if work and work.top and work.stroke_max and work.force_max:
            part = (history.time >= work.start) & (history.time <= work.top)
            ax.fill_between(
                1e3 * stroke[part], -1e-3 * force[part], color=COLOURS[i], alpha=0.15, linewidth=0
            )
            ax.plot(
                [0, 1e3 * work.stroke_max, 1e3 * work.stroke_max],
                [1e-3 * work.force_max] * 2 + [0],
                color=FAINT,
                linewidth=0.8,
                linestyle=":",
            )
            ax.text(
                0.97,
                0.03,
                f"efficiency {work.efficiency:.2f}",
                transform=ax.transAxes,
                ha="right",
                fontsize=9,
            )
        for leg in legs:
            names = [f"leg[{leg}].main_strut.{w}" for w in ("stroke", "force")]
            if measured is not None and all(n in measured for n in names):
                ax.plot(
                    1e3 * measured[names[0]],
                    -1e-3 * measured[names[1]],
                    color=MEASURED,
                    linewidth=0.9,
                    linestyle="--",
                )
        _set_up(ax, _title(i, legs), "stroke [mm]", "compressive force [kN]" if i == 0 else "")
    return figure, {}


def acceleration_figure(found: Validation, mode: str) -> tuple[Figure, dict[str, str]]:
    """The axial acceleration at the top, raw and through the sensor chain, as Figs. 11 and 17."""
    figure, (ax,) = _panels(1)
    raw, sensed, measured = found.histories[mode], found.sensed[mode], found.measured.get(mode)
    ax.plot(
        raw.time,
        raw[ACCELERATION.column],
        color=BEHIND,
        linewidth=0.9,
        label="this landing, raw",
    )
    draw_peaks(ax, raw, ACCELERATION.column, 1.0, BEHIND)
    ax.plot(
        sensed.time,
        sensed[ACCELERATION.column],
        color=COLOURS[0],
        linewidth=1.5,
        label="through the sensor chain (100 Hz)",
    )
    _draw_measured(ax, measured, [ACCELERATION.column], 1.0)
    tooltips = draw_marks(ax, marks(ACCELERATION, (0,), raw, found.comparisons[mode]))
    _set_up(ax, "", "time [s]", ACCELERATION.label)
    _legend(figure, ax, measured=measured is not None)
    return figure, tooltips


def _panels(count: int) -> tuple[Figure, list[Any]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    return figure, list(figure.subplots(1, count, sharey=True, squeeze=False)[0])


def _title(i: int, legs: Sequence[int]) -> str:
    names = "/".join(map(str, legs))
    return f"({'abc'[i]}) {ORDINALS[i]} touchdown, leg{'s' if len(legs) > 1 else ''} {names}"


def _set_up(ax: Any, title: str, x: str, y: str) -> None:
    ax.set_title(title, loc="left", fontsize=10)
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.axhline(0.0, color=FAINT, linewidth=0.6)
    ax.grid(visible=True, linewidth=0.3)
    ax.spines[["top", "right"]].set_visible(False)


def _draw_measured(ax: Any, measured: History | None, names: Sequence[str], factor: float) -> None:
    for name in names:
        if measured is not None and name in measured:
            ax.plot(
                measured.time,
                measured[name] * factor,
                color=MEASURED,
                linewidth=0.9,
                linestyle="--",
                zorder=1,
            )


def _legend(figure: Figure, ax: Any, *, measured: bool) -> None:
    """Draw the legend of lines and marks in one line below the panels."""
    from matplotlib.lines import Line2D

    handles = list(ax.get_legend_handles_labels()[0])
    handles += [
        Line2D(
            [],
            [],
            color=PAPER,
            marker="o",
            markerfacecolor="none",
            linestyle="",
            label="printed, paper's simulation",
        ),
        Line2D([], [], color=COLOURS[0], marker="v", linestyle="", label="true peak, this landing"),
        Line2D([], [], color=PAPER, marker="|", markersize=10, linestyle="", label="printed time"),
        Line2D([], [], color=TEST, marker="x", linestyle="", label="printed, paper's tests"),
    ]
    if measured:
        handles.append(Line2D([], [], color=MEASURED, linestyle="--", label="measured"))
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=9
    )
