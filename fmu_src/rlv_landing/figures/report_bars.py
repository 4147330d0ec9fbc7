"""The bars of a validation: every damper's measures, and every scalar's error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .report_marks import PAPER
from .style import BANDS, COLOURS, FAINT, TEST

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
    energies = {
        "absorbed until the largest stroke": [_bar(w.absorbed) for w in work],
        "dissipated by the end of the rebound": [_bar(w.dissipated) for w in work],
    }
    ax = figure.add_subplot(grid[0, 0])
    _draw_pairs(ax, energies, labels, "energy [J]")
    ax.margins(y=0.25)
    ax = figure.add_subplot(grid[0, 1])
    x = np.arange(len(work))
    ax.bar(x, [_bar(w.efficiency) for w in work], 0.6, color=COLOURS[2])
    _set_up_bars(ax, x, labels, "buffering efficiency")
    ax.set_ylim(0.0, 1.0)
    if found.curves:
        deviations = {
            "as it is": [100 * c.rrms for c in found.curves],
            "through the sensor chain": [100 * c.rrms_sensors for c in found.curves],
        }
        names = [f"{c.mode}\n{c.column}".replace("_strut.", "\n") for c in found.curves]
        _draw_pairs(figure.add_subplot(grid[1, :]), deviations, names, "RRMS [%]")
    return figure


def _draw_pairs(ax: Any, pairs: dict[str, list[float]], labels: list[str], y: str) -> None:
    """Draw two bars beside each other at each label.

    Args:
        ax: The axes.
        pairs: The heights of the left and of the right bars, by their names in the legend.
        labels: The labels of the pairs.
        y: The label of the vertical axis.
    """
    x = np.arange(len(labels))
    for side, colour, (name, heights) in zip((-0.2, 0.2), COLOURS, pairs.items()):
        ax.bar(x + side, heights, 0.38, color=colour, label=name)
    _set_up_bars(ax, x, labels, y)
    ax.legend(frameon=False, fontsize=9)


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
    for level, shade in zip((20, 10, 5), BANDS):
        ax.axvspan(-level, level, color=shade, linewidth=0)
    ax.axvline(0.0, color=FAINT, linewidth=0.6)
    ours = _shown([c.error for c in comparisons])
    test = _shown([c.error_test for c in comparisons])
    paper = _shown([c.scalar.paper_error_test for c in comparisons])
    ax.hlines(y, 0.0, ours, color=COLOURS[0], linewidth=1.0)
    ax.plot(ours, y, "o", color=COLOURS[0], markersize=5, label="ours - simulation")
    ax.plot(test, y, "x", color=TEST, markersize=5, label="ours - test")
    hollow: dict[str, Any] = {"color": PAPER, "markerfacecolor": "none", "markersize": 4}
    ax.plot(paper, y, "s", label="the paper's simulation - test", **hollow)
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
