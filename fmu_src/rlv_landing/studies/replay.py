"""A landing's history with the landing's states on the way, to look between its samples."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

import numpy as np

from ..history import History
from ..landing import Landing
from ..outputs import Extreme

Holds = Callable[[Landing], bool]
# a time is found to this part of it, or to this [s]
RELATIVE, ABSOLUTE = 1e-12, 1e-9


class ReplayedHistory(History):
    """A history of a landing from its start, which can be repeated to any time of it.

    A repetition starts from the last state before that time, and takes the very same internal
    steps. The landing is at the end of the history again afterwards. States at which outputs were
    asked for are kept, too.

    Args:
        part: The history.
        landing: The landing, at its end. Its inputs are not set on the way.
        states: Times [s] and states on the way, ascending, the first at the start.
        stands_from: The sample from which on the vehicle stood until the end, where it ended so.
    """

    def __init__(
        self,
        part: History,
        landing: Landing,
        states: list[tuple[float, array[float]]],
        stands_from: int | None = None,
    ) -> None:
        super().__init__(
            part.time, part.names, part.data, part.parameters, part.ground, part.extremes
        )
        self.stands_from = stands_from
        self._landing = landing
        self._states = states

    def until(self, samples: int, extremes: Mapping[str, Extreme] | None = None) -> ReplayedHistory:
        """The landing until the last of so many `samples`; its extremes are exact."""
        if extremes is None:
            extremes = self.extremes_at(float(self.time[samples - 1]))
        return ReplayedHistory(super().until(samples, extremes), self._landing, self._states)

    def ending_at(self, t: float) -> ReplayedHistory:
        """The landing until time `t` [s], which replaces the first sample from then on."""
        last = int(np.searchsorted(self.time, t))
        with self._landing_at(t) as landing:
            values, extremes = landing.outputs(), landing.extremes()
        part = History(
            np.append(self.time[:last], t),
            self.names,
            np.vstack([self.data[:last], [values[name] for name in self.names]]),
            self.parameters,
            self.ground,
            extremes,
        )
        return ReplayedHistory(part, self._landing, self._states)

    def extremes_at(self, t: float) -> Mapping[str, Extreme]:
        """The extremes from the start to time `t` [s]."""
        with self._landing_at(t) as landing:
            return landing.extremes()

    @contextmanager
    def _landing_at(self, t: float) -> Iterator[Landing]:
        """The landing at time `t` [s]; it is at the end again afterwards."""
        landing, end = self._landing, self._landing.state()
        try:
            landing.restore(self._states[self._before(t)][1], checked=False)
            landing.advance_to(max(t, landing.time))
            yield landing
        finally:
            landing.restore(end, checked=False)

    @contextmanager
    def looks(self) -> Iterator[Callable[[float], Mapping[str, float]]]:
        """All outputs at any time [s]; the landing is at the end again afterwards."""
        landing, end = self._landing, self._landing.state()
        try:
            yield self._look
        finally:
            landing.restore(end, checked=False)

    def _look(self, t: float) -> Mapping[str, float]:
        landing, before = self._landing, self._before(t)
        known, state = self._states[before]
        if not known <= landing.time <= t:
            landing.restore(state, checked=False)
        if t > landing.time:
            landing.advance_to(t)
            self._states.insert(before + 1, (t, landing.state()))
        return landing.outputs()

    def settled_since(self) -> float | None:
        """The time [s] since when the vehicle has settled at the end; None where it has not."""
        with self._landing_at(float(self.time[-1])) as landing:
            return landing.settled_since

    def first_time(self, holds: Holds, after: float, before: float) -> float:
        """The first time [s] at which something `holds` that does not end again.

        Args:
            holds: Whether it holds for a landing at its present time.
            after: A time at which it does not hold [s].
            before: A later time at which it does [s].
        """
        landing, end = self._landing, self._landing.state()
        try:
            first, last = self._before(after), self._before(before)
            while first < last:
                middle = (first + last + 1) // 2
                landing.restore(self._states[middle][1], checked=False)
                if holds(landing):
                    last = middle - 1
                    before = min(before, landing.time)
                else:
                    first = middle
            landing.restore(self._states[first][1], checked=False)
            landing.advance_to(max(after, landing.time))
            return _bisected(landing, holds, before)
        finally:
            landing.restore(end, checked=False)

    def _before(self, t: float) -> int:
        """The number of the last state that is not after time `t` [s]."""
        return max(bisect_right(self._states, t, key=lambda s: s[0]) - 1, 0)


def _bisected(landing: Landing, holds: Holds, before: float) -> float:
    """The first time [s] at which something `holds`: after the landing's time, and `before`."""
    not_yet, state = landing.time, landing.state()
    while before - not_yet > max(ABSOLUTE, RELATIVE * before):
        middle = 0.5 * (not_yet + before)
        landing.advance_to(middle)
        if holds(landing):
            before = middle
            landing.restore(state, checked=False)
        else:
            not_yet, state = middle, landing.state()
    return before
