"""Extremes of outputs: kept at the ends of internal steps, and searched on the interpolant."""

from array import array
from math import cos, hypot, inf, pi, sin

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing.core.bodies.system import System
from rlv_landing.core.records import Bend
from rlv_landing.core.solvers.dormand_prince import DormandPrince
from rlv_landing.core.solvers.exponential import Exponential
from rlv_landing.core.solvers.turning_points import crest, expected, narrowed, where_to_look

METHODS = [Exponential, DormandPrince]
# the outputs of `Swinging`
X, KINKED, STAIRS, NOTHING = range(4)
FREQUENCY = 700.0


class Swinging(System):
    """x'' = -w^2 (x - u); outputs x, one with kinks, one in stairs, and one that is 0."""

    def __init__(self):
        ones, zeros = array("d", [1.0, FREQUENCY]), array("d", [0.0, 0.0])
        super().__init__(ones, zeros, carried=0, inputs=1, row=4, stiff_pairs=0)

    def inputs_after(self, u, rates, dt, now):
        now[0] = u[0] + rates[0] * dt

    def rhs(self, y, u, dy):
        dy[0], dy[1] = y[1], -FREQUENCY * FREQUENCY * (y[0] - u[0])

    def read(self, y, u, dy, out, at):
        out[at : at + 4] = array("d", [y[0], kinked(y[0]), float(y[0] > 0.5), 0.0])


def kinked(x):
    """Rises steeply to its peak at x = 0.37 and falls slowly: never at a step's end."""
    return 40.0 * x if x < 0.37 else 14.8 - 2.0 * (x - 0.37)


def swinging(method, x=-1.0, rtol=1e-9):
    solver = method(Swinging(), rtol)
    solver.y[0] = x
    solver.start(0.0)
    return solver


def found(solver, t, write=None):
    numbers = array("d", bytes(8 * 4 * solver.row))
    (write or solver.extremes)(t, numbers)
    rows = [numbers[k * solver.row : (k + 1) * solver.row] for k in range(4)]
    return list(zip(*rows))


@pytest.mark.parametrize("method", METHODS)
def test_extremes_are_those_of_the_closed_form(method):
    solver = swinging(method)
    solver.advance(0.008)
    low, low_time, high, high_time = found(solver, 0.008)[X]
    assert (low, low_time) == (-1.0, 0.0)
    assert high == approx(1.0, abs=1e-4)
    assert high_time == approx(pi / FREQUENCY, abs=2e-5)
    assert found(solver, 0.008)[NOTHING] == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("method", METHODS)
