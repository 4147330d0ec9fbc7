"""Signals for commands that leave nothing half done behind."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def ends_tidily() -> Iterator[None]:
    """SIGTERM ends the command as Ctrl-C does, by an exception that lets it clean up, with exit
    code 143.
    """

    def end(number: int, _frame: FrameType | None) -> None:
        sys.exit(128 + number)

    # Python takes signals in the main thread only; elsewhere the host's own handling stays.
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
