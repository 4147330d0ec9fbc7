"""The signals that end a command, and handlers of them for a while."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, TypeVar

# Ctrl-C, `kill`, and the end of the terminal, where the system has it
ENDING = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
HANG_UP = getattr(signal, "SIGHUP", None)
Note = TypeVar("Note", bound="SignalNote")
_hung_up = False
_last = 0


def hung_up() -> bool:
    """Whether SIGHUP has come: the terminal may be gone."""
    return _hung_up


def last_signal() -> int:
    """The number of the last signal that any `Handlers` had; 0 before the first."""
    return _last


def _in_main_thread() -> bool:
    # Python can set signal handlers in the main thread only; in another the host's stay
    return threading.current_thread() is threading.main_thread()


class Handlers:
    """`handler` for each of the signals that end a command, from `set` to `restore`.

    A signal that is ignored stays so: SIGHUP below nohup, SIGINT in a script's background.

    Args:
        handler: Called with the signal's number and the frame that it interrupted.
    """

    def __init__(self, handler: Callable[[int, FrameType | None], object]) -> None:
        self._handler = handler
        self._before: dict[int, Any] = {}

    def set(self) -> bool:
        """Set the handlers, in the main thread; whether they are set."""
        if not _in_main_thread():
            return False
        for number in ENDING:
            before = signal.getsignal(number)
            if before is not signal.SIG_IGN:
                # noted first: the signal may come at once
                self._before[number] = signal.SIG_DFL if before is None else before
                signal.signal(number, self._call)
        return True

    def _call(self, number: int, frame: FrameType | None) -> None:
        global _hung_up, _last
        _hung_up = _hung_up or number == HANG_UP
        _last = number
        self._handler(number, frame)

    def call_before(self, number: int, frame: FrameType | None) -> None:
        """Call the handler that was before, if it is one of Python's."""
        before = self._before.get(number)
        if callable(before):
            before(number, frame)

    def restore(self) -> None:
        """Set the handlers that were before; again has no effect."""
        while self._before:
            number, before = self._before.popitem()
            signal.signal(number, before)


class SignalNote:
    """Notes the signals that end a command while it is entered.

    Attributes:
        number: The number of the first signal that has come, or 0.
    """

    def __init__(self) -> None:
        self.number = 0
        self._handlers = Handlers(self._note)

    def __bool__(self) -> bool:
        """Whether a signal has come."""
        return self.number != 0

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.number = self.number or number

    def __enter__(self: Note) -> Note:
        self._handlers.set()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.release()

    def release(self) -> None:
        """End the noting; the handlers are those that were before."""
        self._handlers.restore()


class Hold(SignalNote):
    """Holds the signals that end a command back while it is entered; the first follows at the end.

    A mask of signals does not help: another thread may take the signal.
    """

    def release(self) -> None:
        """End the hold: the first signal that has come is sent again."""
        super().release()
        number, self.number = self.number, 0
        if number:
            signal.raise_signal(number)
