"""The kernels' height field and points of the body, from the user's parameters."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from functools import lru_cache
from math import cos, sin

from ..core import BodyPoint, HeightField
from ..parameters import Parameters
from ..parameters.surroundings import read_points, read_terrain
from .rough_ground import rough_field

NO_FIELD = HeightField(0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0)


def body_points(parameters: Parameters) -> list[BodyPoint]:
    """The points of the body that meet the ground by themselves."""
    return [BodyPoint(*point) for point in read_points(parameters.vehicle.body_points)]


def height_field(parameters: Parameters) -> tuple[HeightField, array[float]]:
    """The height field, and its heights [m] with a node more on each side, row by row.

    The nodes beside a field of a table go on in a straight line, so that a plane is met to its
    edge.

    Raises:
        LandingError: As `rough_field`.
    """
    ground = parameters.ground
    if ground.roughness > 0.0:
        return rough_field(parameters)
    if not ground.terrain:
        return NO_FIELD, array("d", [0.0])
    return _field(ground.terrain, ground.slope_direction)


@lru_cache(maxsize=4)
def _field(text: str, direction: float) -> tuple[HeightField, array[float]]:
    """The field of a text on a slope in a `direction` [rad]; nobody writes to its heights."""
    found = read_terrain(text)
    x, z = found.x, found.z
    rows = [_longer(found.heights[k * x.nodes : (k + 1) * x.nodes]) for k in range(z.nodes)]
    columns = [_longer(column) for column in zip(*rows)]
    numbers = array("d", (h for row in zip(*columns) for h in row))
    return (
        HeightField(
            columns=float(x.nodes),
            rows=float(z.nodes),
            u0=x.first,
            v0=z.first,
            du=x.spacing,
            dv=z.spacing,
            sin_d=sin(direction),
            cos_d=cos(direction),
        ),
        numbers,
    )


def _longer(heights: Sequence[float]) -> list[float]:
    """Heights in a line, with one more at both ends."""
    return [2.0 * heights[0] - heights[1], *heights, 2.0 * heights[-1] - heights[-2]]
