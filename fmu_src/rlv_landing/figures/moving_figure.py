"""A figure that shows one instant of a landing after another.

It has the vehicle, and its curves with a mark that moves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..history import History
from ..touchdown import leg_directions
from .plots import MAIN_FORCE, MAIN_STROKE, legs_of_a_curve
from .style import COLOURS, FAINT, FILM_GROUND, GROUND, INK
from .wireframe import ground_height, wireframe

if TYPE_CHECKING:
    from ..parameters import Parameters

WIDTH, HEIGHT = 9.6, 5.28
CURVES = (MAIN_FORCE, MAIN_STROKE)
WIDTHS = {"hull": 0.6, "outline": 1.4, "main": 2.2, "auxiliary": 1.2}


class MovingFigure:
    """The figure of a landing, WIDTH inches wide; `show(i)` sets it to the i-th of `rows`.

    `view` is `side` or `3d`.
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
        self._legs = sorted(leg_directions(parameters))
        groups = legs_of_a_curve(parameters.drop.mode, self._legs)
        self._colours = {leg: colour for legs, colour in zip(groups, COLOURS) for leg in legs}
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
        first = [min(legs) for legs in groups]
        axes = [self.figure.add_subplot(grid[i, 1]) for i in range(len(CURVES))]
        self._curves = [self._curve(ax, first, *curve) for ax, curve in zip(axes, CURVES)]
        # above the curves, so that it covers none
        axes[0].legend(
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            ncols=len(groups),
            frameon=False,
            fontsize=8,
        )
        axes[-1].set_xlabel("time [s]")
        self.show(0)
        # the first layout is kept: one that is made for each frame would shake
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, i: int) -> None:
        """Set vehicle, marks and the printed time to the i-th frame."""
        for part, lines in self._drawn.items():
            for line, points in zip(lines, self._lines[part][i]):
                if self._solid:
                    line.set_data_3d(points[:, 0], -points[:, 2], points[:, 1])
                else:
                    line.set_data(points[:, 0], points[:, 1])
        row = self._rows[i]
        now = self._history.time[row]
        for bar, dots in self._curves:
            bar.set_xdata((now, now))
            for dot, values in dots:
                dot.set_data((now,), (values[row],))
        pitch = np.degrees(self._history["body.pitch"][row])
        self._time_text.set_text(f"t = {now:.3f} s   pitch {pitch:+.2f}°")

    def _line(self, part: str, i: int) -> Any:
        style: dict[str, Any]
        if part == "feet":
            style = {"marker": "o", "markersize": 5, "linestyle": "", "color": INK}
        else:
            colour = self._colours[self._legs[i]] if part in ("main", "auxiliary") else INK
            visible = self._solid or part != "hull"
            style = {
                "linewidth": WIDTHS[part],
                "color": colour,
                "solid_capstyle": "round",
                "visible": visible,
            }
        (line,) = self._vehicle.plot(*([(), (), ()] if self._solid else [(), ()]), **style)
        return line

    def _set_up_vehicle(self, parameters: Parameters, title: str) -> None:
        """Set limits that fit all frames; draw the ground and the text for the time."""
        ax = self._vehicle
        every = np.concatenate([lines.reshape(-1, 3) for lines in self._lines.values()])
        low, high = every.min(axis=0) - 0.15, every.max(axis=0) + 0.15
        ends = np.array([low[0], high[0]])
        heights = ground_height(parameters, ends)
        low[1] = min(low[1], heights.min())
        if self._solid:
            across = max(-low[2], high[2])
            x, y = np.meshgrid(ends, (-across, across))
            ax.plot_surface(
                x,
                y,
                ground_height(parameters, x, -y),
                color=FILM_GROUND,
                alpha=0.6,
                shade=False,
                linewidth=0,
                zorder=0,
            )
            ax.set(
                xlim=ends,
                ylim=(-across, across),
                zlim=(low[1], high[1]),
                xlabel="x [m]",
                ylabel="y [m]",
                zlabel="z [m]",
            )
            ax.set_box_aspect((ends[1] - ends[0], 2.0 * across, high[1] - low[1]), zoom=0.97)
            ax.view_init(elev=14.0, azim=-62.0)
            ax.locator_params(nbins=4)
            ax.tick_params(labelsize=7)
        else:
            ax.plot(ends, heights, color=GROUND, linewidth=1.2, zorder=0)
            ax.fill_between(ends, heights, low[1] - 0.1, color=FILM_GROUND, zorder=0)
            ax.set(xlim=ends, ylim=(low[1] - 0.1, high[1]), xlabel="x [m]", ylabel="y [m]")
            ax.set_aspect("equal")
            ax.spines[["top", "right"]].set_visible(False)
        self._time_text = ax.set_title("t", loc="left", fontsize=10, family="monospace")
        self.figure.suptitle(title, fontsize=11)

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
            str(other) for other in self._legs if self._colours[other] == self._colours[leg]
        )
