"""Reads single keys from the terminal, and restores the terminal's settings."""

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

# The bytes that a terminal sends for a key; cursor keys in both of their modes.
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
# The first bytes of a key whose last byte has not arrived yet.
PARTIAL_KEY = re.compile(rb"\x1b[\[O]?\Z")


class Keyboard:
    """Keys of the terminal on standard input, while it is entered.

    There are no keys where standard input is no terminal, where another program is in the
    terminal's foreground, and outside the main thread, in which alone Python handles signals.

    The terminal's settings are restored at the end, also on an error, on SIGQUIT, and while
     the process is stopped by Ctrl-Z. Ctrl-C stays a signal.
    """

    def __init__(self) -> None:
        self._fd = -1
        self._saved: list[Any] = []
        self._partial_key = b""
        self._handlers: dict[int, Any] = {}

    @property
    def available(self) -> bool:
        """Whether keys can be read."""
        return self._fd >= 0

    def __enter__(self) -> Keyboard:
        try:
            fd = sys.stdin.fileno()
            in_main_thread = threading.current_thread() is threading.main_thread()
            if not (in_main_thread and os.isatty(fd) and os.tcgetpgrp(fd) == os.getpgrp()):
                return self
            self._saved = termios.tcgetattr(fd)
        except (AttributeError, OSError, ValueError, termios.error):
            # No standard input, or a terminal that does not control this process.
            return self
        self._fd = fd
        for number, handler in (
            (signal.SIGQUIT, self._on_end),
            (signal.SIGTSTP, self._on_suspend),
        ):
            if signal.getsignal(number) is not signal.SIG_IGN:
                self._handlers[number] = signal.signal(number, handler)
        try:
            self._read_single_keys()
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
        """The keys pressed since the last call, as named in `KEYS`; others are left out.

        Waits at most `seconds` [s] for the first.
        """
        if not self.available:
            return []
        try:
            if not select.select([self._fd], [], [], seconds)[0] or not self._in_foreground:
                return []
            data = os.read(self._fd, 1024)
        except OSError:
            data = b""
        if not data:
            # The terminal was closed.
            self._fd = -1
            return []
        data = self._partial_key + data
        partial = PARTIAL_KEY.search(data)
        self._partial_key = partial.group() if partial else b""
        return [KEYS[found.group()] for found in KEY.finditer(data)]

    @property
    def _in_foreground(self) -> bool:
        """Whether this process is in the terminal's foreground.

        In the background, reading or setting the terminal would stop it.
        """
        return os.tcgetpgrp(self._fd) == os.getpgrp()

    def _read_single_keys(self) -> None:
        if self._in_foreground:
            tty.setcbreak(self._fd, termios.TCSANOW)

    def _restore(self) -> None:
        try:
            if self.available and self._in_foreground:
                termios.tcsetattr(self._fd, termios.TCSANOW, self._saved)
        except (OSError, termios.error):
            # The terminal was closed; there is nothing to restore.
            pass

    def _on_end(self, number: int, _frame: FrameType | None) -> None:
        self._restore()
        signal.signal(number, self._handlers[number])
        os.kill(os.getpid(), number)

    def _on_suspend(self, number: int, _frame: FrameType | None) -> None:
        self._restore()
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
        # The process has been continued (SIGCONT).
        signal.signal(number, self._on_suspend)
        self._read_single_keys()
