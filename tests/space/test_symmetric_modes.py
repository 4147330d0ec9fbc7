"""The symmetric modes are special cases of a landing in space."""

from __future__ import annotations

from math import pi, radians
from typing import Any

import pytest
from space_vehicles import SPACE, vehicle

from rlv_landing import Landing
from rlv_landing.quantities import OUTPUTS_BY_NAME

TIMES = [0.03 * k for k in range(1, 16)]
LOADS = {
    "external.force_x": 30.0,
    "external.force_y": -20.0,
    "ground.heave_rate": 0.02,
    "ground.tilt_rate": 0.01,
}
# what a landing in space reaches at another place or by another definition
OTHERS = {"status.stability_margin"}


@pytest.mark.parametrize("load_path", ["footpad", "joint"])
@pytest.mark.parametrize(
    ("mode", "values"),
    [
        ("2-2", {"drop.heading": radians(45.0)}),
        ("2-2", {"vehicle.leg_azimuth": 0.75 * pi, "vehicle.inertia_roll": 60.0}),
        ("1-2-1", {"vehicle.inertia_roll": 90.0, "vehicle.inertia_yaw": 45.0}),
    ],
)
def test_a_symmetric_landing_is_one_in_space(
    mode: str, values: dict[str, Any], load_path: str
) -> None:
    planar = vehicle({"vehicle.transverse_load_at": load_path, "ground.slope": 0.02}, mode)
    two = Landing(planar, mode, rtol=1e-9), Landing(planar.with_values(SPACE | values), rtol=1e-9)
    for landing in two:
        landing.set_inputs(LOADS)
    for time in TIMES:
        for landing in two:
            landing.advance_to(time)
        expected, found = (landing.outputs() for landing in two)
        common = [name for name in expected if name in found and name not in OTHERS]
        assert len(common) > 90
        for name in common:
            least = max(1e-6, 1e-7 * OUTPUTS_BY_NAME[name].nominal)
            assert found[name] == pytest.approx(expected[name], rel=1e-5, abs=least), name
        for name in ("x", "y", "pitch"):
            assert abs(found[f"body.{name}"] - expected[f"body.{name}"]) < 1e-8
        assert abs(found["body.z"]) + abs(found["body.roll"]) < 1e-9
