"""A system that has come to rest sleeps: time passes without steps until an input changes.

An explicit method goes on at rest with the longest stable steps, a thousand a second, and its
states tremble by a small part of the tolerance. Where the rest is, one implicit step tells that is
longer than any motion that is left: backward Euler's, linear, of `FAR` seconds. It leads from the
state y by the shift d, d/FAR - J d = f(y), to where all that decays has decayed. A creep shows in
it as FAR times its speed.
"""

from __future__ import annotations

from array import array
from math import fabs, inf

from ..bodies.system import System
from ..linear import solve
from ..memory import Buffer, Doubles, copy, data
from .watch import Watch

# [s]: to where a probe looks
FAR = 1000.0
# steps at rest between two probes, each of which costs as much as six; a prime, so that a tremble
# that repeats itself is met in all its states
STEPS_BETWEEN = 197
# a rest is that of the state where it is no further away than this [m] times rtol, a fifth of what
# the tolerance allows a position: the methods' tremble at rest is less, but for loose tolerances
# and for seals, on which an explicit method's tremble may hold the strokes; where so many probes
# found it no nearer, by a part of the least distance, the rest is five times as far as the
# tolerance allows, at most
TREMBLE, MOST_TREMBLE = 0.02, 0.5
NO_NEARER = 20
NEARER = 0.99
# [m]: no probe has found a rest yet
UNKNOWN = 1e9
# [m]: and where from there nothing is left that moves further, after so many probes at most
LEFT = 1e-9
PROBES = 6
# part of a state's scale by which derivatives are taken
NUDGE = 1e-7


class Rest(Watch):
    """A path that may come to rest.

    `asleep` tells that the state is one of rest and stays, `nearest` how near the rest has been by
    the probes [m], `still` how many probes in a row found it no nearer, NO_NEARER at most, `waited`
    how many steps at rest came after the last probe.
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
        """Whether the system rests near the state `y` at time `t`; then `_place` is that rest.

        What no state depends on stays as it is.
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
        self._outputs_at(self.t, place, look, 0)
        return self.system.rests(look)

    def _reach_rest(self, y: Doubles) -> bool:
        """Bring the state `y` to its rest at the inputs at time `t`.

        Returns:
            False where there is no rest, or it is too far away.
        """
        self._inputs_at(self.t)
        step = self._probe_step(y)
        if step < NEARER * self.nearest:
            self.nearest = step
            self.still = 0
        else:
            self.still = min(self.still + 1, NO_NEARER)
        near = self.rtol * (TREMBLE if self.still < NO_NEARER else MOST_TREMBLE)
        way = step
        for _ in range(PROBES - 1):
            if not way <= near:
                return False
            if step <= LEFT:
                return True
            step = self._probe_step(y)
            way += step
        return way <= near and step <= LEFT

    def _probe_step(self, y: Doubles) -> float:
        """Take a probe's step from the state `y`; return how far [m] it leads."""
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
        return self.system.distance(shift)

    def _linearise(self, y: Doubles) -> None:
        """Write 1/FAR - J at the state `y`, states in parts of their scales, to `_matrix`."""
        f0, f1, nudged, a = data(self._f0), data(self._f1), data(self._nudged), data(self._matrix)
        m = self.system.controlled
        copy(y, nudged, self.n)
        for j in range(m):
            nudged[j] = y[j] + NUDGE * self._scale(y, j)
            self.system.rhs(nudged, data(self.u_now), f1)
            nudged[j] = y[j]
            for i in range(m):
                a[i * m + j] = -(f1[i] - f0[i]) / (NUDGE * self._scale(y, i))
            a[j * m + j] += 1.0 / FAR

    def _scale(self, y: Doubles, i: int) -> float:
        """The size of state `i`, of which the tolerance is a part."""
        size = self.system.scale[i]
        return size + fabs(y[i]) if self.system.relative[i] > 0.0 else size

    def _awake(self) -> None:
        """Be in motion."""
        self.asleep = False
        self.nearest = UNKNOWN
        self.still = 0
        self.waited = 0

    def _sleep_until(self, t: float) -> None:
        """Let time pass to `t` [s]: the state stays."""
        self.t_before = self.t
        self.t_old = self.t
        self.t = t
