"""The overview of a landing, and figures as SVG in a page."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..history import History
from ..quantities import MOST_LEGS, SPACE, touchdown_groups
from ..text.durable import whole_file
from .style import COLOURS, FILES, INK, plain_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# what is drawn of a leg, and of the body: the column, its factor from SI, and the axis's label
MAIN_FORCE = ("main_strut.force", 1e-3, "main strut force [kN]")
MAIN_STROKE = ("main_strut.stroke", 1e3, "main strut stroke [mm]")
AUXILIARY_FORCE = ("auxiliary_strut.force", 1e-3, "auxiliary strut force [kN]")
# of a tripod
SECOND_FORCE = ("auxiliary_strut_2.force", 1e-3, "second auxiliary strut force [kN]")
DRAWN_OF_A_LEG = (MAIN_FORCE, MAIN_STROKE, AUXILIARY_FORCE)
TOP_ACCELERATION = ("body.top_axial_acceleration", 1.0, "axial acceleration\nat the top [m/s²]")

# the columns that `save_overview` needs, where a vehicle has them
ANY_LEGS = range(1, MOST_LEGS + 1)
COLUMNS = frozenset(
    (
        *(f"leg[{leg}].{column}" for leg in ANY_LEGS for column, _, _ in DRAWN_OF_A_LEG),
        *(f"leg[{leg}].contact.force_y" for leg in ANY_LEGS),
        *(f"leg[{leg}].{SECOND_FORCE[0]}" for leg in ANY_LEGS),
        TOP_ACCELERATION[0],
    )
)


def draw_peaks(ax: Axes, history: History, column: str, factor: float, colour: str) -> None:
    """Mark the extremes of a column at their true values and times, between the samples too.

    Nothing is marked where only samples are known, nor an extreme at the start.
    """
    if history.extremes is None or column not in history.extremes:
        return
    found = history.extremes[column]
    for value, time, marker in (
        (found.minimum, found.minimum_time, "^"),
        (found.maximum, found.maximum_time, "v"),
    ):
        if time > history.time[0]:
            ax.plot(time, factor * value, marker, color=colour, markersize=5)


def save_overview(history: History, path: str | Path, title: str) -> None:
    """Write a picture of main strut forces, strokes, auxiliary strut forces and top acceleration.

    Legs that are mirror images share a curve. Dotted lines mark each leg's first contact, triangles
    true peaks; a tripod's second auxiliary strut is dashed.

    Raises:
        OSError: The disk refuses.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 8.0), layout="constrained")
    axes = figure.subplots(4, 1, sharex=True)
    groups = drawn_legs(history)
    for legs, colour in zip(groups, COLOURS):
        leg = legs[0]
        label = "leg " + "/".join(map(str, legs))
        for ax, (what, factor, _) in zip(axes, DRAWN_OF_A_LEG):
            column = f"leg[{leg}].{what}"
            ax.plot(history.time, factor * history[column], color=colour, label=label)
            draw_peaks(ax, history, column, factor, colour)
        what, factor, _ = SECOND_FORCE
        if (column := f"leg[{leg}].{what}") in history:
            axes[2].plot(history.time, factor * history[column], color=colour, linestyle="--")
            draw_peaks(axes[2], history, column, factor, colour)
        touching = np.flatnonzero(history[f"leg[{leg}].contact.force_y"] > 0.0)
        if len(touching):
            for ax in axes:
                ax.axvline(history.time[touching[0]], color=colour, linestyle=":", linewidth=0.8)
    column, factor, _ = TOP_ACCELERATION
    axes[3].plot(history.time, factor * history[column], color=INK, linewidth=1.0)
    draw_peaks(axes[3], history, column, factor, INK)
    for ax, (_, _, label) in zip(axes, (*DRAWN_OF_A_LEG, TOP_ACCELERATION)):
        ax.set_ylabel(label)
        plain_axes(ax)
        ax.margins(x=0.0)
    # above the curves, beside the title: inside, some vehicle's curves would cross it
    above = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.2}
    axes[0].legend(**above, frameon=False, ncols=len(groups))
    axes[0].set_title(title, loc="left")
    axes[-1].set_xlabel(
        "time [s]   (dotted: first contact; triangles: peaks; "
        "forces negative in compression, strokes positive)"
    )
    save_whole(figure, Path(path), dpi=120)


def save_whole(figure: Figure, path: Path, **options: Any) -> None:
    """Write a figure to `path`, in the format of its ending, whole or not at all.

    The same figure gives the same bytes, and the text of an SVG is text.

    Args:
        figure: The figure.
        path: The file.
        options: Those of `Figure.savefig`.

    Raises:
        OSError: The disk refuses.
    """
    from matplotlib import rc_context

    dates = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    if path.suffix in dates:
        options["metadata"] = dates[path.suffix]
    with rc_context(FILES), whole_file(path) as file:
        figure.savefig(file, format=path.suffix[1:], **options)


def inline_svg(
    figure: Figure, prefix: str, label: str, tooltips: dict[str, str] | None = None
) -> str:
    """A figure as SVG to stand in a page: without links, text as text.

    Args:
        figure: The figure.
        prefix: Put before all ids, so that figures of one page have different ones.
        label: The picture's text for readers who cannot see it.
        tooltips: The tooltip of each mark by the mark's name.
    """
    import matplotlib as mpl

    out = io.StringIO()
    with mpl.rc_context({**FILES, "svg.hashsalt": prefix}):
        figure.savefig(
            out,
            format="svg",
            metadata={"Date": None, "Creator": None, "Format": None, "Type": None},
        )
    svg = out.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'\s+xmlns(:\w+)?="[^"]*"', "", svg).replace("xlink:href", "href")
    svg = re.sub(r'\bid="', f'id="{prefix}-', svg)
    svg = re.sub(r'href="#', f'href="#{prefix}-', svg)
    svg = svg.replace("url(#", f"url(#{prefix}-")
    for name, text in (tooltips or {}).items():
        opening = f'<g id="{prefix}-mark-{name}">'
        svg = svg.replace(opening, f"{opening}<title>{escape(text)}</title>", 1)
    return svg.replace("<svg ", f'<svg role="img" aria-label="{escape(label)}" ', 1)


def drawn_legs(history: History) -> list[tuple[int, ...]]:
    """The legs that share a curve: mirror images, by touchdown; in space each alone."""
    mode = history.parameters.drop.mode if history.parameters is not None else SPACE
    return legs_together(mode, history.legs)


def legs_together(mode: str, legs: Iterable[int]) -> list[tuple[int, ...]]:
    """As `drawn_legs`, of a landing in `mode` on `legs`."""
    return [(leg,) for leg in legs] if mode == SPACE else touchdown_groups(mode)
