"""Responses, limits and margins that are peaks, whatever the samples."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.history import History
from rlv_landing.quantities import LEGS, MODES
from rlv_landing.studies.limits import LIMITS
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.replay import ReplayedHistory
from rlv_landing.studies.sweep.responses import EXTREMES, WORK, Measure, known_responses
from rlv_landing.studies.whole_landing import whole_landing

UNTIL = 0.6
PEAKS = tuple(
    name
    for name in known_responses()
    if name.rpartition(".")[2] in EXTREMES and not name.startswith(("outcome", "margin"))
)
LEAST_MARGINS = ("margin.stability_min", "margin.stroke_left", "margin.joint_clearance")
# works and places that are found between samples of 1 ms
FOUND = (
    *(name for name in known_responses() if name.rpartition(".")[2] in (*WORK, "first_stroke")),
    *(f"leg[{leg}].contact.time" for leg in LEGS),
    *("margin.slid", "margin.stability_end"),
)
EVENTS = ("outcome", "outcome.first_limit", "outcome.leg")
TIMES = ("outcome.time", "outcome.first_limit_time")
NAMES = (*PEAKS, *LEAST_MARGINS, *FOUND, *EVENTS, *TIMES)
# of each kind of loss one
CASES = {
    "moving": {},
    "toppled": {"drop.tilt": 1.2, "drop.pitch_rate": 3.0, "drop.contact_time": 0.0},
    "bottomed out": {"main_strut.stroke_max": 0.02},
}
# passed by every landing at a first peak, and lower than later ones
LOADS = {"contact.force": 2500.0, "main_strut.force": 2000.0}


@cache
def flown(case: str, mode: str, every: float) -> ReplayedHistory:
    landing = Landing(load_preset("yue2022-figures", mode).with_values(CASES[case]), rtol=1e-4)
    return whole_landing(landing, UNTIL, every, decided=False)


@cache
def responses(case: str, mode: str, every: float) -> dict[str, object]:
    return dict(zip(NAMES, Measure(NAMES, LOADS)(flown(case, mode, every), 1)))


@pytest.mark.parametrize("every", [1e-3, 1e-2])
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("mode", MODES)
def test_peaks_do_not_depend_on_the_samples(mode, case, every):
    found, exact = responses(case, mode, every), responses(case, mode, 1e-5)
    assert exact["outcome"] == case
    for name in (*PEAKS, *LEAST_MARGINS):
        assert found[name] == approx(exact[name], rel=1e-3, abs=1e-12), name
    for name in EVENTS:
        assert found[name] == exact[name], name
    assert found["outcome.first_limit_time"] == approx(exact["outcome.first_limit_time"], abs=1e-8)
    assert found["outcome.time"] == approx(exact["outcome.time"], abs=1e-8)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("mode", MODES)
def test_works_contacts_and_slides_do_not_depend_on_samples_of_1_ms(mode, case):
    found, exact = responses(case, mode, 1e-3), responses(case, mode, 1e-5)
    for name in FOUND:
        if isinstance(exact[name], float):
            assert found[name] == approx(exact[name], rel=1e-3, abs=1e-12), name
        else:
            assert found[name] == exact[name], name


@pytest.mark.parametrize("mode", MODES)
def test_a_peak_between_the_samples_is_a_response(mode):
    """Samples of 10 ms miss much of the largest ground force; those of 0.1 us do not."""
    history = flown("moving", mode, 1e-2)
    told = responses("moving", mode, 1e-2)["legs.contact.force.max"]
    peaks = {leg: history.extreme(f"leg[{leg}].contact.force") for leg in LEGS}
    leg = max(LEGS, key=lambda leg: peaks[leg].maximum)
    landing = Landing(load_preset("yue2022-figures", mode), rtol=1e-4)
    landing.advance_to(peaks[leg].maximum_time - 5e-5)
    near = landing.run(landing.time + 1e-4, 1e-7)[f"leg[{leg}].contact.force"]
    assert told == approx(near.max(), rel=1e-3)
    assert max(history[f"leg[{leg}].contact.force"].max() for leg in LEGS) < 0.9 * told


def test_the_force_of_a_contact_is_that_of_all_directions():
    history = flown("moving", "1-2-1", 1e-3)
    for leg in LEGS:
        parts = [history[f"leg[{leg}].contact.force_{axis}"] for axis in "xyz"]
        assert np.allclose(history[f"leg[{leg}].contact.force"], np.linalg.norm(parts, axis=0))


@pytest.mark.parametrize("name", LIMITS)
@pytest.mark.parametrize("every", [1e-3, 1e-2])
def test_a_limit_is_judged_by_the_true_extreme(name, every):
    """A limit just below the largest value of fine samples is passed, one just above it is not."""
    fine, coarse = flown("moving", "2-2", 1e-5), flown("moving", "2-2", every)
    outputs = [name] if name.startswith("body.") else [f"leg[{leg}].{name}" for leg in LEGS]
    signs = (-1.0, 1.0) if name.endswith("strut.force") else (1.0,)
    largest = max((sign * fine[output]).max() for output in outputs for sign in signs)
    passed = outcome(coarse, {name: 0.998 * largest}).first_limit
    assert passed is not None
    assert outcome(coarse, {name: 1.001 * largest}).first_limit is None
    exact = outcome(fine, {name: 0.998 * largest}).first_limit
    assert exact is not None
    assert (passed.name, passed.leg, passed.time) == (
        exact.name,
        exact.leg,
        approx(exact.time, abs=1e-8),
    )


def test_a_limit_is_passed_at_the_first_peak_beyond_it_not_at_the_largest():
    history = flown("moving", "2-2", 1e-2)
    time = outcome(history, LOADS).first_limit.time
    assert time < history.extreme("leg[1].main_strut.force").minimum_time - 0.005
    landing = Landing(load_preset("yue2022-figures", "2-2"), rtol=1e-4)
    landing.advance_to(time - 1e-6)
    assert outcome(landing_history(landing), LOADS).first_limit is None
    landing.advance_to(time + 1e-6)
    assert outcome(landing_history(landing), LOADS).first_limit is not None


def landing_history(landing: Landing) -> History:
    """The present time of a landing, with the extremes since its start."""
    return History(
        np.array([landing.time]),
        tuple(landing.outputs()),
        np.array([landing.values()]),
        landing.parameters,
        extremes=landing.extremes(),
    )


def test_to_judge_a_landing_leaves_it_where_it_was():
    landing = Landing(
        load_preset("yue2022-figures", "2-2").with_values(CASES["toppled"]), rtol=1e-4
    )
    history = whole_landing(landing, UNTIL, 1e-2)
    before = landing.state()
    assert outcome(history, LOADS).name == "toppled"
    assert landing.state() == before


def test_a_history_that_is_cut_has_the_peaks_from_before_the_cut():
    history = Landing(load_preset("yue2022-figures", "2-2"), rtol=1e-4).run(UNTIL)
    half = history.until(300)
    assert len(half) == 300
    for name in history.names:
        if name == "energy.balance":
            continue  # the integrator's error: between its steps the interpolant's
        found, whole, samples = half.extreme(name), history.extreme(name), half[name]
        near = 1e-3 * max(abs(whole.minimum), abs(whole.maximum))
        assert samples.min() + near >= found.minimum >= whole.minimum - near
        assert samples.max() - near <= found.maximum <= whole.maximum + near
        assert max(found.minimum_time, found.maximum_time) <= half.time[-1]
