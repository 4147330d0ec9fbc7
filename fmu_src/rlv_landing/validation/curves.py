"""Measured curves from a CSV file.

Its first column is `time`; the others are named as our outputs. A heading may have a unit in
brackets, `leg[1].main_strut.force [kN]` or `time [ms]`; without one the column is in SI. Stamps of
a clock (seconds since 1970), and times whose steps cannot be those of a landing in the heading's
unit, are refused with the remedy: which stamp is the landing's start is not guessed.
"""

from __future__ import annotations

from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..history import History
from ..quantities import OUTPUT_NAMES, OUTPUTS_BY_NAME, Quantity
from ..text.files import read_csv
from ..text.units import Unit, UnitError, parse_number
from ..text.values import check_row, number_in_si, split_heading, unit_of

# times [s] from which on they are those of a clock, not of a landing
EPOCH = 1e7
# the largest time between samples [s] with which a damper's stroke shows at all, and the longest
# record of a landing [s]
COARSEST, LONGEST = 0.1 * (1.0 + 1e-9), 60.0
FINER = (("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9))
QUANTITIES = {"time": Quantity("s", "time", name="time"), **OUTPUTS_BY_NAME}


def read_curves(path: str | Path) -> History:
    """The curves of a CSV file as a history.

    Raises:
        LandingError: The file is missing, `time` is not its first column, a name is no output or
            comes twice, a unit is wrong, a value is not a finite number, a row has another length,
            times do not rise, are those of a clock or of another unit, or there are fewer than two
            rows. The message names line and column.
    """
    path = Path(path)
    missing = f"there is no file {path} of measured curves"
    rows = list(read_csv(path, "measured curves", missing))
    columns = _columns(path, rows[0][1] if rows else [])
    names = [name for name, _ in columns]
    if len(rows) < 3:
        raise LandingError(
            f"{path} has {max(len(rows) - 1, 0)} rows of numbers below its names; "
            "measured curves need at least two"
        )
    values = np.array([_numbers(path, row, columns, line) for line, row in rows[1:]])
    heading = rows[0][1][0].strip()
    _check_clock(path, heading, values[:, 0])
    back = np.flatnonzero(np.diff(values[:, 0]) <= 0.0)
    if len(back):
        at = int(back[0])
        raise LandingError(
            f"{path}, row {rows[at + 2][0]}: time = {values[at + 1, 0]:g} s does not come after "
            f"{values[at, 0]:g} s; sort the rows by time"
        )
    _check_steps(path, heading, values[:, 0])
    return History(values[:, 0].copy(), names[1:], values[:, 1:].copy())


def _check_clock(path: Path, heading: str, time: NDArray[np.float64]) -> None:
    """Refuse stamps of a clock, with the remedy."""
    if time[0] >= EPOCH:
        raise LandingError(
            f"{path}: {heading} begins at {time[0]:.10g} s, a stamp of a clock; subtract the stamp "
            "of the first contact, and add the landing's time of it, drop.contact_time (stamps in "
            "ms or us: head the column time [ms] or time [us])"
        )


def _check_steps(path: Path, heading: str, time: NDArray[np.float64]) -> None:
    """Refuse times that rise, but not as those of a landing in the heading's unit."""
    step, span = float(np.median(np.diff(time))), float(time[-1] - time[0])
    if step > COARSEST or span > LONGEST:
        fine = (unit for unit, size in FINER if span * size <= LONGEST and step * size <= COARSEST)
        unit = next(fine, "ms")
        raise LandingError(
            f"{path}: {heading} rises by {step:g} s a row and spans {span:g} s; a landing needs at "
            f"most {COARSEST:g} s and {LONGEST:g} s: if it is in {unit}, head the column "
            f"time [{unit}]; else record it finer, or leave out what is no landing"
        )


def _columns(path: Path, header: list[str]) -> list[tuple[str, Unit]]:
    """Name and unit of every column."""
    if not header or split_heading(header[0])[0] != "time":
        raise LandingError(
            f"{path} starts with column {header[0].strip() if header else ''!r}; "
            "its first column must be time, in seconds"
        )
    if len(header) < 2:
        raise LandingError(
            f"{path} has no column beside time; name one as an output, "
            "for example leg[1].main_strut.force"
        )
    columns: list[tuple[str, Unit]] = []
    split = [split_heading(heading) for heading in header]
    names = [name for name, _ in split]
    for heading, (name, unit) in zip(header, split):
        if name not in QUANTITIES:
            raise LandingError(
                f"{path}: {unknown('column', name, OUTPUT_NAMES)}; "
                "`rlv-landing parameters --outputs` lists the names"
            )
        if names.count(name) > 1:
            raise LandingError(
                f"{path}: column {name!r} is there {names.count(name)} times; leave one"
            )
        try:
            columns.append((name, unit_of(QUANTITIES[name], unit)))
        except LandingError as e:
            raise LandingError(f"{path}, column {heading!r}: {e}") from None
    return columns


def _numbers(path: Path, row: list[str], columns: list[tuple[str, Unit]], line: int) -> list[float]:
    try:
        check_row(row, columns)
    except LandingError as e:
        raise LandingError(f"{path}, row {line}: {e}") from None
    numbers = []
    for (name, unit), text in zip(columns, row):
        try:
            value = number_in_si(QUANTITIES[name], parse_number(text), unit)
        except UnitError:
            value = float("nan")
        if not isfinite(value):
            raise LandingError(
                f"{path}, row {line}: {name} = {text!r} is not a finite number; "
                "leave rows with gaps out"
            )
        numbers.append(value)
    return numbers
