"""The counterparts of the paper's Figs. 7 to 19, drawn from a validation.

The printed scalars are marked on the curves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..history import History
from ..quantities import MODES
from .plots import COLOURS, draw_peaks
from .report_marks import ACCELERATION, PAPER, TEST, Curve, draw_marks, marks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..validation.validate import Validation

MEASURED = "#777777"
ORDINALS = ("first", "second", "third")
# each mode's figure numbers in the paper, in this order: force, stroke, loop, auxiliary force,
# acceleration, movement
NUMBERS = {"2-2": (7, 8, 9, 10, 11, 12), "1-2-1": (13, 14, 15, 16, 17, 18)}


def groups(mode: str) -> list[tuple[int, ...]]:
    """The legs of each touchdown, in their order."""
    return [tuple(sorted(leg for leg, _ in g.legs)) for g in MODES[mode]]


def curve_figure(found: Validation, mode: str, curve: Curve) -> tuple[Figure, dict[str, str]]:
    """A quantity of the struts over time, a panel for each touchdown.

    It is the counterpart of Figs. 7, 8, 10, 13, 14 and 16.
    """
    figure, axes = _panels(len(groups(mode)))
    history, measured, tooltips = found.histories[mode], found.measured.get(mode), {}
    for i, (ax, legs) in enumerate(zip(axes, groups(mode))):
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
    figure, axes = _panels(len(groups(mode)))
    history, measured = found.sensed[mode], found.measured.get(mode)
    for i, (ax, legs) in enumerate(zip(axes, groups(mode))):
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
                color="#999999",
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
        color="#9db8c6",
        linewidth=0.9,
        label="this landing, raw",
    )
    draw_peaks(ax, raw, ACCELERATION.column, 1.0, "#9db8c6")
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


def measures_figure(found: Validation) -> Figure:
    """Bars of every damper's measures, and of RRMS where the user gave curves, as Fig. 19."""
    from matplotlib.figure import Figure

    rows = 2 if found.curves else 1
    figure = Figure(figsize=(11.0, 3.3 * rows), layout="constrained")
    grid = figure.add_gridspec(rows, 2, width_ratios=(2, 1))
    labels = [f"{mode}\nleg {leg}" for mode, work in found.work.items() for leg in work]
    work = [w for by_leg in found.work.values() for w in by_leg.values()]
    x = np.arange(len(work))
    ax = figure.add_subplot(grid[0, 0])
    ax.bar(
        x - 0.2,
        [_bar(w.absorbed) for w in work],
        0.38,
        color=COLOURS[0],
        label="absorbed until the largest stroke",
    )
    ax.bar(
        x + 0.2,
        [_bar(w.dissipated) for w in work],
        0.38,
        color=COLOURS[1],
        label="dissipated by the end of the rebound",
    )
    _set_up_bars(ax, x, labels, "energy [J]")
    ax.legend(frameon=False, fontsize=9)
    ax.margins(y=0.25)
    ax = figure.add_subplot(grid[0, 1])
    ax.bar(x, [_bar(w.efficiency) for w in work], 0.6, color=COLOURS[2])
    _set_up_bars(ax, x, labels, "buffering efficiency")
    ax.set_ylim(0.0, 1.0)
    if found.curves:
        ax = figure.add_subplot(grid[1, :])
        x = np.arange(len(found.curves))
        ax.bar(
            x - 0.2, [100 * c.rrms for c in found.curves], 0.38, color=COLOURS[0], label="as it is"
        )
        ax.bar(
            x + 0.2,
            [100 * c.rrms_sensors for c in found.curves],
            0.38,
            color=COLOURS[1],
            label="through the sensor chain",
        )
        _set_up_bars(
            ax,
            x,
            [f"{c.mode}\n{c.column}".replace("_strut.", "\n") for c in found.curves],
            "RRMS [%]",
        )
        ax.legend(frameon=False, fontsize=9)
    return figure


def _bar(value: float | None) -> float:
    """A bar's height; NaN, no bar, where the measure is not known."""
    return float("nan") if value is None else value


def error_figure(found: Validation) -> Figure:
    """Every scalar's error, on one scale.

    The errors are ours against simulation and test, and the paper's simulation against test.
    """
    from matplotlib.figure import Figure

    comparisons = found.all_comparisons
    figure = Figure(figsize=(11.0, 0.9 + 0.19 * len(comparisons)), layout="constrained")
    ax = figure.subplots()
    y = -np.arange(len(comparisons), dtype=float)
    for level, shade in ((20, "#f3f6f8"), (10, "#e6edf1"), (5, "#d5e1e8")):
        ax.axvspan(-level, level, color=shade, linewidth=0)
    ax.axvline(0.0, color="#999999", linewidth=0.6)
    ax.hlines(y, 0.0, _shown([c.error for c in comparisons]), color=COLOURS[0], linewidth=1.0)
    ax.plot(
        _shown([c.error for c in comparisons]),
        y,
        "o",
        color=COLOURS[0],
        markersize=5,
        label="ours - simulation",
    )
    ax.plot(
        _shown([c.error_test for c in comparisons]),
        y,
        "x",
        color=TEST,
        markersize=5,
        label="ours - test",
    )
    ax.plot(
        _shown([c.scalar.paper_error_test for c in comparisons]),
        y,
        "s",
        color=PAPER,
        markerfacecolor="none",
        markersize=4,
        label="the paper's simulation - test",
    )
    ax.set_yticks(y, [c.scalar.id for c in comparisons], fontsize=8)
    ax.set_ylim(y[-1] - 0.8, 0.8)
    ax.set_xlim(-105.0, 105.0)
    ax.set_xlabel(
        "error on the printed simulation's scale [%]; shaded: within 5, 10, 20 %; "
        "an error beyond 100 % is at the edge"
    )
    ax.grid(visible=True, linewidth=0.3)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=True, framealpha=0.9, edgecolor="none", fontsize=9, loc="upper right")
    return figure


def _shown(errors: Sequence[float]) -> NDArray[np.float64]:
    return np.clip(100.0 * np.array(errors), -100.0, 100.0)


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
    ax.axhline(0.0, color="#999999", linewidth=0.6)
    ax.grid(visible=True, linewidth=0.3)
    ax.spines[["top", "right"]].set_visible(False)


def _set_up_bars(ax: Any, x: NDArray[Any], labels: list[str], y: str) -> None:
    ax.set_xticks(x, labels, fontsize=8)
    ax.set_ylabel(y)
    ax.grid(visible=True, axis="y", linewidth=0.3)
    ax.set_axisbelow(True)
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
