"""Copies of a landing are landings of their own, at the same place."""

import copy
import pickle

import pytest

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.errors import StepLimitError
from rlv_landing.interruptible import LIMIT
from rlv_landing.landing import METHODS

COPIES = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda landing: pickle.loads(pickle.dumps(landing)),
}


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("method", METHODS)
def test_a_copy_goes_on_with_the_same_digits_and_by_itself(mode, how, method):
    parameters = load_preset("yue2022-figures").with_values({"ground.slope": 0.02, LIMIT: 1e5})
    landing = Landing(parameters, mode, rtol=1e-4, method=method)
    landing.set_inputs({"external.force_x": 50.0}, {"external.force_x": 10.0})
    landing.advance_to(0.21)
    other = COPIES[how](landing)
    assert (other.time, other.values(), other.state()) == (
        landing.time,
        landing.values(),
        landing.state(),
    )
    here = landing.state()
    other.set_inputs({"external.force_x": -900.0})
    other.advance_to(0.3)
    assert landing.state() == here
    again = COPIES[how](landing)
    for both in (landing, again):
        both.advance_to(0.5)
    assert again.values() == landing.values()
    assert again.extremes() == landing.extremes()
    assert again.statistics == landing.statistics
    again.reset()
    fresh = Landing(parameters, mode, rtol=1e-4, method=method)
    assert again.state() == fresh.state()


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_of_a_landing_that_ended_has_ended(how):
    landing = Landing(Parameters().with_values({LIMIT: 300.0}))
    with pytest.raises(StepLimitError) as ended:
        landing.advance_to(1.0)
    with pytest.raises(StepLimitError) as raised:
        COPIES[how](landing).step(1e-3)
    assert str(raised.value) == str(ended.value)


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_is_reset_to_the_inputs_that_the_landing_was_made_with(how):
    """Also one that only these inputs let start, and on a ground on its way to a new position."""
    values = {"ground.heave": -3.0, "ground.tilt": 0.05, "external.force_x": 20.0}
    rates = {"ground.heave": 0.4, "external.force_x": -3.0}
    landing = Landing(inputs=values, rates=rates)
    landing.step(0.2)
    landing.set_inputs({"ground.heave": -2.9})
    other = COPIES[how](landing)
    for both in (landing, other):
        both.step(0.05)
    assert other.state() == landing.state()
    other.reset()
    assert other.state() == Landing(inputs=values, rates=rates).state()


class Named(Landing):
    """A landing of another class."""


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_is_of_the_same_class_and_its_history_travels(how):
    landing = Named()
    history = landing.run(0.05, 1e-2)
    assert type(COPIES[how](landing)) is Named
    back = COPIES[how](history)
    assert back.extremes == history.extremes
    assert (back.data == history.data).all()
