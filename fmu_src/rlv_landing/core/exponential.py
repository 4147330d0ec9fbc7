"""Runge-Kutta of fourth order whose damper chambers even out exponentially: no chamber holds the step, however stiff.

The flow through an orifice evens its chambers' pressures out at lambda = a1 + a2 (see `damper`): 1e4 to 1e5 1/s near zero flow, while
all else in a landing changes at 1e3 to 5e3 1/s. So that part of the pressures' rates, (a1 x, -a2 x) with x the growth of P2 - P1 since the
step's start and a1, a2 as they are there, is solved exactly within a step; the rest is taken by the classic Runge-Kutta scheme. That is
exponential time differencing, ETDRK4-B of Krogstad, Generalized integrating factor methods for stiff PDEs, Journal of Computational
Physics 203 (2005); here the stiff part is a matrix of rank one for each leg, so that its functions are scalars in closed form. Where
nothing is stiff it is the classic scheme.

The step's error is that against a third-order companion whose last stage is the right-hand side at the step's end, which is the next
step's first. Both see the step's end only; a part of the difference to a second-order companion shows them a kink inside the step.
"""

from array import array
from math import expm1, fabs

from .integrator import BETA, Solver
from .layout import BODY, L_DECAY1, L_DECAY2, LEG, LOADS, P1, P2, STAGES, WEIGHTS
from .pointer import data

THIRD, SIXTH = 1.0 / 3.0, 1.0 / 6.0
# below it, the differences that phi2 and phi3 are made of would cancel
SMALL = 0.1
KINK = 0.3


def phi1(z):
    """(1 - exp(-z))/z."""
    return -expm1(-z) / z if z > 0.0 else 1.0


def phi2(z, f1):
    """(1 - phi1)/z, from `f1` = phi1(z); Taylor's series where that would cancel."""
    if z > SMALL:
        return (1.0 - f1) / z
    tail = 1.0 / 720.0 - z * (
        1.0 / 5040.0 - z * (1.0 / 40320.0 - z * (1.0 / 362880.0 - z / 3628800.0))
    )
    return 0.5 - z * (1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * tail)))


def phi3(z, f2):
    """(1/2 - phi2)/z, from `f2` = phi2(z); Taylor's series where that would cancel."""
    if z > SMALL:
        return (0.5 - f2) / z
    tail = 1.0 / 5040.0 - z * (
        1.0 / 40320.0 - z * (1.0 / 362880.0 - z * (1.0 / 3628800.0 - z / 39916800.0))
    )
    return 1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * (1.0 / 720.0 - z * tail)))


