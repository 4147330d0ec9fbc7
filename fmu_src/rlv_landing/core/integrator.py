"""Dormand-Prince 5(4) with dense output: the paper's ode45, with steps of its own whatever the communication step.

Coefficients: Dormand and Prince (1980); step control and the fourth-order interpolant: Hairer, Norsett and Wanner, Solving
Ordinary Differential Equations I, II.4-II.6.
"""

from array import array
from math import fabs, pow

from .layout import BODY, BODY_LOADS, HEAVE, HEAVE_RATE, INPUTS, INTEGRALS, LEG, LOADS, TILT, TILT_RATE
from .model import Model  # noqa: F401  (the compiled core needs the type)
from .outputs import BODY_OUTPUTS, ENERGY_OUTPUTS, LEG_OUTPUTS, STATUS_OUTPUTS, outputs
from .vehicle import right_hand_side

A21 = 1.0 / 5.0
A31, A32 = 3.0 / 40.0, 9.0 / 40.0
A41, A42, A43 = 44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0
A51, A52, A53, A54 = 19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0
A61, A62, A63, A64, A65 = 9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0
A71, A73, A74, A75, A76 = 35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0
E1, E3, E4, E5, E6, E7 = 71.0 / 57600.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0
D1, D3, D4 = -12715105075.0 / 11282082432.0, 87487479700.0 / 32700410799.0, -10690763975.0 / 1880347072.0
D5, D6, D7 = 701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0, 69997945.0 / 29380423.0

SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
BETA = 0.04
EXPONENT = 0.2 - 0.75 * 0.04
# the shortest step must be able to pass a jump of the friction force at the tightest tolerance
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 1e-5, 2e-3, 1e-16


