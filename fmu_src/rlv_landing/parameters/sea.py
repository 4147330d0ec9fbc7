"""A deck at sea: the waves, the ship that they move, and the place of the deck on it."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Annotated

from ..errors import LandingError
from .declaration import listed, real
from .operators import check_covered

# [m/s2]: waves are those of the Earth, whatever gravity the vehicle lands in
WAVE_GRAVITY = 9.80665
# the band of frequencies that has all waves, in parts of the peak's. A Pierson-Moskowitz spectrum
# has 1.5 % of its variance above it, and 1e-6 below [closure]
LOWEST, HIGHEST = 0.55, 3.0
# height over length of the waves at the peak, beyond which a sea breaks [closure]
STEEPEST_SEA = 1.0 / 15.0


@dataclass(frozen=True)
class Sea:
    """The sea below a deck, and its ship, whose bow is along inertial x; mode = space."""

    wave_height: Annotated[
        float,
        "significant wave height Hs of the sea below the deck; 0: no sea; mode = space",
        real("m", 0.0, 30.0),
    ] = 0.0
    peak_period: Annotated[
        float, "period Tp of the spectrum's peak; mode = space", real("s", 2.0, 30.0)
    ] = 8.0
    peak_enhancement: Annotated[
        float,
        "gamma of the JONSWAP spectrum; 1: Pierson-Moskowitz; mode = space",
        real("", 1.0, 10.0),
    ] = 3.3
    direction: Annotated[
        float,
        "direction in which the waves travel, from +x, the ship's bow, towards +z, starboard; "
        "mode = space",
        real("rad", -3.2, 3.2, display_unit="deg"),
    ] = 0.0
    seed: Annotated[
        float,
        "number whose whole part gives the waves' phases, and their frequencies in their bands; "
        "mode = space",
        real("", 0.0, 2.0**53 - 1.0),
    ] = 0.0
    time: Annotated[
        float,
        "time of the sea at first contact; another one is another moment of the same sea; "
        "mode = space",
        real("s", 0.0, 1e6),
    ] = 0.0
    operators: Annotated[
        str,
        "the ship's response operators; files and --set name a table of amplitudes and phases over "
        "frequency and direction; none: those of a barge by length, beam and draught; mode = space",
        listed(),
    ] = ""
    ship_length: Annotated[
        float, "length of the barge, along x; mode = space", real("m", 5.0, 500.0)
    ] = 90.0
    ship_beam: Annotated[
        float, "beam of the barge, along z; mode = space", real("m", 2.0, 100.0)
    ] = 30.0
    ship_draught: Annotated[float, "draught of the barge; mode = space", real("m", 0.1, 40.0)] = 4.0
    deck_x: Annotated[
        float,
        "place of the deck's origin forward of the point that the operators are of; mode = space",
        real("m", -250.0, 250.0),
    ] = 0.0
    deck_y: Annotated[
        float, "height of the deck above that point; mode = space", real("m", -50.0, 100.0)
    ] = 0.0
    deck_z: Annotated[
        float, "place of the deck to starboard of that point; mode = space", real("m", -50.0, 50.0)
    ] = 0.0


def check_sea(sea: Sea) -> None:
    """Check what belongs together in a sea.

    Raises:
        LandingError: The sea breaks, or the operators do not cover it.
    """
    steepness = 2.0 * pi * sea.wave_height / (WAVE_GRAVITY * sea.peak_period**2)
    if steepness > STEEPEST_SEA:
        highest = STEEPEST_SEA * WAVE_GRAVITY * sea.peak_period**2 / (2.0 * pi)
        raise LandingError(
            f"sea.wave_height = {sea.wave_height:g} m at sea.peak_period = {sea.peak_period:g} s "
            f"is a steepness of {steepness:.3g}, the limit is {STEEPEST_SEA:.3g}, beyond which "
            f"waves break; give at most {highest:.3g} m, or a longer period"
        )
    if sea.operators and sea.wave_height > 0.0:
        peak = 2.0 * pi / sea.peak_period
        check_covered(sea.operators, (LOWEST * peak, HIGHEST * peak), sea.direction)
