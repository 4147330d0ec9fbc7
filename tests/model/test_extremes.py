"""Peaks are the landing's own: no sample and no communication step decides them."""

import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.history import History
from rlv_landing.landing import METHODS
from rlv_landing.quantities import OUTPUT_NAMES

FIGURES = "yue2022-figures"
# a landing in which half of a peak is between two samples
HARD = {"ground.damping": 1e4, "ground.damping_depth": 1e-4, "drop.contact_time": 0.0895}
# tangential forces: the paper's friction law lets no two tolerances agree in them to 0.1 %
SIDEWAYS = ("contact.force_x", "contact.force_z")
# the balance is the integrator's error itself, which is another between steps
BALANCE = "energy.balance"


def landed(mode, until=0.6, every=1e-3, **options):
    return Landing(load_preset(FIGURES), mode, **options).run(until, every)


def test_extremes_are_the_same_at_1_ms_and_10_us_sampling(mode):
    coarse, fine = landed(mode), landed(mode, every=1e-5)
    assert tuple(coarse.extremes) == tuple(fine.extremes) == OUTPUT_NAMES
    # 600 * 1 ms is not 60000 * 10 us to the last digit: what still grows at the end differs
    for name in OUTPUT_NAMES:
        assert coarse.extremes[name] == approx(fine.extremes[name], rel=1e-9, abs=1e-9), name


@pytest.mark.parametrize("method", METHODS)
def test_extremes_are_those_of_samples_that_are_a_microsecond_apart(mode, method):
    history = landed(mode, 0.35, 1e-6, method=method)
    for name in OUTPUT_NAMES:
        if name == BALANCE:
            continue
        samples, extreme = history[name], history.extremes[name]
        # in a step with a kink, the interpolant of an energy that only grows errs by a microjoule
        floor = 1e-6 if name.startswith("energy.") else 0.0
        slack = 1e-3 * max(abs(samples.min()), abs(samples.max())) + floor
        assert extreme.minimum == approx(samples.min(), abs=slack), name
        assert extreme.maximum == approx(samples.max(), abs=slack), name


def test_peaks_are_those_of_a_landing_at_the_tightest_tolerance(mode):
    found = landed(mode).extremes
    exact = landed(mode, every=1e-2, rtol=1e-10, method="dormand-prince").extremes
    for name in OUTPUT_NAMES:
        if name.endswith(SIDEWAYS) or name.startswith(("energy.stop", "energy.dissipated_stop")):
            continue
        if name == BALANCE:
            continue
        slack = 1e-3 * max(abs(exact[name].minimum), abs(exact[name].maximum))
        assert found[name].minimum == approx(exact[name].minimum, abs=slack), name
        assert found[name].maximum == approx(exact[name].maximum, abs=slack), name


def test_samples_a_millisecond_apart_miss_peaks_of_the_ground_force():
    """Half of the peak is between two samples."""
    parameters = load_preset(FIGURES, "1-2-1").with_values(HARD)
    history = Landing(parameters).run(0.6)
    peak = history.extremes["leg[1].contact.force_y"]
    assert history["leg[1].contact.force_y"].max() < 0.6 * peak.maximum
    fine = Landing(parameters)
    fine.advance_to(peak.maximum_time - 2e-6)
    near = fine.run(peak.maximum_time + 2e-6, 1e-7)["leg[1].contact.force_y"]
    assert near.max() == approx(peak.maximum, rel=2e-4)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 10**6), mode=st.sampled_from(["2-2", "1-2-1"]))
def test_extremes_do_not_depend_on_the_communication_steps(seed, mode):
    rng = random.Random(seed)
    straight, wandering = Landing(mode=mode), Landing(mode=mode)
    straight.advance_to(0.3)
    while wandering.time < 0.3:
        wandering.advance_to(min(0.3, wandering.time + 10.0 ** rng.uniform(-5, -1)))
        wandering.extremes()
    assert wandering.extremes() == straight.extremes()


def test_extremes_hold_every_value_that_is_read_on_the_way(mode):
    landing, values = Landing(load_preset(FIGURES), mode), []
    for k in range(1, 1200):
        landing.advance_to(k * 2.7e-4)
        values.append(landing.values())
    rows = np.array(values)
    for name, low, high in zip(OUTPUT_NAMES, rows.min(axis=0), rows.max(axis=0)):
        if name == BALANCE:
            continue
        extreme = landing.extremes()[name]
        slack = 1e-3 * max(abs(low), abs(high))
        assert extreme.minimum <= low + slack, name
        assert extreme.maximum >= high - slack, name
        assert min(extreme.minimum_time, extreme.maximum_time) >= 0.0
        assert max(extreme.minimum_time, extreme.maximum_time) <= landing.time


def test_a_restored_state_goes_on_with_the_same_extremes(mode):
    landing = Landing(load_preset(FIGURES), mode)
    landing.advance_to(0.2517)
    saved, then = landing.state(), landing.extremes()
    landing.advance_to(0.5)
    other = Landing(load_preset(FIGURES), mode)
    other.restore(saved)
    assert other.extremes() == then
    other.advance_to(0.5)
    assert other.extremes() == landing.extremes()


def test_extremes_go_on_over_a_jump_of_an_input(mode):
    landing = Landing(load_preset(FIGURES), mode)
    landing.advance_to(0.3)
    before = landing.extremes()
    landing.set_inputs({"external.force_y": 1e5})
    landing.advance_to(0.301)
    after = landing.extremes()
    assert after["body.ay"].maximum > 300.0
    assert after["body.ay"].maximum_time >= 0.3
    assert after["leg[1].main_strut.force"].minimum == before["leg[1].main_strut.force"].minimum


def test_extremes_at_the_start_are_those_under_the_inputs_set_before_it():
    landing = Landing()
    landing.set_inputs({"external.force_x": 1780.0})
    extreme = landing.extremes()["body.ax"]
    assert extreme.minimum == extreme.maximum == landing.get("body.ax") > 9.0
    landing.reset()
    assert landing.extremes()["body.ax"].maximum < 0.1


def test_a_runs_extremes_are_those_of_its_span(mode):
    landing = Landing(load_preset(FIGURES), mode)
    first = landing.run(0.3)
    second = landing.run(0.5)
    whole = landing.extremes()
    for name in OUTPUT_NAMES:
        a, b = first.extremes[name], second.extremes[name]
        assert b.minimum_time >= 0.3
        assert b.maximum_time >= 0.3
        slack = 1e-3 * max(abs(whole[name].minimum), abs(whole[name].maximum))
        assert min(a.minimum, b.minimum) == approx(whole[name].minimum, abs=slack)
        assert max(a.maximum, b.maximum) == approx(whole[name].maximum, abs=slack)
    straight = Landing(load_preset(FIGURES), mode)
    straight.advance_to(0.5)
    assert straight.extremes() == whole


def test_mirror_images_have_mirrored_extremes(mode):
    found = landed(mode).extremes
    left, right = (found[f"leg[{leg}].footpad.z"] for leg in (4, 3 if mode == "2-2" else 2))
    assert (left.minimum, left.minimum_time) == (-right.maximum, right.maximum_time)
    assert (left.maximum, left.maximum_time) == (-right.minimum, right.minimum_time)


def test_a_history_of_samples_only_has_no_extremes():
    history = landed("2-2", 0.1)
    assert History(history.time, history.names, history.data).extremes is None
