"""The files of rows in a study's results folder: each is checked before its rows are taken up."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LandingError, reason_of
from ...text.durable import PART
from .extras import arrow

ANEW = "remove it, and --resume makes its rows anew"
NAME = re.compile(r"[0-9]{12}\.parquet")


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """A Parquet file, whose pages' checksums are compared as they are read.

    It is opened here, as pyarrow takes no name that is not UTF-8.

    Raises:
        LandingError: It is no Parquet file, is damaged, or cannot be read.
    """
    pyarrow, parquet = arrow()
    try:
        if not path.is_file():
            raise OSError("it is no file")
        with path.open("rb") as file:
            yield parquet.ParquetFile(file, page_checksum_verification=True)
    # a file with checksums that do not fit, or with a torn page, is an OSError
    except (pyarrow.ArrowException, OSError, ValueError, EOFError) as e:
        if isinstance(e, LandingError):
            raise
        raise LandingError(f"{path} is damaged ({reason_of(e).split('. ')[0]}); {ANEW}") from None


def part_name(first: int) -> str:
    """The name of the part whose first row has this index."""
    return f"{first:012d}.parquet"


def part_files(folder: Path) -> list[Path]:
    """The parts in the folder, in the order of their indices; other files are not looked at.

    Raises:
        LandingError: A Parquet file there is none of a study's parts.
    """
    found = sorted(folder.glob("*.parquet"))
    for path in found:
        if not NAME.fullmatch(path.name):
            raise LandingError(
                f"{path} is no part of this study, whose parts are named as {part_name(0)}; "
                "move it out of the folder"
            )
    return found


def remove_unfinished(folder: Path) -> None:
    """Remove the parts that a killed sweep was writing."""
    for path in folder.glob(f"*.parquet{PART}"):
        if NAME.fullmatch(path.name.removesuffix(PART)):
            with suppress(OSError):
                path.unlink()


def check_part(
    path: Path, fingerprint: str, schema: Any, count: int, after: int
) -> tuple[int, int]:
    """The range of the indices of a part's rows.

    Args:
        path: The part.
        fingerprint: The study's fingerprint.
        schema: The study's columns.
        count: The number of the study's landings.
        after: The index after the last row of the part before it.

    Raises:
        LandingError: It is damaged, of another study, or has rows that are not the study's or that
            the part before it has.
    """
    first = int(path.stem)
    with opened(path) as file:
        _check_study(path, file, fingerprint, schema)
        rows = file.metadata.num_rows
        if not rows:
            raise LandingError(f"{path} has no rows; {ANEW}")
        indices = file.read(columns=["index"])["index"].to_numpy(zero_copy_only=False)
    if not np.array_equal(indices, np.arange(first, first + rows)):
        raise LandingError(
            f"{path} has rows {indices[0]} to {indices[-1]}, and its name says that they begin at "
            f"{first} and follow each other; {ANEW}"
        )
    if first + rows > count:
        raise LandingError(
            f"{path} has rows {first} to {first + rows - 1}, "
            f"and the study has {count} landings; {ANEW}"
        )
    if first < after:
        raise LandingError(f"{path} has rows that the part before it has, too; {ANEW}")
    return first, first + rows


def check_results(path: Path, fingerprint: str, schema: Any, count: tuple[int, int]) -> int:
    """Check that the results file is whole, to its last byte of data, and of this study.

    Args:
        path: The file.
        fingerprint: The study's fingerprint.
        schema: The study's columns.
        count: The number of the study's landings, and how many there may be if it grows.

    Returns:
        The number of its rows.

    Raises:
        LandingError: It is not.
    """
    with opened(path) as file:
        _check_study(path, file, fingerprint, schema)
        rows = int(file.metadata.num_rows)
        for group in range(file.num_row_groups):
            file.read_row_group(group)
    asked, most = count
    if rows > most or (rows < asked and asked == most):
        raise LandingError(f"{path} has {rows} rows, and the study has {asked} landings; {ANEW}")
    return rows


def _check_study(path: Path, file: Any, fingerprint: str, schema: Any) -> None:
    metadata = file.schema_arrow.metadata or {}
    try:
        own = json.loads(metadata.get(b"study.json", b"{}"))["fingerprint"]
    except (ValueError, KeyError, TypeError, RecursionError):
        own = None
    if own != fingerprint:
        raise LandingError(f"{path} has rows of another study; move it out of the folder")
    # no checksum covers what a Parquet file says of its columns
    if _columns(file.schema_arrow) != _columns(schema):
        raise LandingError(f"{path} is damaged (its columns are not the study's); {ANEW}")


def _columns(schema: Any) -> list[tuple[str, str, bytes]]:
    """Name, type and unit of every column."""
    return [(f.name, str(f.type), (f.metadata or {}).get(b"unit", b"")) for f in schema]