class Solver:
    """The state of one landing in time: the present state, and the internal step that reaches ahead of it.

    `y` [n] is the state at `t` (s), the end of the last internal step; `advance` moves `t` to or past a time, `interpolate` gives the
    state at any time inside the last step. `u` [INPUTS] holds the inputs at `t_input`, which go on from there at `u_rate` [INPUTS];
    heave and tilt go on at their own rates. The error of a step is measured by `scale` [n]: rtol times scale_i, or
    rtol times (scale_i + |y_i|) for pressures.
    """

    def __init__(self, model, scale, relative, rtol):
        n = len(scale)
        self.model = model
        self.n = n
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
        self.k5 = array("d", bytes(8 * n))
        self.k6 = array("d", bytes(8 * n))
        self.k7 = array("d", bytes(8 * n))
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
        self.u_now[HEAVE] = self.u[HEAVE] + (self.u[HEAVE_RATE] + 0.5 * self.u_rate[HEAVE_RATE] * dt) * dt
        self.u_now[TILT] = self.u[TILT] + (self.u[TILT_RATE] + 0.5 * self.u_rate[TILT_RATE] * dt) * dt

    def slope(self, t, y, dy):
        """Write dy/dt at time `t`."""
        self.move_inputs(t)
        right_hand_side(y, self.u_now, self.model, dy, self.w)
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
        self.slope(t, self.y, self.k1)

    def refresh(self):
        """Work out again, after the stored numbers were overwritten, what is not stored."""
        self.slope(self.t, self.y, self.k1)

    def stages(self, h):
        """Write the seven stages and the new state of a step of `h` [s]."""
        n = self.n
        t = self.t
        y = self.y
        s = self.y_stage
        k1, k2, k3, k4, k5, k6 = self.k1, self.k2, self.k3, self.k4, self.k5, self.k6
        for i in range(n):
            s[i] = y[i] + h * (A21 * k1[i])
        self.slope(t + 0.2 * h, s, k2)
        for i in range(n):
            s[i] = y[i] + h * (A31 * k1[i] + A32 * k2[i])
        self.slope(t + 0.3 * h, s, k3)
        for i in range(n):
            s[i] = y[i] + h * (A41 * k1[i] + A42 * k2[i] + A43 * k3[i])
        self.slope(t + 0.8 * h, s, k4)
        for i in range(n):
            s[i] = y[i] + h * (A51 * k1[i] + A52 * k2[i] + A53 * k3[i] + A54 * k4[i])
        self.slope(t + 8.0 / 9.0 * h, s, k5)
        for i in range(n):
            s[i] = y[i] + h * (A61 * k1[i] + A62 * k2[i] + A63 * k3[i] + A64 * k4[i] + A65 * k5[i])
        self.slope(t + h, s, k6)
        for i in range(n):
            self.y_new[i] = y[i] + h * (A71 * k1[i] + A73 * k3[i] + A74 * k4[i] + A75 * k5[i] + A76 * k6[i])
        self.slope(t + h, self.y_new, self.k7)

    def error(self, h):
        """Error of the step just made, in units of the tolerance (root mean square over the state without the energy integrals)."""
        total = 0.0
        m = self.n - INTEGRALS
        for i in range(m):
            e = h * (E1 * self.k1[i] + E3 * self.k3[i] + E4 * self.k4[i] + E5 * self.k5[i] + E6 * self.k6[i] + E7 * self.k7[i])
            limit = self.scale[i]
            if self.relative[i] > 0.0:
                limit += max(fabs(self.y[i]), fabs(self.y_new[i]))
            e /= self.rtol * limit
            total += e * e
        return pow(total / m, 0.5)

    def accept(self, h):
        """Make the step just computed the last one: keep its interpolant, move on."""
        n = self.n
        d = self.dense
        for i in range(n):
            change = self.y_new[i] - self.y[i]
            bend = h * self.k1[i] - change
            d[i] = self.y[i]
            d[n + i] = change
            d[2 * n + i] = bend
            d[3 * n + i] = change - h * self.k7[i] - bend
            d[4 * n + i] = h * (D1 * self.k1[i] + D3 * self.k3[i] + D4 * self.k4[i] + D5 * self.k5[i] + D6 * self.k6[i] + D7 * self.k7[i])
            self.y[i] = self.y_new[i]
            self.k1[i] = self.k7[i]
        self.t_old = self.t
        self.t += h
        self.steps += 1.0

    def advance(self, t_end):
        """Take internal steps until `t` is at or past `t_end` [s]. Returns False if the step size has collapsed."""
        while self.t < t_end:
            h = self.h
            if h < SHORTEST_STEP:
                return False
            self.stages(h)
            e = self.error(h)
            if e <= 1.0:
                self.accept(h)
                if e < 1e-10:
                    e = 1e-10
                factor = SAFETY * pow(self.error_old, BETA) / pow(e, EXPONENT)
                self.h = h * min(max(factor, SHRINK), GROW)
                if self.h > LONGEST_STEP:
                    self.h = LONGEST_STEP
                self.error_old = max(e, 1e-4)
            else:
                self.rejected += 1.0
                factor = SHRINK
                if e < 1e10:
                    factor = max(SAFETY / pow(e, EXPONENT), SHRINK)
                self.h = h * factor
        return True

    def interpolate(self, t, y):
        """Write the state at time `t` [s], inside the last internal step, to `y`."""
        n = self.n
        d = self.dense
        span = self.t - self.t_old
        a = (t - self.t_old) / span if span > 0.0 else 0.0
        b = 1.0 - a
        for i in range(n):
            y[i] = d[i] + a * (d[n + i] + b * (d[2 * n + i] + a * (d[3 * n + i] + b * d[4 * n + i])))

    def outputs_at(self, t, y, out):
        """Write the outputs at time `t` [s] and state `y` to `out`; uses and spoils the stage arrays."""
        self.move_inputs(t)
        outputs(y, self.u_now, self.model, self.k2, self.w, self.energy_start, out)


def state_size(n_groups):
    """Length of the state of a vehicle of `n_groups` leg groups."""
    return BODY + LEG * n_groups + INTEGRALS


def output_size(n_groups):
    """Length of the outputs of a vehicle of `n_groups` leg groups."""
    return BODY_OUTPUTS + ENERGY_OUTPUTS + STATUS_OUTPUTS + LEG_OUTPUTS * n_groups