class Exponential(Solver):
    """Four right-hand sides a step, fourth order."""

    def __init__(self, model, scale, relative, rtol):
        super().__init__(model, scale, relative, rtol)
        self.decay = array("d", bytes(8 * 2 * model.n_groups))
        self.driven = array("d", bytes(8 * STAGES * model.n_groups))
        self.weights = array("d", bytes(8 * WEIGHTS * model.n_groups))
        self.exponent = 0.25 - 0.75 * BETA

    def begin(self):
        """Take each leg's a1, a2 and the rate of P2 - P1 at the step's start."""
        for g in range(self.model.n_groups):
            j = BODY + LEG * g
            self.decay[2 * g] = self.w[LOADS * g + L_DECAY1]
            self.decay[2 * g + 1] = self.w[LOADS * g + L_DECAY2]
            self.driven[STAGES * g] = self.k1[j + P2] - self.k1[j + P1]

    def weigh(self, h):
        """Write the weights for a step of `h` [s], `WEIGHTS` numbers a leg: Krogstad's a21, 0; a31, a32; a41, a43; b1, b2 = b3, b4."""
        w = data(self.weights)
        for g in range(self.model.n_groups):
            i = WEIGHTS * g
            z = h * (self.decay[2 * g] + self.decay[2 * g + 1])
            f1 = phi1(0.5 * z)
            f2 = phi2(0.5 * z, f1)
            w[i] = 0.5 * f1
            w[i + 1] = 0.0
            w[i + 2] = 0.5 * f1 - f2
            w[i + 3] = f2
            f1 = phi1(z)
            f2 = phi2(z, f1)
            f3 = phi3(z, f2)
            w[i + 4] = f1 - 2.0 * f2
            w[i + 5] = 2.0 * f2
            w[i + 6] = f1 - 3.0 * f2 + 4.0 * f3
            w[i + 7] = 2.0 * f2 - 4.0 * f3
            w[i + 8] = 4.0 * f3 - f2

    def drive(self, stage, s, k):
        """Keep the rate of each leg's P2 - P1 at a stage, less the decay of its growth: from the state `s` and the rates `k` there."""
        y = data(self.y)
        for g in range(self.model.n_groups):
            j = BODY + LEG * g
            growth = s[j + P2] - s[j + P1] - (y[j + P2] - y[j + P1])
            self.driven[STAGES * g + stage] = (
                k[j + P2] - k[j + P1] + (self.decay[2 * g] + self.decay[2 * g + 1]) * growth
            )

    def settle(self, g, s, growth, plain):
        """In `s`, put `growth` [Pa] of leg `g`'s P2 - P1 in the place of the classic scheme's `plain` one; what does not decay stays."""
        a1 = self.decay[2 * g]
        a2 = self.decay[2 * g + 1]
        j = BODY + LEG * g
        shift = (plain - growth) / (a1 + a2)
        s[j + P1] += a1 * shift
        s[j + P2] -= a2 * shift

    def stage(self, i, ahead, h, k, k_next):
        """Stage `i` of a step of `h` [s], `ahead` [s] from its start: from the rates `k` of the stage before to `k_next`."""
        y, s, d, w = data(self.y), data(self.y_stage), data(self.driven), data(self.weights)
        for j in range(self.n):
            s[j] = y[j] + ahead * k[j]
        for g in range(self.model.n_groups):
            j, q, v = BODY + LEG * g, STAGES * g, WEIGHTS * g + 2 * (i - 1)
            self.settle(
                g, s, h * (w[v] * d[q] + w[v + 1] * d[q + i - 1]), ahead * (k[j + P2] - k[j + P1])
            )
        self.slope(self.t + ahead, s, k_next)
        self.drive(i, s, k_next)

    def attempt(self, h):
        """Write the stages and the new state of a step of `h` [s], the right-hand side there, and the error."""
        k1, k2, k3, k4 = data(self.k1), data(self.k2), data(self.k3), data(self.k4)
        self.weigh(h)
        self.stage(1, 0.5 * h, h, k1, k2)
        self.stage(2, 0.5 * h, h, k2, k3)
        self.stage(3, h, h, k3, k4)
        self.finish(h)

    def finish(self, h):
        """The new state from the four stages, the right-hand side there, and the error."""
        y, s, e, d, w = (
            data(self.y),
            data(self.y_new),
            data(self.deviation),
            data(self.driven),
            data(self.weights),
        )
        k1, k2, k3, k4, k5 = (
            data(self.k1),
            data(self.k2),
            data(self.k3),
            data(self.k4),
            data(self.k_end),
        )
        for i in range(self.n):
            s[i] = y[i] + h * (SIXTH * (k1[i] + k4[i]) + THIRD * (k2[i] + k3[i]))
        for g in range(self.model.n_groups):
            j, q, v = BODY + LEG * g, STAGES * g, WEIGHTS * g
            growth = h * (w[v + 6] * d[q] + w[v + 7] * (d[q + 1] + d[q + 2]) + w[v + 8] * d[q + 3])
            self.settle(g, s, growth, (s[j + P2] - s[j + P1]) - (y[j + P2] - y[j + P1]))
        self.slope(self.t + h, s, k5)
        self.drive(4, s, k5)
        for i in range(self.n):
            e[i] = h * SIXTH * (k4[i] - k5[i])
        for g in range(self.model.n_groups):
            j, q, v = BODY + LEG * g, STAGES * g, WEIGHTS * g
            self.settle(g, e, h * w[v + 8] * (d[q + 3] - d[q + 4]), e[j + P2] - e[j + P1])
        for i in range(self.n):
            if self.relative[i] == 0.0:
                e[i] = fabs(e[i]) + KINK * h * SIXTH * fabs(k1[i] - k2[i] - k3[i] + k4[i])
