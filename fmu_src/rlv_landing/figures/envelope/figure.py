"""The figure of an envelope: boundaries by family, all landings, and critical conditions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...quantities import Quantity, shown
from ...studies.envelope.results import lost_text, stretches
from ...studies.envelope.search import Envelope, Family
from ...studies.sweep.factors import value_text
from ..plots import save_whole
from ..style import AREA, FAINT, MORE_COLOURS, plain_axes
from .polar import make_polar, scales
from .sides import name_stable_side, shade, stable_word

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# more families than colours begin them anew in the next style
STYLES = ("-", "--", ":")
# a picture has no more marks; conditions beyond share the last
MARKERS = "osD^"
OTHERS = "other conditions: boundary.csv"
# height of a line of the legend [inch]
LEGEND_LINE = 0.2
# width of the last boundary of a panel, by how much each before it is wider, and the first at most
# [points]
LINE, WIDER, WIDEST = 1.6, 1.4, 4.2


def save_envelope(envelope: Envelope, path: str | Path) -> None:
    """Write a PNG or SVG.

    There is a panel for each combination of the families' values except the first quantity's, which
    is shown by colour. Lines are boundaries; the stable side is shaded and named. Markers on a line
    give the critical condition, where it changes and halfway between. Axes of a speed over its
    direction are a polar chart.
    """
    from matplotlib.figure import Figure

    panels = _panels(envelope)
    columns = min(len(panels), 3)
    rows = -(-len(panels) // columns)
    polar = envelope.study.is_polar
    height = 1.6 + (4.8 if polar else 4.2) * rows
    figure = Figure(figsize=(1.5 + 4.6 * columns, height), layout="constrained")
    axes = figure.subplots(
        rows,
        columns,
        squeeze=False,
        sharex=not polar,
        sharey=not polar,
        subplot_kw={"projection": "polar" if polar else None},
    ).flatten()
    markers = _markers(envelope)
    styles: dict[str, dict[str, Any]] = {}
    for ax, (title, families) in zip(axes, panels.items()):
        for k, family in enumerate(families):
            styles[_name(family)] = _line_style(k, len(families))
            _draw(ax, envelope, family, markers, styles[_name(family)])
        name_stable_side(ax, envelope, families)
        ax.set_title(title, loc="left", fontsize="medium")
        if polar:
            make_polar(ax, envelope.study)
        else:
            plain_axes(ax, zero=False)
    _name_axes(list(axes), len(panels), columns, envelope)
    _add_legend(figure, styles, markers, stable_word(envelope))
    # a polar chart's outer label stands above it
    above = "\n" if polar else ""
    title = (
        f"lost: {lost_text(envelope.study)}\n{envelope.landings} landings "
        f"(a uniform grid: {envelope.uniform}){above}"
    )
    figure.suptitle(title, fontsize="medium", x=0.01, ha="left")
    # the picture grows where legend or title are wider than the panels
    save_whole(figure, Path(path), dpi=110, bbox_inches="tight", pad_inches=0.1)


def _markers(envelope: Envelope) -> dict[str, str]:
    """A marker for each critical condition; those with the longest boundaries have their own."""
    length: Counter[str] = Counter()
    for family in envelope.families:
        for stretch in (r for line in family.lines for r in stretches(line)):
            length[stretch.condition] += len(stretch.points)
    most = [condition for condition, _ in length.most_common()]
    if len(most) <= len(MARKERS):
        return dict(zip(most, MARKERS))
    own = len(MARKERS) - 1
    return {**dict(zip(most, MARKERS)), **dict.fromkeys(most[own:], MARKERS[own])}


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
    if envelope.study.is_polar:
        return
    for ax in axes[max(0, drawn - columns) : drawn]:
        ax.set_xlabel(_label(envelope.study.x.quantity))
        # below some of them is a panel that is not drawn
        ax.tick_params(labelbottom=True)
    for ax in axes[::columns]:
        ax.set_ylabel(_label(envelope.study.y.quantity))


def _add_legend(
    figure: Figure, styles: dict[str, dict[str, Any]], markers: dict[str, str], stable: str
) -> None:
    """Name lines, markers and shade below the panels; the figure grows."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    across = 1 if len(figure.axes) == 1 else 2

    grey: dict[str, Any] = {"color": FAINT, "linestyle": "none"}
    named: dict[str, Any] = {name: Line2D([], [], **style) for name, style in styles.items()}
    shared = len(markers) > len(MARKERS)
    for name, marker in markers.items():
        text = OTHERS if shared and marker == MARKERS[-1] else name
        named[text] = Line2D([], [], marker=marker, **grey)
    named[f"shaded: {stable}"] = Patch(facecolor=AREA, edgecolor=FAINT)
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
    """A family's stable side and boundaries, the latter `drawn` as matplotlib's keywords say."""
    colour = drawn["color"]
    sx, sy = scales(envelope.study)
    shade(ax, envelope, family, colour)
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
