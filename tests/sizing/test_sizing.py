"""A sized vehicle: its geometry against the model's own, its landing against what was asked for."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, LandingError
from rlv_landing.core import Phase
from rlv_landing.sizing import LIKE, leg_geometry, needs_like, size_damper, size_vehicle
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.whole_landing import whole_landing
from rlv_landing.touchdown import footpad_at_rest, footpad_between

# a landing as guidance delivers it: tilted, drifting, on a slope
OFF_NOMINAL = {
    "drop.tilt": 0.03,
    "drop.horizontal_velocity": 0.2,
    "drop.pitch_rate": -0.02,
    "ground.slope": 0.03,
}


@pytest.mark.parametrize("like", LIKE)
def test_the_footpads_are_where_the_needs_say(like):
    needs = LIKE[like]
    radius, height = footpad_at_rest(size_vehicle(needs))
    assert radius == approx(0.5 * needs.span, rel=1e-12)
    assert height == approx(-needs.cg_height, rel=1e-12)


@pytest.mark.parametrize("like", LIKE)
def test_the_stroke_ratio_is_that_of_the_models_geometry(like):
    """Shorten the main strut by a little and see how far the footpad rises."""
    parameters, leg = size_vehicle(LIKE[like]), leg_geometry(LIKE[like])
    step = 1e-6 * leg.main_length
    heights = [
        footpad_between(parameters, leg.main_length + sign * step, leg.auxiliary_length)[1]
        for sign in (1.0, -1.0)
    ]
    assert 2.0 * step / (heights[1] - heights[0]) == approx(leg.stroke_ratio, rel=1e-6)


@pytest.mark.parametrize("like", LIKE)
@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
@pytest.mark.parametrize("changes", [{}, OFF_NOMINAL])
def test_the_vehicles_to_begin_with_settle_within_their_limits(like, mode, changes):
    parameters = size_vehicle(LIKE[like]).for_mode(mode).with_values(changes)
    history = whole_landing(Landing(parameters))
    assert outcome(history).name == "settled"
    force = size_damper(LIKE[like], leg_geometry(LIKE[like])).force
    if not changes:
        assert min(history[f"leg[{leg}].main_strut.force"].min() for leg in (1, 2, 3, 4)) > -force


@settings(max_examples=25, deadline=None)
@given(
    st.floats(20.0, 5e4),
    st.floats(0.5, 3.0),
    st.floats(2.5, 8.0),
    st.floats(0.3, 1.5),
    st.floats(0.05, 0.25),
)
def test_a_level_landing_stays_within_force_and_stroke(mass, sink, factor, slender, foot):
    """Vehicles of any size: lengths grow with the cube root of the mass."""
    length = 0.5 * mass ** (1.0 / 3.0)
    values = {
        "mass": mass,
        "footpad_mass": 0.05 * foot * mass,
        "body_length": length,
        "body_radius": 0.1 * length,
        "cg_height": 0.6 * length,
        "clearance": 0.3 * length,
        "span": (0.4 + slender) * length,
        "sink_speed": sink,
        "load_factor": factor,
    }
    try:
        needs = needs_like("hopper", values)
        damper = size_damper(needs, leg_geometry(needs))
    except LandingError:
        assume(False)
    history = whole_landing(Landing(size_vehicle(needs)))
    # the legs of a large vehicle spread by more than the usual limit of sliding
    assert outcome(history, slide=needs.span).name == "settled"
    for leg in (1, 2, 3, 4):
        assert -history[f"leg[{leg}].main_strut.force"].min() < 1.1 * damper.force
        assert history[f"leg[{leg}].main_strut.stroke"].max() < damper.stroke_max


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"mass": 1e5, "footpad_mass": 0.9}, "footpad_mass = 0.9 kg is below 1e-05 mass = 1 kg"),
        ({"mass": -1.0}, "mass = -1 kg"),
        ({"load_factor": 1.5}, "load_factor = 1.5 leaves a damper of efficiency 0.65 nothing"),
        ({"sink_speed": 10.0}, "sink_speed = 10 m/s at load_factor = 4 takes the footpads"),
        ({"span": 0.4}, "span = 0.4 m is not above 2.2 body_radius = 0.44 m"),
        ({"cg_height": 3.0}, "cg_height = 3 m is not within the body"),
        ({"weight": 3.0}, "unknown need 'weight'"),
    ],
)
def test_needs_that_cannot_be_met_are_refused(values, words):
    with pytest.raises(LandingError, match=words.replace("(", r"\(")):
        size_vehicle(needs_like("hopper", values))


def test_every_parameter_of_a_vehicle_has_its_rule():
    parameters = size_vehicle(LIKE["hopper"])
    rules = {
        name: parameters.source(name) for name, _ in parameters.items() if "solver." not in name
    }
    without = {name for name, r in rules.items() if not re.match("user$|derived: |closure: ", r)}
    assert without == set()
    assert size_vehicle(replace(LIKE["hopper"], mass=70.0))["vehicle.mass"] == 70.0


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_a_stage_on_a_slope_that_has_settled_stops_for_good(mode):
    """Its liquid evens out within seconds of the last 2 mm/s, and then nothing moves any more."""
    values = {"ground.slope": 0.1, "ground.friction": 0.5}
    landing = Landing(size_vehicle(LIKE["stage"]).for_mode(mode).with_values(values))
    landing.advance_to(40.0)
    before = landing.outputs()
    landing.advance_to(1e5)
    assert before["status.phase"] == landing.get("status.phase") == float(Phase.SETTLED)
    assert landing.outputs() == before
