"""A landing that has come to rest sleeps: days of it cost little, and any input wakes it."""

import copy
import random

import numpy as np
import pytest
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.core import Phase
from rlv_landing.landing import METHODS

FIGURES = "yue2022-figures"
WEIGHT = (178.0 + 4 * 4.2) * 9.81
# [m] at the default tolerance, as `rlv_landing.core.solvers.rest` states it
BOUND = 2e-7
# a load that grows by a nanonewton a second lets nothing rest
RESTLESS = {"external.force_x": 1e-9}
LONG = 12.0


@pytest.fixture(scope="module")
def rested(mode):
    """A landing long after it has fallen asleep."""
    landing = Landing(load_preset(FIGURES), mode)
    landing.advance_to(LONG)
    return landing


@pytest.mark.parametrize("method", METHODS)
def test_a_million_seconds_at_rest_take_no_steps(mode, method):
    landing = Landing(load_preset(FIGURES), mode, method=method)
    landing.advance_to(LONG)
    assert landing.statistics["asleep"] == 1
    before, done = landing.values(), landing.statistics
    landing.step(1e6)
    assert landing.values() == before
    assert landing.statistics == done
    assert landing.time == LONG + 1e6
    history = landing.run(2e6, 1e5)
    assert (history.data == np.array(before)).all()


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-2, 9.8e-5, 1e-5])
@pytest.mark.parametrize("preset", [FIGURES, "yue2022-tests"])
def test_on_a_slope_it_falls_asleep_at_any_tolerance(preset, rtol, method):
    """Steps at the limit of stability would shake the seals for ever."""
    slope = {"ground.slope": 0.09, "drop.tilt": 0.09, "ground.friction": 0.54}
    push = {"external.force_x": 58.3}
    parameters = load_preset(preset, "2-2").with_values(
        slope | {"drop.vertical_velocity": -0.786, "drop.contact_time": 0.0}
    )
    landing = Landing(parameters, rtol=rtol, method=method, inputs=push)
    landing.advance_to(LONG)
    assert landing.statistics["asleep"] == 1
    assert landing.get("status.phase") == Phase.SETTLED


@pytest.mark.parametrize("method", METHODS)
def test_what_rocks_settles_once_whatever_the_samples(mode, method):
    """It rocks by up to 2 mm/s for some tenths of a second, and by less for longer."""
    slope = {"ground.slope": 0.07, "drop.tilt": 0.07, "drop.contact_time": 0.0}
    parameters = load_preset(FIGURES, mode).with_values(slope)
    found = set()
    for every in (1e-3, 7e-3):
        landing = Landing(parameters, method=method)
        assert landing.settled_since is None
        history = landing.run(3.5, every)
        settled = history["status.phase"] == Phase.SETTLED
        since = landing.settled_since
        assert np.count_nonzero(np.diff(settled)) == 1
        assert 0.0 <= history.time[int(np.argmax(settled))] - since < every
        found.add(since)
    assert len(found) == 1
    landing.set_inputs({"external.force_x": 500.0})
    assert landing.settled_since is None


@pytest.mark.parametrize("method", METHODS)
def test_a_copy_of_what_sleeps_or_was_pushed_in_space_is_a_landing(method):
    """At a loose tolerance, too: the way to the rest, and states inside steps, turn the body."""
    slope = {"ground.slope": 0.09, "ground.slope_direction": 1.0, "drop.contact_time": 0.0}
    landing = Landing(load_preset(FIGURES, "space").with_values(slope), rtol=1e-2, method=method)
    landing.advance_to(0.0213)
    landing.set_inputs({"external.force_z": 90.0})
    assert copy.copy(landing).values() == landing.values()
    landing.advance_to(LONG)
    assert landing.statistics["asleep"] == 1
    assert copy.copy(landing).values() == landing.values()
    q = [landing.get(f"body.q_{axis}") for axis in "wxyz"]
    assert np.linalg.norm(q) == approx(1.0, abs=1e-12)


def test_what_sleeps_has_settled_and_stands_still(rested):
    assert rested.get("status.phase") == Phase.SETTLED
    for name in ("body.ax", "body.ay", "body.pitch_acceleration"):
        assert rested.get(name) == approx(0.0, abs=1e-6)
    assert sum(rested.get(f"leg[{leg}].contact.force_y") for leg in (1, 2, 3, 4)) == approx(
        WEIGHT, rel=1e-9
    )


