"""Ends a command on SIGTERM so that it cleans up."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any


@contextmanager
def exit_on_sigterm() -> Iterator[None]:
    """Turns SIGTERM into SystemExit with code 143: the command then cleans up as after Ctrl-C."""

    def exit_with_signal(number: int, _frame: FrameType | None) -> None:
        sys.exit(128 + number)

    with _on_sigterm(exit_with_signal):
        yield


@contextmanager
def interrupt_on_sigterm() -> Iterator[None]:
    """Turns SIGTERM into Ctrl-C, which an FMU that is running in this process passes on."""
    with _on_sigterm(signal.default_int_handler):
        yield


@contextmanager
def _on_sigterm(handler: Callable[[int, FrameType | None], Any]) -> Iterator[None]:
    # Python can set signal handlers in the main thread only; in another the host's stay.
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
