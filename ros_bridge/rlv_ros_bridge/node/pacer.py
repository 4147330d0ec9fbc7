"""Paces a loop by the wall clock, and counts the steps that are late."""

from __future__ import annotations

import math
import time
from array import array
from collections.abc import Callable, Sequence

# A longer delay is not made up for: subscribers do not expect such a burst of messages.
STALL_SECONDS = 0.1
# Longest sleep before the interruption is checked [s].
INTERRUPT_POLL_SECONDS = 0.05
# Weight of a new value in a running mean.
MEAN_WEIGHT = 1.0 / 32.0


class RunningMean:
    """The mean of the last values, 0 before the first; older ones fade away.

    `value` is the mean.
    """

    def __init__(self) -> None:
        self.value = 0.0

    def add(self, value: float) -> None:
        """Takes a new value in."""
        self.value += MEAN_WEIGHT * (value - self.value)


class Pacer:
    """Delays step k until `start + (k - first) * period` of wall time [s].

    The start is fixed, so that single late steps do not add up. A period of 0 never delays.
    `late_steps` counts steps that began more than one period late. `lost` is wall time that was not
    made up for after stalls [s]. `lateness` is that of each sample's publication [s].
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
        """Starts at step k with `period` [s]; also after a pause and for a new period."""
        self.stop()
        self.period = period
        self._first = k
        self._started = self._start = time.perf_counter()

    def stop(self) -> None:
        """Pauses: `elapsed` stays as it is until the next start."""
        self._active = self.elapsed
        self._started = None

    @property
    def elapsed(self) -> float:
        """Wall time between starts and stops [s]."""
        running = time.perf_counter() - self._started if self._started is not None else 0.0
        return self._active + running

    def due(self, k: int) -> float:
        """Time of step k on `time.perf_counter`'s clock [s]; in the past for a period of 0."""
        return self._start + (k - self._first) * self.period

    def sleep_until_due(self, k: int, interrupted: Callable[[], bool]) -> None:
        """Sleeps until step k is due, or `interrupted` returns true; counts lateness and stalls."""
        if not self.period:
            return
        while (left := self.due(k) - time.perf_counter()) > 0.0:
            time.sleep(min(left, INTERRUPT_POLL_SECONDS))
            if left > INTERRUPT_POLL_SECONDS and interrupted():
                return
        late = -left
        if late > self.period:
            self.late_steps += 1
        if late > max(STALL_SECONDS, self.period):
            self._start += late
            self.lost += late

    def note_published(self, due: float) -> None:
        """Notes that the sample that was due at `due` [s] has been published."""
        self.lateness.append(max(0.0, time.perf_counter() - due))


def lateness_percentiles(lateness: Sequence[float]) -> tuple[float, float, float]:
    """Median, 99th percentile and maximum of the lateness [s]; 0 where there is none."""
    ordered = sorted(lateness)
    median, p99, largest = (
        ordered[math.ceil(share * len(ordered)) - 1] if ordered else 0.0
        for share in (0.5, 0.99, 1.0)
    )
    return median, p99, largest
