"""The state at the first contact, and what the integrator may spend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..quantities import MODES, SPACE
from .declaration import real, text


@dataclass(frozen=True)
class Drop:
    """The vehicle's state at the first contact, and the duration of the free flight before it."""

    mode: Annotated[
        str,
        "landing mode: legs that touch first - second - third of a symmetric landing, or space",
        text(*MODES, SPACE, source="paper"),
    ] = "2-2"
    contact_time: Annotated[
        float,
        "time of the first contact; the flight before it is free",
        real("s", 0.0, 60.0, source="identified"),
    ] = 0.089502
    tilt: Annotated[
        float,
        "pitch at first contact, clockwise positive",
        real("rad", -1.5, 1.5, source="identified", display_unit="deg"),
    ] = -0.1378
    pitch_rate: Annotated[
        float,
        "pitch rate at first contact, clockwise positive",
        real("rad/s", -10.0, 10.0, source="identified", display_unit="deg/s"),
    ] = 0.4
    horizontal_velocity: Annotated[
        float,
        "velocity of the CG along inertial x at first contact",
        real("m/s", -50.0, 50.0, source="identified"),
    ] = 0.3492
    vertical_velocity: Annotated[
        float,
        "velocity of the CG along inertial y (up) at first contact",
        real("m/s", -50.0, 50.0, source="identified"),
    ] = -1.359
    heading: Annotated[
        float,
        "heading at first contact, counter-clockwise from above: the body is turned about y by it, "
        "then by the roll about x, then by the tilt about z; mode = space",
        real("rad", -3.2, 3.2, display_unit="deg"),
    ] = 0.0
    roll: Annotated[
        float,
        "roll at first contact, about inertial x; mode = space",
        real("rad", -1.5, 1.5, display_unit="deg"),
    ] = 0.0
    roll_rate: Annotated[
        float,
        "angular velocity about inertial x at first contact; mode = space",
        real("rad/s", -10.0, 10.0, display_unit="deg/s"),
    ] = 0.0
    yaw_rate: Annotated[
        float,
        "angular velocity about inertial y at first contact; mode = space",
        real("rad/s", -10.0, 10.0, display_unit="deg/s"),
    ] = 0.0
    lateral_velocity: Annotated[
        float,
        "velocity of the CG along inertial z at first contact; mode = space",
        real("m/s", -50.0, 50.0),
    ] = 0.0


@dataclass(frozen=True)
class Integration:
    """Limits of the integrator."""

    max_steps_per_second: Annotated[
        float,
        "integrator steps, rejected ones included, that a simulated second may take on average; "
        "a landing that needs more is an error",
        real("1/s", 100.0, 1e9),
    ] = 5e5
