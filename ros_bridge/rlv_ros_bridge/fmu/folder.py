"""Temporary folders that live as long as their process, and the removal of dead ones'."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
import time
from contextlib import suppress
from pathlib import Path

LOCK = "lock"
# Making a folder and its lock takes no longer [s].
LEFT_SECONDS = 60.0


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
        remove_locked(self.path)
        os.close(self._lock)


def remove_stale(prefix: str) -> None:
    """Removes the folders whose lock is free, or that have lost it: those of dead processes.

    Folders of other users, and those that cannot be removed, stay.
    """
    for folder in Path(tempfile.gettempdir()).glob(f"{prefix}*"):
        with suppress(OSError):
            if not (folder / LOCK).exists() and _is_left(folder, prefix):
                shutil.rmtree(folder, ignore_errors=True)
    for lock in Path(tempfile.gettempdir()).glob(f"{prefix}*/{LOCK}"):
        with suppress(OSError):
            # in a folder that all may write to, somebody's link is not followed
            file = os.open(lock, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                remove_locked(lock.parent)
            finally:
                os.close(file)


def remove_locked(folder: Path) -> None:
    """Removes a folder whose lock is held; the lock goes last.

    What a program that is just ending still writes into it would otherwise stay, and nobody would
    know that it may go. So the folder then keeps its lock, by which it is found later.
    """
    with suppress(OSError):
        for entry in folder.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                shutil.rmtree(entry, ignore_errors=True)
            elif entry.name != LOCK:
                entry.unlink(missing_ok=True)
        (folder / LOCK).unlink(missing_ok=True)
        try:
            folder.rmdir()
        except OSError:
            (folder / LOCK).touch()


def _is_left(folder: Path, prefix: str) -> bool:
    """Whether a folder without a lock is not one that is just being made."""
    number = folder.name.removeprefix(prefix).partition("-")[0]
    if folder.is_symlink() or time.time() - folder.stat().st_mtime < LEFT_SECONDS:
        return False
    return not (number.isdecimal() and Path(f"/proc/{number}").exists())
