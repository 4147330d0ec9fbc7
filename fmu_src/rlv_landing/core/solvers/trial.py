"""A trial step: its stages and its end, its error, and its loss of conserved quantities.

The system conserves energy, and the liquid mass of dampers.
"""

from __future__ import annotations

from array import array
from math import fabs, inf, sqrt

from ..bodies.system import System
from ..memory import Buffer, Doubles, data
from .rest import Rest

# [s]: the loss of a shorter step is not judged: steps are so short only where a force jumps, and
# lose next to nothing
SHORTEST_JUDGED = 1e-10
# how far the interpolant may overshoot the states at both ends of a step, as a part of their sizes,
# before it is judged: a pressure near the liquid's stiffness changes much energy by a small change
BULGE = 0.002
# at looser tolerances the inside of every step is judged
LOOSE = 1e-4
# so small a cut of an interpolant's slopes, in parts of its state's scale, is no reason to judge
# it: the value inside changes by 4/27 of it at most, a hundredth of what a step may lose where
# little was lost before, and it is no loss at the step's end
UNSEEN = 1e-8
# [parts of the states' scales]: stages that differ by no more tell no rate
TELLS_NOTHING = 1e-13
# a cubic between two values rises throughout where its slopes at both are at most so many times
# that of the straight line (Fritsch and Carlson, Monotone piecewise cubic interpolation, SIAM
# Journal on Numerical Analysis 17, 1980)
STEEPEST = 3.0


class Trial(Rest):
    """A path along which steps are tried.

    A method computes a step from the state `y` and its rates `k1`: its stages, whose rates are `k2`
    to `k4`, the new state `y_new`, the rates `k_end` there, and the step's `deviation` from its
    embedded method. All are [n]. Stages and deviation are those of the controlled states alone:
    nothing depends on the others.

    Attributes:
        rhs_calls: Calls of the right-hand side so far.
        ceiling: [n] how large the error of each state may be at any tolerance.
        flattened: Whether the interpolant written last was changed by more than next to nothing to
            keep a state monotonic.
    """

    rhs_calls: float
    flattened: bool
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
        self.rhs_calls = 0.0
        self.flattened = False
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

    def derivatives(self, t: float, y: Buffer, dy: Buffer) -> None:
        """Write dy/dt at time `t` [s] and state `y` [n] to `dy` [n], for other solvers."""
        self._derivatives(t, data(y), data(dy))

    def _derivatives(self, t: float, y: Doubles, dy: Doubles) -> None:
        self._inputs_at(t)
        self.system.rhs(y, data(self.u_now), dy)
        self.rhs_calls += 1.0

    def _dense_correction(self, h: float, at: int) -> None:
        """Write the fourth-order part of a step's interpolant to `dense[at:]`.

        Only a method that has one does so.
        """

    def _error(self) -> float:
        """Error of the step just computed, in units of the tolerance.

        It is the root mean square over the controlled states, as a mean of those that count. The
        deviation is in these units afterwards.
        """
        y, end, deviation = data(self.y), data(self.y_new), data(self.deviation)
        scale, relative = data(self.system.scale), data(self.system.relative)
        ceiling = data(self.ceiling)
        self.system.weigh(ceiling)
        rtol = self.rtol
        m = self.system.controlled
        # without branches, so that the compiler takes several states at once
        for i in range(m):
            size = max(fabs(y[i]), fabs(end[i]))
            limit = min(rtol * (scale[i] + size), ceiling[i])
            deviation[i] /= limit if relative[i] > 0.0 else rtol * scale[i]
        total = 0.0
        for i in range(m):
            total += deviation[i] * deviation[i]
        return sqrt(total / self.system.counted)

    def _fastest(self, one: Doubles, k_one: Doubles, other: Doubles, k_other: Doubles) -> float:
        """The fastest rate [1/s] by which two states differ in their rates; 0 where they are equal.

        States and rates are those of two stages at the same time, which differ by what decays
        fastest. Source: Hairer and Wanner, Solving Ordinary Differential Equations II, IV.2.
        """
        apart = faster = 0.0
        for i in range(self.system.controlled):
            size = self._scale(one, i)
            way = (one[i] - other[i]) / size
            rate = (k_one[i] - k_other[i]) / size
            apart += way * way
            faster += rate * rate
        return sqrt(faster / apart) if apart > TELLS_NOTHING * TELLS_NOTHING else 0.0

    def _loses(self, h: float) -> bool:
        """Whether a step of `h` [s] loses more than it may of what the system conserves.

        The loss is judged before the step's end is brought back to what is conserved, and after.
        This brings it back, reads it, and writes the step's interpolant.
        """
        end, k_end = data(self.y_new), data(self.k_end)
        self._hold_risen(end)
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

    def _hold_risen(self, end: Doubles) -> None:
        """Keep states that never fall from falling: raise them at the `end` to their start values.

        A method with a negative weight gives a fall where a rate has a narrow peak.
        """
        y = data(self.y)
        first = self.system.controlled
        for i in range(first, first + self.system.rising):
            if end[i] < y[i]:
                end[i] = y[i]

    def _write_dense(self, h: float) -> None:
        """Write the interpolant of the step of `h` [s] just computed.

        It takes the place of that of the step before the last.
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
        change, bend, last = at + n, at + 2 * n, at + 3 * n
        # a loop for each part, so that the compiler takes several states at once
        for i in range(n):
            d[at + i] = y[i]
        for i in range(n):
            d[change + i] = end[i] - y[i]
        for i in range(n):
            d[bend + i] = h * k1[i] - d[change + i]
        for i in range(n):
            d[last + i] = d[change + i] - h * k_end[i] - d[bend + i]
        self._dense_correction(h, at + 4 * n)
        self._keep_rising(h, at)

    def _keep_rising(self, h: float, at: int) -> None:
        """Make the interpolant just written, at `at`, monotonic for states that never fall.

        Slopes at the ends are limited so that the cubic rises. The fourth-order part is left out
        where the quartic might fall: where its coefficients in Bernstein's form do.
        """
        n = self.n
        d, k1, k_end = data(self.dense), data(self.k1), data(self.k_end)
        scale = data(self.system.scale)
        first = self.system.controlled
        self.flattened = False
        for i in range(first, first + self.system.rising):
            j = at + i
            change = d[n + j]
            most = STEEPEST * change
            early = h * k1[i]
            late = h * k_end[i]
            if early < 0.0 or early > most or late < 0.0 or late > most:
                first_slope = min(max(early, 0.0), most)
                last_slope = min(max(late, 0.0), most)
                cut = fabs(first_slope - early) + fabs(last_slope - late) + fabs(d[4 * n + j])
                if cut > UNSEEN * scale[i]:
                    self.flattened = True
                d[2 * n + j] = first_slope - change
                d[3 * n + j] = 2.0 * change - last_slope - first_slope
                d[4 * n + j] = 0.0
            elif d[4 * n + j] != 0.0:
                middle = 0.5 * change + (early - late + d[4 * n + j]) / 6.0
                if middle < 0.25 * early or middle > change - 0.25 * late:
                    self.flattened = True
                    d[4 * n + j] = 0.0

    def _loses_inside(self, h: float) -> bool:
        """Whether the step loses more than it may at its quarters.

        They are judged if the interpolant overshoots the step's ends or was flattened, or the
        tolerance is loose. As for outputs, the states there are brought back first to what the
        system conserves.
        """
        if self.rtol <= LOOSE and not self.flattened and not self._bulges():
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
        """Whether the interpolant just written overshoots the step's ends at a quarter.

        Only states whose error is relative to their size count.
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
