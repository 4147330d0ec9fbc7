"""The harmonics of a deck's motion at sea, from the user's parameters.

The spectrum is cut into bands of one width. Each has one harmonic with the band's variance, so that
the variance of the waves is Hs^2/16 by construction. Its phase, and its frequency in the band, are
drawn by the seed: so the sea does not repeat. Amplitudes are not drawn. [closure]
"""

from __future__ import annotations

from array import array
from bisect import bisect_right
from cmath import rect
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import cos, exp, pi, sin, sqrt
from typing import NamedTuple

from ..core import Sea as SeaKernel
from ..core.bodies.sea import FREEDOMS
from ..errors import LandingError
from ..parameters import Parameters, Sea
from ..parameters.operators import FREEDOMS as NAMES
from ..parameters.operators import TURNS, Operators, read_operators, turned_into
from ..parameters.sea import HIGHEST, LOWEST, WAVE_GRAVITY
from ..quantities import SPACE

HARMONICS = 64
# parts of a band over which its variance is integrated, by Simpson's rule
PARTS = 8
# the largest significant amplitude of an angle of the deck [rad]
MOST_TURN = 0.5
_LOW64 = 2**64 - 1
# constants of Philox4x64 (Salmon, Moraes, Dror and Shaw, Parallel random numbers: as easy as
# 1, 2, 3, SC11): multipliers and Weyl steps
_MULTIPLIERS = (0xD2E7470EE14C6C93, 0xCA5A826395121157)
_STEPS = (0x9E3779B97F4A7C15, 0xBB67AE8584CAA73B)
_ROUNDS = 10


class Waves(NamedTuple):
    """The harmonics of a deck's motion.

    Attributes:
        numbers: Those of each harmonic, see `core.bodies.sea`.
        window: Length of a window [s].
        start: Time of the sea at time 0 of the landing [s].
    """

    numbers: array[float]
    window: float
    start: float

    def kernel(self) -> SeaKernel:
        """The kernel that gives the motion, with a memory of its own."""
        return SeaKernel(self.numbers, self.window, self.start)


CALM = Waves(array("d"), 1.0, 0.0)


def waves_of(parameters: Parameters) -> Waves:
    """The motion of the deck in the parameters' sea; `CALM` where there is none.

    Raises:
        LandingError: The deck would turn too far.
    """
    sea = parameters.sea
    if parameters.drop.mode != SPACE or sea.wave_height == 0.0:
        return CALM
    numbers, window = _harmonics(replace(sea, seed=float(int(sea.seed)), time=0.0))
    return Waves(numbers, window, sea.time - parameters.drop.contact_time)


def spectrum(sea: Sea, frequency: float) -> float:
    """The JONSWAP spectrum at a `frequency` [rad/s], of any size."""
    peak = 2.0 * pi / sea.peak_period
    ratio = peak / frequency
    width = 0.07 if frequency <= peak else 0.09
    off = (frequency - peak) / (width * peak)
    enhanced: float = sea.peak_enhancement ** exp(-0.5 * off * off)
    return ratio**5 * exp(-1.25 * ratio**4) * enhanced


def wave_components(sea: Sea) -> Iterator[tuple[float, float, float]]:
    """Frequency [rad/s], amplitude [m] and phase [rad] of each wave.

    Its elevation at the ship is amplitude times cos(frequency t + phase).
    """
    peak = 2.0 * pi / sea.peak_period
    width = (HIGHEST - LOWEST) * peak / HARMONICS
    edges = [LOWEST * peak + k * width for k in range(HARMONICS)]
    shares = [_integral(sea, edge, width) for edge in edges]
    part = sea.wave_height**2 / 16.0 / sum(shares)
    drawn = uniform(int(sea.seed), 2 * HARMONICS)
    for edge, share, at, phase in zip(edges, shares, drawn[::2], drawn[1::2]):
        yield edge + at * width, sqrt(2.0 * part * share), 2.0 * pi * phase


def uniform(key: int, count: int) -> list[float]:
    """So many numbers in [0, 1): those of numpy's `Generator(Philox(key=key)).random(count)`."""
    found: list[float] = []
    block = 0
    while len(found) < count:
        block += 1
        found += [(word >> 11) * 2.0**-53 for word in _philox((block, 0, 0, 0), (key, 0))]
    return found[:count]


def _philox(counter: tuple[int, int, int, int], key: tuple[int, int]) -> tuple[int, ...]:
    a, b, c, d = counter
    first, second = key
    for _ in range(_ROUNDS):
        p, q = _MULTIPLIERS[0] * a, _MULTIPLIERS[1] * c
        a, b, c, d = (q >> 64) ^ b ^ first, q & _LOW64, (p >> 64) ^ d ^ second, p & _LOW64
        first, second = (first + _STEPS[0]) & _LOW64, (second + _STEPS[1]) & _LOW64
    return a, b, c, d


