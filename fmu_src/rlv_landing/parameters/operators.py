"""Response operators of a ship: `sea.operators`, a table and the text that is kept of it.

An operator is the ship's motion in one degree of freedom to waves of amplitude 1 m: its amplitude,
and by how much its phase leads the wave's elevation at the ship.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from math import isfinite, pi
from typing import NamedTuple

from ..errors import LandingError, first_of

OPERATORS = "sea.operators"
# in the order of the inputs
FREEDOMS = ("surge", "heave", "sway", "roll", "yaw", "tilt")
TURNS = FREEDOMS[3:]
DEGREE = pi / 180.0
# units by what a column has, and their sizes in SI
UNITS: dict[str, dict[str, float]] = {
    "frequency": {"rad/s": 1.0, "Hz": 2.0 * pi},
    "angle": {"rad": 1.0, "deg": DEGREE},
    "shift": {"m/m": 1.0},
    "turn": {"rad/m": 1.0, "deg/m": DEGREE},
}
MOST_ROWS = 4000
# [m/m, rad/m]
LARGEST = {**dict.fromkeys(FREEDOMS, 100.0), **dict.fromkeys(TURNS, 1.0)}
# a direction nearer than this to one of the table is that one [rad]
SAME_DIRECTION = 1e-6
# amplitude and lead of each freedom
Row = tuple[float, ...]


class Operators(NamedTuple):
    """Operators over a grid of directions and frequencies.

    Attributes:
        frequencies: Growing [rad/s].
        directions: Growing, as `sea.direction` [rad].
        rows: [directions x frequencies] Amplitude [m/m, rad/m] and lead [rad] of each freedom.
    """

    frequencies: tuple[float, ...]
    directions: tuple[float, ...]
    rows: tuple[Row, ...]


def columns() -> Iterator[tuple[str, str]]:
    """Each column of a table, and what it has."""
    yield "frequency", "frequency"
    yield "direction", "angle"
    for name in FREEDOMS:
        yield name, "turn" if name in TURNS else "shift"
        yield f"{name} phase", "angle"


@lru_cache(maxsize=8)
def read_operators(text: str) -> Operators:
    """The operators of the text that is kept.

    Raises:
        LandingError: It is no such text, or no table.
    """
    words = text.split()
    try:
        d, o = words.index("directions"), words.index("operators")
        if words[0] != "frequencies":
            raise ValueError
        frequencies, directions, numbers = (
            tuple(map(float, part)) for part in (words[1:d], words[d + 1 : o], words[o + 1 :])
        )
    except (ValueError, IndexError):
        raise LandingError(
            f"{OPERATORS} = {text[:60]!r} is no table of operators; name its file in a parameter "
            "file or by --set"
        ) from None
    size = 2 * len(FREEDOMS)
    rows = tuple(numbers[k : k + size] for k in range(0, len(numbers), size))
    return _checked(Operators(frequencies, directions, rows))


def written_operators(found: Operators) -> str:
    """The text of operators, with all digits."""
    rows = (number for row in found.rows for number in row)
    parts = (
        ("frequencies", found.frequencies),
        ("directions", found.directions),
        ("operators", rows),
    )
    return " ".join(word for name, values in parts for word in (name, *map(repr, values)))


def canonical_operators(text: str) -> str:
    """A text of operators as it is kept; an empty one is none.

    Raises:
        LandingError: As `read_operators`.
    """
    return written_operators(read_operators(text)) if text.strip() else ""


def is_operators(text: str) -> bool:
    """Whether a text begins as that of operators does."""
    return text[:200].split()[:1] == ["frequencies"]


def check_covered(text: str, band: tuple[float, float], direction: float) -> None:
    """Check that operators are known over a `band` of frequencies [rad/s] in a `direction` [rad].

    Raises:
        LandingError: They are not.
    """
    found = read_operators(text)
    low, high = found.frequencies[0], found.frequencies[-1]
    if low > band[0] or high < band[1]:
        raise LandingError(
            f"{OPERATORS} has frequencies from {low:g} to {high:g} rad/s; the sea has waves from "
            f"{band[0]:.4g} to {band[1]:.4g} rad/s (sea.peak_period); give rows up to there, zeros "
            "where the ship does not answer"
        )
    if turned_into(found, direction) is None:
        first, last = found.directions[0], found.directions[-1]
        raise LandingError(
            f"sea.direction = {direction / DEGREE:g} deg is outside the directions of {OPERATORS}, "
            f"{first / DEGREE:g} to {last / DEGREE:g} deg; give one of these, or rows for it"
        )


def turned_into(found: Operators, direction: float) -> float | None:
    """A direction [rad], by whole turns, among those of operators; None where it is outside."""
    low, high = found.directions[0] - SAME_DIRECTION, found.directions[-1] + SAME_DIRECTION
    turns = (direction, direction + 2.0 * pi, direction - 2.0 * pi)
    return next((turned for turned in turns if low <= turned <= high), None)


def operators_from_table(text: str, name: str) -> str:
    """The text `sea.operators` of a table with a heading, a row a frequency and direction.

    Raises:
        LandingError: The table, which errors call `name`, has no such heading, or a hole, or its
            rows are not a grid in growing order.
    """
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip()]
    if len(lines) < 3:
        raise LandingError(f"{name} has no rows of operators; give a heading and 2 rows at least")
    sizes = _sizes(name, _cells(lines[0][1]))
    rows = [_row(name, k, _cells(line), sizes) for k, line in lines[1:]]
    frequencies: list[float] = []
    directions: list[float] = []
    for (k, _), (frequency, direction, *_) in zip(lines[1:], rows):
        if not directions or direction != directions[-1]:
            if directions and direction < directions[-1]:
                raise LandingError(
                    f"{name}, line {k}: directions do not grow; sort the rows by direction, then "
                    "by frequency"
                )
            directions.append(direction)
            place = 0
        if len(directions) == 1:
            frequencies.append(frequency)
        elif place >= len(frequencies) or frequency != frequencies[place]:
            raise LandingError(
                f"{name}, line {k}: {frequency:g} rad/s is not the next frequency of the first "
                "direction; give every direction the same ones, in the same order"
            )
        place += 1
    found = Operators(tuple(frequencies), tuple(directions), tuple(row[2:] for row in rows))
    try:
        return written_operators(_checked(found))
    except LandingError as e:
        raise LandingError(f"{name}: {e}") from None


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.replace(";", ",").split(",")]


def _sizes(name: str, heading: Sequence[str]) -> dict[str, tuple[int, float]]:
    """Place and unit's size of each column of a `heading`."""
    found: dict[str, tuple[int, float]] = {}
    kinds = dict(columns())
    for place, cell in enumerate(heading):
        column, bracket, unit = (part.strip() for part in cell.partition("["))
        column = " ".join(column.split())
        unit = unit.removesuffix("]").strip()
        if column not in kinds:
            raise LandingError(
                f"{name} has a column {column!r}, which is none; the columns are "
                f"{first_of(list(kinds), len(kinds))}"
            )
        units = UNITS[kinds[column]]
        if not bracket or unit not in units:
            raise LandingError(
                f"{name}: column {cell!r} has no unit of its kind; write {column} "
                f"[{'] or ['.join(units)}]"
            )
        if column in found:
            raise LandingError(f"{name} has two columns {column}; leave one")
        found[column] = (place, units[unit])
    missing = [column for column in kinds if column not in found]
    if missing:
        raise LandingError(
            f"{name} has no column {first_of(missing)}; give all, zeros for what does not move"
        )
    return found


