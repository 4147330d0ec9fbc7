"""Vehicles of the tests in space."""

from __future__ import annotations

from math import radians
from typing import Any

from rlv_landing import Parameters, load_preset

SPACE = {"drop.mode": "space"}
# a landing that turns, slides and leans in all directions
TURNING = SPACE | {
    "drop.heading": radians(20.0),
    "drop.roll": 0.03,
    "drop.roll_rate": -0.2,
    "drop.yaw_rate": 0.3,
    "drop.lateral_velocity": 0.25,
    "drop.contact_time": 0.02,
}
# a body without symmetry
UNEVEN = {
    "vehicle.inertia_roll": 150.0,
    "vehicle.inertia_yaw": 60.0,
    "vehicle.inertia_xy": 8.0,
    "vehicle.inertia_xz": -5.0,
    "vehicle.inertia_yz": 4.0,
    "vehicle.cg_offset_x": 0.05,
    "vehicle.cg_offset_z": -0.03,
}


def vehicle(values: dict[str, Any], mode: str = "2-2") -> Parameters:
    """The prototype with some values set anew."""
    return load_preset("yue2022-figures").for_mode(mode).with_values(values)
