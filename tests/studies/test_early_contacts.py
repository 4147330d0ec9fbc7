"""Footpads that touch at the start, within its first samples, or for less than a sample."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from five_legs import FIVE_LEGS
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.core import Phase
from rlv_landing.history import History
from rlv_landing.quantities import MODES
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.replay import ReplayedHistory
from rlv_landing.studies.sweep.responses import REDUCTIONS, WORK, Measure, known_responses
from rlv_landing.studies.whole_landing import whole_landing
from rlv_landing.validation.first_contact import first_contact

# struts that move before their footpad touches
SPRINGS = FIVE_LEGS | {
    "drop.contact_time": 0.0004,
    # it bottoms out before they meet the ground, and a strike is the severer outcome
    "vehicle.body_points": "",
    "main_strut.kind": "spring-damper",
    "main_strut.stiffness": 4e4,
    "main_strut.damping": 300.0,
}
TOPPLES = {
    "drop.contact_time": 0.0,
    "drop.tilt": 0.3,
    "drop.pitch_rate": 3.0,
    "drop.horizontal_velocity": 2.0,
    "ground.friction": 0.9,
}
# outcome and time until which they land [s]
CASES = {"bottomed out": (SPRINGS, 0.25), "toppled": (TOPPLES, 0.4)}


@cache
def flown(case: str, every: float) -> ReplayedHistory:
    values, until = CASES[case]
    landing = Landing(load_preset("yue2022-figures").with_values(values), rtol=1e-4)
    return whole_landing(landing, until, every, decided=False)


@pytest.mark.parametrize("case", CASES)
def test_works_places_and_last_values_do_not_depend_on_samples_of_1_ms(case):
    """The last values of a landing that topples are those at that time."""
    fine, coarse = flown(case, 1e-5), flown(case, 1e-3)
    names = [
        name
        for name in known_responses(Landing(fine.parameters).interface)
        if name.rpartition(".")[2] in (*WORK, *REDUCTIONS, "time", "slid", "outcome")
        # the integrator's error, and 0 at toppling
        and not name.startswith(("energy.balance", "status.stability_margin"))
    ]
    measure = Measure(names)
    exact = dict(zip(names, measure(fine, 0)))
    assert exact["outcome"] == case
    for name, found in zip(names, measure(coarse, 0)):
        if isinstance(exact[name], float):
            assert found == approx(exact[name], rel=1e-3, abs=1e-12), name
        else:
            assert found == exact[name], name


def test_the_time_of_settling_is_exact():
    upright = {"drop.tilt": 0.0, "drop.pitch_rate": 0.0}
    landing = Landing(load_preset("yue2022-figures").with_values(upright), rtol=1e-4)
    found = outcome(whole_landing(landing, None, 1e-2))
    assert found.name == "settled"
    landing.reset()
    landing.advance_to(found.time - 1e-6)
    assert landing.get("status.phase") != Phase.SETTLED
    landing.advance_to(found.time + 1e-6)
    assert landing.get("status.phase") == Phase.SETTLED


@pytest.mark.parametrize("contact", [0.0, 0.0004, 0.0013, 0.0029])
@pytest.mark.parametrize("mode", MODES)
def test_the_first_footpad_touches_at_the_time_of_the_drop(mode, contact):
    """But for what the struts move in the flight."""
    p = load_preset("yue2022-figures", mode).with_values({"drop.contact_time": contact})
    history = whole_landing(Landing(p, rtol=1e-4), 0.01, 1e-3, decided=False)
    times = [found.time for leg in history.legs if (found := first_contact(history, leg))]
    assert min(times) == approx(contact, rel=1e-2, abs=1e-9)


def test_a_touch_between_two_samples_is_the_first_contact():
    """The second footpad stays for 1.2 ms and bounces; samples of 2.5 ms do not show it."""
    p = load_preset("yue2022-figures", "1-2-1").with_values({"ground.stiffness": 1e9})
    landing = Landing(p.with_values({"drop.contact_time": 0.001}))
    fine = whole_landing(landing, 0.2, 1e-5, decided=False)
    landing.reset()
    coarse = whole_landing(landing, 0.2, 2.5e-3, decided=False)
    exact = first_contact(fine, 2)
    assert exact is not None
    first = int(np.searchsorted(coarse.time, exact.time))
    assert coarse["leg[2].contact.force_y"][first] == 0.0
    assert first_contact(coarse, 2).time == approx(exact.time, abs=1e-5)
    # without extremes, samples are all that is known
    samples = History(coarse.time, coarse.names, coarse.data, p)
    assert first_contact(samples, 2).time > exact.time + 1e-3
