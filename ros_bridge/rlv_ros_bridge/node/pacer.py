"""Keeps a loop to the wall clock, and counts where it does not succeed."""

from __future__ import annotations

import math
import time
from array import array
from collections.abc import Callable, Sequence

# Beyond this the lost time is given up: to make it good would be a burst that no subscriber
# expects.
STALL_SECONDS = 0.1
LOOK_ROUND_SECONDS = 0.05


class Pacer:
    """Holds step k back until `start + (k - first) * period` [s] of wall time; a period of 0 never
    holds back.

    The start is fixed, so that single late steps do not add up. `late_steps` began more than one
    period too late; `lost` [s] is time given up after stalls; `lateness` [s] is that of each
    sample's publication.
    """

    def __init__(self, period: float) -> None:
        self.period = period
        self.late_steps = 0
        self.lost = 0.0
        self.lateness = array("d")
        self._active = 0.0
        self._started: float | None = None
        self._start = time.perf_counter()
        self._first = 0

    def start(self, k: int, period: float) -> None:
        """Time runs from now on, at the step k; also after a pause and for a new period."""
        self.stop()
        self.period = period
        self._first = k
        self._started = self._start = time.perf_counter()

    def stop(self) -> None:
        """A pause: time stands still until the next start."""
        self._active = self.elapsed
        self._started = None

    @property
    def elapsed(self) -> float:
        """Wall time in which time ran [s]."""
        return self._active + (
            time.perf_counter() - self._started if self._started is not None else 0.0
        )

    def due(self, k: int) -> float:
        """When step k is due, on `time.perf_counter`'s clock [s]; the past where nothing is held
        back.
        """
        return self._start + (k - self._first) * self.period

    def hold(self, k: int, interrupted: Callable[[], bool]) -> bool:
        """Sleeps until step k is due; False where `interrupted` gets true meanwhile."""
        if not self.period:
            return not interrupted()
        while (left := self.due(k) - time.perf_counter()) > 0.0:
            time.sleep(min(left, LOOK_ROUND_SECONDS))
            if left > LOOK_ROUND_SECONDS and interrupted():
                return False
        late = -left
        if late > self.period:
            self.late_steps += 1
        if late > max(STALL_SECONDS, self.period):
            self._start += late
            self.lost += late
        return not interrupted()

    def note_published(self, due: float) -> None:
        """The sample that was due at `due` is published now."""
        self.lateness.append(max(0.0, time.perf_counter() - due))


def spread(lateness: Sequence[float]) -> tuple[float, float, float]:
    """What half of the values, 99 % of them, and all of them stay at or below; 0 where there are
    none.
    """
    ordered = sorted(lateness)
    half, most, all_of_them = (
        ordered[math.ceil(part * len(ordered)) - 1] if ordered else 0.0 for part in (0.5, 0.99, 1.0)
    )
    return half, most, all_of_them
