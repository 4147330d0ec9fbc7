"""A table of touchdown states, for example of a guidance simulation: CSV or Parquet.

Columns have our names, and units in brackets.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import LandingError
from ...presets import unit_scale
from .design import Design
from .extras import arrow
from .factors import column, variable

# the quantities of a touchdown state: a table has all of them, or the study sets the others
STATE = ("drop.tilt", "drop.pitch_rate", "drop.horizontal_velocity", "drop.vertical_velocity")
HEADING = re.compile(r"\s*(\S+?)\s*(?:\[([^\]]*)\])?\s*")


def read_states(path: Path, ignored: Collection[str], given: Collection[str]) -> Design:
    """The table's rows as a design.

    A heading is a name and, in brackets, a unit (default SI): `drop.tilt [deg]`. A value that is no
    number is kept as it is, so that its row is refused when it is made.

    Args:
        path: The table, .csv or .parquet.
        ignored: Columns to skip.
        given: Quantities that are given elsewhere; a touchdown state needs no column for these.

    Raises:
        LandingError: A missing or unreadable file, an unknown or doubled column, a wrong unit, a
            missing column, or no rows.
    """
    if path.suffix not in (".csv", ".parquet"):
        raise LandingError(f"table {path} must be a .csv or .parquet file")
    if not path.is_file():
        raise LandingError(f"there is no table {path}")
    headings, units, cells = _csv(path) if path.suffix == ".csv" else _parquet(path)
    for name in ignored:
        if name not in headings:
            raise LandingError(f"{path} has no column {name!r} to ignore")
    columns: dict[str, NDArray[Any]] = {}
    for heading, unit, values in zip(headings, units, cells):
        if heading in ignored:
            continue
        found = HEADING.fullmatch(heading)
        try:
            q = variable(found[1] if found else heading, "column")
            unit = (found[2] if found else None) or unit
            scale = 1.0 if q.choices else unit_scale(q, unit)
        except LandingError as e:
            raise LandingError(
                f"{path}, column {heading!r}: {e}; columns that are not ours go to ignore = [...]"
            ) from None
        if q.name in columns:
            raise LandingError(f"{path} has two columns of {q.name}; leave one")
        if q.name in given:
            raise LandingError(
                f"{path} has a column of {q.name}, which the study gives, too; leave one"
            )
        columns[q.name] = column(v if isinstance(v, str) else scale * v for v in values)
    missing = [name for name in STATE if name not in columns and name not in given]
    if missing:
        raise LandingError(
            f"{path} has no column {', '.join(missing)}; a touchdown state needs it: "
            "add it, or give it in [set]"
        )
    count = len(next(iter(columns.values()))) if columns else 0
    if not count:
        raise LandingError(f"{path} has no rows")
    return Design(columns, count)


def _csv(path: Path) -> tuple[list[str], list[str], list[list[float | str]]]:
    try:
        with path.open(newline="", encoding="utf-8-sig") as f:
            rows = csv.reader(f)
            headings = [h.strip() for h in next(rows, [])]
            cells: list[list[float | str]] = [[] for _ in headings]
            for line, row in enumerate(rows, 2):
                if not row:
                    continue
                if len(row) != len(headings):
                    raise LandingError(
                        f"{path}, line {line}: {len(row)} values under {len(headings)} headings"
                    )
                for values, text in zip(cells, row):
                    values.append(_cell(text))
    except (OSError, UnicodeDecodeError, csv.Error) as e:
        raise LandingError(f"table {path} cannot be read: {e}") from None
    return headings, [""] * len(headings), cells


def _cell(text: str) -> float | str:
    text = text.strip()
    try:
        return float(text) if text else float("nan")
    except ValueError:
        return text


def _parquet(path: Path) -> tuple[list[str], list[str], list[list[float | str]]]:
    _, parquet = arrow()
    try:
        table = parquet.read_table(path)
    except Exception as e:
        raise LandingError(f"table {path} cannot be read: {e}") from None
    units = [((field.metadata or {}).get(b"unit") or b"").decode() for field in table.schema]
    cells = [
        [np.nan if v is None else v if isinstance(v, str) else float(v) for v in c.to_pylist()]
        for c in table.columns
    ]
    return list(table.column_names), units, cells
