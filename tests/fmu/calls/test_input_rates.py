"""Inputs that change linearly between communication points: fmi2SetRealInputDerivatives."""

from __future__ import annotations

import math
from ctypes import c_double

import numpy as np
import pytest
from fmpy.simulation import Input
from fmu_instance import DISCARD, OK

from rlv_landing import Landing

SEEN = (
    "body.x",
    "body.y",
    "body.pitch",
    "energy.work_external",
    "energy.work_ground",
    "leg[1].main_strut.force",
)
FORCE, MOMENT, HEAVE = "external.force_x", "external.moment", "ground.heave"


def assert_equal_at_every_step(instance, landing, steps, first=0):
    """FMU and `Landing` give the same digits at each of the 5 ms steps."""
    for k in range(first, first + steps):
        assert instance.step(k * 5e-3, 5e-3) == OK
        landing.advance_to(k * 5e-3 + 5e-3)
        assert [instance.get(n) for n in SEEN] == [landing.get(n) for n in SEEN]


@pytest.mark.parametrize("looked_at", [False, True])
@pytest.mark.parametrize("rate_first", [False, True])
def test_a_rate_acts_as_on_landing_in_whatever_order_it_is_given(instance, rate_first, looked_at):
    """Also if outputs, which inputs change at once, are read in between."""
    landing = Landing()
    instance.start()
    for k in range(40):
        value, rate = 300.0 * math.sin(k), 4e4 * math.cos(k)
        if rate_first:
            assert instance.set_rate(FORCE, rate) == OK
            if looked_at:
                instance.get("body.ax")
        instance.set(FORCE, value)
        if looked_at:
            instance.get("body.ax")
        if not rate_first:
            assert instance.set_rate(FORCE, rate) == OK
        instance.set(MOMENT, 10.0 * k)
        landing.set_inputs({FORCE: value, MOMENT: 10.0 * k}, {FORCE: rate})
        assert_equal_at_every_step(instance, landing, 1, first=k)


def test_an_input_set_without_a_rate_goes_on_constant_and_one_not_set_goes_on_as_it_was(instance):
    landing = Landing()
    instance.start()
    instance.set(FORCE, 100.0)
    instance.set_rate(FORCE, 5e3)
    landing.set_inputs({FORCE: 100.0}, {FORCE: 5e3})
    assert_equal_at_every_step(instance, landing, 20)
    instance.set(MOMENT, 50.0)
    landing.set_inputs({MOMENT: 50.0})
    assert_equal_at_every_step(instance, landing, 20, first=20)
    instance.set(FORCE, 100.0)
    landing.set_inputs({FORCE: 100.0})
    assert_equal_at_every_step(instance, landing, 20, first=40)


def test_the_rate_of_the_decks_heave_is_its_heave_rate(instance):
    landing = Landing()
    instance.start()
    instance.set(HEAVE, 0.02)
    instance.set_rate(HEAVE, 0.3)
    landing.set_inputs({HEAVE: 0.02, "ground.heave_rate": 0.3})
    assert_equal_at_every_step(instance, landing, 40)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_bad_rate_is_refused_with_a_reason_until_the_input_is_set_again(instance, bad):
    landing = Landing()
    instance.start()
    assert_equal_at_every_step(instance, landing, 5)
    instance.set(FORCE, 200.0)
    instance.set_rate(FORCE, bad)
    for _ in range(2):
        assert instance.step(25e-3, 5e-3) == DISCARD
        assert f"rate of external.force_x = {bad:g} N/s must be finite" in instance.reason()
    instance.set(FORCE, 200.0)
    landing.set_inputs({FORCE: 200.0})
    assert_equal_at_every_step(instance, landing, 20, first=5)


def test_pending_values_and_rates_are_part_of_the_state(instance):
    instance.start()
    instance.steps(0, 100)
    instance.set(FORCE, 500.0)
    instance.set_rate(FORCE, 2e4)
    data = instance.slave.serializeFMUstate(instance.slave.getFMUState())
    instance.steps(100, 200)
    expected = [instance.get(n) for n in SEEN]
    instance.slave.reset()
    instance.slave.setFMUState(instance.slave.deSerializeFMUstate(data))
    instance.steps(100, 200)
    assert [instance.get(n) for n in SEEN] == expected


@pytest.mark.parametrize("interpolated", [True, False])
def test_fmpys_interpolated_input_lands_on_the_exact_ramp_where_a_held_one_does_not(
    instance, description, interpolated
):
    """A side load that grows by 800 N/s, in 10 ms steps."""
    signal = np.array([(-1.0, -800.0), (1.0, 800.0)], dtype=[("time", float), (FORCE, float)])
    ramp = Input(instance.slave, description, signal, set_input_derivatives=interpolated)
    # FMPy 0.3.32 makes room for nine derivatives, whatever their number, and then stops
    ramp.continuous = [c._replace(derivatives=(c_double * len(c.vrs))()) for c in ramp.continuous]
    instance.start()
    for k in range(50):
        ramp.apply(k * 1e-2)
        instance.slave.doStep(k * 1e-2, 1e-2)
    landing = Landing()
    landing.set_inputs({FORCE: 0.0}, {FORCE: 800.0})
    landing.advance_to(0.5)
    error = abs(instance.get("body.x") - landing.get("body.x"))
    # restarts each 10 ms cost the integrator some of its tolerance
    assert error < 3e-5 if interpolated else error > 1e-4
