"""The pictures of a Monte Carlo's report: causes of loss, directions of toppling, loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from ...quantities import shown
from ...studies.montecarlo.study import MonteCarlo, low_is_bad
from ...studies.montecarlo.summary import Load, Summary, lost_run
from ...studies.sweep.responses import every_response
from ..style import AREA, COLOURS, INK, plain_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ACROSS = 3
BINS = 40
# the worst percentile is drawn
LOST_COLOUR = COLOURS[1]


@dataclass(frozen=True)
class Picture:
    """A picture with its title and a note."""

    title: str
    note: str
    figure: Figure


def pictures(found: Summary, study: MonteCarlo, rows: Sequence[Mapping[str, Any]]) -> list[Picture]:
    """The pictures of the report.

    Args:
        found: The summary.
        study: The study.
        rows: Its rows.
    """
    drawn = []
    if found.causes:
        drawn.append(Picture("Causes of loss", "runs by cause", _causes(found)))
    if found.directions:
        note = "runs that toppled, by the direction across the edge that the CG passed; "
        note += "0 deg is inertial x, 90 deg is z; seen from above, x up"
        drawn.append(Picture("Directions of toppling", note, _rose(found)))
    if found.loads:
        note = "runs by value; lost ones in red; dashed: the largest percentile, with its interval"
        drawn.append(Picture("Loads and margins", note, _loads(found, study, rows)))
    return drawn


def _causes(found: Summary) -> Figure:
    from matplotlib.figure import Figure

    names, counts = list(found.causes), list(found.causes.values())
    figure = Figure(figsize=(9.0, 0.8 + 0.32 * len(names)), layout="constrained")
    ax = figure.subplots()
    bars = ax.barh(names, counts, color=LOST_COLOUR)
    ax.bar_label(bars, [f"{c}, {100.0 * c / found.runs:.2g} %" for c in counts], padding=3)
    ax.invert_yaxis()
    ax.set_xlabel("runs")
    ax.margins(x=0.15)
    plain_axes(ax, zero=False)
    return figure


def _rose(found: Summary) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0, 4.6), layout="constrained")
    ax: Any = figure.subplots(subplot_kw={"projection": "polar"})
    ax.set_theta_zero_location("N")
    # from x towards z is clockwise, seen from above
    ax.set_theta_direction(-1)
    width = 2.0 * pi / len(found.directions)
    angles = np.arange(len(found.directions)) * width
    ax.bar(angles, found.directions, 0.92 * width, color=LOST_COLOUR)
    ax.grid(linewidth=0.4)
    return figure


def _loads(found: Summary, study: MonteCarlo, rows: Sequence[Mapping[str, Any]]) -> Figure:
    from matplotlib.figure import Figure

    lines = ceil(len(found.loads) / ACROSS)
    figure = Figure(figsize=(11.0, 2.7 * lines), layout="constrained")
    axes = figure.subplots(lines, ACROSS, squeeze=False).flatten()
    lost = [lost_run(row, study.criterion) for row in rows]
    for ax, load in zip(axes, found.loads):
        _draw_load(ax, load, rows, lost)
    for ax in axes[len(found.loads) :]:
        ax.set_axis_off()
    return figure


def _draw_load(
    ax: Any, load: Load, rows: Sequence[Mapping[str, Any]], lost: Sequence[bool]
) -> None:
    """The histogram of one load, with its worst percentile."""
    unit, size = shown(every_response()[load.name])
    sides = [
        [row[load.name] / size for row, one in zip(rows, lost) if one is which and _has(row, load)]
        for which in (False, True)
    ]
    ax.hist(sides, BINS, stacked=True, histtype="stepfilled", color=[COLOURS[0], LOST_COLOUR])
    if load.percentiles:
        worst = load.percentiles[-1]
        ax.axvline(worst.value / size, color=INK, linestyle="--", linewidth=1.0)
        if worst.low is not None and worst.high is not None:
            ax.axvspan(worst.low / size, worst.high / size, color=AREA, zorder=0)
        side = "above" if low_is_bad(load.name) else "below"
        title = f"{worst.percent:g} % {side} {worst.value / size:.4g} {unit}"
        ax.set_title(title, fontsize="small", loc="left")
    ax.set_xlabel(f"{load.name} [{unit or 1}]", fontsize="small")
    ax.tick_params(labelsize="small")
    plain_axes(ax, zero=False)


def _has(row: Mapping[str, Any], load: Load) -> bool:
    return row[load.name] is not None
