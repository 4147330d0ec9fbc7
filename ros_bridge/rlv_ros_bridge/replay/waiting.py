"""The waits of a replay until messages are due, in which keys and services are served."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from ..ros.setup import StopFlag
from .clock import ReplayClock
from .keyboard import Keyboard

# The system ends a sleep up to some hundred microseconds late, so the last part of a wait is a busy
# loop [s].
BUSY_WAIT_SECONDS = 300e-6
# Serving the node's services once costs half a millisecond. It is done every SERVICE_SECONDS if the
# next message is not due for SERVICE_GAP_SECONDS, else every LONGEST_SERVICE_SECONDS.
SERVICE_SECONDS = 0.05
SERVICE_GAP_SECONDS = 2e-3
LONGEST_SERVICE_SECONDS = 0.5
# Period of reading the keyboard [s], and the factor by which a cursor key changes the rate.
KEY_SECONDS = 0.02
RATE_FACTOR = 1.1


class ReplayWaits:
    """Waits until times of the log are due; meanwhile keys and services act on the clock.

    `quit` says whether a key has ended the replay.

    Args:
        clock: the replay's clock.
        keyboard: source of keys.
        stop: notes signals, which end the replay.
        serve: serves the node's services once, waiting at most the seconds given.
    """

    def __init__(
        self,
        clock: ReplayClock,
        keyboard: Keyboard,
        stop: StopFlag,
        serve: Callable[[float], object],
    ) -> None:
        self.quit = False
        self._clock, self._keyboard, self._stop, self._serve = clock, keyboard, stop, serve
        self._services_served = self._keyboard_read = 0.0

    @property
    def ended(self) -> bool:
        """Whether a signal or a key has ended the replay."""
        return bool(self._stop) or self.quit

    @property
    def status(self) -> str:
        """The rate, and whether the replay is paused."""
        return f"rate {self._clock.rate:.3g}{', paused' if self._clock.paused else ''}"

    def wait_until(self, position: float, bar: Any) -> bool:
        """Waits until the time `position` [s] of the log is due; False if the replay is to end.

        Args:
            position: the time.
            bar: tqdm's progress bar, which shows the status.
        """
        clock = self._clock
        while not self.ended:
            now = time.perf_counter()
            if self._keyboard.available and now - self._keyboard_read > KEY_SECONDS:
                self._keyboard_read = now
                self._handle_keys(self._keyboard.keys(), bar)
                continue
            left = clock.due(position) - now
            if left <= 0.0:
                return True
            if clock.paused:
                self._serve(KEY_SECONDS)
            elif left > BUSY_WAIT_SECONDS:
                unserved = now - self._services_served
                in_gap = unserved > SERVICE_SECONDS and left > SERVICE_GAP_SECONDS
                if in_gap or unserved > LONGEST_SERVICE_SECONDS:
                    self._serve(0.0)
                    self._services_served = time.perf_counter()
                else:
                    time.sleep(min(left - BUSY_WAIT_SECONDS, KEY_SECONDS))
        return False

    def _handle_keys(self, keys: Sequence[str], bar: Any) -> None:
        clock = self._clock
        for key in keys:
            now = time.perf_counter()
            if key == "space":
                (clock.resume if clock.paused else clock.pause)(now)
            elif key == "right":
                clock.step()
            elif key == "q":
                self.quit = True
            else:
                clock.change_rate(RATE_FACTOR if key == "up" else 1.0 / RATE_FACTOR, now)
        if keys:
            bar.set_postfix_str(self.status)
