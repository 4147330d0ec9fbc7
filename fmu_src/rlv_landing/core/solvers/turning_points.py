"""Turning points of quantities: the maximum near three samples, by parabolic interpolation.

A `Bend` is three successive samples of a quantity, a `Crest` the maximum of the parabola through
them.
"""

from __future__ import annotations

from math import inf

from ..memory import Doubles
from ..records import Bend, Crest

# a quantity that changes by no more than this part of its last change has become constant
LEVEL = 1e-30
# a maximum is known well enough where the parabola rises above it by no more than this part of its
# size
ENOUGH = 2e-4
# and where no side falls by more than this part
STEEP = 0.0005
# between two samples that differ steeply, a kink may reach this part of their difference above the
# crest
HIDDEN = 0.5
# the next sample is no nearer to a known one than this part of the interval between two of them
NEAREST = 0.05


def expected(b: Bend, t: float) -> float:
    """The value at time `t` [s] of the parabola through the three points of `b`."""
    rise = (b.v1 - b.v0) / (b.t1 - b.t0)
    fall = (b.v2 - b.v1) / (b.t2 - b.t1)
    return b.v1 + (t - b.t1) * (rise + (t - b.t0) * (fall - rise) / (b.t2 - b.t0))


def crest(b: Bend) -> Crest:
    """The top of the parabola through the three points of `b`, whose middle one is highest."""
    before = b.t1 - b.t0
    after = b.t2 - b.t1
    rise = (b.v1 - b.v0) / before
    fall = (b.v2 - b.v1) / after
    if rise <= fall:
        return Crest(b.t1, b.v1)
    slope = (rise * after + fall * before) / (before + after)
    ahead = 0.5 * slope * (before + after) / (rise - fall)
    return Crest(b.t1 + ahead, b.v1 + 0.5 * slope * ahead)


def where_to_look(b: Bend, record: float, size: float, surprise: float) -> float:
    """The time [s] of the next sample in `b`, to find a value above the `record`.

    It is at the crest, away from the times that are known; in the middle of the longer interval if
    the parabola missed the last sample by a `surprise` that is large; in the middle of the steeper
    interval if that is so steep that it may hold a kink; -inf if a sample would not find much
    more, in parts of `size`.
    """
    top = crest(b)
    enough = ENOUGH * size
    steepest = max(b.v1 - b.v0, b.v1 - b.v2)
    before, after = b.t0 - b.t1, b.t2 - b.t1
    if surprise > enough and steepest > enough:
        ahead = 0.5 * (before if -before > after else after)
    elif top.value - record > enough:
        gap = before if top.t < b.t1 else after
        ahead = gap * min(max((top.t - b.t1) / gap, NEAREST), 1.0 - NEAREST)
    elif steepest > STEEP * size and top.value + HIDDEN * steepest > record:
        ahead = 0.5 * (before if b.v0 < b.v2 else after)
    else:
        return -inf
    t = b.t1 + ahead
    return t if b.t0 < t < b.t2 and t != b.t1 else -inf


def narrowed(b: Bend, t: float, v: float) -> Bend:
    """`b` with the point (`t`, `v`) in the place of one of its ends, the highest in the middle."""
    if v > b.v1:
        if t < b.t1:
            return Bend(b.t0, b.v0, t, v, b.t1, b.v1)
        return Bend(b.t1, b.v1, t, v, b.t2, b.v2)
    if t < b.t1:
        return Bend(t, v, b.t1, b.v1, b.t2, b.v2)
    return Bend(b.t0, b.v0, b.t1, b.v1, t, v)


def mark_turns(
    first: Doubles, middle: Doubles, following: Doubles, level: float, turns: Doubles, count: int
) -> None:
    """Write below 0 to `turns` for each quantity that turns in the middle of three times.

    One that becomes constant there counts as well. There are neither branches nor calls, so that
    the compiler takes several of the `count` quantities at once.
    """
    for i in range(count):
        rise = middle[i] - first[i]
        turns[i] = rise * (following[i] - middle[i] - level * rise)
