"""Vehicles of the tests in space."""

from __future__ import annotations

from math import radians
from typing import Any

from rlv_landing import Parameters, load_preset

SPACE = {"drop.mode": "space"}
# the three-legged vehicle of the reference cases: exactly linear struts and ground
THREE_LEGS = SPACE | {
    "vehicle.mass": 178.0,
    "vehicle.footpad_mass": 4.2,
    "vehicle.legs": 3.0,
    "vehicle.inertia": 197.0,
    "vehicle.inertia_roll": 197.0,
    "vehicle.inertia_yaw": 40.0,
    "main_strut.kind": "spring-damper",
    "main_strut.stiffness": 2.3e5,
    "main_strut.damping": 3000.0,
    "main_strut.joint_radius": 0.445,
    "main_strut.joint_depth": 1.103,
    "main_strut.length": 1.426,
    "auxiliary_strut.joint_radius": 0.463,
    "auxiliary_strut.joint_depth": 1.513,
    "auxiliary_strut.length": 1.145,
    "auxiliary_strut.stiffness": 3e5,
    "auxiliary_strut.damping": 7000.0,
    "auxiliary_strut.exponent": 1.0,
    "auxiliary_strut.play_tension": 0.0,
    "auxiliary_strut.play_compression": 0.0,
    "ground.stiffness": 5e6,
    "ground.exponent": 1.0,
    "ground.damping": 0.0,
    "ground.friction": 0.0,
    "ground.stribeck_gain": 0.0,
    "ground.gravity": 9.81,
    "drop.contact_time": 0.0,
    "drop.heading": radians(10.0),
    "drop.roll": radians(3.0),
    "drop.tilt": -0.133,
    "drop.pitch_rate": 0.18,
    "drop.horizontal_velocity": 0.354,
    "drop.vertical_velocity": -1.4,
}
# a landing that turns, slides and leans in all directions
TURNING = SPACE | {
    "drop.heading": radians(20.0),
    "drop.roll": 0.03,
    "drop.roll_rate": -0.2,
    "drop.yaw_rate": 0.3,
    "drop.lateral_velocity": 0.25,
    "drop.contact_time": 0.02,
}


def vehicle(values: dict[str, Any], mode: str = "2-2") -> Parameters:
    """The prototype with some values set anew."""
    return load_preset("yue2022-figures").for_mode(mode).with_values(values)
