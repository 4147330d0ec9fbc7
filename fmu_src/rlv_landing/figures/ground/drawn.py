"""The ground in a film, in space or from aside, wherever its deck is."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from ...core import SpatialInputs
from ..style import FILM_GROUND, GROUND, SOLID_GROUND_EDGE
from .shape import GroundShape, Points


class DrawnGround:
    """The ground on axes; `show` moves it to where its deck is.

    A plane has an area. In space, and from aside in a landing in space, the ground has a grid; from
    aside, a line.

    Args:
        ax: The axes, in space or of a view from aside.
        shape: The ground's shape.
        bottom: Height of the lower edge of a view from aside [m].
        in_space: Whether the landing is in space.
    """

    def __init__(self, ax: Any, shape: GroundShape, bottom: float, *, in_space: bool) -> None:
        self._shape, self._bottom = shape, bottom
        self._deck: SpatialInputs | None = None
        self._solid = is_in_space(ax)
        self._area: Any = None
        self._grid: Any = None
        self._edge: Any = None
        colour: dict[str, Any] = {"facecolor": FILM_GROUND, "zorder": 0}
        if self._solid and not shape.is_field:
            art = import_module("mpl_toolkits.mplot3d.art3d")
            self._area = art.Poly3DCollection([np.zeros((4, 3))], alpha=0.6, **colour)
            ax.add_collection3d(self._area)
        elif not self._solid and not in_space:
            (self._area,) = ax.fill((0.0,) * 3, (0.0,) * 3, **colour)
        if in_space or self._solid:
            self._grid = empty_line(ax, color=SOLID_GROUND_EDGE, linewidth=0.5, zorder=0.5)
        if not self._solid:
            self._edge = empty_line(ax, color=GROUND, linewidth=1.2, zorder=0.6)

    def show(self, deck: SpatialInputs) -> None:
        """Draw it on `deck`; nothing is done where it is there already."""
        if deck == self._deck:
            return
        self._deck = deck
        if self._grid is not None:
            set_line(self._grid, self._shape.grid(deck))
        if self._solid:
            if self._area is not None:
                self._area.set_verts([in_view(self._shape.area(deck))])
            return
        cut = self._shape.cut(deck)
        set_line(self._edge, cut)
        if self._area is not None:
            x, y = cut[:, 0], cut[:, 1]
            self._area.set_xy([*zip(x, y), (x[-1], self._bottom), (x[0], self._bottom)])


def is_in_space(ax: Any) -> bool:
    """Whether axes are in space."""
    return hasattr(ax, "zaxis")


def empty_line(ax: Any, **style: Any) -> Any:
    """A line of axes that has no points yet."""
    (line,) = ax.plot(*([()] * (3 if is_in_space(ax) else 2)), **style)
    return line


def set_line(line: Any, points: Points) -> None:
    """Set a line to `points` of the inertial axes, (points, 3) [m]."""
    if hasattr(line, "set_data_3d"):
        line.set_data_3d(*in_view(points).T)
    else:
        line.set_data(points[:, 0], points[:, 1])


def in_view(points: Points) -> Points:
    """Points of the inertial axes in ROS's axes (z up), in which the view in space is."""
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)
