"""Rough ground from a seed: waves in all directions, none shorter than its length.

Heights are those of a Gaussian surface: the mean of their squares is roughness^2, their correlation
at a distance r exp(-r^2 / length^2). `WAVES` plane waves of the same amplitude make them, with
directions, lengths and phases of the seed; their mean square over the plane is exact. [closure]
"""

from __future__ import annotations

from array import array
from functools import lru_cache
from math import ceil, cos, exp, hypot, log, pi, sin, sqrt
from operator import mul
from random import Random
from typing import NamedTuple

from ..core import HeightField
from ..errors import LandingError
from ..parameters import Parameters

WAVES = 32
# nodes of the grid for each length, and at most on each side of the origin
NODES, MOST = 3, 300
# the field goes on around the vehicle for so long, at the horizontal velocity of the drop [s]
DRIFT = 2.0
# the part of the waves that are shorter than the length, which there are none of
SHORTER = exp(-(pi**2))


class Wave(NamedTuple):
    """A plane wave cos(x u + z v + phase)."""

    x: float  # [rad/m]
    z: float  # [rad/m]
    phase: float  # [rad]


def rough_field(parameters: Parameters) -> tuple[HeightField, array[float]]:
    """The height field, and its heights [m] with a node more on each side, row by row.

    Its axes are the deck's, wherever the slope falls. It covers the vehicle twice, and the way that
    it makes in 2 s.

    Raises:
        LandingError: The length is too short for that.
    """
    ground, drop = parameters.ground, parameters.drop
    most = max(parameters.main_strut.length, parameters.auxiliary_strut.length)
    reach = 2.0 * (parameters.main_strut.joint_radius + most)
    speed = hypot(drop.horizontal_velocity, drop.lateral_velocity)
    reach += speed * (drop.contact_time + DRIFT)
    spacing = ground.roughness_length / NODES
    nodes = ceil(reach / spacing)
    if nodes > MOST:
        raise LandingError(
            f"ground.roughness_length = {ground.roughness_length:g} m is too short for a field "
            f"that reaches {reach:g} m; the limit is {NODES * reach / MOST:.3g} m"
        )
    heights = _heights(int(ground.terrain_seed), ground.roughness_length, nodes, ground.roughness)
    first, count = -nodes * spacing, 2.0 * nodes + 1.0
    return (
        HeightField(
            columns=count,
            rows=count,
            u0=first,
            v0=first,
            du=spacing,
            dv=spacing,
            sin_d=sin(ground.slope_direction),
            cos_d=cos(ground.slope_direction),
        ),
        heights,
    )


def waves(seed: int, length: float) -> list[Wave]:
    """The waves of a seed, in parts of the whole evenly over directions and lengths."""
    draw = Random(seed).random
    order = sorted(range(WAVES), key=lambda _: draw())
    found = []
    for j, k in enumerate(order):
        direction = pi * (j + draw()) / WAVES
        longer = 1.0 - (1.0 - SHORTER) * (k + draw()) / WAVES
        number = 2.0 / length * sqrt(-log(longer))
        found.append(Wave(number * cos(direction), number * sin(direction), 2.0 * pi * draw()))
    return found


@lru_cache(maxsize=4)
def _heights(seed: int, length: float, nodes: int, roughness: float) -> array[float]:
    """Heights at the nodes -`nodes` - 1 to `nodes` + 1 along x and z; nobody writes to them."""
    found = waves(seed, length)
    size = roughness * sqrt(2.0 / WAVES)
    places = [k * length / NODES for k in range(-nodes - 1, nodes + 2)]
    along = [
        [size * part for one in found for part in (cos(one.x * x), sin(one.x * x))] for x in places
    ]
    heights = array("d")
    for z in places:
        turns = [one.z * z + one.phase for one in found]
        across = [part for turn in turns for part in (cos(turn), -sin(turn))]
        heights.extend(sum(map(mul, across, row)) for row in along)
    return heights
