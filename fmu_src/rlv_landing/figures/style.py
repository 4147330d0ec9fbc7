"""Colours and lines of all pictures, and how their files are written.

The font is matplotlib's own, DejaVu Sans.
"""

from __future__ import annotations

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
# what is measured, what the paper prints of its tests, and curves behind others
MEASURED, TEST, BEHIND = "#777777", "#b5379a", "#9db8c6"
# what every file is written with; the same figure gives the same bytes, and text stays text
FILES: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "rlv-landing",
}


def plain_axes(ax: Axes, *, zero: bool = True) -> None:
    """A faint grid, no frame on the right and above, and on request a line at zero."""
    ax.grid(visible=True, linewidth=0.3)
    ax.spines[["top", "right"]].set_visible(False)
    if zero:
        ax.axhline(0.0, color=FAINT, linewidth=0.6)
