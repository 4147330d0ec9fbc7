"""Where the legs' joints sit, in ROS axes."""

from __future__ import annotations

from collections.abc import Iterator

from rlv_landing.parameters import azimuth
from rlv_landing.quantities import LEGS, MODES

from .axes import to_ros


def around(mode: str, radius: float, height: float) -> list[tuple[float, float, float]]:
    """For each leg, by its number, the point at `radius` from the axis and `height` above the CG
    [m]: x forward, y left, z up.
    """
    turns = dict(_turns(mode))
    return [
        to_ros(radius * cosine, height, side * radius * sine)
        for sine, cosine, side in (turns[leg] for leg in LEGS)
    ]


def _turns(mode: str) -> Iterator[tuple[int, tuple[float, float, int]]]:
    for group in MODES[mode]:
        for leg, side in group.legs:
            yield leg, (*azimuth(group.azimuth), side)
