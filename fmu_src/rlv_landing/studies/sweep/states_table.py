"""A table of touchdown states, for example of a guidance simulation: CSV or Parquet.

Columns have our names, and units in brackets.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ...errors import LandingError, reason_of
from ...text.files import read_csv
from ...text.units import UnitError, parse_number
from ...text.values import check_row, number_in_si, split_heading, unit_of
from ..variables import POLAR, variable
from .design import Design
from .extras import arrow
from .factors import column

# the quantities of a touchdown state: a table has all of them, or the study sets the others
STATE = ("drop.tilt", "drop.pitch_rate", "drop.horizontal_velocity", "drop.vertical_velocity")
STATE_IN_SPACE = (
    *STATE,
    "drop.lateral_velocity",
    "drop.heading",
    "drop.roll",
    "drop.roll_rate",
    "drop.yaw_rate",
)
# what POLAR may give instead
VELOCITY = ("drop.horizontal_velocity", "drop.lateral_velocity")


def read_states(
    path: Path, ignored: Collection[str], given: Collection[str], *, in_space: bool = False
) -> Design:
    """The table's rows as a design.

    A heading is a name and, in brackets, a unit (default SI): `drop.tilt [deg]`. A value that is no
    number is kept as it is, so that its row is refused when it is made.

    Args:
        path: The table, .csv or .parquet.
        ignored: Columns to skip.
        given: Quantities that are given elsewhere; a touchdown state needs no column for these.
        in_space: Whether the state is that of a landing in space.

    Raises:
        LandingError: A missing or unreadable file, an unknown or doubled column, a wrong unit, a
            missing column, or no rows.
    """
    if path.suffix not in (".csv", ".parquet"):
        raise LandingError(f"table {path} must be a .csv or .parquet file")
    if not path.exists():
        raise LandingError(f"there is no table {path}")
    headings, units, cells = _csv(path) if path.suffix == ".csv" else _parquet(path)
    for name in ignored:
        if name not in headings:
            raise LandingError(f"{path} has no column {name!r} to ignore")
    columns: dict[str, NDArray[Any]] = {}
    for heading, unit, values in zip(headings, units, cells):
        if heading in ignored:
            continue
        name, own_unit = split_heading(heading)
        try:
            q = variable(name, "column")
            found = None if q.choices else unit_of(q, own_unit or unit)
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
        columns[q.name] = column(
            v if found is None or isinstance(v, str) else number_in_si(q, v, found) for v in values
        )
    known = {*columns, *given}
    if known.issuperset(POLAR):
        known.update(VELOCITY)
    missing = [name for name in (STATE_IN_SPACE if in_space else STATE) if name not in known]
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
    headings: list[str] = []
    cells: list[list[float | str]] = []
    for line, row in read_csv(path, "table"):
        if not headings:
            headings = [h.strip() for h in row]
            cells = [[] for _ in headings]
            continue
        try:
            check_row(row, headings)
        except LandingError as e:
            raise LandingError(f"{path}, line {line}: {e}") from None
        for values, text in zip(cells, row):
            values.append(_cell(text))
    return headings, [""] * len(headings), cells


def _cell(text: str) -> float | str:
    text = text.strip()
    if not text:
        return float("nan")
    try:
        return parse_number(text)
    except UnitError:
        return text


def _parquet(path: Path) -> tuple[list[str], list[str], list[list[float | str]]]:
    _, parquet = arrow()
    try:
        table = parquet.read_table(path)
        units = [
            ((field.metadata or {}).get(b"unit") or b"").decode("utf-8", "replace")
            for field in table.schema
        ]
        columns = [c.to_pylist() for c in table.columns]
    except Exception as e:
        raise LandingError(f"table {path} cannot be read: {reason_of(e)}") from None
    return list(table.column_names), units, [[_number(v) for v in values] for values in columns]


def _number(value: Any) -> float | str:
    """A Parquet value; what is no number becomes text."""
    if value is None:
        return float("nan")
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return float(value)
