"""One-step integration with dense output, with steps of its own whatever the communication step.

The methods are subclasses.
"""

from __future__ import annotations

from array import array
from math import fabs, inf, sqrt

from ..bodies.system import System
from ..memory import Buffer, Doubles, data, nogil
from ..records import Fault
from .rest import Rest
from .step_control import (
    FIRST_STEP,
    LEAST_PREVIOUS_ERROR,
    LONGEST_STEP,
    SHORTEST_STEP,
    step_factor,
)

# tries of a step that a start or a jump of an input may take beside the limit
FREE_TRIES = 10.0
# [s]: what a shorter step loses is not judged, for it is at a force that jumps, and loses next to
# nothing
SHORTEST_JUDGED = 1e-10
# part of the size of a step's ends that its interpolant may leave them by unseen
BULGE = 0.1
# at looser tolerances the inside of every step is judged
LOOSE = 1e-4


class Solver(Rest):
    """The state of one `System` in time: the present state, and the internal step that reaches
    ahead of it.

    `y` [n] is the state at `t` (s), the end of the last internal step; `advance` moves `t` to or
    past a time, `interpolate` gives the state at any time inside the last step. `exponent` of the
    step control is the method's.

    `limit` is how many tries of a step a second may take: `spent` counts those beyond that rate,
    which may be as many as a second has. `fault` is a `Fault`: with one, no more steps are taken.

    Forces that switch do so inside steps: the error control finds them. The system takes off at a
    step's end what the step has gathered beyond where a state may be, which would be a first-order
    error.
    """

    exponent: float
    limit: float
    spent: float
    fault: int
    h: float
    error_old: float
    steps: float
    rejected: float
    rhs_calls: float
    y: Buffer
    y_new: Buffer
    y_stage: Buffer
    k1: Buffer
    k2: Buffer
    k3: Buffer
    k4: Buffer
    k_end: Buffer
    deviation: Buffer
    ceiling: Buffer

    def __init__(self, system: System, rtol: float) -> None:
        super().__init__(system, rtol)
        n = system.n
        self.exponent = 0.0
        self.limit = inf
        self.spent = 0.0
        self.fault = Fault.NONE
        self.y = array("d", bytes(8 * n))
        self.y_new = array("d", bytes(8 * n))
        self.y_stage = array("d", bytes(8 * n))
        self.k1 = array("d", bytes(8 * n))
        self.k2 = array("d", bytes(8 * n))
        self.k3 = array("d", bytes(8 * n))
        self.k4 = array("d", bytes(8 * n))
        self.k_end = array("d", bytes(8 * n))
        self.deviation = array("d", bytes(8 * n))
        self.ceiling = array("d", [inf] * n)
        self.h = FIRST_STEP
        self.error_old = LEAST_PREVIOUS_ERROR
        self.steps = 0.0
        self.rejected = 0.0
        self.rhs_calls = 0.0

    def derivatives(self, t: float, y: Buffer, dy: Buffer) -> None:
        """Write dy/dt at time `t` [s] and state `y` [n] to `dy` [n], for other solvers."""
        self._derivatives(t, data(y), data(dy))

    def _derivatives(self, t: float, y: Doubles, dy: Doubles) -> None:
        self._inputs_at(t)
        self.system.rhs(y, data(self.u_now), dy)
        self.rhs_calls += 1.0

    def start(self, t: float) -> None:
        """Start at time `t` [s] from the state in `y` and the inputs in `u`; extremes and counts
        start there, too.
        """
        self.t_start = t
        self.t_span = inf
        self.steps = 0.0
        self.rejected = 0.0
        self.rhs_calls = 0.0
        self.spent = 0.0
        self.fault = Fault.NONE
        self.h = FIRST_STEP
        self.restart(t)

    def cut(self, t: float) -> None:
        """End the path at time `t` [s], inside the last internal step: write the state there to
        `y`, from which `restart` goes on.
        """
        self._cut(t)

    def _cut(self, t: float) -> None:
        self._watch(t)
        self._interpolate(t, data(self.y))

    def restart(self, t: float) -> None:
        """Go on from time `t` [s] from the state in `y` and the inputs in `u`, with no step behind."""
        self._restart(t)

    def _restart(self, t: float) -> None:
        self.t = t
        self.t_old = t
        self.t_before = t
        self.t_input = t
        self.error_old = LEAST_PREVIOUS_ERROR
        self._stand_still(data(self.y))
        self.h = min(self.h, FIRST_STEP)
        self.spent = max(self.spent - FREE_TRIES, 0.0)
        self._recompute_derived()
        if self.system.conserve(data(self.y)) > 0.0:
            self._recompute_derived()
        self._start_rows(data(self.y), data(self.k1))
        self._awake()

    def recompute_derived(self) -> None:
        """Work out again, after the stored numbers were overwritten, what is not stored."""
        self._recompute_derived()

    def _recompute_derived(self) -> None:
        self._derivatives(self.t, data(self.y), data(self.k1))
        self._start_step()

    def _start_step(self) -> None:
        """What a method takes from the system at the start of a step, where the right-hand side was
        called last.
        """

    def _try_step(self, h: float) -> None:
        """Compute a step of `h` [s]: the new state, the right-hand side there (`k_end`), the step's
        `deviation` from its companion.
        """

    def _dense_correction(self, h: float, at: int) -> None:
        """Write the fourth-order part of a step's interpolant, where the method has one, to
        `dense[at:]`.
        """

    def _error(self) -> float:
        """Error of the step just computed, in units of the tolerance: root mean square over the
        controlled states.
        """
        y, end, deviation = data(self.y), data(self.y_new), data(self.deviation)
        scale, relative = data(self.system.scale), data(self.system.relative)
        ceiling = data(self.ceiling)
        self.system.weigh(ceiling)
        total = 0.0
        m = self.system.controlled
        for i in range(m):
            limit = self.rtol * scale[i]
            if relative[i] > 0.0:
                limit = min(self.rtol * (scale[i] + max(fabs(y[i]), fabs(end[i]))), ceiling[i])
            e = deviation[i] / limit
            total += e * e
        return sqrt(total / m)

    def _loses(self, h: float) -> bool:
        """Bring the end of a step of `h` [s] back to what the system conserves, read it, and write
        the step's interpolant; whether the step loses more of what the system conserves than it
        may, before it is brought back or by that.
        """
        end, k_end = data(self.y_new), data(self.k_end)
        self._read_end(end, k_end)
        lost = self.system.lost(data(self.last), data(self._end), h)
        away = self.system.conserve(end)
        if away > 0.0:
            self._derivatives(self.t + h, end, k_end)
            self._read_end(end, k_end)
            lost = max(lost, self.system.lost(data(self.last), data(self._end), h))
        self._write_dense(h)
        if h < SHORTEST_JUDGED:
            return False
        if max(lost, away) > 1.0:
            return True
        return self._loses_inside(h)

    def _write_dense(self, h: float) -> None:
        """Write the interpolant of the step of `h` [s] just computed in the place of that of the
        step before the last.
        """
        n = self.n
        d, y, end, k1, k_end = (
            data(self.dense),
            data(self.y),
            data(self.y_new),
            data(self.k1),
            data(self.k_end),
        )
        at = self._other_dense()
        for i in range(n):
            j = at + i
            change = end[i] - y[i]
            bend = h * k1[i] - change
            d[j] = y[i]
            d[n + j] = change
            d[2 * n + j] = bend
            d[3 * n + j] = change - h * k_end[i] - bend
        self._dense_correction(h, at + 4 * n)

    def _loses_inside(self, h: float) -> bool:
        """The same inside the step: at its quarters, where its interpolant leaves its ends far
        behind or the tolerance is loose. They are read as outputs are, brought back.
        """
        if self.rtol <= LOOSE and not self._bulges():
            return False
        inside = data(self.y_stage)
        most = 0.0
        for i in range(3):
            ahead = 0.25 * (i + 1) * h
            t = self.t + ahead
            self._inside(self._other_dense(), t, self.t, self.t + h, inside)
            self._derivatives(t, inside, data(self.k_end))
            if self.system.conserve(inside) > 0.0:
                self._derivatives(t, inside, data(self.k_end))
            self.system.read(inside, data(self.u_now), data(self.k_end), data(self._half), 0)
            most = max(most, self.system.lost(data(self.last), data(self._half), ahead))
        self._derivatives(self.t + h, data(self.y_new), data(self.k_end))
        return most > 1.0

    def _bulges(self) -> bool:
        """Whether the interpolant just written leaves its ends far behind at a quarter, in a state
        whose error is relative to its size.
        """
        n = self.n
        d, relative = data(self.dense), data(self.system.relative)
        y, end = data(self.y), data(self.y_new)
        at = self._other_dense()
        for i in range(self.system.controlled):
            if relative[i] > 0.0:
                j = at + i
                change = d[n + j]
                # 3/16 of these are the interpolant's distances from the straight line
                bend = d[2 * n + j] + 0.1875 * d[4 * n + j]
                first = bend + 0.25 * d[3 * n + j]
                second = bend + 0.75 * d[3 * n + j]
                out = 0.1875 * max(fabs(first), fabs(second))
                if out > fabs(change) + BULGE * (fabs(y[i]) + fabs(end[i])):
                    return True
        return False

    def _accept(self, h: float) -> None:
        """Make the step just computed the last one: take up its interpolant, move on."""
        n = self.n
        y, end, k1, k_end = data(self.y), data(self.y_new), data(self.k1), data(self.k_end)
        self._next_row()
        self.system.note(data(self.last))
        self.dense_at = self._other_dense()
        for i in range(n):
            y[i] = end[i]
            k1[i] = k_end[i]
        self.system.project(y)
        self.t_before = self.t_old
        self.t_old = self.t
        self.t += h
        self.steps += 1.0
        self._start_step()

    def advance(self, t_end: float) -> bool:
        """Take internal steps until `t` is at or past `t_end` [s].

        Returns False if there is a fault.
        """
        return self._advance(t_end, inf)

    def advance_some(self, t_end: float, tries: int) -> bool:
        """The same with at most so many `tries` of a step; False if it takes more, too."""
        return self._advance(t_end, self.steps + self.rejected + tries)

    def _advance(self, t_end: float, last_try: float) -> bool:
        while self.t < t_end:
            if self.fault != Fault.NONE or self.steps + self.rejected >= last_try:
                return False
            if not self.noted:
                self._note_step()
                self._fall_asleep()
            if self.asleep:
                self._sleep_until(t_end)
            else:
                self._step()
        return True

    def _fall_asleep(self) -> None:
        """Where the system has come to rest, be there, and sleep."""
        y, place = data(self.y), data(self._place)
        if self._found_rest(y):
            self._cut(self.t)
            for i in range(self.n):
                y[i] = place[i]
            self._restart(self.t)
            self._watch(self.t)
            self.asleep = True

    def _step(self) -> None:
        """Try a step, and choose the next one's length."""
        h = self.h
        if h < SHORTEST_STEP or self.t + h <= self.t:
            self.fault = Fault.COLLAPSED
            return
        self._try_step(h)
        error = self._error()
        self.h = h * step_factor(error, self.error_old, self.exponent)
        self.spent += 1.0
        if error <= 1.0 and self._loses(h):
            self.h = 0.5 * h
            self.rejected += 1.0
        elif error <= 1.0:
            self._accept(h)
            self.h = min(self.h, LONGEST_STEP)
            self.error_old = max(error, LEAST_PREVIOUS_ERROR)
            self.spent = max(self.spent - self.limit * h, 0.0)
        else:
            self.rejected += 1.0
        if self.spent > self.limit:
            self.fault = Fault.TOO_MANY_STEPS

    def record(self, start: float, every: float, first: int, last: int, rows: Buffer) -> int:
        """Go on and write the outputs at times start + k every [s], k from `first` to `last` - 1,
        to `rows`: row k begins at k times `row`.

        Returns the first k that was not reached: `last`, or earlier if there is a fault. Other
            threads run meanwhile.
        """
        numbers = data(rows)
        with nogil:
            reached = self._record(start, every, first, last, numbers, inf)
        return reached

    def record_some(
        self, start: float, every: float, first: int, last: int, rows: Buffer, tries: int
    ) -> int:
        """The same with at most so many `tries` of a step."""
        numbers = data(rows)
        last_try = self.steps + self.rejected + tries
        with nogil:
            reached = self._record(start, every, first, last, numbers, last_try)
        return reached

    def _record(
        self, start: float, every: float, first: int, last: int, rows: Doubles, last_try: float
    ) -> int:
        y = data(self.y_stage)
        for k in range(first, last):
            t = start + k * every
            if not self._advance(t, last_try):
                return k
            self._interpolate(t, y)
            self._outputs_at(t, y, rows, k * self.system.row)
        return last
