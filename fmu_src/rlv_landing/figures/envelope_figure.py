"""The figure of an envelope: boundaries by family, all landings, and critical conditions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..quantities import Quantity, shown
from ..studies.envelope.results import lost_text, stretches
from ..studies.envelope.search import Envelope, Family
from ..studies.sweep.factors import value_text
from .plots import COLOURS, save_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MORE_COLOURS = (*COLOURS, "#7a4fa3", "#b8860b", "#3d3d3d")
# more families than colours begin them anew in the next style
STYLES = ("-", "--", ":")
MARKERS = "osD^v<>Ph*X"
# height of a line of the legend [inch]
LEGEND_LINE = 0.2
# width of the last boundary of a panel, by how much each before it is wider, and the first at most
# [points]
LINE, WIDER, WIDEST = 1.6, 1.4, 4.2


def save_envelope(envelope: Envelope, path: str | Path) -> None:
    """Write a PNG or SVG.

    There is a panel for each combination of the families' values except the first quantity's, which
    is shown by colour. Lines are boundaries, dots are landings (filled: lost). Markers on a line
    give the critical condition, where it changes and halfway between.
    """
    from matplotlib.figure import Figure

    panels = _panels(envelope)
    columns = min(len(panels), 3)
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(1.5 + 4.6 * columns, 1.6 + 4.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).flatten()
    markers = _markers(envelope)
    styles: dict[str, dict[str, Any]] = {}
    for ax, (title, families) in zip(axes, panels.items()):
        for k, family in enumerate(families):
            styles[_name(family)] = _line_style(k, len(families))
            _draw(ax, envelope, family, markers, styles[_name(family)])
        ax.set_title(title, loc="left", fontsize="medium")
        ax.grid(visible=True, linewidth=0.3)
    _name_axes(list(axes), len(panels), columns, envelope)
    _add_legend(figure, styles, markers, 1 if columns == 1 else 2)
    title = (
        f"lost: {lost_text(envelope.study)}\n{envelope.landings} landings "
        f"(a uniform grid: {envelope.uniform})"
    )
    figure.suptitle(title, fontsize="medium", x=0.01, ha="left")
    # the picture grows where legend or title are wider than the panels
    save_whole(figure, Path(path), dpi=110, bbox_inches="tight", pad_inches=0.1)


def _markers(envelope: Envelope) -> dict[str, str]:
    """A marker for each critical condition."""
    conditions = dict.fromkeys(
        r.condition for f in envelope.families for line in f.lines for r in stretches(line)
    )
    return {condition: MARKERS[k % len(MARKERS)] for k, condition in enumerate(conditions)}


def _line_style(k: int, count: int) -> dict[str, Any]:
    """Matplotlib's keywords for the boundary `k` of the `count` in a panel.

    The earlier lines are wider, so that those that others cover show beside them.
    """
    later = count - 1
    return {
        "color": MORE_COLOURS[k % len(MORE_COLOURS)],
        "linewidth": LINE + min(WIDER, WIDEST / max(later, 1)) * (later - k),
        "linestyle": STYLES[k // len(MORE_COLOURS) % len(STYLES)],
    }


def _name_axes(axes: Sequence[Axes], drawn: int, columns: int, envelope: Envelope) -> None:
    """Label the outer axes of the `drawn` panels, and hide those that are not drawn."""
    for ax in axes[drawn:]:
        ax.set_visible(False)
    for ax in axes[max(0, drawn - columns) : drawn]:
        ax.set_xlabel(_label(envelope.study.x.quantity))
        # below some of them is a panel that is not drawn
        ax.tick_params(labelbottom=True)
    for ax in axes[::columns]:
        ax.set_ylabel(_label(envelope.study.y.quantity))


def _add_legend(
    figure: Figure, styles: dict[str, dict[str, Any]], markers: dict[str, str], across: int
) -> None:
    """Name lines, markers and dots in `across` columns below the panels; the figure grows."""
    from matplotlib.lines import Line2D

    grey: dict[str, Any] = {"color": "#666666", "linestyle": "none"}
    named = {name: Line2D([], [], **style) for name, style in styles.items()}
    named |= {name: Line2D([], [], marker=marker, **grey) for name, marker in markers.items()}
    for text, face in (("a landing that is lost", "#666666"), ("one that is not", "none")):
        named[text] = Line2D([], [], marker="o", markersize=3, markerfacecolor=face, **grey)
    figure.legend(
        named.values(),
        named.keys(),
        loc="outside lower center",
        frameon=False,
        fontsize="small",
        ncols=across,
    )
    figure.set_figheight(figure.get_figheight() + LEGEND_LINE * -(-len(named) // across))


def _panels(envelope: Envelope) -> dict[str, list[Family]]:
    panels: dict[str, list[Family]] = {}
    for family in envelope.families:
        rest = list(family.values.items())[1:]
        panels.setdefault(", ".join(f"{n} = {value_text(n, v)}" for n, v in rest), []).append(
            family
        )
    return panels


def _label(q: Quantity) -> str:
    unit, _ = shown(q)
    return f"{q.name} [{unit}]" if unit else q.name


def _name(family: Family) -> str:
    """The family's name in the legend: its first quantity's value."""
    return next(
        (f"{name} = {value_text(name, value)}" for name, value in family.values.items()), "boundary"
    )


def _draw(
    ax: Axes,
    envelope: Envelope,
    family: Family,
    markers: dict[str, str],
    drawn: dict[str, Any],
) -> None:
    """A family's landings and boundaries, the latter `drawn` as matplotlib's keywords say."""
    colour = drawn["color"]
    (_, sx), (_, sy) = shown(envelope.study.x.quantity), shown(envelope.study.y.quantity)
    for lost in (False, True):
        points = [
            (x / sx, y / sy)
            for x, y, landing in family.landings
            if landing.lost(envelope.study.criterion) == lost
        ]
        if points:
            xs, ys = map(list, zip(*points))
            ax.scatter(
                xs,
                ys,
                s=5,
                facecolors=colour if lost else "none",
                edgecolors=colour,
                linewidths=0.4,
                alpha=0.35,
            )
    for line in family.lines:
        ax.plot([c.x / sx for c in line], [c.y / sy for c in line], **drawn)
        for stretch in stretches(line):
            marked = (stretch.points[0], stretch.points[len(stretch.points) // 2])
            xs, ys = [c.x / sx for c in marked], [c.y / sy for c in marked]
            ax.plot(
                xs,
                ys,
                markers[stretch.condition],
                color=colour,
                markeredgecolor="white",
                markersize=7,
                linestyle="none",
            )
