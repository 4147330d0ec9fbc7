"""A solver integrates any system: here some that are no vehicle, against their closed forms."""

from array import array
from itertools import pairwise
from math import cos, exp, sin

import pytest
from pytest import approx

from rlv_landing.core.bodies.system import System
from rlv_landing.core.records import StiffPair
from rlv_landing.core.solvers.dormand_prince import DormandPrince
from rlv_landing.core.solvers.exponential import Exponential
from rlv_landing.core.solvers.step_control import GROW, SHRINK, step_factor

METHODS = [Exponential, DormandPrince]


def doubles(*values):
    return array("d", values)


class Relaxing(System):
    """An oscillator x'' = u - x beside a pair of states that evens out.

    The pair's difference decays at 3 `decay` [1/s]; its first state is driven as x is.
    """

    def __init__(self, decay, declared):
        super().__init__(
            doubles(1.0, 1.0, 1.0, 1.0),
            doubles(0.0, 0.0, 0.0, 0.0),
            carried=0,
            inputs=1,
            row=2,
            stiff_pairs=int(declared),
        )
        self.decay = decay

    def inputs_after(self, u, rates, dt, now):
        now[0] = u[0] + rates[0] * dt

    def rhs(self, y, u, dy):
        difference = y[3] - y[2]
        dy[0], dy[1] = y[1], u[0] - y[0]
        dy[2], dy[3] = self.decay * difference, -2.0 * self.decay * difference

    def stiff(self, k):
        return StiffPair(2, 3, self.decay, 2.0 * self.decay)

    def read(self, y, u, dy, out, at):
        out[at], out[at + 1] = y[0], u[0]


class Stopped(System):
    """x' = 1, with x held at `limit`."""

    def __init__(self, limit):
        super().__init__(doubles(1.0), doubles(0.0), carried=0, inputs=1, row=1, stiff_pairs=0)
        self.limit = limit

    def rhs(self, y, u, dy):
        dy[0] = 1.0

    def project(self, y):
        y[0] = min(y[0], self.limit)


class Pulsed(System):
    """A state whose rate is pulses far shorter than the steps, beside a state at rest."""

    def __init__(self, rising):
        super().__init__(
            doubles(1.0, 1.0), doubles(0.0, 0.0), carried=1, inputs=1, row=1, stiff_pairs=0
        )
        self.rising = rising

    def inputs_after(self, u, rates, dt, now):
        now[0] = dt

    def rhs(self, y, u, dy):
        dy[0], dy[1] = 0.0, max(0.0, sin(7000.0 * u[0])) ** 8

    def read(self, y, u, dy, out, at):
        out[at] = y[1]


def started(method, system, rtol, *y):
    solver = method(system, rtol)
    for i, value in enumerate(y):
        solver.y[i] = value
    solver.restart(0.0)
    return solver


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("declared", [True, False])
def test_a_system_with_a_decaying_pair_is_solved(method, declared):
    solver = started(method, Relaxing(50.0, declared), 1e-8, 1.0, 0.0, 1.0, 3.0)
    assert solver.advance(0.5)
    end = doubles(0.0, 0.0, 0.0, 0.0)
    solver.interpolate(0.5, end)
    assert (end[0], end[1]) == approx((cos(0.5), -sin(0.5)), abs=1e-7)
    # 2 z1 + z2 is kept, z2 - z1 decays
    assert 2.0 * end[2] + end[3] == approx(5.0, abs=1e-7)
    assert end[3] - end[2] == approx(2.0 * exp(-75.0), abs=1e-7)


def test_a_declared_stiff_pair_does_not_limit_the_step_however_stiff():
    steps = {}
    for declared in (True, False):
        solver = started(Exponential, Relaxing(2e5, declared), 1e-4, 1.0, 0.0, 1.0, 3.0)
        assert solver.advance(0.02)
        steps[declared] = solver.steps
    assert steps[True] < 0.05 * steps[False]


@pytest.mark.parametrize("method", METHODS)
def test_a_state_past_its_bound_is_brought_back_at_the_end_of_every_step(method):
    solver = started(method, Stopped(0.01), 1e-6, 0.0)
    while solver.t < 0.05:
        assert solver.advance(solver.t + 1e-6)
        assert solver.y[0] <= 0.01
    assert solver.y[0] == 0.01


def test_outputs_are_recorded_at_counted_times_with_the_inputs_there():
    solver = started(Exponential, Relaxing(50.0, True), 1e-8, 1.0, 0.0, 1.0, 1.0)
    solver.u[0], solver.u_rate[0] = 0.0, 2.0
    solver.restart(0.0)
    rows = doubles(*([0.0] * 8))
    assert solver.record(0.0, 0.1, 1, 4, rows) == 4
    assert rows[:2] == doubles(0.0, 0.0)  # row 0 was not asked for
    for k in (1, 2, 3):
        t = 0.1 * k
        assert rows[2 * k] == approx(cos(t) + 2.0 * (t - sin(t)), abs=1e-7)
        assert rows[2 * k + 1] == approx(2.0 * t)


@pytest.mark.parametrize("exponent", [0.17, 0.22])
def test_steps_grow_where_the_error_is_small_and_shrink_where_it_is_too_large(exponent):
    assert step_factor(0.0, 1e-4, exponent) == GROW
    assert step_factor(1e30, 1.0, exponent) == SHRINK
    assert step_factor(float("nan"), 1.0, exponent) == SHRINK
    assert step_factor(1e-4, 1.0, exponent) > 1.0
    factors = [
        step_factor(error, 1.0, exponent) for error in (1e-6, 1e-3, 0.5, 1.0, 2.0, 50.0, 1e5)
    ]
    assert factors == sorted(factors, reverse=True)
    assert all(factor < 1.0 for factor in factors[3:])


def largest_fall(solver, until):
    """The largest fall of the only output between two of many times up to `until`."""
    rows = doubles(*bytes(4000))
    every = until / len(rows)
    assert solver.record(0.0, every, 0, len(rows), rows) == len(rows)
    return max(a - b for a, b in pairwise(rows))


@pytest.mark.parametrize("method", METHODS)
def test_a_state_that_never_falls_does_not_fall_inside_a_step(method):
    assert largest_fall(started(method, Pulsed(rising=1), 1e-5, 0.0, 0.0), 0.1) <= 1e-17


@pytest.mark.parametrize("method", METHODS)
def test_without_that_rule_the_same_state_falls_inside_a_step(method):
    """So that the test above is of steps long enough to show a fall."""
    assert largest_fall(started(method, Pulsed(rising=0), 1e-5, 0.0, 0.0), 0.1) > 1e-6
