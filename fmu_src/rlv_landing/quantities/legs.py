"""The four legs: how they stand in a landing mode, and which are mirror images."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import cos, radians, sin

from ..errors import LandingError

LEGS = (1, 2, 3, 4)
# of a landing in space
LEAST_LEGS, MOST_LEGS = 3, 8
# kinds of legs: main and auxiliary strut in a plane that keeps the footpad, or a main strut between
# two auxiliary struts, whose footpad is free
RADIAL, TRIPOD = "radial", "tripod"
# quantities of a leg whose sign changes in its mirror image
MIRRORED = ("footpad.z", "contact.force_z")


@dataclass(frozen=True)
class LegGroup:
    """Legs that are each other's mirror images.

    Attributes:
        azimuth: Azimuth of the legs of side +1 [deg].
        legs: (number, side) of each leg; side -1 is the mirror image, with z reversed.
    """

    azimuth: int
    legs: tuple[tuple[int, int], ...]


# the landing modes; legs are numbered round the body, and no other place knows the mode
MODES: dict[str, tuple[LegGroup, ...]] = {
    "2-2": (LegGroup(135, ((1, 1), (2, -1))), LegGroup(45, ((4, 1), (3, -1)))),
    "1-2-1": (LegGroup(180, ((1, 1),)), LegGroup(90, ((4, 1), (2, -1))), LegGroup(0, ((3, 1),))),
}


def touchdown_groups(mode: str) -> list[tuple[int, ...]]:
    """The numbers of the legs that touch down together, in the order of touchdown."""
    return [tuple(sorted(leg for leg, _ in group.legs)) for group in groups_of(mode)]


# the mode of a landing in space; the others are symmetric
SPACE = "space"


def groups_of(mode: str) -> tuple[LegGroup, ...]:
    """The leg groups of a symmetric landing.

    Raises:
        LandingError: The landing is in space.
    """
    if mode == SPACE:
        raise LandingError(
            f"drop.mode = {SPACE} has no leg groups, and this needs a symmetric landing; "
            f"choose {' or '.join(MODES)}"
        )
    return MODES[mode]


@cache
def azimuth(degrees: float) -> tuple[float, float]:
    """Sine and cosine of an azimuth [deg], exactly 0 at multiples of 90 degrees."""
    s, c = sin(radians(degrees)), cos(radians(degrees))
    return (0.0 if abs(s) < 1e-15 else s), (0.0 if abs(c) < 1e-15 else c)
