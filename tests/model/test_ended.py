"""A landing that the solver cannot continue ends with a named fault, within the limit of steps."""

import threading
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st
from interrupting import interrupted_after
from pytest import approx

from rlv_landing import Landing, LandingError, Parameters, load_preset
from rlv_landing.errors import IntegrationError, StepLimitError, StepSizeError
from rlv_landing.landing import METHODS
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.state import StateHeader

LIMIT = "solver.max_steps_per_second"
# a seal that grips like a vice: millions of steps for a second
STIFF = {"main_strut.seal_coulomb": 1e6, LIMIT: 2e4}
# a pull that nothing holds
TORN = {"external.force_x": 1e7, "external.force_y": -1e7, "external.moment": 1e7}
# a load that grows lets nothing rest
RESTLESS = {"external.force_x": 1e-3}
# after years at rest
BEFORE, BEYOND = 9e8, 9e8 + 10.0


def stiff():
    return Landing(Parameters().with_values(STIFF))


def limited(limit):
    return Landing(Parameters().with_values({LIMIT: limit}))


def torn():
    """A landing whose steps become so short that their sum with the time is the time."""
    landing = Landing()
    landing.advance_to(BEFORE)
    landing.set_inputs(TORN)
    return landing


def step_to(landing, time):
    while landing.time < time:
        landing.step(1e-3)


GOING_ON = {
    "step": lambda landing: landing.step(1e-3),
    "advance_to": lambda landing: landing.advance_to(landing.time + 1.0),
    "run": lambda landing: landing.run(landing.time + 1.0),
    "set_inputs": lambda landing: landing.set_inputs({"external.force_x": 1.0}),
}


@pytest.mark.parametrize("make", [stiff, torn])
@pytest.mark.parametrize("how", ["advance_to", "run"])
def test_a_landing_that_ended_is_ended_for_all_that_would_go_on(make, how):
    landing = make()
    with pytest.raises(IntegrationError) as ended:
        GOING_ON[how](landing)
    time, state = landing.time, landing.state()
    for go_on in GOING_ON.values():
        with pytest.raises(type(ended.value)) as again:
            go_on(landing)
        assert str(again.value) == str(ended.value)
    assert (landing.time, landing.state()) == (time, state)
    assert f"t = {time:g} s" in str(ended.value)
    landing.reset()
    landing.step(1e-3)
    assert landing.time == 1e-3


def test_the_ends_have_names_and_say_what_to_do():
    with pytest.raises(
        StepLimitError, match=rf"{LIMIT} = 20000 1/s at t = .*loosen rtol, or raise"
    ):
        stiff().run(1.0)
    with pytest.raises(StepSizeError, match=r"step size has collapsed at t = .*soften"):
        torn().run(BEYOND)


@pytest.mark.parametrize("make", [stiff, torn])
def test_a_state_from_before_the_end_goes_on_to_the_same_end(make):
    landing = make()
    early = landing.state()
    with pytest.raises(IntegrationError) as ended:
        landing.advance_to(BEYOND)
    late = landing.state()
    landing.restore(early)
    with pytest.raises(IntegrationError) as again:
        step_to(landing, BEYOND)
    assert str(again.value) == str(ended.value)
    assert landing.state() == late
    other = make()
    other.restore(late)
    with pytest.raises(IntegrationError) as raised:
        other.step(1e-3)
    assert str(raised.value) == str(ended.value)


def test_the_limit_is_a_parameter_and_holds_any_landing_on_average():
    with pytest.raises(StepLimitError):
        limited(300.0).run(1.0)
    free, held = Landing(), limited(1e4)
    for landing in (free, held):
        landing.advance_to(1.0)
    assert held.values() == free.values()
    with pytest.raises(LandingError, match=rf"{LIMIT} = 5 1/s is outside"):
        limited(5.0)


def test_no_more_is_spent_than_a_second_may_take_and_the_time_allows():
    landing = stiff()
    with pytest.raises(StepLimitError):
        landing.advance_to(1.0)
    done = landing.statistics
    assert done["steps"] + done["rejected"] <= 2e4 * (1.0 + landing.time) + 1


def test_jumps_of_inputs_do_not_count_against_the_limit():
    """A host that sets an input every 10 us starts 1e5 times a second."""
    landing = limited(10000.0)
    for k in range(1, 3000):
        landing.set_inputs({"external.force_x": float(k % 7)})
        landing.step(1e-5)
    assert landing.time == approx(2999e-5)


