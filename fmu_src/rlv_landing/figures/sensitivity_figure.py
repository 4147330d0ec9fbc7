"""Sobol indices as bars, a panel for each response.

Each factor has a first-order and a total index, with their intervals.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..studies.sweep.sensitivity import Indices

PANELS_ACROSS = 3
WIDTH, HEIGHT = 4.6, 0.42


def save_bars(found: Sequence[Indices], path: Path, title: str) -> None:
    """Draw the responses that vary to `path` (.png).

    Raises:
        OSError: The file cannot be written.
    """
    from matplotlib.figure import Figure

    shown = [f for f in found if not np.isnan(f.total).any()]
    across = min(PANELS_ACROSS, max(1, len(shown)))
    down = max(1, -(-len(shown) // across))
    factors = found[0].factors
    figure = Figure(
        figsize=(WIDTH * across, 1.0 + (1.2 + HEIGHT * len(factors)) * down), layout="constrained"
    )
    figure.suptitle(title)
    axes = figure.subplots(down, across, squeeze=False, sharex=True).ravel()
    for axis, indices in zip(axes, shown):
        for offset, values, label, color in (
            (-0.2, indices.first, "alone", "tab:blue"),
            (0.2, indices.total, "in all", "tab:orange"),
        ):
            reach = np.maximum(0.0, [values[:, 0] - values[:, 1], values[:, 2] - values[:, 0]])
            axis.barh(
                np.arange(len(factors)) + offset,
                values[:, 0],
                0.38,
                xerr=reach,
                label=label,
                color=color,
                ecolor="0.3",
                capsize=2,
            )
        axis.set_yticks(np.arange(len(factors)), factors, fontsize=8)
        axis.invert_yaxis()
        axis.set_title(f"{indices.response}, {indices.mode}", fontsize=9)
        axis.axvline(0.0, color="0.6", lw=0.8)
        axis.grid(axis="x", alpha=0.3)
    for axis in axes[len(shown) :]:
        axis.set_axis_off()
    if shown:
        axes[0].legend(fontsize=8, title="share of variance", title_fontsize=8)
    figure.savefig(path, dpi=110)
