"""A command of the bridge on a pseudo-terminal of its own, with job control as in a shell."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from contextlib import suppress
from types import TracebackType

from bridge_tools import TIMEOUT, command, environment

# Stands for the shell: starts the command as a job in the foreground of the terminal, and writes
# to file 3 when it stops or ends.
SHELL = """
import fcntl, os, signal, sys, termios
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
# a shell passes the terminal's end on to its jobs
signal.signal(signal.SIGHUP, lambda number, _: os.kill(child, number))
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
child = os.fork()
if child == 0:
    os.setpgid(0, 0)
    os.tcsetpgrp(0, os.getpid())
    # whatever the suite was started with, such as SIGHUP ignored by nohup
    for number in (signal.SIGTTOU, signal.SIGHUP, signal.SIGINT, signal.SIGQUIT):
        signal.signal(number, signal.SIG_DFL)
    os.close(3)
    os.execv(sys.argv[1], sys.argv[1:])
os.write(3, f"{child}\\n".encode())
while True:
    _, status = os.waitpid(child, os.WUNTRACED)
    os.write(3, f"{status}\\n".encode())
    if not os.WIFSTOPPED(status):
        break
"""


class Terminal:
    """The command `arguments` on a terminal, to be entered.

    `shown` is what the terminal shows so far, the command's stdout included.
    """

    def __init__(self, *arguments: object, domain: int) -> None:
        self.master, self.slave = pty.openpty()
        # A line of 150 columns: of a terminal without a size the progress line would show nothing.
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 150, 0, 0))
        self.settings = termios.tcgetattr(self.slave)
        self.shown = ""
        status_read, status_write = os.pipe()
        self._status_pipe = os.fdopen(status_read)
        self._shell = subprocess.Popen(
            [
                sys.executable,
                "-c",
                f"import os; os.dup2({status_write}, 3)\n{SHELL}",
                *command(*arguments),
            ],
            env=environment(domain, PYTHONUNBUFFERED="1"),
            stdin=self.slave,
            stdout=self.slave,
            stderr=self.slave,
            start_new_session=True,
            pass_fds=(status_write,),
        )
        os.close(status_write)
        self.pid = int(self._status_pipe.readline())

    def __enter__(self) -> Terminal:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for process in (self.pid, self._shell.pid):
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        self._shell.wait(TIMEOUT)
        if self.master >= 0:
            os.close(self.master)
        os.close(self.slave)
        self._status_pipe.close()

    def close(self) -> int:
        """Closes the terminal; the wait status of the command's end."""
        os.close(self.master)
        self.master = -1
        return int(self._status_pipe.readline())

    def press(self, keys: str) -> None:
        """Types `keys`."""
        os.write(self.master, keys.encode())

    def until(self, text: str) -> None:
        """Returns once the terminal has shown `text` after what was looked for before."""
        end = time.monotonic() + TIMEOUT
        start = 0
        while (at := self.shown.find(text, start)) < 0:
            assert time.monotonic() < end, self.shown
            if select.select([self.master], [], [], 0.1)[0]:
                self.shown += os.read(self.master, 65536).decode(errors="replace")
        self.shown = self.shown[at + len(text) :]

    def status(self) -> int:
        """The wait status of the command's next stop, or of its end.

        Its output is read meanwhile, so that it never waits for that.
        """
        while not select.select([self._status_pipe], [], [], 0.0)[0]:
            if (
                select.select([self.master, self._status_pipe], [], [], TIMEOUT)[0]
                and select.select([self.master], [], [], 0.0)[0]
            ):
                self.shown += os.read(self.master, 65536).decode(errors="replace")
        return int(self._status_pipe.readline())

    @property
    def is_as_it_was(self) -> bool:
        """Whether the terminal has its first settings."""
        return termios.tcgetattr(self.slave) == self.settings

    @property
    def line_by_line(self) -> bool:
        """Whether the terminal passes on whole lines, as for a shell, not single keys."""
        return bool(termios.tcgetattr(self.slave)[3] & termios.ICANON)
