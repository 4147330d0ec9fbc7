"""A ground that moves to a new position (a `Way`): with sleep, Ctrl-C, states and copies."""

import copy
import threading

import pytest
from interrupting import interrupted_after
from pytest import approx

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.inputs.ground_way import Way
from rlv_landing.quantities import interface_of
from rlv_landing.state import StateHeader

RESTED = 12.0
HEADER = len(StateHeader._fields)


@pytest.fixture(scope="module")
def rested(mode):
    """A landing that sleeps."""
    landing = Landing(load_preset("yue2022-figures"), mode)
    landing.advance_to(RESTED)
    assert landing.statistics["asleep"] == 1
    return landing


@pytest.mark.parametrize("position", ["ground.heave", "ground.tilt"])
def test_a_ground_position_wakes_the_landing_and_the_motion_to_it_keeps_it_awake(rested, position):
    landing, before = copy.copy(rested), rested.get("body.y")
    landing.set_inputs({position: 1e-4})
    assert landing.statistics["asleep"] == 0
    landing.step(RESTED)  # so slow that the vehicle rests on the way
    assert landing.statistics["asleep"] == 0
    landing.step(RESTED)
    assert landing.statistics["asleep"] == 1
    if position == "ground.heave":
        assert landing.get("body.y") - before == approx(1e-4, abs=1e-6)
    again = copy.copy(landing)
    again.set_inputs({position: 1e-4})
    assert again.statistics["asleep"] == 1


def test_each_of_several_ground_positions_wakes_the_landing_and_it_sleeps_after_the_last(rested):
    landing = copy.copy(rested)
    for k in range(40):
        landing.set_inputs({"ground.heave": 1e-4 * (1 + k // 4)})
        landing.step(0.05)
        assert landing.statistics["asleep"] == 0
    landing.step(RESTED)
    assert landing.statistics["asleep"] == 1


@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(),
    reason="signals reach the main thread",
)
@pytest.mark.parametrize("how", ["advance_to", "run"])
def test_ctrl_c_during_the_motion_does_not_move_the_ground(rested, how):
    copy.copy(rested).run(RESTED + 1e-3)  # imports what `run` needs before the interrupt comes
    landing, other, end = copy.copy(rested), copy.copy(rested), RESTED + 400.0
    for both in (landing, other):
        both.set_inputs({"ground.heave": 0.5, "ground.tilt": 0.01})
    go_on = {
        "advance_to": lambda: landing.advance_to(end),
        "run": lambda: landing.run(end, 400.0),
    }[how]
    interrupted_after(0.02, go_on)
    assert RESTED < landing.time < end
    height = landing.get("body.y") - rested.get("body.y")
    share = (landing.time - RESTED) / 400.0
    assert height == approx(0.5 * share, abs=0.02)
    landing.advance_to(end)
    other.advance_to(end)
    assert landing.values() == other.values()


def on_the_way():
    landing = Landing()
    landing.advance_to(0.2)
    landing.set_inputs({"ground.heave": 0.01})
    landing.step(0.01)
    landing.set_inputs({"ground.heave": 0.02})
    landing.step(0.001)
    return landing


@pytest.mark.parametrize("which", range(len(interface_of("2-2").positions)))
@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("since", 1.0, "a ground position set at 1 s"),
        ("since", -1.0, "a ground position set at -1 s"),
        ("interval", -1.0, "ground positions -1 s apart"),
        ("interval", 1e300, "ground positions 1e\\+300 s apart"),
        ("goal", float("nan"), "not finite"),
        ("end", 0.1, "that it had at 0.1 s"),
    ],
)
def test_a_state_with_a_ground_motion_that_no_landing_has_is_refused(which, field, value, message):
    landing = on_the_way()
    before, spoiled = landing.state(), landing.state()
    spoiled[HEADER + which * len(Way._fields) + Way._fields.index(field)] = value
    if field == "end" and which == 1:
        landing.restore(spoiled)  # the tilt is not on its way
        return
    with pytest.raises(LandingError, match=message):
        landing.restore(spoiled)
    assert landing.state() == before


def test_the_motion_of_the_ground_continues_from_a_state_and_in_a_copy():
    landing, other = on_the_way(), Landing()
    other.restore(landing.state())
    for both in (landing, other, third := copy.deepcopy(landing)):
        for _ in range(20):
            both.step(0.001)
    assert landing.state() == other.state() == third.state()
