"""The movement of the vehicle as a sequence of wireframes, light to dark in time.

It is the counterpart of the paper's Figs. 12 and 18.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..history import History
from ..parameters import Parameters
from .report_marks import PITCH, draw_marks, marks
from .style import COLOURS, GROUND, plain_axes
from .wireframe import Lines, ground_height, wireframe

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..validation.validate import Validation

FRAMES = 13


def movement_figure(found: Validation, mode: str) -> tuple[Figure, dict[str, str]]:
    """The sequence over the ground, and the pitch over time.

    The paper's time of rest is marked on the pitch.
    """
    figure, _, below = sequence(found.histories[mode], 0.9)
    tooltips = draw_marks(below, marks(PITCH, (0,), found.histories[mode], found.comparisons[mode]))
    below.set_title("| printed: at rest in the paper", loc="left", fontsize=10)
    return figure, tooltips


def sequence(history: History, longest: float) -> tuple[Figure, Any, Any]:
    """The vehicle at equal times over the ground, and its pitch over time.

    Args:
        history: The landing, with its parameters.
        longest: The last time that is drawn, if the landing is as long [s].

    Returns:
        The figure, and its axes on the left and on the right.
    """
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    parameters = history.parameters
    assert parameters is not None
    figure = Figure(figsize=(11.0, 5.2), layout="constrained")
    ax, below = figure.subplots(1, 2, width_ratios=(1.35, 1.0))
    end = min(float(history.time[-1]), longest)
    shades = colormaps["Blues"](np.linspace(0.18, 1.0, FRAMES))
    instants = np.linspace(0.0, end, FRAMES)
    lines = wireframe(
        history, parameters, [int(np.argmin(np.abs(history.time - t))) for t in instants]
    )
    for i, (t, shade) in enumerate(zip(instants, shades)):
        _draw(ax, {part: each[i] for part, each in lines.items()}, shade)
        below.axvline(t, ymax=0.04, color=shade, linewidth=3.0, zorder=0)
    _ground(ax, parameters)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(
        f"light to dark: t = 0 to {end:.3g} s, every {1e3 * end / (FRAMES - 1):.0f} ms",
        loc="left",
        fontsize=10,
    )
    below.plot(history.time, history["body.pitch"] * PITCH.factor, color=COLOURS[0], linewidth=1.5)
    below.set_xlabel("time [s]; bars: the instants drawn on the left")
    below.set_ylabel("pitch [deg], clockwise positive")
    for each in (ax, below):
        plain_axes(each, zero=False)
    return figure, ax, below


def _draw(ax: Any, lines: dict[str, Lines], shade: Any) -> None:
    for part, width in (("outline", 1.0), ("main", 1.4), ("auxiliary", 0.9)):
        for line in lines[part]:
            ax.plot(line[:, 0], line[:, 1], color=shade, linewidth=width, solid_capstyle="round")
    ax.plot(
        lines["feet"][..., 0].ravel(), lines["feet"][..., 1].ravel(), "o", color=shade, markersize=3
    )


def _ground(ax: Any, parameters: Parameters) -> None:
    ends = np.array(ax.get_xlim())
    ax.plot(ends, ground_height(parameters, ends), color=GROUND, linewidth=1.2, zorder=0)
    ax.set_xlim(*ends)
