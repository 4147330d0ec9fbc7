"""Single keys from the terminal, which is left as it was found."""

from __future__ import annotations

import os
import re
import select
import signal
import sys
import termios
import threading
import tty
from types import FrameType, TracebackType
from typing import Any

# What a terminal sends for a key, cursor keys in both of their modes.
KEYS = {
    b" ": "space",
    b"q": "q",
    b"Q": "q",
    **{
        b"\x1b" + mode + code: name
        for mode in (b"[", b"O")
        for code, name in ((b"A", "up"), (b"B", "down"), (b"C", "right"))
    },
}
KEY = re.compile(b"|".join(map(re.escape, KEYS)))
# The beginning of a key whose rest has not arrived yet.
BEGUN = re.compile(rb"\x1b[\[O]?\Z")
# Signals that end a process unless somebody takes them.
ENDING = (signal.SIGHUP, signal.SIGQUIT)


class Keyboard:
    """Keys of the terminal on standard input while it is entered; where that is no terminal, or
    another program has it, none ever come.

    The terminal's settings are restored at the end, also by an error, SIGHUP, SIGQUIT, and while
    the process is stopped by Ctrl-Z. Ctrl-C stays a signal. Python takes signals in the main thread
    only, so in others no keys come.
    """

    def __init__(self) -> None:
        self._fd = -1
        self._saved: list[Any] = []
        self._begun = b""
        self._handlers: dict[int, Any] = {}

    @property
    def there(self) -> bool:
        """Whether keys can come."""
        return self._fd >= 0

    def __enter__(self) -> Keyboard:
        try:
            fd = sys.stdin.fileno()
            mine = threading.current_thread() is threading.main_thread()
            if not (mine and os.isatty(fd) and os.tcgetpgrp(fd) == os.getpgrp()):
                return self
            self._saved = termios.tcgetattr(fd)
        except (AttributeError, OSError, ValueError, termios.error):
            # No standard input at all, or a terminal that does not control this process.
            return self
        self._fd = fd
        for number in (*ENDING, signal.SIGTSTP):
            self._handlers[number] = signal.signal(
                number, self._suspend if number == signal.SIGTSTP else self._end
            )
        try:
            self._set()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._restore()
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self._handlers, self._fd = {}, -1

    def keys(self, seconds: float = 0.0) -> list[str]:
        """The keys pressed since the last time; waits at most `seconds` for one.

        Others than those of `KEYS` are left out.
        """
        if not self.there:
            return []
        try:
            if not select.select([self._fd], [], [], seconds)[0] or not self._in_front:
                return []
            data = os.read(self._fd, 1024)
        except OSError:
            data = b""
        if not data:
            # The terminal is gone.
            self._fd = -1
            return []
        data = self._begun + data
        begun = BEGUN.search(data)
        self._begun = begun.group() if begun else b""
        return [KEYS[found.group()] for found in KEY.finditer(data)]

    @property
    def _in_front(self) -> bool:
        """Whether the terminal is ours: reading or setting another's would stop this process."""
        return os.tcgetpgrp(self._fd) == os.getpgrp()

    def _set(self) -> None:
        if self._in_front:
            tty.setcbreak(self._fd, termios.TCSANOW)

    def _restore(self) -> None:
        try:
            if self.there and self._in_front:
                termios.tcsetattr(self._fd, termios.TCSANOW, self._saved)
        except (OSError, termios.error):
            # The terminal is gone, and its settings with it.
            pass

    def _end(self, number: int, _frame: FrameType | None) -> None:
        self._restore()
        signal.signal(number, self._handlers[number])
        os.kill(os.getpid(), number)

    def _suspend(self, number: int, _frame: FrameType | None) -> None:
        self._restore()
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
        # From here on it goes on again.
        signal.signal(number, self._suspend)
        self._set()
