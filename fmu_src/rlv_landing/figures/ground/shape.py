"""The ground of a landing as lines and areas: slope, height field, and the deck as it moves."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ...assembly import DeckMotion
from ...assembly.spatial import spatial_model
from ...assembly.surroundings import height_field
from ...core import SpatialInputs
from ...core.bodies.deck import deck_turn, ground_axes
from ...core.ground.terrain import terrain_place
from ...core.records import Vector
from ...history import History
from ...parameters import Parameters

Points = NDArray[np.float64]
STILL = SpatialInputs(*[0.0] * len(SpatialInputs._fields))
# grid lines in each direction on a plane and on a height field, and points of one on the latter
PLANE_LINES, FIELD_LINES, FIELD_POINTS = 9, 25, 73


def deck_of(positions: dict[str, float]) -> SpatialInputs:
    """The deck at the ground's positions, such as `ground.heave`, by name [m, rad]."""
    return STILL._replace(**{name.removeprefix("ground."): at for name, at in positions.items()})


def decks_of(history: History, rows: Iterable[int]) -> list[SpatialInputs]:
    """The deck at samples of a landing: where `decks` of the history has it, else by its `ground`.

    Args:
        history: The landing.
        rows: The samples' indices.
    """
    if history.decks is not None:
        return [history.decks[row] for row in rows]
    motion, time = history.ground, history.time
    if isinstance(motion, DeckMotion):
        return [motion.at(float(time[row] - time[0])) for row in rows]
    found = (motion.at(float(time[row] - time[0])) for row in rows)
    return [STILL._replace(heave=heave, tilt=tilt) for heave, tilt in found]


class GroundShape:
    """A part of the ground, in inertial axes (x forward, y up, z right) wherever its deck is.

    A height field is drawn as far as it goes.

    Args:
        parameters: The landing's.
        x: Least and largest x that it shall have on a deck at rest [m].
        z: The same for z.
    """

    def __init__(
        self, parameters: Parameters, x: tuple[float, float], z: tuple[float, float]
    ) -> None:
        self._model = spatial_model(parameters)
        self._field, self._heights = height_field(parameters)
        self._direction = parameters.ground.slope_direction
        self.is_field = self._field.columns > 0.0
        # a plane seen from above is shorter by the cosine of its slope
        u, v = ((a / self._model.normal_y, b / self._model.normal_y) for a, b in (x, z))
        if self.is_field:
            f = self._field
            u = _within(u, f.u0, f.u0 + (f.columns - 1.0) * f.du)
            v = _within(v, f.v0, f.v0 + (f.rows - 1.0) * f.dv)
        lines, count = (FIELD_LINES, FIELD_POINTS) if self.is_field else (PLANE_LINES, 2)
        along = [self._on_ground(np.linspace(*u, count), at) for at in np.linspace(*v, lines)]
        across = [self._on_ground(at, np.linspace(*v, count)) for at in np.linspace(*u, lines)]
        end = np.full((1, 3), np.nan)
        self._grid = np.concatenate([part for line in (*along, *across) for part in (line, end)])
        self._area = np.concatenate([along[0], along[-1][::-1]])
        self._cut = self._on_ground(np.linspace(*u, FIELD_POINTS), 0.0)

    def grid(self, deck: SpatialInputs = STILL) -> Points:
        """Lines along and across, one after the other, NaN between two: (points, 3) [m]."""
        return self._placed(self._grid, deck)

    def lines(self) -> list[Points]:
        """The lines of `grid` on a deck at rest, one by one, each (points, 3) [m]."""
        points = self.grid()
        ends = np.flatnonzero(np.isnan(points[:, 0]))
        return [line[~np.isnan(line[:, 0])] for line in np.split(points, ends)[:-1]]

    def area(self, deck: SpatialInputs = STILL) -> Points:
        """The edge of a plane: (points, 3) [m]."""
        return self._placed(self._area, deck)

    def cut(self, deck: SpatialInputs = STILL) -> Points:
        """The ground below its own x axis: (points, 3) [m]."""
        return self._placed(self._cut, deck)

    def _on_ground(self, u: Points | float, v: Points | float) -> Points:
        """Points on the ground, in the axes of its plane (1, normal, 2) from its origin."""
        towards = self._direction
        u, v = np.broadcast_arrays(u, v)
        first = np.cos(towards) * u + np.sin(towards) * v
        second = np.cos(towards) * v - np.sin(towards) * u
        heights = np.zeros_like(first)
        if self.is_field:
            width = int(self._field.columns) + 2
            heights[:] = [
                terrain_place(self._field, self._heights, width, Vector(a, 0.0, b)).depth
                for a, b in zip(first.tolist(), second.tolist())
            ]
        return np.stack([first, heights, second], axis=-1)

    def _placed(self, points: Points, deck: SpatialInputs) -> Points:
        axes = np.array(ground_axes(deck_turn(deck), self._model)).reshape(3, 3)
        placed: Points = points @ axes + (deck.surge, deck.heave, deck.sway)
        return placed


def _within(ends: tuple[float, float], low: float, high: float) -> tuple[float, float]:
    return float(np.clip(ends[0], low, high)), float(np.clip(ends[1], low, high))
