"""A figure that shows one instant of a landing after another.

It has the vehicle, and its curves with a mark that moves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..history import History
from ..quantities import SPACE
from ..touchdown import leg_directions
from .ground.drawn import DrawnGround, empty_line, set_line
from .ground.shape import GroundShape, Points, decks_of
from .plots import MAIN_FORCE, MAIN_STROKE, legs_together
from .style import COLOURS, FAINT, FORCE, INK
from .wireframe import contact_forces, wireframe

if TYPE_CHECKING:
    from ..parameters import Parameters

WIDTH, HEIGHT = 9.6, 5.28
CURVES = (MAIN_FORCE, MAIN_STROKE)
WIDTHS = {"hull": 0.6, "outline": 1.4, "main": 2.2, "auxiliary": 1.2}
# by part, of what is drawn as marks
MARKS = {"feet": 5, "points": 2}
# length of the largest contact force, in parts of the picture's height
LONGEST_FORCE = 0.45


class MovingFigure:
    """The figure of a landing, WIDTH inches wide; `show(i)` sets it to the i-th of `rows`.

    Args:
        history: The landing's columns over time.
        parameters: The vehicle and its ground.
        rows: The samples that are shown.
        title: The figure's title.
        view: `side` or `3d`.
    """

    def __init__(
        self,
        history: History,
        parameters: Parameters,
        rows: NDArray[np.intp],
        title: str,
        view: str,
    ) -> None:
        from matplotlib.figure import Figure

        self.figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
        self.frames = len(rows)
        self._history, self._rows = history, rows
        self._lines = wireframe(history, parameters, rows)
        self._solid = view == "3d"
        groups = legs_together(parameters.drop.mode, leg_directions(parameters))
        self._colours = {leg: colour for legs, colour in zip(groups, COLOURS) for leg in legs}
        in_space = parameters.drop.mode == SPACE
        self._angles = ("pitch", "roll", "heading") if in_space else ("pitch",)
        self._decks = decks_of(history, rows)
        grid = self.figure.add_gridspec(len(CURVES), 2, width_ratios=(1.0, 1.15))
        # Any: matplotlib's types do not distinguish axes in space
        self._vehicle: Any = self.figure.add_subplot(
            grid[:, 0], **({"projection": "3d", "computed_zorder": False} if self._solid else {})
        )
        self._drawn = {
            part: [self._line(part, i) for i in range(self._lines[part].shape[1])]
            for part in self._lines
        }
        self._set_up_vehicle(parameters, title)
        self._set_up_forces(contact_forces(history, parameters, rows))
        first = [legs[0] for legs in groups]
        axes = [self.figure.add_subplot(grid[i, 1]) for i in range(len(CURVES))]
        self._curves = [self._curve(ax, first, *curve) for ax, curve in zip(axes, CURVES)]
        # above the curves, so that it covers none
        axes[0].legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, frameon=False, fontsize=8
        )
        axes[-1].set_xlabel("time [s]")
        self.show(0)
        # the first layout is kept: one that is made for each frame would shake
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, i: int) -> None:
        """Set vehicle, ground, forces, marks and the printed time to the i-th frame."""
        for part, lines in self._drawn.items():
            for line, points in zip(lines, self._lines[part][i]):
                set_line(line, points)
        set_line(self._forces, self._force_lines[i])
        self._ground.show(self._decks[i])
        row = self._rows[i]
        now = self._history.time[row]
        for bar, dots in self._curves:
            bar.set_xdata((now, now))
            for dot, values in dots:
                dot.set_data((now,), (values[row],))
        turned = (
            f"{name} {np.degrees(self._history[f'body.{name}'][row]):+.2f}°"
            for name in self._angles
        )
        # the three of a landing in space take a line of their own
        between = "   " if len(self._angles) == 1 else "\n"
        self._time_text.set_text(f"t = {now:.3f} s{between}{'  '.join(turned)}")

    def _line(self, part: str, i: int) -> Any:
        style: dict[str, Any]
        if part in MARKS:
            style = {"marker": "o", "markersize": MARKS[part], "linestyle": "", "color": INK}
        else:
            colour = self._colours[i + 1] if part in ("main", "auxiliary") else INK
            visible = self._solid or part != "hull"
            style = {
                "linewidth": WIDTHS[part],
                "color": colour,
                "solid_capstyle": "round",
                "visible": visible,
            }
        return empty_line(self._vehicle, **style)

    def _set_up_vehicle(self, parameters: Parameters, title: str) -> None:
        """Set limits that fit all frames; draw the ground and the text for the time."""
        every = np.concatenate([lines.reshape(-1, 3) for lines in self._lines.values()])
        low, high = every.min(axis=0) - 0.15, every.max(axis=0) + 0.15
        in_space = parameters.drop.mode == SPACE
        if not in_space:
            high[2] = max(-low[2], high[2])
            low[2] = -high[2]
        decks = list(dict.fromkeys(self._decks))
        ways = np.array([(deck.surge, 0.0, deck.sway) for deck in decks])
        first, last = low - ways.max(axis=0), high - ways.min(axis=0)
        shape = GroundShape(parameters, (first[0], last[0]), (first[2], last[2]))
        shown = shape.grid if self._solid else shape.cut
        low[1] = min(low[1], *(float(np.nanmin(shown(deck)[:, 1])) for deck in decks))
        self._set_up_axes(low, high)
        self._ground = DrawnGround(self._vehicle, shape, low[1] - 0.1, in_space=in_space)
        self._reach = LONGEST_FORCE * (high[1] - low[1])
        self._time_text = self._vehicle.set_title(
            "\n" * (len(self._angles) > 1),
            loc="left",
            fontsize=10 if len(self._angles) == 1 else 9,
            family="monospace",
        )
        self.figure.suptitle(title, fontsize=11)

    def _set_up_axes(self, low: Points, high: Points) -> None:
        ax = self._vehicle
        if not self._solid:
            ax.set(xlim=(low[0], high[0]), ylim=(low[1] - 0.1, high[1]))
            ax.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
            ax.spines[["top", "right"]].set_visible(False)
            return
        ax.set(
            xlim=(low[0], high[0]),
            ylim=(-high[2], -low[2]),
            zlim=(low[1], high[1]),
            xlabel="x [m]",
            ylabel="y [m]",
            zlabel="z [m]",
        )
        ax.set_box_aspect((high - low)[[0, 2, 1]], zoom=0.97)
        ax.view_init(elev=14.0, azim=-62.0)
        ax.locator_params(nbins=4)
        ax.tick_params(labelsize=7)

    def _set_up_forces(self, forces: Points) -> None:
        """Make lines from the footpads along the ground's forces, (frames, legs, 3) [N]."""
        largest = float(np.linalg.norm(forces, axis=-1).max())
        feet = self._lines["feet"][:, :, 0]
        ends = feet + forces * (self._reach / largest if largest > 0.0 else 0.0)
        lines = np.stack([feet, ends, np.full_like(feet, np.nan)], axis=2)
        self._force_lines = lines.reshape(self.frames, -1, 3)
        label = f"contact forces, the longest {largest / 1e3:.3g} kN"
        self._forces = empty_line(self._vehicle, color=FORCE, linewidth=2.0, zorder=3, label=label)
        self._vehicle.legend(
            handles=[self._forces],
            loc="upper center",
            bbox_to_anchor=(0.5, -0.1),
            frameon=False,
            fontsize=8,
        )

    def _curve(
        self, ax: Any, legs: list[int], name: str, factor: float, label: str
    ) -> tuple[Any, list[tuple[Any, Any]]]:
        """Draw a quantity of one leg of each touchdown.

        Returns:
            The bar and the dots that move, each dot with the values of its curve.
        """
        span = slice(self._rows[0], self._rows[-1] + 1)
        dots = []
        for leg in legs:
            values = self._history[f"leg[{leg}].{name}"] * factor
            ax.plot(
                self._history.time[span],
                values[span],
                color=self._colours[leg],
                linewidth=1.2,
                label=self._legs_like(leg),
            )
            dots.append(
                (ax.plot((), (), "o", color=self._colours[leg], markersize=6, zorder=5)[0], values)
            )
        bar = ax.axvline(self._history.time[span.start], color=INK, linewidth=1.0, zorder=4)
        ax.axhline(0.0, color=FAINT, linewidth=0.6)
        ax.set_ylabel(label)
        ax.grid(visible=True, linewidth=0.3)
        ax.margins(x=0.0)
        ax.spines[["top", "right"]].set_visible(False)
        return bar, dots

    def _legs_like(self, leg: int) -> str:
        return "leg " + "/".join(
            str(other) for other in self._colours if self._colours[other] == self._colours[leg]
        )
