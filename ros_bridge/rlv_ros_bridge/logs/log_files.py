"""The files of a log: their names, their order, and whether they are MCAP at all."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rlv_landing.errors import LandingError, reason_of

from .mcap_files.records import HEADER, MAGIC, RECORD_HEAD

FINISHED = ".mcap"
# The ending until the writer has finished the file.
UNFINISHED = ".mcap.part"
# A message that is later has the time of the day: that of 1973 [s].
WALL_TIME = 1e8


def shown_time(seconds: float) -> str:
    """A message's time as text, with its milliseconds even where it is the time of the day."""
    return f"{seconds:g} s" if seconds < WALL_TIME else f"{seconds:.3f} s"


def find_files(path: Path) -> list[Path]:
    """The MCAP files of the log at `path` in their order, unfinished ones too.

    Raises:
        LandingError: there are none.
    """
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise LandingError(f"there is no log {path}; name a log's folder or its .mcap file")
    try:
        files = in_order(
            f for f in path.iterdir() if f.name.endswith((FINISHED, UNFINISHED)) and f.is_file()
        )
    except OSError as e:
        raise LandingError(f"{path} cannot be read: {reason_of(e)}") from None
    if not files:
        raise LandingError(
            f"{path} holds no .mcap or .db3 file; name a log's folder or its .mcap file"
        )
    return files


def log_name(file: Path) -> str:
    """The name of a log's file without its ending."""
    return file.name.removesuffix(UNFINISHED).removesuffix(FINISHED)


def in_order(files: Iterable[Path]) -> list[Path]:
    """The files of a log in the order in which they were recorded."""
    return sorted(files, key=_number)


def _number(file: Path) -> tuple[str, int]:
    # The files of a split log end in `_0`, `_1`, ..., `_10`.
    name = log_name(file).removesuffix(".db3")
    stem, _, number = name.rpartition("_")
    return (stem, int(number)) if number.isdecimal() else (name, 0)


def check_file(file: Path) -> None:
    """Checks that `file` can be opened, starts as MCAP does, and has a whole first record.

    Raises:
        LandingError: it does not.
    """
    try:
        with file.open("rb") as stream:
            start = stream.read(len(MAGIC) + RECORD_HEAD.size)
            length = int.from_bytes(start[len(MAGIC) + 1 :], "little")
            whole = file.stat().st_size >= len(MAGIC) + RECORD_HEAD.size + length
    except OSError as e:
        raise LandingError(f"{file} cannot be read: {reason_of(e)}") from None
    if not start:
        raise LandingError(f"{file} is empty; nothing was recorded")
    if not MAGIC.startswith(start[: len(MAGIC)]):
        raise LandingError(
            f"{file} is not MCAP: it does not start as one; name a log's folder or its .mcap file"
        )
    if len(start) < len(MAGIC) + RECORD_HEAD.size or start[len(MAGIC)] != HEADER or not whole:
        raise LandingError(f"{file} is cut within its first record; nothing in it can be read")
