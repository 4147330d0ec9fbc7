"""The motion of a deck in a sea: a sum of harmonics, at any time, with its rates.

A sum at each call would cost more than the vehicle. Time is cut into windows of one length, counted
from 0. In each window the sum is a Taylor series about the window's middle, whose remainder is
below rounding; the rates are the derivatives of the same series. It is a function of time alone.
"""

from __future__ import annotations

from array import array
from math import cos, floor, inf, sin

from ..memory import Buffer, Doubles, data

# degrees of freedom, in the order of the inputs: surge, heave, sway, roll, yaw, tilt
FREEDOMS = 6
# numbers of a harmonic: its frequency [rad/s], then each freedom's parts along cosine and sine
WAVE = 13
# terms of the series: in a window the fastest harmonic turns by half a radian from the middle, and
# 0.5^14/14! of its amplitude is left out
TERMS = 14


def open_window(waves: Doubles, count: int, middle: float, terms: Doubles) -> None:
    """Write the series about the time `middle` [s] to `terms`, freedom by freedom.

    Args:
        waves: The harmonics, WAVE numbers each.
        count: How many there are.
        middle: The time about which the series is made [s].
        terms: Where to write it, TERMS numbers a freedom.
    """
    for k in range(FREEDOMS * TERMS):
        terms[k] = 0.0
    for i in range(count):
        w = waves[WAVE * i]
        along = cos(w * middle)
        across = sin(w * middle)
        for j in range(FREEDOMS):
            a = waves[WAVE * i + 1 + 2 * j]
            b = waves[WAVE * i + 2 + 2 * j]
            even = a * along + b * across
            odd = b * along - a * across
            power = 1.0
            for n in range(0, TERMS, 2):
                terms[TERMS * j + n] += even * power
                power = power * w / (n + 1)
                terms[TERMS * j + n + 1] += odd * power
                power = -power * w / (n + 2)


def add_series(terms: Doubles, dt: float, now: Doubles, at: int) -> None:
    """Add each freedom's place and rate `dt` [s] from a window's middle to `now[at:]`."""
    for j in range(FREEDOMS):
        place = terms[TERMS * j + TERMS - 1]
        rate = 0.0
        for n in range(TERMS - 1):
            rate = rate * dt + place
            place = place * dt + terms[TERMS * j + TERMS - 2 - n]
        now[at + 2 * j] += place
        now[at + 2 * j + 1] += rate


def add_curvatures(terms: Doubles, dt: float, rates: Doubles) -> None:
    """Add each freedom's acceleration `dt` [s] from a window's middle to `rates`."""
    for j in range(FREEDOMS):
        place = terms[TERMS * j + TERMS - 1]
        rate = half = 0.0
        for n in range(TERMS - 1):
            half = half * dt + rate
            rate = rate * dt + place
            place = place * dt + terms[TERMS * j + TERMS - 2 - n]
        rates[j] += 2.0 * half


class Sea:
    """The motion of a deck in a sea.

    Args:
        waves: The harmonics, WAVE numbers each; none for a deck at rest.
        window: Length of a window [s].
        start: Time of the sea at time 0 [s].

    Attributes:
        count: How many harmonics there are.
    """

    count: int
    _waves: Buffer
    _window: float
    _start: float
    # the window that `_terms` holds
    _at: float
    _terms: Buffer

    def __init__(self, waves: Buffer, window: float, start: float) -> None:
        self.count = len(waves) // WAVE
        self._waves = array("d", [*waves, 0.0])
        self._window = window
        self._start = start
        self._at = inf
        self._terms = array("d", bytes(8 * FREEDOMS * TERMS))

    def add_to(self, t: float, now: Doubles, at: int) -> None:
        """Add each freedom's place [m, rad] and its rate at time `t` [s] to `now[at:]`."""
        dt = self._in_window(t)
        add_series(data(self._terms), dt, now, at)

    def add_accelerations(self, t: float, rates: Doubles) -> None:
        """Add each freedom's acceleration [m/s2, rad/s2] at time `t` [s] to `rates` [FREEDOMS]."""
        dt = self._in_window(t)
        add_curvatures(data(self._terms), dt, rates)

    def _in_window(self, t: float) -> float:
        """Open the window of the time `t` [s]; return how far that is from its middle [s]."""
        time = self._start + t
        number = floor(time / self._window)
        middle = (number + 0.5) * self._window
        if number != self._at:
            self._at = number
            open_window(data(self._waves), self.count, middle, data(self._terms))
        return time - middle

    def places(self, times: Buffer, count: int, rows: Buffer) -> None:
        """Write each freedom's place and rate at so many `times` [s] to `rows`."""
        given = data(times)
        found = data(rows)
        for i in range(count):
            for k in range(2 * FREEDOMS):
                found[2 * FREEDOMS * i + k] = 0.0
            self.add_to(given[i], found, 2 * FREEDOMS * i)
