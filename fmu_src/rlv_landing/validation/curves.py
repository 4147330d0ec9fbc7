"""Measured curves from a CSV file.

Its first column is `time` [s]; the others are named as our outputs, in SI units.
"""

from __future__ import annotations

import csv
from math import isfinite
from pathlib import Path

import numpy as np

from ..errors import LandingError, unknown
from ..history import History
from ..quantities import OUTPUT_NAMES


def read_curves(path: str | Path) -> History:
    """The curves of a CSV file as a history.

    Raises:
        LandingError: The file is missing, `time` is not its first column, a name is no output or
            comes twice, a value is not a finite number, a row has another length, times do not
            rise, or there are fewer than two rows. The message names line and column.
    """
    path = Path(path)
    try:
        with path.open(newline="", encoding="utf-8-sig") as f:
            rows = [row for row in csv.reader(f) if any(cell.strip() for cell in row)]
    except FileNotFoundError:
        raise LandingError(f"there is no file {path} of measured curves") from None
    except (OSError, UnicodeDecodeError, csv.Error) as e:
        raise LandingError(f"measured curves {path} cannot be read: {e}") from None
    names = _names(path, rows[0] if rows else [])
    if len(rows) < 3:
        raise LandingError(
            f"{path} has {max(len(rows) - 1, 0)} rows of numbers below its names; "
            "measured curves need at least two"
        )
    values = np.array([_numbers(path, row, names, line) for line, row in enumerate(rows[1:], 2)])
    back = np.flatnonzero(np.diff(values[:, 0]) <= 0.0)
    if len(back):
        line = int(back[0]) + 3
        raise LandingError(
            f"{path}, row {line}: time = {values[line - 2, 0]:g} s does not come after "
            f"{values[line - 3, 0]:g} s; sort the rows by time"
        )
    return History(values[:, 0].copy(), names[1:], values[:, 1:].copy())


def _names(path: Path, header: list[str]) -> list[str]:
    names = [name.strip() for name in header]
    if not names or names[0] not in ("time", "time [s]"):
        raise LandingError(
            f"{path} starts with column {names[0] if names else ''!r}; "
            "its first column must be time, in seconds"
        )
    if len(names) < 2:
        raise LandingError(
            f"{path} has no column beside time; name one as an output, "
            "for example leg[1].main_strut.force"
        )
    for name in names[1:]:
        if name not in OUTPUT_NAMES:
            raise LandingError(
                f"{path}: {unknown('column', name, OUTPUT_NAMES)}; "
                "`rlv-landing parameters --outputs` lists the names"
            )
        if names.count(name) > 1:
            raise LandingError(
                f"{path}: column {name!r} is there {names.count(name)} times; leave one"
            )
    return names


def _numbers(path: Path, row: list[str], names: list[str], line: int) -> list[float]:
    if len(row) != len(names):
        raise LandingError(
            f"{path}, row {line}: {len(row)} values for {len(names)} columns; "
            "give every column a value in every row"
        )
    numbers = []
    for name, text in zip(names, row):
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not isfinite(value):
            raise LandingError(
                f"{path}, row {line}: {name} = {text!r} is not a finite number; "
                "leave rows with gaps out"
            )
        numbers.append(value)
    return numbers
