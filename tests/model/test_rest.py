"""A landing within the friction angle ends at rest, and stays where it is."""

from __future__ import annotations

import random
from math import degrees, radians, tan
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.audit.energy import DISSIPATED, largest_fall
from rlv_landing.audit.rest import feet
from rlv_landing.quantities import MODES
from rlv_landing.studies.outcome import outcome

FIGURES = "yue2022-figures"
SETTLED, TOPPLED = 2.0, 3.0
# 1e-6 mm/s
DRIFT = 1e-9


def drift(landing: Landing, time: float = 5.0) -> float:
    """Mean speed [m/s] of the fastest footpad over the `time` [s] to come."""
    history = landing.run(landing.time + time, time)
    return float(np.abs(feet(history, -1) - feet(history, 0)).max()) / time


def slope_landing(rng: random.Random) -> tuple[str, dict[str, Any]]:
    """A mode, and a slope of 1 to 8 deg either way with friction 0.3 to 0.8."""
    return rng.choice(sorted(MODES)), {
        "ground.slope": radians(rng.uniform(1.0, 8.0)) * rng.choice((-1.0, 1.0)),
        "ground.friction": rng.uniform(0.3, 0.8),
        "vehicle.transverse_load_at": rng.choice(("footpad", "joint")),
    }


def check_that_it_rests(mode: str, values: dict[str, Any]) -> str:
    """Land, and come to rest or topple: the outcome's name."""
    landing = Landing(load_preset(FIGURES, mode).with_values(values))
    history = landing.run(10.0, 1e-2)
    if history["status.phase"].max() == TOPPLED:
        assert outcome(history).name == "toppled"
        return "toppled"
    assert history["status.phase"][-1] == SETTLED, (mode, values)
    assert drift(landing) < DRIFT, (mode, values)
    assert landing.get("status.phase") == SETTLED
    return "settled"


@pytest.mark.torture
def test_landings_on_slopes_end_settled_and_do_not_creep(many):
    rng = random.Random(2024)
    cases = [slope_landing(rng) for _ in range(many(12))]
    found = [check_that_it_rests(mode, values) for mode, values in cases]
    # the preset's lateral speed carries a few over their feet on the steepest slopes
    assert found.count("settled") >= 0.8 * len(found)


@settings(max_examples=8, deadline=None)
@given(
    mode=st.sampled_from(sorted(MODES)),
    slope=st.floats(-0.12, 0.12),
    friction=st.floats(0.2, 0.8),
    side=st.floats(-0.15, 0.15),
    at=st.sampled_from(("footpad", "joint")),
)
def test_what_is_dissipated_never_falls_whatever_slope_and_side_load(
    mode, slope, friction, side, at
):
    values = {
        "ground.slope": slope,
        "ground.friction": friction,
        "vehicle.transverse_load_at": at,
    }
    parameters = load_preset(FIGURES, mode).with_values(values)
    landing = Landing(parameters, rtol=1e-8)
    landing.set_inputs({"external.force_x": side * 9.81 * 194.8})
    history = landing.run(10.0, 1e-2)
    assert largest_fall(history) < 1e-9
    assert history["energy.friction"].min() >= 0.0
    phase = history["status.phase"]
    if abs(tan(slope)) + abs(side) < 0.8 * friction and phase.max() < TOPPLED:
        assert drift(landing) < DRIFT


def test_a_parked_vehicle_takes_nothing_from_the_slope_it_stands_on(mode):
    """The time is 50 s, in which it gains 13 J under the paper's law.

    Here the steps' errors at the default tolerance are left.
    """
    values = {"ground.slope": radians(6.8), "ground.friction": 0.4}
    landing = Landing(load_preset(FIGURES, mode).with_values(values))
    landing.advance_to(10.0)
    before = landing.outputs()
    landing.advance_to(60.0)
    after = landing.outputs()
    for term in (*DISSIPATED, "potential", "friction", "kinetic"):
        name = f"energy.{term}"
        assert after[name] == approx(before[name], abs=1e-3)


@pytest.mark.parametrize("rtol", [1e-3, 1e-4])
@pytest.mark.parametrize(
    ("values", "side"),
    [
        ({"vehicle.transverse_load_at": "joint", "ground.friction": 0.8}, 0.15),
        ({"main_strut.seal_coulomb": 3531.0, "ground.friction": 0.7, "ground.slope": 0.2}, 0.0),
        ({"vehicle.footpad_mass": 0.42, "ground.friction": 0.9}, 0.0),
    ],
    ids=["side load", "stiff seals", "light feet"],
)
def test_a_vehicle_that_oscillates_by_a_loose_tolerance_comes_to_rest_too(mode, values, side, rtol):
    """However its accelerations oscillate: else it would neither be called settled nor sleep."""
    upright = {"drop.horizontal_velocity": 0.0, "drop.tilt": values.get("ground.slope", 0.0)}
    landing = Landing(load_preset(FIGURES, mode).with_values({**upright, **values}), rtol=rtol)
    landing.set_inputs({"external.force_x": side * 9.81 * 194.8})
    landing.advance_to(12.0)
    assert landing.get("status.phase") == SETTLED
    assert drift(landing) < DRIFT


