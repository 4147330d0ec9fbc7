"""Files that are written whole or not at all, and locks of folders."""

from __future__ import annotations

import errno
import io
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import BinaryIO, TextIO

from ..errors import LandingError, reason_of

# file systems take names of 255 bytes; a temporary name is longer than the file's own
LONGEST_NAME = 240
PART = ".part"
LOCK = ".lock"
# the remedy where the folder of a search or an envelope cannot be used
ANOTHER_WORK = "name another folder by --work"
# what the system says where a disk, a user's share of it, or a file takes no more
NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
# what it says of a path that the user can change
NOT_USABLE = {
    errno.ENOENT,
    errno.EACCES,
    errno.EPERM,
    errno.EEXIST,
    errno.ENOTDIR,
    errno.EISDIR,
    errno.ENAMETOOLONG,
    errno.ELOOP,
    errno.EROFS,
}


def temporary_name(path: Path, ending: str = PART) -> Path:
    """The name beside `path` under which it is written.

    It is the same each time, so that a killed writer leaves one file at most, which the next one
    replaces.

    Args:
        path: The file.
        ending: The ending of the temporary name.
    """
    name = os.fsencode(path.name)
    if len(name) + len(ending) <= LONGEST_NAME:
        return path.with_name(f"{path.name}{ending}")
    return path.with_name(f"{sha256(name).hexdigest()[:32]}{ending}")


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """A file to write, which gets the name `path` when all is written and on the disk.

    It is written beside `path`. Where the body or the disk fails, `path` is as it was and nothing
    else is left. A link is followed: the file that it names is replaced.

    Raises:
        OSError: The disk refuses.
    """
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))
    temporary = temporary_name(target)
    # what a killed writer left, or somebody's link, is not written to
    temporary.unlink(missing_ok=True)
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    handle = os.open(temporary, flags, 0o666)
    try:
        with os.fdopen(handle, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)
    except BaseException:
        with suppress(OSError):
            temporary.unlink()
        raise
    _sync_folder(target.parent)


@contextmanager
def text_of(file: BinaryIO) -> Iterator[TextIO]:
    """A binary file as a text in UTF-8, whose ends of lines are as they are written."""
    text = io.TextIOWrapper(file, encoding="utf-8", newline="")
    try:
        yield text
        text.flush()
    finally:
        # closing is the business of who opened the file; what is left in memory is not written
        with suppress(OSError):
            text.detach()


def write_durably(path: Path, data: bytes) -> None:
    """Write `path` by a temporary name, and its folder's entry for it, to the disk.

    After a crash the file is the old one or the new one.

    Raises:
        OSError: The disk refuses.
    """
    with whole_file(path) as file:
        file.write(data)


def _sync_folder(path: Path) -> None:
    # other systems cannot open a folder
    if os.name == "posix":
        folder = os.open(path, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def unwritable(
    path: Path, error: OSError, remedy: str = "name another", *, kept: bool = False, what: str = ""
) -> LandingError:
    """The error for a file or folder that cannot be written.

    Of a folder it names the file in it, where the system does.

    Args:
        path: The file or folder.
        error: Why.
        remedy: What helps, beside making room on a disk that is full.
        kept: Whether what was done is kept in the folder `path`, so that room alone helps.
        what: The word for it, with a blank.
    """
    named = error.filename2 or error.filename
    name = os.fsdecode(named) if isinstance(named, (str, bytes)) and _is_folder(path) else path
    return LandingError(
        f"{what}{name} cannot be written: {reason_of(error)}; {_remedy(error, remedy, kept=kept)}"
    )


def _is_folder(path: Path) -> bool:
    with suppress(OSError):
        return path.is_dir()
    return False


def _remedy(error: OSError, remedy: str, *, kept: bool) -> str:
    if error.errno in NO_ROOM:
        return "make room" if kept else f"make room, or {remedy}"
    return f"move it away, or {remedy}" if error.errno == errno.EISDIR else remedy


def refuse_no_files(folder: Path, names: Iterable[str], remedy: str) -> None:
    """Refuse names in `folder` that are there and are no files, such as folders.

    Raises:
        LandingError: One is; the error has the `remedy`.
    """
    for path in (folder / name for name in names):
        if path.exists() and not path.is_file():
            raise LandingError(f"{path} is there and is no file; move it away, or {remedy}")


@contextmanager
def writing(path: Path, remedy: str = "name another") -> Iterator[None]:
    """The body writes `path`; what the disk refuses is `unwritable`'s error.

    Raises:
        LandingError: The disk refuses.
    """
    try:
        yield
    except OSError as e:
        raise unwritable(path, e, remedy) from None


class FolderLock:
    """The lock of a folder, by its file `.lock`, held until `release` or the end of the process.

    A killed process does not hold it.

    Args:
        folder: The folder, which is made.
        remedy: What to do where it is in use or cannot be written, for the error.

    Raises:
        LandingError: Another process holds it, the folder cannot be written, or the lock is a link
            or no file.
    """

    def __init__(self, folder: Path, remedy: str) -> None:
        import fcntl

        self._file = -1
        path = folder / LOCK
        try:
            folder.mkdir(parents=True, exist_ok=True)
            # a pipe does not block, and a link is not followed
            flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC | os.O_NONBLOCK
            self._file = os.open(path, flags, 0o666)
        except OSError as e:
            if e.errno in (errno.ELOOP, errno.EISDIR, errno.ENXIO):
                raise LandingError(f"{path} is a link or no file; remove it, or {remedy}") from None
            raise unwritable(folder, e, remedy) from None
        try:
            if not stat.S_ISREG(os.fstat(self._file).st_mode):
                raise LandingError(f"{path} is no file; remove it, or {remedy}")
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self.release()
            raise LandingError(
                f"{folder} is in use by another sweep or search; wait for it, or {remedy}"
            ) from None
        except OSError as e:
            self.release()
            raise unwritable(folder, e, remedy) from None
        except LandingError:
            self.release()
            raise

    def release(self) -> None:
        """Release the lock."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def __del__(self) -> None:
        self.release()
