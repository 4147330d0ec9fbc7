"""Every landing in space below the friction angle comes to rest, on any slope, and stays."""

from __future__ import annotations

from math import atan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from space_vehicles import SPACE, vehicle

from rlv_landing import Landing

ANGLE = st.floats(-3.1, 3.1)
RATE = st.floats(-0.3, 0.3)


# the same examples each time, so that the suite does not depend on chance
@settings(max_examples=12, deadline=None, derandomize=True)
@given(
    legs=st.sampled_from([3, 4, 5, 6, 8]),
    heading=ANGLE,
    direction=ANGLE,
    slope=st.floats(0.0, 0.12),
    friction=st.floats(0.3, 0.8),
    rates=st.tuples(RATE, RATE, RATE),
    lateral=st.floats(-0.5, 0.5),
    roll=st.floats(-0.06, 0.06),
)
def test_rest_on_a_slope_in_any_direction(
    *,
    legs: int,
    heading: float,
    direction: float,
    slope: float,
    friction: float,
    rates: tuple[float, float, float],
    lateral: float,
    roll: float,
) -> None:
    assert slope < atan(friction)
    pitch_rate, roll_rate, yaw_rate = rates
    parameters = vehicle(
        SPACE
        | {
            "vehicle.legs": float(legs),
            "drop.heading": heading,
            "drop.roll": roll,
            "drop.pitch_rate": pitch_rate,
            "drop.roll_rate": roll_rate,
            "drop.yaw_rate": yaw_rate,
            "drop.lateral_velocity": lateral,
            "drop.contact_time": 0.02,
            "ground.slope": slope,
            "ground.slope_direction": direction,
            "ground.friction": friction,
        }
    )
    landing = Landing(parameters)
    before = landing.get("energy.dissipated")
    while landing.time < 12.0:
        landing.advance_to(landing.time + 1.0)
        now = landing.outputs()
        assert now["energy.dissipated"] >= before
        before = now["energy.dissipated"]
        turned = max(before, 1.0)
        assert abs(now["energy.balance"]) < 1e-4 * turned
    if now["status.phase"] == 3.0:
        # beyond its feet, or over: the body's axis points down
        upright = 1.0 - 2.0 * (now["body.q_x"] ** 2 + now["body.q_z"] ** 2)
        assert now["status.stability_margin"] < 0.0 or upright < 0.0
        return
    assert now["status.phase"] == 2.0
    landing.advance_to(landing.time + 100.0)
    later = landing.outputs()
    way = max(abs(later[f"body.{axis}"] - now[f"body.{axis}"]) for axis in "xyz")
    # below 1e-6 mm/s
    assert way / 100.0 < 1e-9


def test_a_vehicle_on_a_slope_steeper_than_its_friction_slides_down_it() -> None:
    values = {"ground.slope": 0.3, "ground.slope_direction": 1.2, "ground.friction": 0.15}
    landing = Landing(vehicle(SPACE | values | {"drop.contact_time": 0.0, "drop.tilt": 0.0}))
    landing.advance_to(1.0)
    x, z = landing.get("body.vx"), landing.get("body.vz")
    assert landing.get("status.phase") == 1.0
    # down the slope, towards its direction
    assert z > 0.3
    assert z / x == pytest.approx(2.57, rel=0.6)