@pytest.mark.parametrize("slope", [12.0, 20.0])
def test_on_a_slope_beyond_the_friction_angle_it_slides_and_is_said_to(slope):
    values = {
        "ground.slope": radians(slope),
        "ground.friction": 0.8 * tan(radians(slope)),
        "drop.tilt": radians(slope),
        "drop.pitch_rate": 0.0,
        "drop.horizontal_velocity": 0.0,
        "drop.vertical_velocity": -0.3,
        "drop.contact_time": 0.0,
    }
    history = Landing(load_preset(FIGURES, "2-2").with_values(values)).run(4.0, 1e-2)
    assert outcome(history).name == "slid"
    assert history["status.phase"][-1] != SETTLED
    late = history.time > 3.0
    speed = np.hypot(history["body.vx"], history["body.vy"])[late]
    assert np.polyfit(history.time[late], speed, 1)[0] == approx(
        0.2 * 9.81 * np.sin(radians(slope)), rel=0.1
    )


LENGTHS = (
    "vehicle.top_height", "main_strut.joint_radius", "main_strut.joint_depth", "main_strut.length",
    "main_strut.stroke_max", "auxiliary_strut.joint_radius", "auxiliary_strut.joint_depth",
    "auxiliary_strut.length", "ground.damping_depth", "ground.stick_displacement",
    "auxiliary_strut.play_tension", "auxiliary_strut.play_compression",
)  # fmt: skip


def scaled(mass: float, length: float) -> Parameters:
    """The preset's vehicle, `mass` times as heavy and `length` times as large, built alike.

    Loads grow with the weight, so areas do at equal pressure, and volumes with area and stroke. At
    equal strokes over length, stiffness grows as weight over length; speeds as the square root of
    length, which keeps the motion's shape.
    """
    base = load_preset(FIGURES)
    speed = length**0.5
    growth: dict[str, float] = {
        "vehicle.mass": mass,
        "vehicle.footpad_mass": mass,
        "vehicle.inertia": mass * length**2,
        "ground.stiffness": mass / length ** base.ground.exponent,
        "auxiliary_strut.stiffness": mass / length ** base.auxiliary_strut.exponent,
        **{
            f"main_strut.{name}": mass
            for name in ("area_upper", "area_lower", "seal_coulomb", "seal_stribeck")
        },
        **{f"main_strut.{name}": mass * length for name in ("volume_upper", "volume_lower")},
        **{f"main_strut.orifice_area_{name}": mass * speed for name in ("compression", "rebound")},
        "main_strut.seal_pressure": mass,
        "main_strut.stop_stiffness": mass / length,
        "auxiliary_strut.play_stiffness": mass / length,
        "main_strut.stop_damping": 1.0 / speed,
        **{f"{group}.damping": mass / speed for group in ("auxiliary_strut", "ground")},
        "ground.stick_damping": mass / speed,
        **dict.fromkeys(LENGTHS, length),
        **{f"drop.{name}": speed for name in ("horizontal_velocity", "vertical_velocity")},
        **{f"main_strut.seal_{name}_speed": speed for name in ("stribeck", "smoothing")},
        "ground.stribeck_speed": speed,
        "drop.pitch_rate": 1.0 / speed,
    }  # fmt: skip
    return base.with_values({name: float(base[name]) * k for name, k in growth.items()})


@pytest.mark.parametrize(
    ("mass", "length"), [(60.0 / 194.8, 0.7), (25e3 / 194.8, 5.0)], ids=["60 kg", "25 t"]
)
def test_a_hopper_and_a_stage_settle_on_a_slope_at_the_prototypes_cost(mode, mass, length):
    """The derived tangential stiffness and slip zone scale with them."""

    def land(parameters: Parameters, scale: float) -> tuple[Landing, int]:
        on_slope = parameters.with_values({"ground.slope": radians(5.0), "drop.contact_time": 0.0})
        landing = Landing(on_slope, mode)
        landing.advance_to(3.0 * scale)
        return landing, landing.statistics["rhs_calls"]

    _, prototype = land(load_preset(FIGURES), 1.0)
    landing, calls = land(scaled(mass, length), length**0.5)
    assert calls < 2.0 * prototype
    landing.advance_to(12.0 * length**0.5)
    assert landing.get("status.phase") == SETTLED
    assert abs(degrees(landing.get("body.pitch"))) < 8.0
    assert drift(landing) < DRIFT
