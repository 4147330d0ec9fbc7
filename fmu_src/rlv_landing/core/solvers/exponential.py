"""Exponential Runge-Kutta of fourth order for stiff pairs of states.

No pair limits the step, however stiff. A system names pairs of states whose difference decays at
lambda = a1 + a2, far faster than all else changes: the pressures in the chambers of a damper, which
its orifice evens out at 1e4 to 1e5 1/s near zero flow, while all else in a landing changes at 1e3
to 5e3 1/s. That part of the pair's rates, (a1 x, -a2 x) with x the growth of the difference since
the step's start and a1, a2 as they are there, is solved exactly within a step; the rest is taken by
the classic Runge-Kutta scheme. That is exponential time differencing, ETDRK4-B of Krogstad,
Generalized integrating factor methods for stiff PDEs, Journal of Computational Physics 203 (2005);
here the stiff part is a matrix of rank one for each pair, so that its functions are scalars in
closed form. Where nothing is stiff it is the classic scheme.

The error estimate is the difference to an embedded third-order method whose last stage is the
right-hand side at the step's end, which is the next step's first. Both see the step's end only. To
detect a kink inside the step, a part of the difference to a second-order method is added.
"""

from __future__ import annotations

from array import array
from math import fabs, inf

from ..access import PHI_WEIGHTS, STIFF_PAIR, keep, phi_weights_of, stiff_pair_of
from ..bodies.system import System
from ..memory import Buffer, Doubles, Records, data, room
from ..records import PhiWeights, StiffPair
from .phi import phi_weights
from .solver import Solver
from .step_control import BETA

THIRD, SIXTH = 1.0 / 3.0, 1.0 / 6.0
# part of the difference to the second-order method that counts as error
KINK = 0.3
# the longest step near a rest, times the fastest rate of decay: at the limit of stability, 2.8,
# oscillations of the tolerance's size stay for ever
WELL_DAMPED = 1.6
# right-hand sides of a step: at its start, at the stages 2 to 4, at its end
STAGES = 5


