"""A signal that ends a command is one KeyboardInterrupt, which is never lost.

Python loses an exception that a handler raises in a callback, such as that of an import's lock or
of a destructor, and an import that is interrupted may crash. So it is raised when no import is
under way, and again where it has died without an answer.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

from .handlers import Handlers, hung_up, last_signal

# the wait until an interrupt is raised again [s]
AGAIN_SECONDS = 0.005
# other systems raise at once, and once
TIMED = hasattr(signal, "setitimer")


class Interrupt(KeyboardInterrupt):
    """Raised by a signal that ends a command."""

    def __init__(self, owner: Interrupts) -> None:
        super().__init__()
        self._owner = owner

    def __del__(self) -> None:
        self._owner.raise_soon()


class Interrupts:
    """Raises `Interrupt` at the first of the signals that end a command, once, while it is open.

    One that comes before is raised by `open`; one that comes later is sent again by
    `restore_handlers`.
    """

    def __init__(self) -> None:
        self.number = 0
        self.answered = False
        self._open = False
        self._handlers = Handlers(self._on_signal)
        self._alarm: Any = None

    def set_handlers(self) -> None:
        """Set the handlers, in the main thread; signals are noted."""
        if self._handlers.set() and TIMED:
            self._alarm = signal.signal(signal.SIGALRM, self._on_alarm)

    def open(self) -> None:
        """From here on a signal raises KeyboardInterrupt, at once if it has come."""
        self._open = True
        if self.number:
            raise Interrupt(self)

    def close(self) -> None:
        """From here on a signal is noted again."""
        self._open = False
        if self.number and not self.answered:
            raise Interrupt(self)

    def restore_handlers(self) -> None:
        """Set the handlers that were before; a signal that nothing has answered follows."""
        self._open = False
        if self._alarm is not None:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, self._alarm)
        self._handlers.restore()
        if self.number and not self.answered:
            signal.raise_signal(self.number)

    def raise_soon(self) -> None:
        """Raise the interrupt a moment from now, unless it was answered."""
        if TIMED and self._open and not self.answered:
            signal.setitimer(signal.ITIMER_REAL, AGAIN_SECONDS)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        if not self.number:
            self.number = number
            if self._open:
                self._raise(frame)

    def _on_alarm(self, number: int, frame: FrameType | None) -> None:
        if self._open and not self.answered:
            self._raise(frame)

    def _raise(self, frame: FrameType | None) -> None:
        if TIMED and _importing(frame):
            self.raise_soon()
        else:
            raise Interrupt(self)


def _importing(frame: FrameType | None) -> bool:
    """Whether an import is under way in `frame` or below it."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


# the one whose handlers are set in this process
_current: Interrupts | None = None


def answer() -> int:
    """Note that an interrupt is answered, which then is not raised again; the exit code.

    To be called in each `except KeyboardInterrupt` that ends a command.
    """
    number = 0
    if _current is not None:
        _current.answered, number = True, _current.number
    # a handler within may have had it
    return 128 + (number or last_signal() or signal.SIGINT)


@contextmanager
def interrupts() -> Iterator[Interrupts]:
    """The signals that end a command raise KeyboardInterrupt in the body."""
    global _current
    here = Interrupts()
    before, hook, printing = _current, sys.unraisablehook, sys.excepthook

    def keep_silent(lost: Any) -> None:
        # it is raised again
        if not isinstance(lost.exc_value, Interrupt):
            hook(lost)

    def print_others(kind: Any, lost: BaseException, trace: Any) -> None:
        # functions of Cython that cannot raise print what they lose; sys.last_value then keeps it
        if isinstance(lost, Interrupt):
            here.raise_soon()
        else:
            printing(kind, lost, trace)

    _current, sys.unraisablehook, sys.excepthook = here, keep_silent, print_others
    here.set_handlers()
    try:
        yield here
    finally:
        here.restore_handlers()
        _current, sys.unraisablehook, sys.excepthook = before, hook, printing


@contextmanager
def terminal_left() -> Iterator[None]:
    """Where the terminal is closed meanwhile, what the body cannot write to it is no error.

    The program then ends with 129, as after SIGHUP.
    """
    try:
        yield
    except OSError:
        if not hung_up():
            raise
        answer()
        sys.exit(128 + signal.SIGHUP)
    finally:
        if hung_up():
            # what is left in memory has no reader, and would be an error at the very end
            with suppress(OSError):
                nowhere = os.open(os.devnull, os.O_WRONLY)
                for stream in (sys.stdout, sys.stderr):
                    if stream.isatty():
                        os.dup2(nowhere, stream.fileno())
                os.close(nowhere)
