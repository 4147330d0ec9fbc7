"""Colours and lines of all pictures and pages, and how pictures are written.

The font of pictures is matplotlib's own, DejaVu Sans; that of pages is `FONT`.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# of curves, in this order
COLOURS = (
    "#0b6e99",
    "#c8553d",
    "#5b8c3e",
    "#8a4fa0",
    "#c79a1e",
    "#3f3f8f",
    "#17a398",
    "#7a5c3e",
)
# of the struts, wherever a vehicle is drawn
MAIN, AUXILIARY = COLOURS[:2]
# text and what is drawn like it, what is beside it, the body's edge, the ground, and areas
INK, FAINT, BODY, GROUND, AREA = "#30363d", "#999999", "#5a6672", "#555555", "#eef1f4"
# a body and the ground in space, with their edges; the ground of a film
SOLID, SOLID_TOP, SOLID_EDGE = "#c3ccd2", "#dde4e8", "#8d99a1"
SOLID_GROUND, SOLID_GROUND_EDGE, FILM_GROUND = "#eef1e6", "#b9c0a8", "#e4e7e9"
# the ground's force, and the viewer's grid and background
FORCE, GRID, PAPER = "#e0a100", "#a8adb2", "#f4f5f6"
# of bands about zero, the widest first, and of lines between rows
BANDS, LINE = ("#f3f6f8", "#e6edf1", "#d5e1e8"), "#d9e1e6"
# of curves beyond the first
MORE_COLOURS = (*COLOURS, "#7a4fa3", "#b8860b", "#3d3d3d")
# of a page's cells that are near, less near, still bearable, and not
WITHIN = {"within5": "#d6ecd9", "within10": "#e9f3d3", "within20": "#fcefc7", "out": "#f8d7d0"}
FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif'
# what is measured, what the paper prints of its tests, and curves behind others
MEASURED, TEST, BEHIND = "#777777", "#b5379a", "#9db8c6"
# what every file is written with; the same figure gives the same bytes, and text stays text
FILES: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "rlv-landing",
}


def page_css() -> str:
    """The style of all pages: colours and font as variables, and `page.css`, which uses them."""
    values = {"ink": INK, "soft": BODY, "line": LINE, "main": MAIN, "pale": AREA, **WITHIN}
    variables = " ".join(f"--{name}: {value};" for name, value in {**values, "font": FONT}.items())
    rules = Path(__file__).with_name("page.css").read_text(encoding="utf-8")
    return f"  :root {{ {variables} }}\n{rules}"


def plain_axes(ax: Axes, *, zero: bool = True) -> None:
    """A faint grid, no frame on the right and above, and on request a line at zero."""
    ax.grid(visible=True, linewidth=0.3)
    ax.spines[["top", "right"]].set_visible(False)
    if zero:
        ax.axhline(0.0, color=FAINT, linewidth=0.6)
