"""A system that has come to rest sleeps: time passes without steps until an input changes.

At rest an explicit method continues with the longest stable steps, a thousand a second, and its
states oscillate about the equilibrium by a small part of the tolerance. The equilibrium is found by
a probe: one linearised backward Euler step of `PROBE_STEP` seconds, longer than any motion that is
left. It shifts the state y by d, d/PROBE_STEP - J d = f(y), to where all that decays has decayed. A
creep shows in it as PROBE_STEP times its speed.
"""

from __future__ import annotations

from array import array
from math import fabs, inf

from ..bodies.system import System
from ..linear import solve
from ..memory import Buffer, Doubles, copy, data
from .watch import Watch

# [s]: length of a probe's backward Euler step
PROBE_STEP = 1000.0
# steps at rest between two probes, each of which costs as much as six; a prime, so that probes meet
# a periodic oscillation in all its phases
STEPS_BETWEEN = 197
# [m], times rtol: the system rests if its equilibrium is no further away than the first, a fifth of
# what the tolerance allows a position. The methods oscillate by less at rest, but for loose
# tolerances and for seals, on which the oscillation of an explicit method may hold the strokes.
# Therefore the second, five times what the tolerance allows, applies after NO_NEARER probes in a
# row of which none found a distance below NEARER times the least so far
NEAR, NEAR_AT_MOST = 0.02, 0.5
NO_NEARER = 20
NEARER = 0.99
# [m]: distance of the equilibrium before the first probe
UNKNOWN = 1e9
# [m]: probes are repeated until one moves the state no further, and so many times at most
CONVERGED = 1e-9
PROBES = 6
# [s]: the move to the equilibrium may lose as much of what the system conserves as a step this long
LOSS_TIME = 1.0
# increment of the finite differences for J, as a part of a state's scale
NUDGE = 1e-7


class Rest(Watch):
    """A path that may come to rest.

    `asleep` tells that the state is at rest and stays, `nearest` the least distance to the
    equilibrium that a probe found [m], `still` how many probes in a row found none below it,
    NO_NEARER at most, `waited` how many steps at rest came after the last probe.
    """

    rtol: float
    asleep: bool
    nearest: float
    still: int
    waited: int
    _matrix: Buffer
    _shift: Buffer
    _place: Buffer
    _nudged: Buffer
    _f0: Buffer
    _f1: Buffer

    def __init__(self, system: System, rtol: float) -> None:
        super().__init__(system)
        n = system.n
        self.rtol = rtol
        self.asleep = False
        self.nearest = UNKNOWN
        self.still = 0
        self.waited = 0
        self._matrix = array("d", bytes(8 * n * n))
        self._shift = array("d", bytes(8 * n))
        self._place = array("d", bytes(8 * n))
        self._nudged = array("d", bytes(8 * n))
        self._f0 = array("d", bytes(8 * n))
        self._f1 = array("d", bytes(8 * n))

    def _found_rest(self, y: Doubles) -> bool:
        """Whether the system rests near the state `y` at time `t`, at the equilibrium `_place`.

        States that no other state depends on stay as they are.
        """
        if not self.system.may_rest(data(self.u), data(self.u_rate), data(self.last)):
            self._awake()
            return False
        self.waited += 1
        if self.waited < STEPS_BETWEEN:
            return False
        self.waited = 0
        place = data(self._place)
        copy(y, place, self.n)
        if not self._reach_rest(place):
            return False
        look = data(self._look)
        self._inputs_at(self.t)
        self.system.outputs(place, data(self.u_now), look, 0)
        if self.system.lost(data(self.last), look, LOSS_TIME) > 1.0:
            return False
        return self.system.rests(look, 1.0)

    def _reach_rest(self, y: Doubles) -> bool:
        """Move the state `y` to the equilibrium at the inputs at time `t`.

        Returns:
            False where there is no equilibrium, or it is too far away.
        """
        self._inputs_at(self.t)
        step = self._probe_step(y)
        if step < NEARER * self.nearest:
            self.nearest = step
            self.still = 0
        else:
            self.still = min(self.still + 1, NO_NEARER)
        near = self.rtol * (NEAR if self.still < NO_NEARER else NEAR_AT_MOST)
        way = step
        for _ in range(PROBES - 1):
            if not way <= near:
                return False
            if step <= CONVERGED:
                return True
            step = self._probe_step(y)
            way += step
        return way <= near and step <= CONVERGED

    def _probe_step(self, y: Doubles) -> float:
        """Move the state `y` by one probe; return how far [m] it moved."""
        f0, shift, a = data(self._f0), data(self._shift), data(self._matrix)
        m = self.system.controlled
        self.system.rhs(y, data(self.u_now), f0)
        for i in range(m):
            shift[i] = f0[i] / self._scale(y, i)
        self._linearise(y)
        if not solve(a, shift, m):
            return inf
        for i in range(m):
            shift[i] *= self._scale(y, i)
            y[i] += shift[i]
        self.system.normalise(y)
        return self.system.distance(shift)

    def _linearise(self, y: Doubles) -> None:
        """Write 1/PROBE_STEP - J at the state `y` to `_matrix`, states in parts of their scales."""
        f0, f1, nudged, a = data(self._f0), data(self._f1), data(self._nudged), data(self._matrix)
        m = self.system.controlled
        copy(y, nudged, self.n)
        for j in range(m):
            nudged[j] = y[j] + NUDGE * self._scale(y, j)
            self.system.rhs(nudged, data(self.u_now), f1)
            nudged[j] = y[j]
            for i in range(m):
                a[i * m + j] = -(f1[i] - f0[i]) / (NUDGE * self._scale(y, i))
            a[j * m + j] += 1.0 / PROBE_STEP

    def _scale(self, y: Doubles, i: int) -> float:
        """The size of state `i`, of which the tolerance is a part."""
        size = self.system.scale[i]
        return size + fabs(y[i]) if self.system.relative[i] > 0.0 else size

    def _awake(self) -> None:
        """Mark the system as moving, and forget the probes so far."""
        self.asleep = False
        self.nearest = UNKNOWN
        self.still = 0
        self.waited = 0

    def _sleep_until(self, t: float) -> None:
        """Let time pass to `t` [s]: the state stays."""
        self.t_before = self.t
        self.t_old = self.t
        self.t = t