def test_the_rest_is_where_a_landing_that_cannot_sleep_is(mode, rested):
    """From shortly before it falls asleep."""
    later = Landing(load_preset(FIGURES), mode)
    while not later.statistics["asleep"]:
        waked = copy.copy(later)
        later.step(0.1)
    waked.set_inputs({}, RESTLESS)
    waked.advance_to(LONG)
    assert waked.statistics["asleep"] == 0
    for name in ("body.x", "body.y", "body.pitch", "leg[1].footpad.x", "leg[3].main_strut.stroke"):
        assert rested.get(name) == approx(waked.get(name), abs=BOUND)
    assert rested.get("energy.balance") == approx(waked.get("energy.balance"), abs=1e-3)


@pytest.mark.parametrize(
    ("values", "rates"),
    [
        ({"external.force_x": 200.0}, {}),
        ({"external.moment": -50.0}, {}),
        ({}, {"external.force_y": -1e3}),
        ({"ground.heave": 0.02}, {}),
        ({"ground.heave_rate": 0.1}, {}),
        ({}, {"ground.tilt": 0.05}),
    ],
)
def test_any_input_wakes_it(rested, values, rates):
    landing = copy.copy(rested)
    landing.set_inputs(values, rates)
    assert landing.statistics["asleep"] == 0
    before = landing.get("body.x"), landing.get("body.y"), landing.get("body.pitch")
    landing.step(0.05)
    after = landing.get("body.x"), landing.get("body.y"), landing.get("body.pitch")
    assert max(abs(a - b) for a, b in zip(after, before)) > 1e-6
    assert landing.statistics["steps"] > rested.statistics["steps"]


def test_it_falls_asleep_again_under_another_load(rested):
    landing = copy.copy(rested)
    landing.set_inputs({"external.force_y": -30.0})
    landing.step(LONG)
    assert landing.statistics["asleep"] == 1
    total = sum(landing.get(f"leg[{leg}].contact.force_y") for leg in (1, 2, 3, 4))
    assert total == approx(WEIGHT + 30.0, rel=1e-9)


def test_an_input_that_is_what_it_was_lets_it_sleep(rested):
    landing = copy.copy(rested)
    landing.set_inputs({"external.force_x": 0.0, "ground.heave": 0.0})
    assert landing.statistics["asleep"] == 1


def test_a_moving_deck_lets_nothing_sleep(rested):
    landing = copy.copy(rested)
    landing.set_inputs({"ground.heave_rate": 0.01})
    landing.step(8.0)
    assert landing.get("status.phase") != Phase.SETTLED or landing.statistics["asleep"] == 0
    assert landing.statistics["asleep"] == 0


def test_sleep_does_not_depend_on_the_communication_steps(mode, rested):
    rng, wandering = random.Random(7), Landing(load_preset(FIGURES), mode)
    while wandering.time < LONG:
        wandering.advance_to(min(LONG, wandering.time + 10.0 ** rng.uniform(-4, 0)))
        assert wandering.statistics["asleep"] == 0 or (
            wandering.get("status.phase") == Phase.SETTLED
        )
    assert wandering.values() == rested.values()
    assert wandering.extremes() == rested.extremes()
    for landing in (wandering, both := copy.copy(rested)):
        landing.set_inputs({"external.force_x": 100.0})
        landing.advance_to(LONG + 0.3)
    assert wandering.values() == both.values()


def test_sleep_belongs_to_the_state(mode, rested):
    other = Landing(load_preset(FIGURES), mode)
    other.restore(rested.state())
    assert other.statistics == rested.statistics
    other.step(1e5)
    assert other.values() == rested.values()
    other.reset()
    assert other.statistics["asleep"] == 0


def test_nothing_sleeps_in_flight_or_toppling(mode):
    flying = Landing(
        load_preset(FIGURES, mode).with_values(
            {"drop.contact_time": 4.0, "drop.vertical_velocity": -50.0}
        )
    )
    flying.advance_to(3.9)
    assert flying.statistics["asleep"] == 0
    toppling = load_preset(FIGURES, mode).with_values(
        {"drop.horizontal_velocity": 6.0, "ground.friction": 1.0}
    )
    toppled = Landing(toppling)
    toppled.advance_to(1.5)
    assert toppled.get("status.phase") == Phase.TOPPLED
    assert toppled.statistics["asleep"] == 0
