"""Positions of the legs' joints, in ROS axes."""

from __future__ import annotations

from collections.abc import Iterator

from rlv_landing.quantities import LEGS, azimuth, groups_of

from .axes import to_ros


def leg_points(mode: str, radius: float, height: float) -> list[tuple[float, float, float]]:
    """A point of each leg, in the order of `LEGS`, in the body's frame.

    Args:
        mode: the landing mode, one of `MODES`.
        radius: of the points from the body's axis [m].
        height: of the points above the CG [m].

    Returns:
        x forward, y left, z up [m] for each leg.
    """
    azimuths = dict(_azimuths(mode))
    return [
        to_ros(radius * cosine, height, side * radius * sine)
        for sine, cosine, side in (azimuths[leg] for leg in LEGS)
    ]


def _azimuths(mode: str) -> Iterator[tuple[int, tuple[float, float, int]]]:
    for group in groups_of(mode):
        for leg, side in group.legs:
            yield leg, (*azimuth(group.azimuth), side)
