"""The energy that a strut takes up, from its curves over time.

Forces are those of the outputs: negative in compression [N]. Strokes [m] are positive in
compression. Energies [J] are positive where the strut takes them up.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Point(NamedTuple):
    """A point of a strut's curves."""

    time: float  # [s]
    stroke: float  # [m]
    work: float  # energy taken up until then [J]


def work_of(force: Array, stroke: Array) -> Array:
    """Energy [J] that a damper has taken up along a curve until each sample, (n,).

    E = int -F s' dt = -int F ds, Eq. (44) [paper]; positive in compression. It is summed by
    trapezoids over the stroke: exact for a force that is linear in stroke between samples.

    Args:
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
    """
    return _summed(-0.5 * (force[1:] + force[:-1]) * np.diff(stroke))


def smooth_work(time: Array, force: Array, stroke: Array, rate: Array) -> Array:
    """As `work_of`, for smooth curves: by cubics between samples.

    The force's slopes at the samples are such that no cubic overshoots.

    Args:
        time: Times of the samples [s], (n,).
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
        rate: Its rate [m/s], (n,).
    """
    # takes a tenth of a second, which only logs need
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    if len(time) < 2:
        return np.zeros(len(time))
    pull = PchipInterpolator(time, force)
    way = CubicHermiteSpline(time, stroke, rate).derivative()
    step = np.diff(time)
    done = np.zeros(len(step))
    # the power is of fifth degree, which three points sum up exactly
    for place, weight in zip(*np.polynomial.legendre.leggauss(3)):
        at = time[:-1] + 0.5 * (1.0 + place) * step
        done -= 0.5 * weight * step * pull(at) * way(at)
    return _summed(done)


def _summed(parts: Array) -> Array:
    """The sums of the parts before each sample."""
    return np.concatenate([[0.0], np.cumsum(parts)])


@dataclass(frozen=True)
class StrutCurves:
    """A strut's curves over time.

    Attributes:
        time: Times of the samples [s], (n,).
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
        rate: Its rate [m/s], (n,), where the curves are a model's: cubics between samples. None:
            they are measured, and nothing is known between samples.
        work: Energy taken up until each sample [J], (n,).
    """

    time: Array
    force: Array
    stroke: Array
    rate: Array | None
    work: Array

    def turn(self, i: int) -> Point:
        """Where the stroke is largest or smallest: at the sample `i`, or next to it."""
        rate, stroke = self.rate, self.stroke
        if rate is None or not 0 < i < len(stroke) - 1 or rate[i] == 0.0:
            return self._sample(i)
        # towards the sample at which the stroke moves the other way
        a = i if (rate[i] > 0.0) == (stroke[i] > stroke[i + 1]) else i - 1
        if rate[a] * rate[a + 1] >= 0.0:
            return self._sample(i)
        return self._between(a, _turning_part(*self._span(a, rate)))

    def extended(self, top: int, end: int) -> Point | None:
        """Where the stroke first falls to 0 between samples `top` and `end`; None: it stays above.

        The damper may meet a stop there, so that the curves before go on to it: the rate and the
        power as straight lines through the last two samples.
        """
        stroke, rate = self.stroke, self.rate
        if rate is None or stroke[top] <= 0.0 or self.turn(end).stroke >= 0.0:
            return None
        extended = np.flatnonzero(stroke[top : end + 1] <= 0.0)
        a = top + int(extended[0]) - 1 if len(extended) else end
        if not a or rate[a] >= 0.0:
            return None
        step = float(self.time[a + 1] - self.time[a])
        before = float(self.time[a] - self.time[a - 1])
        power = -self.force * rate
        speed, bend = float(rate[a]), float(rate[a] - rate[a - 1]) / before
        root = sqrt(max(speed * speed - 2.0 * bend * float(stroke[a]), 0.0))
        ahead = min(2.0 * float(stroke[a]) / (root - speed), step)
        growth = float(power[a] + 0.5 * ahead * (power[a] - power[a - 1]) / before) * ahead
        return Point(float(self.time[a]) + ahead, 0.0, float(self.work[a]) + growth)

    def _sample(self, i: int) -> Point:
        return Point(float(self.time[i]), float(self.stroke[i]), float(self.work[i]))

    def _span(self, a: int, rate: Array) -> tuple[float, float, float]:
        """The stroke's change from the sample `a` to the next, and its slopes there."""
        step = float(self.time[a + 1] - self.time[a])
        change = float(self.stroke[a + 1] - self.stroke[a])
        return change, step * float(rate[a]), step * float(rate[a + 1])

    def _between(self, a: int, part: float) -> Point:
        """At this `part` of the span from the sample `a` to the next."""
        assert self.rate is not None
        way, first, last = self._span(a, self.rate)
        powers = (-float(self.force[a]) * first, -float(self.force[a + 1]) * last)
        here = self._sample(a)
        return Point(
            here.time + part * float(self.time[a + 1] - self.time[a]),
            here.stroke + _cubic(part, way, first, last),
            here.work + _cubic(part, float(self.work[a + 1] - self.work[a]), *powers),
        )


def _cubic(u: float, change: float, first: float, last: float) -> float:
    """Growth until the part `u` of a span: the cubic with these `change` and slopes at the ends."""
    return u * (first + u * (3.0 * change - 2.0 * first - last + u * (first + last - 2.0 * change)))


def _turning_part(change: float, first: float, last: float) -> float:
    """The part of a span at which its cubic turns; its slopes at the ends have unlike signs."""
    a = 3.0 * (first + last - 2.0 * change)
    half_b = 3.0 * change - 2.0 * first - last
    # of both roots the one at which the slope goes from the first sign to the last
    root = sqrt(half_b * half_b - a * first)
    return first / (-half_b + (root if first > 0.0 else -root)) if first else 0.0
