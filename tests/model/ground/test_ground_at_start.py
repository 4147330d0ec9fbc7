"""The vehicle at its start, above a ground that is tilted, lifted or moving."""

from math import inf

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, LandingError, Parameters, load_preset
from rlv_landing.quantities import MODES

FIGURES = "yue2022-figures"
LEGS = (1, 2, 3, 4)
GROUND = ("ground.heave", "ground.heave_rate", "ground.tilt", "ground.tilt_rate")


def lowest(landing: Landing) -> float:
    """Depth [m] of the footpad that is deepest in the ground."""
    return max(landing.get(f"leg[{leg}].contact.penetration") for leg in LEGS)


@settings(max_examples=60, deadline=None)
@given(
    mode=st.sampled_from(sorted(MODES)),
    slope=st.floats(-0.2, 0.2),
    pitch=st.floats(-0.2, 0.2),
    pitch_rate=st.floats(-0.3, 0.3),
    flight=st.sampled_from((0.0, 0.05, 0.3)),
    ground=st.tuples(
        st.floats(-50.0, 50.0), st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(-0.2, 0.2)
    ),
    changes=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.2, 0.2)),
)
def test_the_lowest_footpad_touches_the_moving_ground_at_the_contact_time(
    mode, slope, pitch, pitch_rate, flight, ground, changes
):
    """The CG is above the ground's origin then, with the drop's pitch and velocities.

    No footpad is deep in the ground before. Pitching flight deflects the legs by some micrometres.
    """
    values = {
        "ground.slope": slope,
        "drop.tilt": pitch,
        "drop.pitch_rate": pitch_rate,
        "drop.contact_time": flight,
        "drop.vertical_velocity": -2.0,
        "main_strut.charge_pressure": 101300.0,
    }
    parameters = load_preset(FIGURES, mode).with_values(values)
    rates = dict(zip(("ground.heave_rate", "ground.tilt_rate"), changes))
    try:
        landing = Landing(parameters, rtol=1e-7, inputs=dict(zip(GROUND, ground)), rates=rates)
    except LandingError as e:
        assume("below the ground" not in str(e))
        raise
    assert landing.get("energy.balance") == 0.0
    if flight > 0.0:
        for k in range(1, 9):
            assert lowest(landing) < 2e-5
            landing.advance_to(flight * k / 8)
    assert lowest(landing) == approx(0.0, abs=3e-5 if flight else 1e-12)
    assert landing.get("body.x") == approx(0.0, abs=3e-5)
    assert landing.get("body.pitch") == approx(pitch, abs=1e-5)
    assert landing.get("body.vx") == approx(parameters.drop.horizontal_velocity, abs=1e-3)
    assert landing.get("body.vy") == approx(-2.0, abs=1e-3)


def test_a_tilt_at_the_start_is_the_same_as_a_slope(mode):
    sloped = load_preset(FIGURES, mode).with_values({"ground.slope": 0.07})
    tilted = Landing(load_preset(FIGURES, mode), inputs={"ground.tilt": 0.07})
    assert np.array_equal(tilted.run(1.0).data, Landing(sloped).run(1.0).data)


def test_a_heave_at_the_start_shifts_the_whole_landing_up(mode):
    plain = Landing(load_preset(FIGURES, mode), rtol=1e-8).run(1.0)
    lifted = Landing(load_preset(FIGURES, mode), rtol=1e-8, inputs={"ground.heave": 0.2}).run(1.0)
    assert lifted["body.y"] - 0.2 == approx(plain["body.y"], abs=1e-7)
    for name in ("leg[1].contact.force_y", "leg[3].main_strut.force"):
        assert np.abs(lifted[name]).max() == approx(np.abs(plain[name]).max(), rel=1e-4)


@pytest.mark.parametrize("flight", [0.0, 0.2])
def test_a_landing_on_steadily_rising_ground_is_that_on_ground_at_rest_in_its_frame(mode, flight):
    base = load_preset(FIGURES, mode).with_values({"drop.contact_time": flight})
    solid = Landing(base.with_values({"drop.vertical_velocity": -1.7}), rtol=1e-9).run(0.5)
    deck = Landing(
        base.with_values({"drop.vertical_velocity": -1.4}),
        rtol=1e-9,
        inputs={"ground.heave": 1.0, "ground.heave_rate": 0.3},
    )
    history = deck.run(0.5)
    assert history["body.y"] - 1.0 - 0.3 * history.time == approx(solid["body.y"], abs=1e-6)
    assert history["leg[1].main_strut.stroke"] == approx(
        solid["leg[1].main_strut.stroke"], abs=5e-6
    )
    assert np.abs(history["energy.balance"]).max() < 1e-3


