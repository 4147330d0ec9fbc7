"""Dormand-Prince 5(4), the paper's ode45.

It is explicit: the stiffest damper chamber limits its steps by stability, at any tolerance.

Coefficients: Dormand and Prince (1980); the fourth-order interpolant: Hairer, Norsett and Wanner,
Solving Ordinary Differential Equations I, II.6.
"""

from __future__ import annotations

from array import array
from math import inf

from ..bodies.system import System
from ..memory import Buffer, data
from .solver import Solver
from .step_control import BETA

A21 = 1.0 / 5.0
A31, A32 = 3.0 / 40.0, 9.0 / 40.0
A41, A42, A43 = 44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0
A51, A52, A53, A54 = 19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0
A61, A62, A63, A64, A65 = (
    9017.0 / 3168.0,
    -355.0 / 33.0,
    46732.0 / 5247.0,
    49.0 / 176.0,
    -5103.0 / 18656.0,
)
A71, A73, A74, A75, A76 = 35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0
E1, E3, E4, E5, E6, E7 = (
    71.0 / 57600.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
)
D1, D3, D4 = (
    -12715105075.0 / 11282082432.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
)
D5, D6, D7 = 701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0, 69997945.0 / 29380423.0
# the longest step near a rest, times the fastest rate of decay: at the limit of stability, 3.3,
# oscillations of the tolerance's size stay for ever
DAMPED = 0.8
# in parts of a slow system's kinetic energy: below it, a vibration that nothing damps is kept up by
# steps longer than a sixth of its period, which the method does not damp
VIBRATES = 100.0


class DormandPrince(Solver):
    """Six right-hand sides a step, fifth order, error by the embedded fourth-order method."""

    k5: Buffer
    k6: Buffer

    def __init__(self, system: System, rtol: float) -> None:
        super().__init__(system, rtol)
        self.k5 = array("d", bytes(8 * self.n))
        self.k6 = array("d", bytes(8 * self.n))
        self.exponent = 0.2 - 0.75 * BETA
        self.damped_below = VIBRATES

    def _try_step(self, h: float) -> None:
        """Write the seven stages and the new state of a step of `h` [s]."""
        n = self.n
        m = self.system.controlled
        t = self.t
        y, s, end, e = data(self.y), data(self.y_stage), data(self.y_new), data(self.deviation)
        k1, k2, k3, k4 = data(self.k1), data(self.k2), data(self.k3), data(self.k4)
        k5, k6, k7 = data(self.k5), data(self.k6), data(self.k_end)
        for i in range(m):
            s[i] = y[i] + h * (A21 * k1[i])
        self._derivatives(t + 0.2 * h, s, k2)
        for i in range(m):
            s[i] = y[i] + h * (A31 * k1[i] + A32 * k2[i])
        self._derivatives(t + 0.3 * h, s, k3)
        for i in range(m):
            s[i] = y[i] + h * (A41 * k1[i] + A42 * k2[i] + A43 * k3[i])
        self._derivatives(t + 0.8 * h, s, k4)
        for i in range(m):
            s[i] = y[i] + h * (A51 * k1[i] + A52 * k2[i] + A53 * k3[i] + A54 * k4[i])
        self._derivatives(t + 8.0 / 9.0 * h, s, k5)
        for i in range(m):
            s[i] = y[i] + h * (A61 * k1[i] + A62 * k2[i] + A63 * k3[i] + A64 * k4[i] + A65 * k5[i])
        self._derivatives(t + h, s, k6)
        for i in range(n):
            end[i] = y[i] + h * (
                A71 * k1[i] + A73 * k3[i] + A74 * k4[i] + A75 * k5[i] + A76 * k6[i]
            )
        self.system.normalise(end)
        self._derivatives(t + h, end, k7)
        for i in range(m):
            e[i] = h * (E1 * k1[i] + E3 * k3[i] + E4 * k4[i] + E5 * k5[i] + E6 * k6[i] + E7 * k7[i])

    def _longest_damped(self) -> float:
        """By the last two stages, both at the step's end."""
        fastest = self._fastest(
            data(self.y_new), data(self.k_end), data(self.y_stage), data(self.k6)
        )
        return DAMPED / fastest if fastest > 0.0 else inf

    def _dense_correction(self, h: float, at: int) -> None:
        """The interpolant's fourth-order part."""
        n = self.n
        for i in range(n):
            self.dense[at + i] = h * (
                D1 * self.k1[i]
                + D3 * self.k3[i]
                + D4 * self.k4[i]
                + D5 * self.k5[i]
                + D6 * self.k6[i]
                + D7 * self.k_end[i]
            )
