"""Keeps a loop to the wall clock."""

from __future__ import annotations

import time
from statistics import median

# Beyond this the lost time is given up: to make it good would be a burst that no subscriber expects.
STALL_SECONDS = 0.1


class Pacer:
    """Holds step k back until `start + k * period` [s] of wall time; a period of 0 never holds back.

    The start is fixed, so that single late steps do not add up. `late_steps` began more than one period too late; `lost` [s] is time
    given up after stalls; `lateness` [s] is kept for every step.
    """

    def __init__(self, period: float) -> None:
        self.period = period
        self.late_steps = 0
        self.lost = 0.0
        self.lateness: list[float] = []
        self.started = self._start = time.perf_counter()

    def start(self) -> None:
        """Time runs from now."""
        self.started = self._start = time.perf_counter()

    @property
    def elapsed(self) -> float:
        """Wall time since the start [s]."""
        return time.perf_counter() - self.started

    def spare(self, k: int) -> float:
        """Wall time left until step k is due [s]; infinite where nothing is held back, since then no step is due."""
        return self._start + k * self.period - time.perf_counter() if self.period else float("inf")

    def hold(self, k: int, longest: float = 0.05) -> bool:
        """Sleeps until step k is due, at most `longest` [s], so that the caller can look round; whether it is due now."""
        if not self.period:
            return True
        left = self.spare(k)
        if left > 0.0:
            time.sleep(min(left, longest))
            if left > longest:
                return False
        self._note(-self.spare(k))
        return True

    def _note(self, late: float) -> None:
        self.lateness.append(late)
        if late > self.period:
            self.late_steps += 1
        if late > max(STALL_SECONDS, self.period):
            self._start += late
            self.lost += late

    def median_lateness(self) -> float:
        """Median lateness of the steps so far [s]."""
        return median(self.lateness) if self.lateness else 0.0

    def largest_lateness(self) -> float:
        """Largest lateness of the steps so far [s]."""
        return max(self.lateness, default=0.0)
