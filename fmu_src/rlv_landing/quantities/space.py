"""The inputs and outputs of a landing in space, in the order of the core's records."""

from __future__ import annotations

from dataclasses import replace

from .inputs import INPUTS_BY_NAME
from .legs import TRIPOD
from .outputs import (
    BODY_QUANTITIES,
    ENERGY_QUANTITIES,
    LEG_QUANTITIES,
    STATUS_QUANTITIES,
    leg_quantity,
)
from .quantity import Quantity

SPREAD = (
    "; a change after the start is spread over the time since the last change, at most 1 s, "
    "at least the next step"
)
GOES_ON = "; the ground goes on at it until inputs are set again"
_BODY = {q.name: q for q in BODY_QUANTITIES}


def _load(unit: str, name: str, meaning: str) -> Quantity:
    shown = "kN" if unit == "N" else ""
    return Quantity(unit, meaning, -1e7, 1e7, name=name, display_unit=shown)


def _shift(name: str, meaning: str) -> tuple[Quantity, Quantity]:
    """A position of the deck and its rate."""
    position = Quantity("m", f"{meaning}{SPREAD}", -100.0, 100.0, name=f"ground.{name}")
    rate = Quantity(
        "m/s", f"rate of the {name}{GOES_ON}", -100.0, 100.0, name=f"ground.{name}_rate"
    )
    return position, rate


def _turn(name: str, meaning: str) -> tuple[Quantity, Quantity]:
    """An angle of the deck and its rate."""
    angle = Quantity(
        "rad", f"{meaning}{SPREAD}", -1.0, 1.0, name=f"ground.{name}", display_unit="deg"
    )
    rate = Quantity(
        "rad/s",
        f"rate of the {name}{GOES_ON}",
        -10.0,
        10.0,
        name=f"ground.{name}_rate",
        display_unit="deg/s",
    )
    return angle, rate


SPACE_INPUTS: tuple[Quantity, ...] = (
    INPUTS_BY_NAME["external.force_x"],
    INPUTS_BY_NAME["external.force_y"],
    _load("N", "external.force_z", "external force on the body at its CG, along inertial z"),
    _load("N.m", "external.moment_x", "external moment on the body, about inertial x"),
    _load("N.m", "external.moment_y", "external moment on the body, about inertial y (up)"),
    _load("N.m", "external.moment_z", "external moment on the body, about inertial z"),
    *_shift("surge", "way of the ground along inertial x"),
    *_shift("heave", "lift of the ground along inertial y"),
    *_shift("sway", "way of the ground along inertial z"),
    *_turn("roll", "turn of the ground about inertial x, before the tilt"),
    *_turn("yaw", "turn of the ground about inertial y, before the roll"),
    *_turn("tilt", "tilt of the ground about inertial z, clockwise positive"),
)


def _turned(name: str, meaning: str) -> Quantity:
    return Quantity("rad", meaning, name=f"body.{name}", display_unit="deg")


SPACE_BODY_QUANTITIES: tuple[Quantity, ...] = (
    _BODY["body.x"],
    _BODY["body.y"],
    Quantity("m", "CG of the upper mass along inertial z", name="body.z"),
    Quantity("", "attitude, body to inertial axes: the quaternion's w", name="body.q_w"),
    Quantity("", "attitude: the quaternion's x", name="body.q_x"),
    Quantity("", "attitude: the quaternion's y", name="body.q_y"),
    Quantity("", "attitude: the quaternion's z", name="body.q_z"),
    _turned("pitch", "pitch psi about inertial z, after heading and roll, clockwise positive"),
    _turned("roll", "roll about inertial x, after the heading"),
    _turned("heading", "heading about inertial y, within half a turn of that at first contact"),
    _BODY["body.vx"],
    _BODY["body.vy"],
    Quantity("m/s", "velocity of the CG along inertial z", name="body.vz"),
    *(
        Quantity(
            "rad/s",
            f"angular velocity about body {axis}",
            name=f"body.spin_{axis}",
            display_unit="deg/s",
        )
        for axis in "xyz"
    ),
    _BODY["body.ax"],
    _BODY["body.ay"],
    Quantity("m/s2", "acceleration of the CG along inertial z", name="body.az"),
    *(
        Quantity(
            "rad/s2",
            f"angular acceleration about body {axis}",
            name=f"body.spin_acceleration_{axis}",
        )
        for axis in "xyz"
    ),
    _BODY["body.top_axial_acceleration"],
    Quantity(
        "m",
        "least distance of the body's points from the ground, 0 where there are none; below 0 the "
        "body strikes it",
        name="body.clearance",
    ),
    *(
        Quantity(
            "N",
            f"force of the ground on the body's points along inertial {axis}",
            name=f"body.strike_force_{axis}",
            display_unit="kN",
        )
        for axis in "xyz"
    ),
    *(
        Quantity(
            "N.m", f"its moment about the CG, inertial {axis}", name=f"body.strike_moment_{axis}"
        )
        for axis in "xyz"
    ),
)
SPACE_STATUS_QUANTITIES: tuple[Quantity, ...] = tuple(
    replace(
        q,
        meaning="seen from above, from the whole vehicle's CG to the nearest edge of the footpads' "
        "polygon, negative beyond",
    )
    if q.name == "status.stability_margin"
    else q
    for q in STATUS_QUANTITIES
)
SPACE_LEG_QUANTITIES: tuple[Quantity, ...] = (
    *LEG_QUANTITIES,
    Quantity(
        "N",
        "force of the leg on its footpad across the leg's plane, along e_t of its azimuth",
        name="auxiliary_strut.transverse_force",
        display_unit="kN",
    ),
)

# of legs on three struts; the first auxiliary strut is on the side of e_t, the second on the other
TRIPOD_LEG_QUANTITIES: tuple[Quantity, ...] = (
    *LEG_QUANTITIES,
    *(
        replace(q, name=q.name.replace("auxiliary_strut.", "auxiliary_strut_2."))
        for q in LEG_QUANTITIES
        if q.name.startswith("auxiliary_strut.")
    ),
)


def leg_quantities_in_space(kind: str) -> tuple[Quantity, ...]:
    """The quantities of a leg of this kind in a landing in space."""
    return TRIPOD_LEG_QUANTITIES if kind == TRIPOD else SPACE_LEG_QUANTITIES


def space_outputs(legs: int, kind: str) -> tuple[Quantity, ...]:
    """The outputs of a landing in space on so many legs of this kind."""
    return (
        *SPACE_BODY_QUANTITIES,
        *ENERGY_QUANTITIES,
        *SPACE_STATUS_QUANTITIES,
        *(
            leg_quantity(leg, q)
            for leg in range(1, legs + 1)
            for q in leg_quantities_in_space(kind)
        ),
    )
