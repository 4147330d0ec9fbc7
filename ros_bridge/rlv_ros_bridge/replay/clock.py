"""The time of a replay: goes on at a rate, stands still in a pause, steps from message to message."""

from __future__ import annotations

import math

# Beyond this lateness [s of wall time] the lost time is given up: to make it good would be a burst
# that no subscriber expects.
STALL_SECONDS = 0.1
SLOWEST, FASTEST = 1e-3, 1e3


class ReplayClock:
    """Which time of the log is due when.

    Times of the log in s since the replay's start, wall times in s of `time.perf_counter`.

    `lost` is the wall time that was given up after stalls [s].
    """

    def __init__(self, rate: float, paused: bool = False) -> None:
        self.rate = rate
        self.paused = paused
        self.lost = 0.0
        self._position = 0.0
        self._wall = 0.0
        self._steps = 0

    def start(self, now: float) -> None:
        """Time runs from `now` on, unless it is paused."""
        self._wall = now

    def due(self, position: float) -> float:
        """When the time `position` of the log is due: never in a pause, at once for a step that was
        asked for.
        """
        if self.paused:
            return -math.inf if self._steps else math.inf
        return self._wall + (position - self._position) / self.rate

    def passed(self, position: float) -> None:
        """A message of the time `position` was played. In a pause that was a step."""
        if self.paused:
            self._position = max(self._position, position)
            self._steps = max(0, self._steps - 1)

    def give_up(self, late: float) -> None:
        """Gives up the lateness `late` [s of wall time] where it comes of a stall."""
        if STALL_SECONDS < late < math.inf:
            self._wall += late
            self.lost += late

    def pause(self, now: float) -> bool:
        """Time stands still; whether it ran before."""
        if self.paused:
            return False
        self._anchor(now)
        self.paused = True
        return True

    def resume(self, now: float) -> bool:
        """Time goes on where it stood; whether it stood."""
        if not self.paused:
            return False
        self.paused, self._wall, self._steps = False, now, 0
        return True

    def step(self, now: float = 0.0) -> bool:
        """One message more; whether that was possible, which it is in a pause only.

        `now` is of no account.
        """
        self._steps += self.paused
        return self.paused

    def change_rate(self, factor: float, now: float) -> None:
        """Time goes on `factor` times as fast, within the bounds of `--rate`."""
        if not self.paused:
            self._anchor(now)
        self.rate = min(max(self.rate * factor, SLOWEST), FASTEST)

    def _anchor(self, now: float) -> None:
        self._position += (now - self._wall) * self.rate
        self._wall = now