def _row(name: str, line: int, cells: Sequence[str], sizes: dict[str, tuple[int, float]]) -> Row:
    """The numbers of a row in SI, in the order of `columns`."""
    if len(cells) != len(sizes):
        raise LandingError(
            f"{name}, line {line}, has {len(cells)} values under {len(sizes)} headings; "
            "give every column a value"
        )
    numbers = []
    for column, _ in columns():
        place, size = sizes[column]
        try:
            number = float(cells[place])
        except ValueError:
            what = repr(cells[place]) if cells[place] else "a hole"
            raise LandingError(
                f"{name}, line {line}, has {what} for {column}; give a number"
            ) from None
        if not isfinite(number):
            raise LandingError(f"{name}, line {line}: {column} = {number:g} is not finite")
        numbers.append(number * size)
    return tuple(numbers)


def _checked(found: Operators) -> Operators:
    for what, values, least in (
        ("frequencies", found.frequencies, 2),
        ("directions", found.directions, 1),
    ):
        grows = all(a < b for a, b in pairwise(values))
        if len(values) < least or not grows or not all(map(isfinite, values)):
            raise LandingError(
                f"{OPERATORS}: its {len(values)} {what} do not grow; give at least {least}, "
                "finite, each above the last"
            )
    if found.frequencies[0] < 0.0 or max(map(abs, found.directions)) > 2.0 * pi:
        raise LandingError(
            f"{OPERATORS}: frequencies from {found.frequencies[0]:g} rad/s, directions from "
            f"{found.directions[0]:g} to {found.directions[-1]:g} rad; give frequencies from 0 on, "
            "directions within a turn"
        )
    nodes = len(found.frequencies) * len(found.directions)
    if nodes > MOST_ROWS:
        raise LandingError(f"{OPERATORS} has {nodes} rows, the limit is {MOST_ROWS}; give fewer")
    if len(found.rows) != nodes or len(found.rows[-1]) != 2 * len(FREEDOMS):
        raise LandingError(
            f"{OPERATORS} has {len(found.rows)} rows for {len(found.frequencies)} frequencies in "
            f"{len(found.directions)} directions; give every one a row"
        )
    for k, row in enumerate(found.rows):
        for freedom, amplitude, lead in zip(FREEDOMS, row[::2], row[1::2]):
            if not (0.0 <= amplitude <= LARGEST[freedom] and abs(lead) <= 1e3):
                raise LandingError(
                    f"{OPERATORS}, row {k + 1}: {freedom} of amplitude {amplitude:g} and phase "
                    f"{lead:g} rad is outside [0, {LARGEST[freedom]:g}] "
                    f"{'rad/m' if freedom in TURNS else 'm/m'} or [-1000, 1000] rad"
                )
    return found
