"""A vehicle whose landing in space has no symmetry: its FMUs are fixtures of the tests."""

from __future__ import annotations

from math import radians

from rlv_landing import Parameters, load_preset

FIVE_LEGS: dict[str, float | str] = {
    "drop.mode": "space",
    "vehicle.legs": 5.0,
    "vehicle.leg_azimuth": 3.0,
    "vehicle.inertia_roll": 120.0,
    "vehicle.inertia_yaw": 60.0,
    "vehicle.inertia_xy": 3.0,
    "vehicle.inertia_yz": -4.0,
    "vehicle.cg_offset_x": 0.03,
    "vehicle.cg_offset_z": -0.02,
    "drop.heading": radians(20.0),
    "drop.roll": radians(2.0),
    "drop.roll_rate": 0.1,
    "drop.yaw_rate": -0.2,
    "drop.lateral_velocity": 0.3,
    "ground.slope": radians(3.0),
    "ground.slope_direction": radians(50.0),
    # bumps of some centimetres
    "ground.terrain": "x -6 4 4 z -6 4 4 h 0 0.02 0 0 0.01 0.03 0 0.02 0 0.01 0.02 0 0.02 0 0 0.01",
    "leg[2].ground.step": 0.012,
    "leg[2].main_strut.orifice_area_compression": 7e-6,
    "leg[4].ground.friction": 0.15,
    "leg[5].vehicle.footpad_mass": 4.8,
    # a nozzle's rim that strikes
    "vehicle.body_points": "0.25 -2.105 0.0; -0.12 -2.105 0.22; -0.12 -2.105 -0.22",
}
# a deck on its way, and a gust, from the start on
DECK: dict[str, float] = {
    "external.force_z": -300.0,
    "external.moment_y": 40.0,
    "ground.heave": 0.05,
    "ground.heave_rate": 0.2,
    "ground.sway": -0.1,
    "ground.sway_rate": 0.1,
    "ground.roll": 0.02,
    "ground.roll_rate": -0.03,
}


def five_legs() -> Parameters:
    """Its parameters."""
    return load_preset("yue2022-figures").with_values(FIVE_LEGS)