class Exponential(Solver):
    """Four right-hand sides a step, fourth order.

    `driven` holds, for each stiff pair and each of the STAGES, the rate of its difference less the
    decay of the difference's growth.
    """

    driven: Buffer
    _pairs: Records[StiffPair]
    _weights: Records[PhiWeights]

    def __init__(self, system: System, rtol: float) -> None:
        super().__init__(system, rtol)
        self.driven = array("d", bytes(8 * STAGES * max(system.stiff_pairs, 1)))
        self._pairs = room(system.stiff_pairs, STIFF_PAIR)
        self._weights = room(system.stiff_pairs, PHI_WEIGHTS)
        self.exponent = 0.25 - 0.75 * BETA

    def _start_step(self) -> None:
        """Freeze the linear part."""
        self._freeze_linear_part()

    def _freeze_linear_part(self) -> None:
        """Take each pair's a1, a2 and the rate of its difference at the step's start."""
        for k in range(self.system.stiff_pairs):
            pair = self.system.stiff(k)
            keep(pair, self._pairs, k)
            self.driven[STAGES * k] = self.k1[pair.j] - self.k1[pair.i]

    def _weigh_pairs(self, h: float) -> None:
        """Keep each pair's weights for a step of `h` [s]."""
        for k in range(self.system.stiff_pairs):
            pair = stiff_pair_of(self._pairs, k)
            keep(phi_weights(h * (pair.a1 + pair.a2)), self._weights, k)

    def _nonlinear_rate(self, stage: int, s: Doubles, rates: Doubles) -> None:
        """Keep the rate of each pair's difference at a stage, less the decay of its growth.

        The state there is `s`, its rates are `rates`.
        """
        y = data(self.y)
        for k in range(self.system.stiff_pairs):
            pair = stiff_pair_of(self._pairs, k)
            growth = s[pair.j] - s[pair.i] - (y[pair.j] - y[pair.i])
            self.driven[STAGES * k + stage] = (
                rates[pair.j] - rates[pair.i] + (pair.a1 + pair.a2) * growth
            )

    def _replace_linear_growth(
        self, pair: StiffPair, s: Doubles, growth: float, plain: float
    ) -> None:
        """In `s`, put `growth` of the pair's difference in the place of the `plain` one.

        The plain growth is that of the classic scheme. What does not decay stays.
        """
        decay = pair.a1 + pair.a2
        if decay > 0.0:
            shift = (plain - growth) / decay
            s[pair.i] += pair.a1 * shift
            s[pair.j] -= pair.a2 * shift

    def _stage(self, i: int, ahead: float, h: float, k: Doubles, k_next: Doubles) -> None:
        """Compute stage `i` of a step of `h` [s], `ahead` [s] from its start.

        `k` are the rates of the stage before, `k_next` becomes those of this stage.
        """
        y, s, d = data(self.y), data(self.y_stage), data(self.driven)
        for j in range(self.system.controlled):
            s[j] = y[j] + ahead * k[j]
        for g in range(self.system.stiff_pairs):
            pair = stiff_pair_of(self._pairs, g)
            first, last = stage_weights(i, phi_weights_of(self._weights, g))
            growth = h * (first * d[STAGES * g] + last * d[STAGES * g + i - 1])
            self._replace_linear_growth(pair, s, growth, ahead * (k[pair.j] - k[pair.i]))
        self._derivatives(self.t + ahead, s, k_next)
        self._nonlinear_rate(i, s, k_next)

    def _try_step(self, h: float) -> None:
        """Write the stages and the new state of a step of `h` [s].

        The right-hand side there and the error are written as well.
        """
        k1, k2, k3, k4 = data(self.k1), data(self.k2), data(self.k3), data(self.k4)
        self._weigh_pairs(h)
        self._stage(1, 0.5 * h, h, k1, k2)
        self._stage(2, 0.5 * h, h, k2, k3)
        self._stage(3, h, h, k3, k4)
        self._finish_step(h)
        self._compare(h)

    def _finish_step(self, h: float) -> None:
        """The new state from the four stages, and the right-hand side there."""
        y, s, d = data(self.y), data(self.y_new), data(self.driven)
        k1, k2, k3, k4, k5 = (
            data(self.k1),
            data(self.k2),
            data(self.k3),
            data(self.k4),
            data(self.k_end),
        )
        for i in range(self.n):
            s[i] = y[i] + h * (SIXTH * (k1[i] + k4[i]) + THIRD * (k2[i] + k3[i]))
        for g in range(self.system.stiff_pairs):
            pair = stiff_pair_of(self._pairs, g)
            w = phi_weights_of(self._weights, g)
            q = STAGES * g
            growth = h * (w.b1 * d[q] + w.b23 * (d[q + 1] + d[q + 2]) + w.b4 * d[q + 3])
            self._replace_linear_growth(
                pair, s, growth, (s[pair.j] - s[pair.i]) - (y[pair.j] - y[pair.i])
            )
        self.system.normalise(s)
        self._derivatives(self.t + h, s, k5)
        self._nonlinear_rate(4, s, k5)

    def _compare(self, h: float) -> None:
        """The step's deviation from its embedded methods."""
        e, d, relative = data(self.deviation), data(self.driven), data(self.system.relative)
        k1, k2, k3, k4, k5 = (
            data(self.k1),
            data(self.k2),
            data(self.k3),
            data(self.k4),
            data(self.k_end),
        )
        m = self.system.controlled
        for i in range(m):
            e[i] = h * SIXTH * (k4[i] - k5[i])
        for g in range(self.system.stiff_pairs):
            pair = stiff_pair_of(self._pairs, g)
            w = phi_weights_of(self._weights, g)
            q = STAGES * g
            self._replace_linear_growth(
                pair, e, h * w.b4 * (d[q + 3] - d[q + 4]), e[pair.j] - e[pair.i]
            )
        # without branches, so that the compiler takes several states at once
        for i in range(m):
            kink = KINK * h * SIXTH * fabs(k1[i] - k2[i] - k3[i] + k4[i])
            e[i] = fabs(e[i]) + kink if relative[i] == 0.0 else e[i]

    def _longest_damped(self) -> float:
        """By the last two stages, both at the step's end, less what is solved exactly."""
        end, s = data(self.y_new), data(self.y_stage)
        k4 = data(self.k4)
        for g in range(self.system.stiff_pairs):
            pair = stiff_pair_of(self._pairs, g)
            grown = (end[pair.j] - end[pair.i]) - (s[pair.j] - s[pair.i])
            k4[pair.i] += pair.a1 * grown
            k4[pair.j] -= pair.a2 * grown
        fastest = self._fastest(end, data(self.k_end), s, k4)
        return WELL_DAMPED / fastest if fastest > 0.0 else inf


def stage_weights(i: int, w: PhiWeights) -> tuple[float, float]:
    """Weights at stage `i` of the rates at the step's start and at the stage before."""
    if i == 1:
        return w.a21, 0.0
    if i == 2:
        return w.a31, w.a32
    return w.a41, w.a43
