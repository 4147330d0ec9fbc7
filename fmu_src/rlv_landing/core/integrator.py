"""One-step integration with dense output, with steps of its own whatever the communication step. The methods are subclasses.

Step control and interpolants: Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.4-II.6.
"""

from array import array
from math import fabs, pow, sqrt

from .layout import (
    BODY,
    BODY_LOADS,
    HEAVE,
    HEAVE_RATE,
    INPUTS,
    INTEGRALS,
    LEG,
    LOADS,
    SX,
    SZ,
    TILT,
    TILT_RATE,
)
from .model import Model  # noqa: F401  (the compiled core needs the type)
from .outputs import BODY_OUTPUTS, ENERGY_OUTPUTS, LEG_OUTPUTS, STATUS_OUTPUTS, outputs
from .pointer import data, nogil
from .vehicle import right_hand_side

SAFETY, SHRINK, GROW, BETA = 0.9, 0.2, 5.0, 0.04
# the shortest step must be able to pass a jump of the friction force at the tightest tolerance
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 1e-5, 2e-3, 1e-16


class Solver:
    """The state of one landing in time: the present state, and the internal step that reaches ahead of it.

    `y` [n] is the state at `t` (s), the end of the last internal step; `advance` moves `t` to or past a time, `interpolate` gives the
    state at any time inside the last step. `u` [INPUTS] holds the inputs at `t_input`, which go on from there at `u_rate` [INPUTS];
    heave and tilt go on at their own rates. The error of a step is measured by `scale` [n]: rtol times scale_i, or
    rtol times (scale_i + |y_i|) for pressures, which are `relative` [n].

    Contact, friction and stops switch inside steps: the error control finds them. What a step gathers of friction displacement
    after sticking has turned to slip would be a first-order error, so it is taken off at the step's end.
    """

    def __init__(self, model, scale, relative, rtol):
        n = len(scale)
        self.model = model
        self.n = n
        self.row = output_size(model.n_groups)
        self.rtol = rtol
        self.scale = scale
        self.relative = relative
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
        self.u = array("d", bytes(8 * INPUTS))
        self.u_rate = array("d", bytes(8 * INPUTS))
        self.u_now = array("d", bytes(8 * INPUTS))
        self.w = array("d", bytes(8 * (LOADS * model.n_groups + BODY_LOADS)))
        self.t = 0.0
        self.t_old = 0.0
        self.t_input = 0.0
        self.h = FIRST_STEP
        self.error_old = 1e-4
        self.exponent = 0.0
        self.energy_start = 0.0
        self.steps = 0.0
        self.rejected = 0.0
        self.rhs_calls = 0.0

    def inputs_at(self, t):
        """Write the inputs at time `t` [s] to `u_now`."""
        self.move_inputs(t)

    def move_inputs(self, t):
        """What `inputs_at` does, for the kernels."""
        dt = t - self.t_input
        for i in range(INPUTS):
            self.u_now[i] = self.u[i] + self.u_rate[i] * dt
        self.u_now[HEAVE] = (
            self.u[HEAVE] + (self.u[HEAVE_RATE] + 0.5 * self.u_rate[HEAVE_RATE] * dt) * dt
        )
        self.u_now[TILT] = (
            self.u[TILT] + (self.u[TILT_RATE] + 0.5 * self.u_rate[TILT_RATE] * dt) * dt
        )

    def derivatives(self, t, y, dy):
        """Write dy/dt at time `t` [s] and state `y` to `dy`, for other solvers."""
        self.slope(t, data(y), data(dy))

    def slope(self, t, y, dy):
        """What `derivatives` does, for the kernels."""
        self.move_inputs(t)
        right_hand_side(y, data(self.u_now), self.model, dy, data(self.w))
        self.rhs_calls += 1.0

    def restart(self, t):
        """Start anew at time `t` from the state in `y` and the inputs in `u`, with no step behind."""
        self.t = t
        self.t_old = t
        self.t_input = t
        self.error_old = 1e-4
        for i in range(5 * self.n):
            self.dense[i] = 0.0
        for i in range(self.n):
            self.dense[i] = self.y[i]
        if self.h > FIRST_STEP:
            self.h = FIRST_STEP
        self.slope(t, data(self.y), data(self.k1))
        self.begin()

    def refresh(self):
        """Work out again, after the stored numbers were overwritten, what is not stored."""
        self.slope(self.t, data(self.y), data(self.k1))
        self.begin()

    def attempt(self, h):
        """Compute a step of `h` [s]: the new state, the right-hand side there (`k_end`), the step's `deviation` from its companion."""

    def error(self):
        """Error of the step just computed, in units of the tolerance (root mean square over the state without the energy integrals)."""
        y, end, scale, relative, deviation = (
            data(self.y),
            data(self.y_new),
            data(self.scale),
            data(self.relative),
            data(self.deviation),
        )
        total = 0.0
        m = self.n - INTEGRALS
        for i in range(m):
            limit = scale[i]
            if relative[i] > 0.0:
                limit += max(fabs(y[i]), fabs(end[i]))
            e = deviation[i] / (self.rtol * limit)
            total += e * e
        return sqrt(total / m)

    def bend(self, h):
        """Write the interpolant's fourth-order part, where the method has one, to the end of `dense`."""

    def begin(self):
        """What a method takes from the loads at the start of a step."""

    def accept(self, h):
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
        self.bend(h)
        for i in range(n):
            k1[i] = k_end[i]
        limit = self.model.s_r0
        for g in range(self.model.n_groups):
            for i in range(BODY + LEG * g + SX, BODY + LEG * g + SZ + 1):
                y[i] = min(max(y[i], -limit), limit)
        self.t_old = self.t
        self.t += h
        self.steps += 1.0
        self.begin()

    def advance(self, t_end):
        """Take internal steps until `t` is at or past `t_end` [s]. Returns False if the step size has collapsed."""
        return self.go_to(t_end)

    def go_to(self, t_end):
        """What `advance` does, for the kernels."""
        while self.t < t_end:
            h = self.h
            if h < SHORTEST_STEP:
                return False
            self.attempt(h)
            e = self.error()
            if e <= 1.0:
                self.accept(h)
                if e < 1e-10:
                    e = 1e-10
                factor = SAFETY * pow(self.error_old, BETA) / pow(e, self.exponent)
                self.h = h * min(max(factor, SHRINK), GROW)
                if self.h > LONGEST_STEP:
                    self.h = LONGEST_STEP
                self.error_old = max(e, 1e-4)
            else:
                self.rejected += 1.0
                factor = SHRINK
                if e < 1e10:
                    factor = max(SAFETY / pow(e, self.exponent), SHRINK)
                self.h = h * factor
        return True

    def state_at(self, t, y):
        """What `interpolate` does, for the kernels."""
        n = self.n
        d = data(self.dense)
        span = self.t - self.t_old
        a = (t - self.t_old) / span if span > 0.0 else 0.0
        b = 1.0 - a
        for i in range(n):
            y[i] = d[i] + a * (
                d[n + i] + b * (d[2 * n + i] + a * (d[3 * n + i] + b * d[4 * n + i]))
            )

    def interpolate(self, t, y):
        """Write the state at time `t` [s], inside the last internal step, to `y`."""
        self.state_at(t, data(y))

    def outputs_at(self, t, y, out):
        """Write the outputs at time `t` [s] and state `y` to `out`; uses and spoils the stage arrays."""
        self.move_inputs(t)
        outputs(
            data(y),
            data(self.u_now),
            self.model,
            data(self.k2),
            data(self.w),
            self.energy_start,
            data(out),
            0,
        )

    def fill(self, start, every, first, last, rows):
        """What `record` does, for the kernels."""
        y = data(self.y_stage)
        for k in range(first, last):
            t = start + k * every
            if not self.go_to(t):
                return k
            self.state_at(t, y)
            self.move_inputs(t)
            outputs(
                y,
                data(self.u_now),
                self.model,
                data(self.k2),
                data(self.w),
                self.energy_start,
                rows,
                k * self.row,
            )
        return last

    def record(self, start, every, first, last, rows):
        """Go on and write the outputs at times start + k every [s], k from `first` to `last` - 1, to `rows`: row k begins at k times `row`.

        Returns the first k that was not reached: `last`, or earlier if the step size has collapsed. Other threads run meanwhile.
        """
        numbers = data(rows)
        with nogil:
            reached = self.fill(start, every, first, last, numbers)
        return reached


def state_size(n_groups):
    """Length of the state of a vehicle of `n_groups` leg groups."""
    return BODY + LEG * n_groups + INTEGRALS


def output_size(n_groups):
    """Length of the outputs of a vehicle of `n_groups` leg groups."""
    return BODY_OUTPUTS + ENERGY_OUTPUTS + STATUS_OUTPUTS + LEG_OUTPUTS * n_groups
