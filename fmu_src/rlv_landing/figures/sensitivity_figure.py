"""Sobol indices as bars, a panel for each response.

Each factor has a first-order and a total index, with their intervals. All panels have the axis from
0 to 1, where indices are. An interval that goes beyond ends in an arrow with its limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..studies.sweep.sensitivity import Indices
from .plots import save_whole
from .style import COLOURS, FAINT, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PANELS_ACROSS = 3
WIDTH, HEIGHT = 4.6, 0.42
LEFT, RIGHT = -0.25, 1.25
# what is drawn of each factor: place beside its name, index, label, colour
BARS = ((-0.2, "first", "alone", COLOURS[0]), (0.2, "total", "in all", COLOURS[4]))


def save_bars(found: Sequence[Indices], path: Path, title: str) -> None:
    """Draw the indices to `path` (.png).

    Responses without indices are named below, with the reason. Factors for which the samples are
    too few are pale, and say so.

    Raises:
        OSError: The file cannot be written.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    shown = [f for f in found if not f.reason]
    missing = [f"{f.response}, {f.mode}: no indices: {f.reason}" for f in found if f.reason]
    across = min(PANELS_ACROSS, max(1, len(shown)))
    down = -(-len(shown) // across)
    height = 1.3 + (1.2 + HEIGHT * len(found[0].factors)) * down + 0.22 * len(missing)
    figure = Figure(figsize=(max(WIDTH * across, 7.0), height), layout="constrained")
    figure.suptitle(title)
    axes: list[Axes] = []
    if shown:
        axes = list(figure.subplots(down, across, squeeze=False).ravel())
    for axis, indices in zip(axes, shown):
        _draw(axis, indices)
    for axis in axes[len(shown) :]:
        axis.set_axis_off()
    if missing:
        figure.supxlabel("\n".join(missing), fontsize=8, x=0.01, ha="left")
    if shown:
        handles = [Patch(color=color, label=label) for _, _, label, color in BARS]
        figure.legend(
            handles=handles,
            loc="outside upper right",
            ncols=2,
            frameon=False,
            fontsize=8,
            title="share of variance",
            title_fontsize=8,
        )
    # the picture grows where a title or a reason is wider than the panels
    save_whole(figure, path, dpi=110, bbox_inches="tight", pad_inches=0.1)


def _draw(axis: Axes, indices: Indices) -> None:
    """One response's panel."""
    places = range(len(indices.factors))
    enough = [indices.enough(k) for k in places]
    for offset, order, _, color in BARS:
        values = getattr(indices, order)
        for place, (index, low, high), sure in zip(places, values, enough):
            axis.barh(place + offset, index, 0.38, color=color, alpha=1.0 if sure else 0.3)
            _draw_interval(axis, place + offset, low, high)
    for place, sure in zip(places, enough):
        if not sure:
            axis.text(
                0.5,
                place,
                "too few samples",
                ha="center",
                va="center",
                fontsize=8,
                color=COLOURS[1],
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1},
            )
    axis.set_yticks(places, indices.factors, fontsize=8)
    axis.invert_yaxis()
    axis.set_xlim(LEFT, RIGHT)
    axis.set_title(f"{indices.response}, {indices.mode}", fontsize=9)
    axis.axvline(0.0, color=FAINT, lw=0.8)
    axis.grid(axis="x", alpha=0.3)


def _draw_interval(axis: Axes, place: float, low: float, high: float) -> None:
    """An interval as a line with a stroke at each end, or an arrow where it leaves the axis."""
    style: dict[str, Any] = {"color": INK, "lw": 1.1}
    inside = np.clip([low, high], LEFT, RIGHT)
    axis.plot(inside, [place, place], **style)
    for end in (e for e in (low, high) if LEFT <= e <= RIGHT):
        axis.plot(end, place, "|", markersize=5, **style)
    for beyond, limit, marker, side in (
        ([e for e in (low, high) if e < LEFT], LEFT, "<", "left"),
        ([e for e in (low, high) if e > RIGHT], RIGHT, ">", "right"),
    ):
        if beyond:
            axis.plot(limit, place, marker, markersize=5, clip_on=False, **style)
            text = f"  {' to '.join(f'{e:.3g}' for e in beyond)}  "
            axis.text(limit, place - 0.05, text, ha=side, va="bottom", fontsize=7, color=INK)