@pytest.mark.parametrize("method", METHODS)
def test_the_default_limit_lets_the_tightest_tolerance_land(method):
    landing = Landing(rtol=1e-12, method=method)
    landing.advance_to(0.5)
    assert landing.time == 0.5


@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(),
    reason="signals reach the main thread",
)
@pytest.mark.parametrize(
    "work",
    [
        lambda landing: landing.advance_to(1e8),
        lambda landing: landing.step(1e8),
        lambda landing: landing.run(1e8, 1e7),
    ],
)
def test_ctrl_c_ends_a_step_that_would_take_days_and_the_landing_goes_on_from_there(work):
    landing = Landing()
    landing.set_inputs({}, RESTLESS)
    interrupted_after(0.2, lambda: work(landing))
    assert 0.0 < landing.time < 1e8
    time, found = landing.time, landing.values()
    other = Landing()
    other.set_inputs({}, RESTLESS)
    other.advance_to(time)
    assert other.values() == found
    assert other.extremes() == landing.extremes()
    for both in (landing, other):
        both.step(0.01)
    assert other.values() == landing.values()


HEADER = StateHeader._fields


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("h", 0.0, "a next step of 0 s"),
        ("h", -1e-3, "a next step of -0.001 s"),
        ("h", 1.0, "a next step of 1 s"),
        ("h", nan, "not finite"),
        ("t_old", 5.0, "not in order"),
        ("t", -1.0, "not in order"),
        ("t", 1e300, "not in order"),
        ("time", 1e6, "not in order"),
        ("t_before", 1.0, "not in order"),
        ("t_start", 1.0, "not in order"),
        ("t_input", 1e9, "inputs set at"),
        ("error_old", 0.0, "an error of the last step of 0"),
        ("error_old", -1.0, "an error of the last step of -1"),
        ("steps", 1e300, "steps = 1e\\+300, which is not a count"),
        ("steps", -1.0, "steps = -1, which is not a count"),
        ("rejected", 0.5, "rejected = 0.5, which is not a count"),
        ("rhs_calls", inf, "not finite"),
        ("spent", -1e9, "-1e\\+09 steps spent"),
        ("fault", 7.0, "fault = 7"),
        ("dense_at", 1.0, "dense_at = 1"),
        ("seen", 0.0, "seen = 0"),
        ("noted", 2.0, "noted = 2"),
    ],
)
def test_a_state_with_a_number_that_none_has_is_refused_and_nothing_changes(field, value, message):
    landing = Landing()
    landing.advance_to(0.2)
    before, spoiled = landing.state(), landing.state()
    spoiled[HEADER.index(field)] = value
    with pytest.raises(LandingError, match=message):
        landing.restore(spoiled)
    assert landing.state() == before


@given(
    st.lists(st.tuples(st.integers(0, len(HEADER) + 60), st.floats()), min_size=1, max_size=4),
)
def test_no_state_hangs_a_landing(spoilt):
    """Any altered state is refused, or the landing continues or ends with a named fault."""
    landing = limited(1000.0)
    landing.advance_to(0.02)
    state = landing.state()
    for i, value in spoilt:
        state[i] = value
    try:
        landing.restore(state)
        landing.step(1e-3)
        landing.extremes()
    except LandingError:
        pass
    landing.reset()
    landing.advance_to(0.02)


def test_the_limit_is_listed_as_other_parameters_are():
    q = PARAMETER_QUANTITIES[LIMIT]
    assert (q.unit, q.kind) == ("1/s", "real")
    assert load_preset("yue2022-figures")[LIMIT] == q.default == 5e5


@pytest.mark.parametrize("part", range(5))
@pytest.mark.parametrize("value", [-1e300, 1e300])
def test_an_interpolant_that_no_landing_has_is_refused(part, value):
    """From within such a step a landing would continue with the shortest steps to its limit."""
    landing = Landing()
    landing.advance_to(0.2)
    before, solver = landing.state(), landing._solver
    first = len(before) - sum(map(len, (solver.dense, solver.kept, *[solver.last] * 3)))
    for i in range(solver.n):
        spoiled = before[:]
        spoiled[first + int(solver.dense_at) + part * solver.n + i] = value
        with pytest.raises(LandingError, match="an interpolant of"):
            landing.restore(spoiled)
    assert landing.state() == before
