"""Cases beside our landings: every number's difference in parts of its tolerance."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..cases.compare import Result
from .style import BANDS, COLOURS, plain_axes

# the least part that is drawn: what is nearer stands there
LEAST = 1e-6


def save_differences(results: Sequence[Result], path: Path) -> None:
    """Draw a row a case to `path` (.png).

    Raises:
        OSError: The file cannot be written.
    """
    from matplotlib.figure import Figure

    from .plots import save_whole

    figure = Figure(figsize=(9.0, 1.2 + 0.45 * len(results)), layout="constrained")
    axes = figure.add_subplot()
    axes.axvspan(LEAST, 1.0, color=BANDS[0])
    for row, result in enumerate(results):
        parts = [min(max(c.part, LEAST), 1e3) for c in result.compared]
        colours = [COLOURS[0] if c.within else COLOURS[1] for c in result.compared]
        axes.scatter(parts, [row] * len(parts), s=14, c=colours, zorder=2)
    axes.set_yticks(range(len(results)), [result.case.name for result in results])
    axes.set_ylim(len(results) - 0.5, -0.5)
    axes.set_xscale("log")
    axes.set_xlabel("difference in parts of the tolerance")
    plain_axes(axes, zero=False)
    save_whole(figure, path)