def test_a_peak_with_a_kink_between_steps_is_found(method):
    for x in (-1.0, -0.9, -0.8, -0.7):
        solver = swinging(method, x, 1e-6)
        solver.advance(0.004)
        assert found(solver, 0.004)[KINKED][2] == approx(14.8, rel=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_the_time_of_an_extreme_that_lasts_is_when_it_was_reached(method):
    solver = swinging(method)
    solver.advance(0.004)
    low, low_time, high, high_time = found(solver, 0.004)[STAIRS]
    assert (low, low_time, high) == (0.0, 0.0, 1.0)
    passes = (pi - 1.0471975511965976) / FREQUENCY
    assert passes <= high_time <= passes + 1e-4


@pytest.mark.parametrize("method", METHODS)
@given(stops=st.lists(st.floats(1e-6, 0.02), max_size=12))
def test_extremes_do_not_depend_on_the_communication_steps(method, stops):
    straight, wandering = swinging(method, rtol=1e-5), swinging(method, rtol=1e-5)
    straight.advance(0.02)
    for t in sorted(stops):
        wandering.advance(t)
        found(wandering, t)
    wandering.advance(0.02)
    assert found(wandering, 0.02) == found(straight, 0.02)


@given(st.floats(1e-4, 0.02), st.floats(1e-4, 0.02))
def test_extremes_enclose_all_values_up_to_the_present_time_and_none_after_it(t, until):
    assume(t <= until)
    solver = swinging(Exponential, rtol=1e-6)
    solver.advance(until)
    low, low_time, high, high_time = found(solver, until)[X]
    assert low - 1e-3 <= -cos(FREQUENCY * t) <= high + 1e-3
    assert high <= max(-cos(FREQUENCY * min(until, pi / FREQUENCY)), -1.0) + 1e-3
    assert max(low_time, high_time) <= until


def test_the_extremes_of_a_span_begin_with_it():
    solver = swinging(Exponential)
    start, end = 0.5 * pi / FREQUENCY, 0.9 * pi / FREQUENCY
    solver.advance(start)
    solver.open_span(start)
    solver.advance(end)
    low, low_time, high, high_time = found(solver, end, solver.extremes_of_span)[X]
    assert (low_time, high_time) == (start, end)
    assert (low, high) == approx((0.0, -cos(0.9 * pi)), abs=1e-6)
    solver.close_span()
    assert found(solver, end)[X][0] == -1.0


def test_extremes_leave_out_the_part_of_a_step_after_a_jump_of_an_input():
    """The internal step reaches past the jump, after which the motion is another one."""
    solver = swinging(Exponential)
    cut = 0.7 * pi / FREQUENCY
    solver.advance(cut)
    solver.cut(cut)
    solver.u[0] = -1.0
    solver.restart(cut)
    x, v = -cos(0.7 * pi), FREQUENCY * sin(0.7 * pi)
    solver.advance(0.006)
    peak = -1.0 + hypot(x + 1.0, v / FREQUENCY)
    assert found(solver, 0.006)[X][2] == approx(peak, abs=2e-4)


def test_inputs_set_before_time_passes_are_those_of_the_start():
    solver = swinging(Exponential)
    solver.cut(0.0)
    solver.y[0] = 0.25
    solver.restart(0.0)
    assert found(solver, 0.0)[X] == (0.25, 0.0, 0.25, 0.0)


class Counted(Swinging):
    """`Swinging` with one output several times; it counts how often they are read."""

    def __init__(self, copies, unsought):
        super().__init__()
        self.reads, self.copies, self.unsought = 0, copies, unsought

    def read(self, y, u, dy, out, at):
        self.reads += 1
        values = [kinked(y[0])] * self.copies
        out[at : at + 4] = array("d", [*values, *([0.0] * (4 - self.copies))])


def counted(copies, unsought=-1):
    solver = DormandPrince(Counted(copies, unsought), 1e-6)
    solver.y[0] = -0.9
    solver.start(0.0)
    solver.advance(0.02)
    return solver


def test_outputs_that_turn_together_share_their_samples():
    one, three = counted(1), counted(3)
    assert one.system.reads > one.steps + 5
    assert three.system.reads == one.system.reads
    assert found(three, 0.02)[:3] == [found(one, 0.02)[0]] * 3


def test_an_output_that_is_unsought_has_the_extremes_of_steps_ends():
    sought, plain = counted(1), counted(1, unsought=0)
    assert plain.system.reads < sought.system.reads
    assert found(plain, 0.02)[0][2] < found(sought, 0.02)[0][2]


gaps = st.floats(1e-6, 1e-2)
values = st.floats(-1e4, 1e4)


@st.composite
def bends(draw):
    t1, top = draw(st.floats(0.1, 10.0)), draw(values)
    v0, v2 = top - draw(st.floats(0.0, 1e4)), top - draw(st.floats(0.0, 1e4))
    return Bend(t1 - draw(gaps), v0, t1, top, t1 + draw(gaps), v2)


@given(bends())
def test_the_parabola_passes_through_its_points_and_is_nowhere_higher_than_at_its_crest(b):
    size = 1e-6 * (1.0 + max(abs(b.v0), abs(b.v1), abs(b.v2)))
    for t, v in ((b.t0, b.v0), (b.t1, b.v1), (b.t2, b.v2)):
        assert expected(b, t) == approx(v, abs=size)
    top = crest(b)
    assert b.t0 <= top.t <= b.t2
    assert top.value >= b.v1
    assert expected(b, top.t) == approx(top.value, abs=size)


@given(bends(), st.floats(0.0, 1e3), st.floats(0.0, 1.0), values)
def test_each_sample_narrows_the_interval_and_the_highest_stays_in_the_middle(
    b, surprise, above, v
):
    t = where_to_look(b, b.v1 - above, abs(b.v1), surprise)
    if t == -inf:
        return
    assert b.t0 < t < b.t2
    assert t != b.t1
    n = narrowed(b, t, v)
    assert n.t0 < n.t1 < n.t2
    assert n.t2 - n.t0 < b.t2 - b.t0
    assert n.v1 == max(v, b.v1)
    assert n.v1 >= max(n.v0, n.v2)
