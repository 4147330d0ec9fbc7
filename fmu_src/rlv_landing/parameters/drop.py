"""The state at the first contact, and what the integrator may spend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..quantities import MODES
from .declaration import real, text


@dataclass(frozen=True)
class Drop:
    """The vehicle's state at the first contact, and the duration of the free flight before it."""

    mode: Annotated[
        str, "landing mode: legs that touch first - second - third", text(*MODES, source="paper")
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


@dataclass(frozen=True)
class Integration:
    """Limits of the integrator."""

    max_steps_per_second: Annotated[
        float,
        "integrator steps, rejected ones included, that a simulated second may take on average; "
        "a landing that needs more is an error",
        real("1/s", 100.0, 1e9),
    ] = 5e5
