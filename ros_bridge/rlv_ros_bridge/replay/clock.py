"""The time of a replay: it runs at a rate, pauses, and steps from message to message."""

from __future__ import annotations

import math

from ..node.pacer import STALL_SECONDS

SLOWEST, FASTEST = 1e-3, 1e3


class ReplayClock:
    """Maps times of the log to wall times.

    Times of the log are in s since the replay's start, wall times in s of `time.perf_counter`.
    `lost` is wall time that was not made up for after stalls [s].

    Args:
        rate: seconds of the log per second of wall time.
        paused: begin in a pause.
    """

    def __init__(self, rate: float, *, paused: bool = False) -> None:
        self.rate = rate
        self.paused = paused
        self.lost = 0.0
        self._position = 0.0
        self._wall = 0.0
        self._steps = 0

    def start(self, now: float) -> None:
        """Starts the time at the wall time `now` [s], unless it is paused."""
        self._wall = now

    def due(self, position: float) -> float:
        """The wall time at which the time `position` of the log is due [s].

        In a pause it is infinite, or minus infinity while steps are requested.
        """
        if self.paused:
            return -math.inf if self._steps else math.inf
        return self._wall + (position - self._position) / self.rate

    def mark_played(self, position: float) -> None:
        """Notes that a message of the time `position` was played; in a pause that ends a step."""
        if self.paused:
            self._position = max(self._position, position)
            self._steps = max(0, self._steps - 1)

    def skip_stall(self, late: float) -> None:
        """Skips the lateness `late` [s of wall time] if it is that of a stall."""
        if STALL_SECONDS < late < math.inf:
            self._wall += late
            self.lost += late

    def pause(self, now: float) -> bool:
        """Stops the time; whether it was running."""
        if self.paused:
            return False
        self._anchor(now)
        self.paused = True
        return True

    def resume(self, now: float) -> bool:
        """Continues from where the time was stopped; whether it was stopped."""
        if not self.paused:
            return False
        self.paused, self._wall, self._steps = False, now, 0
        return True

    def step(self, now: float = 0.0) -> bool:
        """Requests one message in a pause; whether there is a pause.

        `now` is unused: pause, resume and step are called alike by the services.
        """
        self._steps += self.paused
        return self.paused

    def change_rate(self, factor: float, now: float) -> None:
        """Multiplies the rate by `factor`, within the bounds of `--rate`."""
        if not self.paused:
            self._anchor(now)
        self.rate = min(max(self.rate * factor, SLOWEST), FASTEST)

    def _anchor(self, now: float) -> None:
        self._position += (now - self._wall) * self.rate
        self._wall = now
