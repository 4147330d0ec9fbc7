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
# of the lines of each part
WIDTHS = {"outline": 1.0, "main": 1.4, "auxiliary": 0.9}
# of a landing in space, the angles that are drawn
ANGLES = ("pitch", "roll", "heading")


def movement_figure(found: Validation, mode: str) -> tuple[Figure, dict[str, str]]:
    """The sequence over the ground, and the pitch over time.

    The paper's time of rest is marked on the pitch.
    """
    figure, _, below = sequence(found.histories[mode], 0.9)
    tooltips = draw_marks(below, marks(PITCH, (0,), found.histories[mode], found.comparisons[mode]))
    below.set_title("| printed: at rest in the paper", loc="left", fontsize=10)
    return figure, tooltips


def movement_in_space(history: History, longest: float) -> Figure:
    """The vehicle at equal times from the side and from behind, and its attitude over time.

    Args:
        history: A landing in space, with its parameters.
        longest: The last time that is drawn, if the landing is as long [s].
    """
    from matplotlib.figure import Figure

    parameters = history.parameters
    assert parameters is not None
    figure = Figure(figsize=(11.0, 5.2), layout="constrained")
    side, behind, below = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.9))
    instants, shades, lines = _instants(history, longest)
    for ax, axis, across in ((side, "x", 0), (behind, "z", 2)):
        for i, shade in enumerate(shades):
            instant = {part: each[i] for part, each in lines.items()}
            _draw(ax, instant, shade, {"hull": 0.5, **WIDTHS}, across)
        _ground(ax, parameters, across)
        ax.set_aspect("equal")
        ax.set_xlabel(f"{axis} [m]")
        ax.set_ylabel("y [m]")
    side.set_title(_caption(instants), loc="left", fontsize=10)
    behind.set_title("from behind, x away from the viewer", loc="left", fontsize=10)
    shown = history.time <= instants[-1]
    for name, colour in zip(ANGLES, COLOURS):
        angle = history[f"body.{name}"][shown] * PITCH.factor
        below.plot(history.time[shown], angle, color=colour, linewidth=1.5, label=name)
    below.set_xlabel("time [s]")
    below.set_ylabel("attitude [deg]")
    below.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=8)
    for each in (side, behind, below):
        plain_axes(each, zero=False)
    return figure


def sequence(history: History, longest: float) -> tuple[Figure, Any, Any]:
    """The vehicle at equal times over the ground, and its pitch over time.

    Args:
        history: The landing, with its parameters.
        longest: The last time that is drawn, if the landing is as long [s].

    Returns:
        The figure, and its axes on the left and on the right.
    """
    from matplotlib.figure import Figure

    parameters = history.parameters
    assert parameters is not None
    figure = Figure(figsize=(11.0, 5.2), layout="constrained")
    ax, below = figure.subplots(1, 2, width_ratios=(1.35, 1.0))
    instants, shades, lines = _instants(history, longest)
    for i, (t, shade) in enumerate(zip(instants, shades)):
        _draw(ax, {part: each[i] for part, each in lines.items()}, shade)
        below.axvline(t, ymax=0.04, color=shade, linewidth=3.0, zorder=0)
    _ground(ax, parameters)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(_caption(instants), loc="left", fontsize=10)
    below.plot(history.time, history["body.pitch"] * PITCH.factor, color=COLOURS[0], linewidth=1.5)
    below.set_xlabel("time [s]; bars: the instants drawn on the left")
    below.set_ylabel("pitch [deg], clockwise positive")
    for each in (ax, below):
        plain_axes(each, zero=False)
    return figure, ax, below


def _instants(history: History, longest: float) -> tuple[Any, Any, dict[str, Lines]]:
    """The times that are drawn [s], a shade for each, and the vehicle at each."""
    from matplotlib import colormaps

    parameters = history.parameters
    assert parameters is not None
    instants = np.linspace(0.0, min(float(history.time[-1]), longest), FRAMES)
    rows = [int(np.argmin(np.abs(history.time - t))) for t in instants]
    shades = colormaps["Blues"](np.linspace(0.18, 1.0, FRAMES))
    return instants, shades, wireframe(history, parameters, rows)


def _caption(instants: Any) -> str:
    end = instants[-1]
    return f"light to dark: t = 0 to {end:.3g} s, every {1e3 * end / (FRAMES - 1):.0f} ms"


def _draw(
    ax: Any,
    lines: dict[str, Lines],
    shade: Any,
    widths: dict[str, float] = WIDTHS,
    across: int = 0,
) -> None:
    """Draw the vehicle; `across` is the axis that is drawn to the right: 0 is x, 2 is z."""
    for part, width in widths.items():
        for line in lines[part]:
            way, height = line[:, across], line[:, 1]
            ax.plot(way, height, color=shade, linewidth=width, solid_capstyle="round")
    feet = lines["feet"].reshape(-1, 3)
    ax.plot(feet[:, across], feet[:, 1], "o", color=shade, markersize=3)


def _ground(ax: Any, parameters: Parameters, across: int = 0) -> None:
    ends = np.array(ax.get_xlim())
    heights = ground_height(parameters, *((ends, 0.0) if across == 0 else (0.0 * ends, ends)))
    ax.plot(ends, heights, color=GROUND, linewidth=1.2, zorder=0)
    ax.set_xlim(*ends)
