"""A system at rest sleeps at its equilibrium; one that moves, creeps or decays does not."""

from array import array

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing.core.bodies.system import System
from rlv_landing.core.linear import solve
from rlv_landing.core.solvers.dormand_prince import DormandPrince
from rlv_landing.core.solvers.exponential import Exponential

METHODS = [Exponential, DormandPrince]
RTOL = 1e-6
# as `rlv_landing.core.solvers.rest` states it [m]
BOUND = 0.1 * RTOL


class Hung(System):
    """A weight on a stiff spring and damper, and one that creeps at a constant `creep` [m/s].

    The weight has x'' = 1e6 (u - x) - 400 x'.
    """

    def __init__(self, creep=0.0, slow=0.0):
        scale = array("d", [0.1, 1.0, 0.1, 0.1])
        super().__init__(scale, array("d", bytes(32)), carried=0, inputs=1, row=3, stiff_pairs=0)
        self.creep, self.slow = creep, slow

    def inputs_after(self, u, rates, dt, now):
        now[0] = u[0] + rates[0] * dt

    def rhs(self, y, u, dy):
        dy[0], dy[1] = y[1], 1e6 * (u[0] - y[0]) - 400.0 * y[1]
        dy[2], dy[3] = self.creep, -self.slow * y[3]

    def read(self, y, u, dy, out, at):
        out[at : at + 3] = array("d", [y[0], y[1], y[3]])

    def may_rest(self, u, rates, outputs):
        return rates[0] == 0.0 and abs(outputs[1]) < 1e-3

    def rests(self, outputs, most):
        return abs(outputs[1]) < 1e-3

    def distance(self, shift):
        return max(abs(shift[0]), abs(shift[2]), abs(shift[3]))


def hung(method, system, *y):
    solver = method(system, RTOL)
    for i, value in enumerate(y):
        solver.y[i] = value
    solver.start(0.0)
    return solver


@pytest.mark.parametrize("method", METHODS)
def test_a_system_at_rest_sleeps_at_its_equilibrium(method):
    solver = hung(method, Hung(), 1e-3)
    solver.u[0] = 2e-4
    solver.restart(0.0)
    assert solver.advance(5.0)
    assert solver.asleep
    assert solver.y[0] == approx(2e-4, abs=1e-12)
    assert solver.y[1] == approx(0.0, abs=1e-12)
    steps = solver.steps
    assert solver.advance(1e9)
    assert (solver.steps, solver.t) == (steps, 1e9)


@pytest.mark.parametrize("method", METHODS)
def test_a_load_that_changes_keeps_it_awake(method):
    solver = hung(method, Hung(), 1e-3)
    solver.u_rate[0] = 1e-12
    solver.restart(0.0)
    assert solver.advance(5.0)
    assert not solver.asleep


@pytest.mark.parametrize("method", METHODS)
def test_a_jump_of_an_input_wakes_it_and_it_moves_as_one_that_never_slept(method):
    slept, waked = (hung(method, Hung(), 1e-3) for _ in range(2))
    waked.u_rate[0] = 1e-15
    waked.restart(0.0)
    for solver in (slept, waked):
        solver.advance(7.0)
        solver.cut(7.0)
        solver.u[0], solver.u_rate[0] = 1e-3, 0.0
        solver.restart(7.0)
        assert not solver.asleep
        solver.advance(7.002)
    ends = [array("d", bytes(32)) for _ in range(2)]
    for solver, end in zip((slept, waked), ends):
        solver.interpolate(7.002, end)
    assert ends[0][0] == approx(ends[1][0], abs=BOUND)
    assert ends[0][0] > 1e-4


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("creep", [1e-11, 1e-8])
def test_a_system_that_creeps_never_sleeps(method, creep):
    solver = hung(method, Hung(creep), 1e-3)
    assert solver.advance(20.0)
    assert not solver.asleep
    assert solver.y[2] == approx(20.0 * creep, rel=0.1)


@pytest.mark.parametrize("method", METHODS)
def test_a_system_that_decays_slowly_sleeps_only_when_nothing_is_left_to_decay(method):
    """With a time constant of 2 s, a millimetre takes more than 18 s to come below the bound."""
    solver = hung(method, Hung(slow=0.5), 0.0, 0.0, 0.0, 1e-3)
    assert solver.advance(18.0)
    assert not solver.asleep
    assert solver.advance(40.0)
    assert solver.asleep


def test_a_system_that_declares_no_rest_never_sleeps():
    class Restless(Hung):
        def may_rest(self, u, rates, outputs):
            return System.may_rest(self, u, rates, outputs)

    solver = hung(Exponential, Restless(), 1e-3)
    assert solver.advance(3.0)
    assert not solver.asleep


entries = st.floats(-10.0, 10.0)


@given(
    st.integers(1, 12).flatmap(lambda n: st.lists(entries, min_size=n * n + n, max_size=n * n + n))
)
def test_linear_equations_are_solved(numbers):
    n = next(k for k in range(1, 13) if k * k + k == len(numbers))
    a, b = np.array(numbers[: n * n]).reshape(n, n), np.array(numbers[n * n :])
    assume(np.linalg.norm(a) > 1e-3)
    assume(np.linalg.cond(a) < 1e8)
    matrix, x = array("d", a.ravel()), array("d", b)
    assert solve(matrix, x, n)
    assert a @ np.array(x) == approx(b, abs=1e-6)


def test_a_singular_matrix_is_reported():
    assert not solve(array("d", [1.0, 2.0, 2.0, 4.0]), array("d", [1.0, 1.0]), 2)
    assert not solve(array("d", [float("nan")]), array("d", [1.0]), 1)