@settings(max_examples=10, deadline=None)
@given(
    ground=st.permutations(
        [
            ("ground.heave", 0.3),
            ("ground.heave_rate", 0.2),
            ("ground.tilt", -0.05),
            ("ground.tilt_rate", 0.1),
            ("external.force_x", 200.0),
        ]
    )
)
def test_inputs_before_the_first_step_may_be_set_one_by_one_or_at_once(ground):
    at_once, one_by_one = Landing(), Landing(inputs={"ground.heave": -1.0})
    at_once.set_inputs(dict(ground))
    for name, value in ground:
        one_by_one.set_inputs({name: value})
        one_by_one.outputs()
    made_with = Landing(inputs=dict(ground))
    for landing in (one_by_one, made_with):
        assert landing.values() == at_once.values()
        assert landing.state() == at_once.state()


def test_reset_restores_the_inputs_that_the_landing_was_made_with():
    landing = Landing(inputs={"ground.heave": 0.3}, rates={"external.force_x": 50.0})
    first = landing.state()
    landing.set_inputs({"ground.heave": 0.1})
    landing.advance_to(0.3)
    landing.set_inputs({"ground.tilt": 0.01})
    landing.reset()
    assert landing.state() == first


def test_ground_inputs_after_the_start_do_not_move_the_vehicle(mode):
    """In flight the ground moves below the vehicle."""
    plain, moved = (Landing(load_preset(FIGURES, mode)) for _ in range(2))
    for landing in (plain, moved):
        landing.advance_to(1e-3)
    moved.set_inputs({"ground.heave": -0.05, "ground.tilt": 0.02})
    for landing in (plain, moved):
        landing.advance_to(0.05)
    for name in ("body.x", "body.y", "body.pitch", "energy.potential"):
        assert moved.get(name) == approx(plain.get(name), abs=1e-6)
    assert lowest(moved) < lowest(plain) - 0.01


@pytest.mark.parametrize(
    ("values", "inputs", "message"),
    [
        (
            {"drop.contact_time": 0.5, "drop.vertical_velocity": -6.0},
            {"ground.heave_rate": -9.0},
            (
                r"drop\.contact_time = 0\.5 s of free flight would pass \d\.\d+ m below the "
                r"ground, the limit is 1e-06 m"
            ),
        ),
        (
            {"drop.contact_time": 0.3, "drop.vertical_velocity": -4.0},
            {"ground.tilt_rate": 4.0, "ground.tilt": -1.0},
            "below the ground",
        ),
        (
            {"ground.slope": 0.7},
            {"ground.tilt": 0.9},
            (
                r"ground\.slope \+ ground\.tilt = 1\.6 rad at 0 s, up to the first contact, "
                r"is outside \[-1\.5, 1\.5\] rad"
            ),
        ),
        (
            {"drop.contact_time": 2.0, "drop.vertical_velocity": -40.0},
            {"ground.tilt_rate": 9.0},
            r"is outside \[-1\.5, 1\.5\] rad; tilt the ground less",
        ),
    ],
)
def test_a_start_below_the_ground_or_on_too_steep_ground_is_refused_and_changes_nothing(
    values, inputs, message
):
    parameters = Parameters().with_values(values)
    with pytest.raises(LandingError, match=message):
        Landing(parameters, inputs=inputs)
    landing = Landing(parameters, inputs={"external.force_x": 100.0})
    before = landing.state()
    with pytest.raises(LandingError, match=message):
        landing.set_inputs({"external.force_x": 5.0, **inputs})
    assert landing.state() == before
    landing.step(1e-3)


def test_a_rising_vehicle_may_start_above_ground_that_rises_faster():
    rising = Parameters().with_values(
        {"drop.vertical_velocity": 2.0, "drop.contact_time": 0.1, "drop.pitch_rate": 0.0}
    )
    with pytest.raises(LandingError, match="below the ground"):
        Landing(rising)
    landing = Landing(rising, inputs={"ground.heave_rate": 5.0})
    landing.advance_to(0.1)
    assert lowest(landing) == approx(0.0, abs=2e-5)


def test_no_contact_force_acts_before_the_contact_time(mode):
    """Heave and tilt at the start put no footpad into the ground."""
    weight = (178.0 + 4 * 4.2) * 9.81
    for inputs in ({"ground.tilt": 0.0698}, {"ground.heave": 0.2}, {"ground.heave": -0.2}):
        landing = Landing(load_preset(FIGURES, mode), inputs=inputs)
        touched = inf
        history = landing.run(1.0, 1e-4)
        for leg in LEGS:
            force = history[f"leg[{leg}].contact.force_y"]
            touched = min(touched, history.time[np.argmax(force > 0.0)])
            assert force.min() >= 0.0
            assert force.max() < 20.0 * weight
        contact = landing.parameters.drop.contact_time
        assert touched == approx(contact, abs=2e-4)
