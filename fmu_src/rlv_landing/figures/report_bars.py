"""The bars of a validation: every damper's measures, and every scalar's error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .plots import COLOURS
from .report_marks import PAPER, TEST

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..validation.validate import Validation


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


def _set_up_bars(ax: Any, x: NDArray[Any], labels: list[str], y: str) -> None:
    ax.set_xticks(x, labels, fontsize=8)
    ax.set_ylabel(y)
    ax.grid(visible=True, axis="y", linewidth=0.3)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
