"""Ends a command on SIGTERM so that it cleans up."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def exit_on_sigterm() -> Iterator[None]:
    """Turns SIGTERM into SystemExit with code 143: the command then cleans up as after Ctrl-C."""

    def exit_with_signal(number: int, _frame: FrameType | None) -> None:
        sys.exit(128 + number)

    # Python can set signal handlers in the main thread only; in another the host's stay.
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, exit_with_signal)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
