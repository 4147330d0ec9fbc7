"""Temporary folders that live as long as their process, and the removal of dead ones'."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

LOCK = "lock"


class ProcessFolder:
    """A new temporary folder `path`, locked as long as this process lives.

    Making one also removes the folders of dead processes with the same prefix.

    Args:
        prefix: of its name.
    """

    def __init__(self, prefix: str) -> None:
        remove_stale(prefix)
        self.path = Path(tempfile.mkdtemp(prefix=f"{prefix}{os.getpid()}-"))
        new = self.path / f"{LOCK}.new"
        self._lock = os.open(new, os.O_CREAT | os.O_EXCL | os.O_RDWR | os.O_CLOEXEC)
        fcntl.flock(self._lock, fcntl.LOCK_EX)
        # The file gets its name once the lock is held, so that no process finds it unlocked.
        new.rename(self.path / LOCK)

    def remove(self) -> None:
        """Removes the folder and releases its lock."""
        shutil.rmtree(self.path, ignore_errors=True)
        os.close(self._lock)


def remove_stale(prefix: str) -> None:
    """Removes the folders whose lock is free: those of dead processes.

    Folders of other users, and those that cannot be removed, stay.
    """
    for lock in Path(tempfile.gettempdir()).glob(f"{prefix}*/{LOCK}"):
        with suppress(OSError):
            # in a folder that all may write to, somebody's link is not followed
            file = os.open(lock, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(lock.parent, ignore_errors=True)
            finally:
                os.close(file)
