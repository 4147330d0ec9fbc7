"""Integration by a one-step method: step control, dense output, limits.

Internal steps do not depend on the communication step. The methods are subclasses.
"""

from __future__ import annotations

from math import inf

from ..bodies.system import System
from ..memory import Buffer, Doubles, copy, data, nogil
from ..records import Fault
from .path import NEVER
from .step_control import (
    FIRST_STEP,
    LEAST_PREVIOUS_ERROR,
    LONGEST_STEP,
    SHORTEST_STEP,
    step_factor,
)
from .trial import Trial

# tries of a step that a start or a jump of an input may take without counting against the limit
FREE_TRIES = 10.0


class Solver(Trial):
    """The state of one `System` in time: the present state, and the internal step ahead of it.

    `y` [n] is the state at `t` (s), the end of the last internal step; `advance` moves `t` to or
    past a time, `interpolate` gives the state at any time inside the last step. `exponent` is that
    of the step control; each method sets it. Steps damp what decays
    fastest below `damped_below` times the kinetic energy of a slow system.

    `limit` is how many tries of a step a second may take: `spent` counts those beyond that rate,
    which may be as many as a second has. `fault` is a `Fault`: with one, no more steps are taken.

    Forces switch inside steps: there is no event location, the error control shortens the step. A
    step may carry a state past its bound, a friction displacement past the slip limit; that would
    be a first-order error, so the system brings it back to the bound at the step's end.
    """

    exponent: float
    damped_below: float
    limit: float
    spent: float
    fault: int
    h: float
    error_old: float
    steps: float
    rejected: float

    def __init__(self, system: System, rtol: float) -> None:
        super().__init__(system, rtol)
        self.exponent = 0.0
        self.damped_below = 1.0
        self.limit = inf
        self.spent = 0.0
        self.fault = Fault.NONE
        self.h = FIRST_STEP
        self.error_old = LEAST_PREVIOUS_ERROR
        self.steps = 0.0
        self.rejected = 0.0

    def start(self, t: float) -> None:
        """Start at time `t` [s] from the state in `y` and the inputs in `u`.

        Extremes and counts start there, too.
        """
        self.t_start = t
        self.t_span = inf
        self.steps = 0.0
        self.rejected = 0.0
        self.rhs_calls = 0.0
        self.spent = 0.0
        self.fault = Fault.NONE
        self.h = FIRST_STEP
        self._forget_after(-NEVER)
        self.restart(t)

    def cut(self, t: float) -> None:
        """End the path at time `t` [s], inside the last internal step.

        The state there is written to `y`, from which `restart` continues.
        """
        self._cut(t)

    def _cut(self, t: float) -> None:
        self._watch(t)
        self._interpolate(t, data(self.y))

    def restart(self, t: float) -> None:
        """Continue from time `t` [s], the state in `y` and the inputs in `u`, as at a start."""
        self._restart(t)

    def _restart(self, t: float) -> None:
        self.t = t
        self.t_old = t
        self.t_before = t
        self.t_input = t
        self.error_old = LEAST_PREVIOUS_ERROR
        self.system.normalise(data(self.y))
        self._stand_still(data(self.y))
        self.h = min(self.h, FIRST_STEP)
        self.spent = max(self.spent - FREE_TRIES, 0.0)
        self._recompute_derived()
        if self.system.conserve(data(self.y)) > 0.0:
            self._recompute_derived()
        self._start_rows(data(self.y), data(self.k1))
        self._awake()

    def recompute_derived(self) -> None:
        """Compute what a saved state does not hold, after what it holds was restored."""
        self._recompute_derived()

    def _recompute_derived(self) -> None:
        self._derivatives(self.t, data(self.y), data(self.k1))
        self._follow_ground()
        self._start_step()

    def _follow_ground(self) -> None:
        """Let the system know its motion relative to the ground at time `t`.

        The right-hand side was called last there.
        """
        self.system.follow_ground(
            self.t, data(self.y), data(self.k1), data(self.u_now), data(self.u_rate)
        )

    def _start_step(self) -> None:
        """Take from the system what a method needs at the start of a step.

        The right-hand side was called last there.
        """

    def _try_step(self, h: float) -> None:
        """Compute a step of `h` [s]: see `Trial` for what it writes."""

    def _longest_damped(self) -> float:
        """The longest step [s] that damps what decays fastest in the step just computed.

        It is infinite where a method does not know it.
        """
        return inf

    def _accept(self, h: float) -> None:
        """Accept the step just computed: it becomes the last one, and `t` its end."""
        n = self.n
        y, end, k1, k_end = data(self.y), data(self.y_new), data(self.k1), data(self.k_end)
        self._next_row()
        self.system.note(data(self.last))
        if self.system.is_off_ground(data(self.last)):
            self.fault = Fault.OFF_GROUND
        self.dense_at = self._other_dense()
        copy(end, y, n)
        copy(k_end, k1, n)
        self.system.project(y)
        self.t_before = self.t_old
        self.t_old = self.t
        self.t += h
        self._follow_ground()
        self._judge_rest(data(self.last))
        self.steps += 1.0
        self._start_step()

    def advance(self, t_end: float) -> bool:
        """Take internal steps until `t` is at or past `t_end` [s].

        Returns False if there is a fault.
        """
        return self._advance(t_end, inf)

    def advance_some(self, t_end: float, tries: int) -> bool:
        """As `advance`, with at most so many `tries` of a step; False if it takes more, too."""
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
        """If the system has come to rest, move its state to the equilibrium and sleep."""
        y, place = data(self.y), data(self._place)
        if self._found_rest(y):
            self._cut(self.t)
            self._rest_from(self.t)
            copy(place, y, self.n)
            self._restart(self.t)
            self._watch(self.t)
            self.asleep = True

    def _step(self) -> None:
        """Try a step, and choose the next one's length."""
        h = self.h
        if h < SHORTEST_STEP or self.t + h <= self.t:
            self.fault = Fault.COLLAPSED
            return
        slow = self.system.is_slow(data(self.last), self.damped_below)
        self._try_step(h)
        longest = LONGEST_STEP
        if slow:
            longest = min(longest, self._longest_damped())
        error = self._error()
        self.h = h * step_factor(error, self.error_old, self.exponent)
        self.spent += 1.0
        if error <= 1.0 and self._loses(h):
            self.h = 0.5 * h
            self.rejected += 1.0
        elif error <= 1.0:
            self._accept(h)
            self.h = min(self.h, longest)
            self.error_old = max(error, LEAST_PREVIOUS_ERROR)
            self.spent = max(self.spent - self.limit * h, 0.0)
        else:
            self.rejected += 1.0
        if self.spent > self.limit:
            self.fault = Fault.TOO_MANY_STEPS

    def record(self, start: float, every: float, first: int, last: int, rows: Buffer) -> int:
        """Advance, and write the outputs at times start + k every [s] to `rows`.

        `k` goes from `first` to `last` - 1, and row k begins at k times `row`. Other threads run
        meanwhile.

        Returns:
            The first k that was not reached: `last`, or earlier if there is a fault.
        """
        numbers = data(rows)
        with nogil:
            reached = self._record(start, every, first, last, numbers, inf)
        return reached

    def record_some(
        self, start: float, every: float, first: int, last: int, rows: Buffer, tries: int
    ) -> int:
        """As `record`, with at most so many `tries` of a step."""
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
