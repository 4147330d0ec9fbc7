"""The inputs: loads on the body, and the motion of the ground."""

from __future__ import annotations

from .quantity import Quantity

INPUT_QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "N",
        "external force on the body at its CG, along inertial x",
        -1e7,
        1e7,
        name="external.force_x",
        display_unit="kN",
    ),
    Quantity(
        "N",
        "external force on the body at its CG, along inertial y (up)",
        -1e7,
        1e7,
        name="external.force_y",
        display_unit="kN",
    ),
    Quantity(
        "N.m",
        "external moment on the body, clockwise positive, as the pitch",
        -1e7,
        1e7,
        name="external.moment",
    ),
    Quantity(
        "m",
        "lift of the ground along inertial y; a change after the start is spread over the time "
        "since the last change, at most 1 s, at least the next step",
        -100.0,
        100.0,
        name="ground.heave",
    ),
    Quantity(
        "m/s",
        "rate of the lift; the ground goes on at it until inputs are set again",
        -100.0,
        100.0,
        name="ground.heave_rate",
    ),
    Quantity(
        "rad",
        "tilt of the ground about its origin, on top of ground.slope, clockwise positive; "
        "a change after the start is spread over the time since the last change, at most 1 s, "
        "at least the next step",
        -1.0,
        1.0,
        name="ground.tilt",
        display_unit="deg",
    ),
    Quantity(
        "rad/s",
        "rate of the tilt; the ground goes on at it until inputs are set again",
        -10.0,
        10.0,
        name="ground.tilt_rate",
        display_unit="deg/s",
    ),
)

INPUT_NAMES: tuple[str, ...] = tuple(q.name for q in INPUT_QUANTITIES)
INPUTS_BY_NAME: dict[str, Quantity] = {q.name: q for q in INPUT_QUANTITIES}
