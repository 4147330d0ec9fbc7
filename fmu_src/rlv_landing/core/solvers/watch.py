"""The extremes of every output along the path of a system, whatever the communication step.

At the end of each internal step the outputs are known without a further call of the right-hand
side. Where an output turns there, its extreme lies in the step before or after; if the parabola
through the outputs at the three ends may pass the extreme so far, it is searched on the
interpolant.
"""

from __future__ import annotations

from array import array
from math import fabs, inf

from ..bodies.system import System
from ..memory import Buffer, Doubles, copy, data
from ..records import Bend
from .path import Path
from .turning_points import LEVEL, expected, mark_turns, narrowed, where_to_look

# a maximum near three samples is no higher above the middle one than so many times the larger of
# its differences from the other two
REACH = 2.0
# the accuracy of an extreme is a part of its size, or of this share of the output's range so far
SHARE = 0.1
# samples of the search for one extreme, at most, beside those taken for other outputs
LOOKS = 20
# how many samples of a search are kept for the other outputs that turn in the same place
SHARED = 32


class Watch(Path):
    """A path whose outputs' extremes are kept.

    Extremes are four blocks of `row` numbers: least values, their times [s], greatest values, their
    times. `kept` are those from `t_start` to the start of the last step, in which the present time
    lies; `span` those from `t_span` on, which is infinite where no span is open.

    `last`, `middle`, `before` [row] are the outputs at `t`, `t_old`, `t_before`; `seen` tells how
    many of them there are since the path began or inputs jumped, `noted` whether `middle` has been
    judged.
    """

    row: int
    t_start: float
    t_span: float
    seen: int
    noted: bool
    kept: Buffer
    span: Buffer
    before: Buffer
    middle: Buffer
    last: Buffer
    _end: Buffer
    _half: Buffer
    _now: Buffer
    _look: Buffer
    _samples: Buffer
    _sampled: Buffer
    _sample_count: int
    _turns: Buffer
    _y_look: Buffer

    def __init__(self, system: System) -> None:
        super().__init__(system)
        row = system.row
        self.row = row
        self.t_start = 0.0
        self.t_span = inf
        self.seen = 0
        self.noted = True
        self.kept = array("d", bytes(8 * 4 * row))
        self.span = array("d", bytes(8 * 4 * row))
        self.before = array("d", bytes(8 * row))
        self.middle = array("d", bytes(8 * row))
        self.last = array("d", bytes(8 * row))
        self._end = array("d", bytes(8 * row))
        self._half = array("d", bytes(8 * row))
        self._now = array("d", bytes(8 * row))
        self._look = array("d", bytes(8 * row))
        self._samples = array("d", bytes(8 * SHARED * row))
        self._sampled = array("d", bytes(8 * SHARED))
        self._sample_count = 0
        self._turns = array("d", bytes(8 * row))
        self._y_look = array("d", bytes(8 * system.n))

    def extremes(self, t: float, found: Buffer) -> None:
        """Write the extremes from the start to the time `t` [s] to `found` [4 row].

        The time is inside the last internal step.
        """
        copy(data(self.kept), data(found), 4 * self.row)
        self._watch_until(t, data(found), self.t_start)

    def open_span(self, t: float) -> None:
        """Keep extremes from time `t` [s] on, beside those from the start.

        The time is inside the last internal step; at the start both are the same.
        """
        if t <= self.t_start:
            return
        self.t_span = t
        self._row_at(t, data(self._now), 0)
        self._begin(data(self._now), t, data(self.span))

    def extremes_of_span(self, t: float, found: Buffer) -> None:
        """Write the extremes from the time of `open_span` to `t` [s] to `found` [4 row].

        The time is inside the last internal step.
        """
        if self.t_span < inf:
            copy(data(self.span), data(found), 4 * self.row)
            self._watch_until(t, data(found), self.t_span)
        else:
            self.extremes(t, found)

    def close_span(self) -> None:
        """Keep the extremes from the start only."""
        self.t_span = inf

    def _row_at(self, t: float, rows: Doubles, at: int) -> None:
        """Write the outputs at time `t` [s], inside one of the last two steps, to `rows[at:]`."""
        y = data(self._y_look)
        self._interpolate_back(t, y)
        self._outputs_at(t, y, rows, at)

    def _start_rows(self, y: Doubles, dy: Doubles) -> None:
        """Begin at time `t` at the state `y`, whose rates are `dy`, before the first step."""
        self.seen = 1
        self.noted = True
        self.system.read(y, data(self.u_now), dy, data(self.last), 0)
        self._judge_rest(data(self.last))
        # not read before there are steps; filled so that a saved state holds nothing from before
        copy(data(self.last), data(self.middle), self.row)
        copy(data(self.last), data(self.before), self.row)
        if self.t == self.t_start:
            self._begin(data(self.last), self.t, data(self.kept))

    def _read_end(self, y: Doubles, dy: Doubles) -> None:
        """Read the outputs at the end of a step, at the state `y`, whose rates are `dy`."""
        self.system.read(y, data(self.u_now), dy, data(self._end), 0)

    def _next_row(self) -> None:
        """Keep the outputs that were read at the end of a step."""
        copy(data(self.middle), data(self.before), self.row)
        copy(data(self.last), data(self.middle), self.row)
        self.seen = min(self.seen + 1, 3)
        self.noted = False
        copy(data(self._end), data(self.last), self.row)

    def _note_step(self) -> None:
        """Judge the outputs at the start of the last step, which is about to be left behind."""
        self.noted = True
        self._judge_middle(data(self.last), self.t, data(self.kept), self.t_start)
        if self.t_span < inf:
            self._judge_middle(data(self.last), self.t, data(self.span), self.t_span)

    def _watch(self, t: float) -> None:
        """Bring the extremes that are kept to the time `t` [s] inside the last step.

        The path ends or stays there.
        """
        self._watch_until(t, data(self.kept), self.t_start)
        if self.t_span < inf:
            self._watch_until(t, data(self.span), self.t_span)

    def _watch_until(self, t: float, found: Doubles, since: float) -> None:
        """Bring the extremes `found`, kept since a time, to the time `t` [s].

        It is inside the last step.
        """
        half, now = data(self._half), data(self._now)
        if t > self.t_old:
            middle = 0.5 * (self.t_old + t)
            self._row_at(middle, half, 0)
            self._row_at(t, now, 0)
            self._judge_middle(half, middle, found, since)
            self._judge(self.t_old, data(self.middle), middle, half, t, now, found, since)
            self._note_row(now, t, found, since)
        elif self.seen == 1:
            self._note_row(data(self.last), t, found, since)
        else:
            self._note_row(data(self.middle), t, found, since)

    def _judge_middle(self, following: Doubles, t: float, found: Doubles, since: float) -> None:
        """Judge the outputs at the last step's start.

        Those after it are `following`, at time `t` [s].
        """
        middle = data(self.middle)
        if self.seen > 2:
            self._judge(
                self.t_before, data(self.before), self.t_old, middle, t, following, found, since
            )
        else:
            self._note_row(middle, self.t_old, found, since)

    def _judge(  # noqa: PLR0913  three times with their outputs
        self,
        t0: float,
        first: Doubles,
        t1: float,
        middle: Doubles,
        t2: float,
        following: Doubles,
        found: Doubles,
        since: float,
    ) -> None:
        """Update the extremes `found` by the outputs that turn in the `middle` or near it."""
        if t1 < since:
            return
        if t1 <= t0 or t2 <= t1:
            self._note_row(middle, t1, found, since)
            return
        self._sample_count = 0
        turns = data(self._turns)
        mark_turns(first, middle, following, LEVEL, turns, self.row)
        for i in range(self.row):
            if turns[i] < 0.0 and self._may_raise(i, first[i], middle[i], following[i], found):
                sign = 1.0 if middle[i] > first[i] else -1.0
                b = Bend(t0, sign * first[i], t1, sign * middle[i], t2, sign * following[i])
                self._raise(i, sign, b, found, since)

    def _may_raise(self, i: int, v0: float, v1: float, v2: float, found: Doubles) -> bool:
        """Whether the output `i` may be beyond the extremes `found` where it turns at `v1`."""
        reach = REACH * max(fabs(v1 - v0), fabs(v1 - v2))
        if v1 > v0:
            return v1 + reach > found[2 * self.row + i]
        return v1 - reach < found[i]

    def _raise(self, i: int, sign: float, b: Bend, found: Doubles, since: float) -> None:
        """Search the samples `b` of `sign` times the output `i` for a value beyond the extreme.

        The samples that other outputs have asked for are used first.
        """
        at = (2 * self.row if sign > 0.0 else 0) + i
        self._put_higher(at, sign, b.t1, b.v1, found)
        if i == self.system.unsought:
            return
        size = max(fabs(b.v1), SHARE * (found[2 * self.row + i] - found[i]))
        surprise = 0.0
        known = self._sample_count
        for k in range(known + LOOKS):
            t = where_to_look(b, sign * found[at], size, surprise)
            if t < since:
                return
            place = k if k < known else self._take_sample(t)
            t = self._sampled[place]
            if since <= t and b.t0 < t < b.t2 and t != b.t1:
                value = sign * self._samples[place * self.row + i]
                self._put_higher(at, sign, t, value, found)
                if value == b.v1:
                    return
                surprise = fabs(value - expected(b, t))
                b = narrowed(b, t, value)

    def _take_sample(self, t: float) -> int:
        """Read the outputs at time `t` [s] for all outputs that turn there; return their place."""
        place = min(self._sample_count, SHARED - 1)
        self._sample_count = place + 1
        self._sampled[place] = t
        self._row_at(t, data(self._samples), place * self.row)
        return place

    def _put_higher(self, at: int, sign: float, t: float, value: float, found: Doubles) -> None:
        """Keep `value` at time `t` [s], `sign` times an output, if it is a new extreme.

        The extreme so far is `found[at]`.
        """
        if value > sign * found[at]:
            found[at] = sign * value
            found[at + self.row] = t

    def _begin(self, outputs: Doubles, t: float, found: Doubles) -> None:
        """Begin the extremes `found` with the `outputs` at time `t` [s]."""
        n = self.row
        for i in range(n):
            found[i] = outputs[i]
            found[n + i] = t
            found[2 * n + i] = outputs[i]
            found[3 * n + i] = t

    def _note_row(self, outputs: Doubles, t: float, found: Doubles, since: float) -> None:
        """Update the extremes `found` by the `outputs` at time `t` [s]."""
        if t < since:
            return
        n = self.row
        for i in range(n):
            value = outputs[i]
            if value < found[i]:
                found[i] = value
                found[n + i] = t
            if value > found[2 * n + i]:
                found[2 * n + i] = value
                found[3 * n + i] = t
