"""Input files that may be pipes or terminals, as `<(command)` gives: a wait for them is reported.

A pipe whose writer does not come, or writes nothing, would hold a command for ever without a word.
"""

from __future__ import annotations

import io
import os
import select
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import BinaryIO, NoReturn

from ..signals.handlers import Handlers

# after this time [s] without a byte the wait is reported
SILENT_SECONDS = 2.0


def open_input(path: Path) -> BinaryIO:
    """A file, pipe or terminal, open to be read.

    Reads of what is no regular file wait for its writer. Where nothing comes for 2 s, standard
    error says so, once; Ctrl-C, SIGTERM and SIGHUP end the wait.

    Raises:
        OSError: It is missing or cannot be read.
    """
    if not hasattr(select, "poll") or stat.S_ISREG(path.stat().st_mode):
        return path.open("rb")
    handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    if stat.S_ISDIR(os.fstat(handle).st_mode):
        os.close(handle)
        # which says why
        return path.open("rb")
    return io.BufferedReader(_Waiting(handle, path))


def is_pipe(path: Path) -> bool:
    """Whether it is a pipe, which gives what is in it once.

    Raises:
        OSError: It is missing.
    """
    return stat.S_ISFIFO(path.stat().st_mode)


class _Waiting(io.RawIOBase):
    """A pipe or device that is waited for, with a word on standard error."""

    def __init__(self, handle: int, path: Path) -> None:
        self._handle = handle
        self._path = path
        self._reported = False

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        while True:
            self._wait()
            try:
                return os.readv(self._handle, [buffer])
            except BlockingIOError:
                continue

    def _wait(self) -> None:
        poll = select.poll()
        poll.register(self._handle, select.POLLIN)
        with _interruptible():
            if not self._reported and not poll.poll(1000.0 * SILENT_SECONDS):
                self._reported = True
                print(
                    f"waiting for {self._path}, to which nothing is written yet; Ctrl-C ends this",
                    file=sys.stderr,
                    flush=True,
                )
            poll.poll()

    def close(self) -> None:
        if not self.closed:
            os.close(self._handle)
        super().close()


@contextmanager
def _interruptible() -> Iterator[None]:
    """A signal that ends a command raises KeyboardInterrupt, also where it is only noted."""

    def interrupt(number: int, frame: FrameType | None) -> NoReturn:
        handlers.call_before(number, frame)
        raise KeyboardInterrupt

    handlers = Handlers(interrupt)
    try:
        handlers.set()
        yield
    finally:
        handlers.restore()
