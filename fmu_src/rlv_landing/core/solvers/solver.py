"""One-step integration with dense output, with steps of its own whatever the communication step.

The methods are subclasses.

Interpolants: Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.6.
"""

from __future__ import annotations

from array import array
from math import fabs, sqrt

from ..bodies.system import System
from ..memory import Buffer, Doubles, data, nogil
from .step_control import LEAST_PREVIOUS_ERROR, step_factor

# the shortest step must be able to pass a jump of the friction force at the tightest tolerance
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 1e-5, 2e-3, 1e-16


class Solver:
    """The state of one `System` in time: the present state, and the internal step that reaches
    ahead of it.

    `y` [n] is the state at `t` (s), the end of the last internal step; `advance` moves `t` to or
    past a time, `interpolate` gives the state at any time inside the last step. `u` [inputs] holds
    the inputs at `t_input`, which go on from there at `u_rate` [inputs]. `exponent` of the step
    control is the method's.

    Forces that switch do so inside steps: the error control finds them. The system takes off at a
    step's end what the step has gathered beyond where a state may be, which would be a first-order
    error.
    """

    system: System
    n: int
    rtol: float
    exponent: float
    t: float
    t_old: float
    t_input: float
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
    dense: Buffer
    u: Buffer
    u_rate: Buffer
    u_now: Buffer

    def __init__(self, system: System, rtol: float) -> None:
        n = system.n
        self.system = system
        self.n = n
        self.rtol = rtol
        self.exponent = 0.0
        self.y = array("d", bytes(8 * n))
        self.y_new = array("d", bytes(8 * n))
        self.y_stage = array("d", bytes(8 * n))
        self.k1 = array("d", bytes(8 * n))
        self.k2 = array("d", bytes(8 * n))
        self.k3 = array("d", bytes(8 * n))
        self.k4 = array("d", bytes(8 * n))
        self.k_end = array("d", bytes(8 * n))
        self.deviation = array("d", bytes(8 * n))
        self.dense = array("d", bytes(8 * 5 * n))
        self.u = array("d", bytes(8 * system.inputs))
        self.u_rate = array("d", bytes(8 * system.inputs))
        self.u_now = array("d", bytes(8 * system.inputs))
        self.t = 0.0
        self.t_old = 0.0
        self.t_input = 0.0
        self.h = FIRST_STEP
        self.error_old = LEAST_PREVIOUS_ERROR
        self.steps = 0.0
        self.rejected = 0.0
        self.rhs_calls = 0.0

    def inputs_at(self, t: float) -> None:
        """Write the inputs at time `t` [s] to `u_now`."""
        self._inputs_at(t)

    def _inputs_at(self, t: float) -> None:
        self.system.inputs_after(
            data(self.u), data(self.u_rate), t - self.t_input, data(self.u_now)
        )

    def derivatives(self, t: float, y: Buffer, dy: Buffer) -> None:
        """Write dy/dt at time `t` [s] and state `y` [n] to `dy` [n], for other solvers."""
        self._derivatives(t, data(y), data(dy))

    def _derivatives(self, t: float, y: Doubles, dy: Doubles) -> None:
        self._inputs_at(t)
        self.system.rhs(y, data(self.u_now), dy)
        self.rhs_calls += 1.0

    def restart(self, t: float) -> None:
        """Start anew at time `t` [s] from the state in `y` and the inputs in `u`, with no step
        behind.
        """
        self.t = t
        self.t_old = t
        self.t_input = t
        self.error_old = LEAST_PREVIOUS_ERROR
        for i in range(5 * self.n):
            self.dense[i] = 0.0
        for i in range(self.n):
            self.dense[i] = self.y[i]
        if self.h > FIRST_STEP:
            self.h = FIRST_STEP
        self.recompute_derived()

    def recompute_derived(self) -> None:
        """Work out again, after the stored numbers were overwritten, what is not stored."""
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

    def _dense_correction(self, h: float) -> None:
        """Write the interpolant's fourth-order part, where the method has one, to the end of
        `dense`.
        """

    def _error(self) -> float:
        """Error of the step just computed, in units of the tolerance: root mean square over the
        controlled states.
        """
        y, end, deviation = data(self.y), data(self.y_new), data(self.deviation)
        scale, relative = data(self.system.scale), data(self.system.relative)
        total = 0.0
        m = self.system.controlled
        for i in range(m):
            limit = scale[i]
            if relative[i] > 0.0:
                limit += max(fabs(y[i]), fabs(end[i]))
            e = deviation[i] / (self.rtol * limit)
            total += e * e
        return sqrt(total / m)

    def _accept(self, h: float) -> None:
        """Make the step just computed the last one: keep its interpolant, move on."""
        n = self.n
        d, y, end, k1, k_end = (
            data(self.dense),
            data(self.y),
            data(self.y_new),
            data(self.k1),
            data(self.k_end),
        )
        for i in range(n):
            change = end[i] - y[i]
            bend = h * k1[i] - change
            d[i] = y[i]
            d[n + i] = change
            d[2 * n + i] = bend
            d[3 * n + i] = change - h * k_end[i] - bend
            y[i] = end[i]
        self._dense_correction(h)
        for i in range(n):
            k1[i] = k_end[i]
        self.system.project(y)
        self.t_old = self.t
        self.t += h
        self.steps += 1.0
        self._start_step()

    def advance(self, t_end: float) -> bool:
        """Take internal steps until `t` is at or past `t_end` [s].

        Returns False if the step size has collapsed.
        """
        return self._advance(t_end)

    def _advance(self, t_end: float) -> bool:
        while self.t < t_end:
            h = self.h
            if h < SHORTEST_STEP:
                return False
            self._try_step(h)
            error = self._error()
            self.h = h * step_factor(error, self.error_old, self.exponent)
            if error <= 1.0:
                self._accept(h)
                self.h = min(self.h, LONGEST_STEP)
                self.error_old = max(error, LEAST_PREVIOUS_ERROR)
            else:
                self.rejected += 1.0
        return True

    def interpolate(self, t: float, y: Buffer) -> None:
        """Write the state at time `t` [s], inside the last internal step, to `y` [n]."""
        self._interpolate(t, data(y))

    def _interpolate(self, t: float, y: Doubles) -> None:
        n = self.n
        d = data(self.dense)
        span = self.t - self.t_old
        a = (t - self.t_old) / span if span > 0.0 else 0.0
        b = 1.0 - a
        for i in range(n):
            y[i] = d[i] + a * (
                d[n + i] + b * (d[2 * n + i] + a * (d[3 * n + i] + b * d[4 * n + i]))
            )

    def outputs_at(self, t: float, y: Buffer, out: Buffer) -> None:
        """Write the outputs at time `t` [s] and state `y` [n] to `out` [row]."""
        self._outputs_at(t, data(y), data(out), 0)

    def _outputs_at(self, t: float, y: Doubles, out: Doubles, at: int) -> None:
        self._inputs_at(t)
        self.system.outputs(y, data(self.u_now), out, at)

    def record(self, start: float, every: float, first: int, last: int, rows: Buffer) -> int:
        """Go on and write the outputs at times start + k every [s], k from `first` to `last` - 1,
        to `rows`: row k begins at k times `row`.

        Returns the first k that was not reached: `last`, or earlier if the step size has collapsed.
            Other threads run meanwhile.
        """
        numbers = data(rows)
        with nogil:
            reached = self._record(start, every, first, last, numbers)
        return reached

    def _record(self, start: float, every: float, first: int, last: int, rows: Doubles) -> int:
        y = data(self.y_stage)
        for k in range(first, last):
            t = start + k * every
            if not self._advance(t):
                return k
            self._interpolate(t, y)
            self._outputs_at(t, y, rows, k * self.system.row)
        return last