def _integral(sea: Sea, edge: float, width: float) -> float:
    step = width / PARTS
    weights = (1.0, *(4.0, 2.0) * (PARTS // 2 - 1), 4.0, 1.0)
    return sum(w * spectrum(sea, edge + k * step) for k, w in enumerate(weights)) * step / 3.0


@lru_cache(maxsize=16)
def _harmonics(sea: Sea) -> tuple[array[float], float]:
    """The numbers of the harmonics, which nobody writes to, and the length of a window [s]."""
    numbers = array("d")
    variances = [0.0] * FREEDOMS
    table = read_operators(sea.operators) if sea.operators else None
    for frequency, amplitude, phase in wave_components(sea):
        answers = _barge(sea, frequency) if table is None else _from_table(table, sea, frequency)
        numbers.append(frequency)
        for j, answer in enumerate(_at_deck(sea, answers)):
            moved = amplitude * answer * rect(1.0, phase)
            # the real part of moved e^(i w t)
            numbers.extend((moved.real, -moved.imag))
            variances[j] += 0.5 * abs(moved) ** 2
    for name, variance in zip(NAMES, variances):
        significant = 2.0 * sqrt(variance)
        if name in TURNS and significant > MOST_TURN:
            raise LandingError(
                f"sea: the deck's {name} has a significant amplitude of {significant:.3g} rad, the "
                f"limit is {MOST_TURN:g} rad; lower sea.wave_height = {sea.wave_height:g} m, or "
                "check sea.operators"
            )
    return numbers, 1.0 / (HIGHEST * 2.0 * pi / sea.peak_period)


def _at_deck(sea: Sea, answers: list[complex]) -> list[complex]:
    """The operators of the deck's origin, from those of the ship's point; small angles."""
    surge, heave, sway, roll, yaw, tilt = answers
    x, y, z = sea.deck_x, sea.deck_y, sea.deck_z
    return [
        surge + yaw * z + tilt * y,
        heave - tilt * x - roll * z,
        sway + roll * y - yaw * x,
        roll,
        yaw,
        tilt,
    ]


def _barge(sea: Sea, frequency: float) -> list[complex]:
    """The operators of a barge that moves as the water does which it displaces.

    Deep water; heave is the surface's mean over length and beam, surge and sway the mean way of the
    water, tilt, roll and yaw the slopes of the lines that fit best; all fall with the draught.
    There is no resonance. [closure]
    """
    k = frequency * frequency / WAVE_GRAVITY
    along, across = cos(sea.direction), sin(sea.direction)
    u, v = 0.5 * k * sea.ship_length * along, 0.5 * k * sea.ship_beam * across
    depth = exp(-k * sea.ship_draught)
    mean = depth * _mean(u) * _mean(v)
    by_length, by_beam = depth * _slope(u) * _mean(v), depth * _mean(u) * _slope(v)
    return [
        -1j * along * mean,
        complex(mean),
        -1j * across * mean,
        1j * k * across * by_beam,
        complex(k * along * across * by_length),
        1j * k * along * by_length,
    ]


def _mean(u: float) -> float:
    """The mean of cos over [-u, u]."""
    return sin(u) / u if abs(u) > 1e-4 else 1.0 - u * u / 6.0


def _slope(u: float) -> float:
    """The slope of the line that fits sin best over [-u, u]: 1 for small u."""
    return 3.0 * (sin(u) - u * cos(u)) / u**3 if abs(u) > 1e-2 else 1.0 - u * u / 10.0


def _from_table(table: Operators, sea: Sea, frequency: float) -> list[complex]:
    """The operators of a table, linear between its nodes as complex numbers."""
    i, part = _between(table.frequencies, frequency)
    turned = turned_into(table, sea.direction)
    j, aside = _between(table.directions, sea.direction if turned is None else turned)
    found = [0j] * FREEDOMS
    for row, share in ((j, 1.0 - aside), (j + 1, aside)):
        for column, weight in ((i, share * (1.0 - part)), (i + 1, share * part)):
            if weight > 0.0:
                node = table.rows[row * len(table.frequencies) + column]
                pairs = zip(node[::2], node[1::2])
                found = [f + weight * rect(size, lead) for f, (size, lead) in zip(found, pairs)]
    return found


def _between(nodes: tuple[float, ...], value: float) -> tuple[int, float]:
    """The node before a value, and the part of the way to the next one."""
    i = min(max(bisect_right(nodes, value) - 1, 0), max(len(nodes) - 2, 0))
    if len(nodes) == 1:
        return 0, 0.0
    part = (value - nodes[i]) / (nodes[i + 1] - nodes[i])
    return i, min(max(part, 0.0), 1.0)
