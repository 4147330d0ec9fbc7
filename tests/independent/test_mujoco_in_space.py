"""Landings in space against MuJoCo, with exactly linear struts on both sides, without friction."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mujoco_vehicle import DAMPING, STIFFNESS, land_in_space

from rlv_landing import Landing, load_preset

LINEAR: dict[str, Any] = {
    "drop.mode": "space",
    "vehicle.inertia": 197.0,
    "vehicle.inertia_roll": 190.0,
    "vehicle.inertia_yaw": 60.0,
    "vehicle.inertia_xy": 6.0,
    "vehicle.inertia_xz": -4.0,
    "main_strut.kind": "spring-damper",
    "main_strut.stiffness": STIFFNESS,
    "main_strut.damping": DAMPING,
    "main_strut.stroke_max": 0.2,
    "main_strut.volume_lower": 1e-3,
    "auxiliary_strut.stiffness": 3e5,
    "auxiliary_strut.damping": 7000.0,
    "auxiliary_strut.exponent": 1.0,
    "auxiliary_strut.play_tension": 0.0,
    "auxiliary_strut.play_compression": 0.0,
    "ground.stiffness": 5e6,
    "ground.exponent": 1.0,
    "ground.damping": 2000.0,
    "ground.damping_depth": 1e-4,
    "ground.friction": 0.0,
    "ground.stick_damping": 0.0,
    "drop.contact_time": 0.0,
    "drop.heading": 0.3,
    "drop.roll": 0.05,
    "drop.roll_rate": -0.3,
    "drop.yaw_rate": 0.4,
    "drop.lateral_velocity": 0.2,
}
CASES: dict[str, dict[str, Any]] = {
    "five legs on a slope": {
        "vehicle.legs": 5.0,
        "ground.slope": 0.06,
        "ground.slope_direction": 2.0,
    },
    "three uneven legs on steps, the CG off the axis": {
        "vehicle.legs": 3.0,
        "vehicle.leg_azimuths": "0.2 2.1 4.5",
        "vehicle.cg_offset_x": 0.06,
        "vehicle.cg_offset_z": -0.04,
        "leg[1].ground.step": 0.02,
        "leg[3].ground.step": -0.015,
    },
}


@pytest.mark.parametrize("name", CASES)
def test_a_landing_that_rolls_and_yaws_is_that_of_mujoco(name: str) -> None:
    """MuJoCo's steps of 0.05 ms pass the contacts with errors of some micrometres."""
    parameters = load_preset("yue2022-figures").with_values({**LINEAR, **CASES[name]})
    landing = Landing(parameters, rtol=1e-8)
    now = landing.outputs()
    parts = [f"body.{axis}" for axis in "xyz"] + [f"body.q_{part}" for part in "wxyz"]
    rates = [f"body.v{axis}" for axis in "xyz"] + [f"body.spin_{axis}" for axis in "xyz"]
    poses, strokes = land_in_space(parameters, [now[n] for n in (*parts, *rates)], 0.12, 5e-5)
    history = landing.run(0.12, 1e-3)
    ours = np.array([history[part] for part in parts])
    assert np.abs(poses - ours).max() < 5e-6
    own = np.array([history[f"leg[{i}].main_strut.stroke"] for i in landing.interface.legs])
    assert np.abs(own).max() > 0.01
    assert np.abs(strokes - own).max() < 1e-5
    assert np.ptp(history["body.roll"]) > 5e-3
    assert np.ptp(history["body.heading"]) > 0.02
