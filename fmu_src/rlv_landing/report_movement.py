"""The movement of the vehicle as a sequence of wireframes, light to dark in time, as the paper's Figs. 12 and 18."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .history import History
from .parameters import Parameters, azimuth
from .plots import COLOURS
from .quantities import LEGS, MODES
from .report_figures import PITCH, draw_marks, marks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .studies.validate import Validation

FRAMES = 13
Line = tuple[tuple[float, float], ...]


def wireframe(history: History, parameters: Parameters, row: int) -> dict[str, list[Line]]:
    """Body, struts and footpads at one sample as lines in the symmetric plane, inertial (x, y) [m]."""
    x, y, pitch = (float(history[f"body.{n}"][row]) for n in ("x", "y", "pitch"))
    sine, cosine = np.sin(pitch), np.cos(pitch)
    v, m, a = parameters.vehicle, parameters.main_strut, parameters.auxiliary_strut

    def place(bx: float, by: float) -> tuple[float, float]:
        return float(x + bx * cosine + by * sine), float(y - bx * sine + by * cosine)

    half, bottom = min(m.joint_radius, a.joint_radius), -max(m.joint_depth, a.joint_depth)
    corners = ((-half, bottom), (half, bottom), (half, v.top_height), (-half, v.top_height), (-half, bottom))
    lines: dict[str, list[Line]] = {"body": [tuple(place(*c) for c in corners)], "main": [], "auxiliary": [], "feet": []}
    turns = {leg: azimuth(g.azimuth)[1] for g in MODES[parameters.drop.mode] for leg, _ in g.legs}
    for leg in LEGS:
        foot = (float(history[f"leg[{leg}].footpad.x"][row]), float(history[f"leg[{leg}].footpad.y"][row]))
        lines["main"].append((place(m.joint_radius * turns[leg], -m.joint_depth), foot))
        lines["auxiliary"].append((place(a.joint_radius * turns[leg], -a.joint_depth), foot))
        lines["feet"].append((foot,))
    return lines


def movement_figure(found: Validation, mode: str) -> tuple[Figure, dict[str, str]]:
    """The sequence over the ground, and the pitch over time with the time at which the paper has the vehicle at rest."""
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    history = found.histories[mode]
    parameters = history.parameters
    assert parameters is not None
    figure = Figure(figsize=(11.0, 5.2), layout="constrained")
    ax, below = figure.subplots(1, 2, width_ratios=(1.35, 1.0))
    end = min(float(history.time[-1]), 0.9)
    shades = colormaps["Blues"](np.linspace(0.18, 1.0, FRAMES))
    for t, shade in zip(np.linspace(0.0, end, FRAMES), shades):
        row = int(np.argmin(np.abs(history.time - t)))
        _draw(ax, wireframe(history, parameters, row), shade)
        below.axvline(t, ymax=0.04, color=shade, linewidth=3.0, zorder=0)
    _ground(ax, parameters)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(f"light to dark: t = 0 to {end:g} s, every {1e3 * end / (FRAMES - 1):.0f} ms", loc="left", fontsize=10)
    below.plot(history.time, history["body.pitch"] * PITCH.factor, color=COLOURS[0], linewidth=1.5)
    said = draw_marks(below, marks(PITCH, (0,), history, found.comparisons[mode]))
    below.set_xlabel("time [s]; bars: the instants drawn on the left")
    below.set_ylabel("pitch [deg], clockwise positive")
    below.set_title("| printed: at rest in the paper", loc="left", fontsize=10)
    for each in (ax, below):
        each.grid(True, linewidth=0.3)
        each.spines[["top", "right"]].set_visible(False)
    return figure, said


def _draw(ax: Any, lines: dict[str, list[Line]], shade: Any) -> None:
    for part, width in (("body", 1.0), ("main", 1.4), ("auxiliary", 0.9)):
        for line in lines[part]:
            ax.plot(*zip(*line), color=shade, linewidth=width, solid_capstyle="round")
    ax.plot(*zip(*(p for line in lines["feet"] for p in line)), "o", color=shade, markersize=3)


def _ground(ax: Any, parameters: Parameters) -> None:
    low, high = ax.get_xlim()
    slope = np.tan(parameters.ground.slope)
    ax.plot((low, high), (-slope * low, -slope * high), color="#555555", linewidth=1.2, zorder=0)
    ax.set_xlim(low, high)
