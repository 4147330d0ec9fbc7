"""Scalars that a user measured, from a CSV file.

The columns `id` and `value` are needed; `unit`, `mode`, `weight` and `scale` are there where they
say something. An id is that of a scalar that the paper prints, or the name of a response of sweeps.
The unit stands in its column, in the heading (`value [kN]`), or behind the number (`-4.3 kN`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import inf
from pathlib import Path

from ...errors import LandingError, unknown
from ...parameters import Parameters
from ...quantities import MODES, OUTPUT_NAMES, Quantity
from ...studies.sweep.responses import REDUCTIONS, known_responses
from ...text.files import read_csv
from ...text.units import UnitError, parse_unit, split
from ...text.values import parse_value, split_heading, to_si
from ...validation.paper import Scalar, other_vehicle, printed_scalars
from ..targets import Wanted

# units of the paper's numbers
SI_UNITS = {"N": "N", "s": "s", "mm": "m", "m/s2": "m/s2"}
NEEDED = ("id", "value")
COLUMNS = (*NEEDED, "unit", "mode", "weight", "scale")
WEIGHT = Quantity("", "factor of a misfit", 1e-6, 1e6, name="weight")
# without limits no landing passes one
NO_NUMBER = "outcome.first_limit_time"


def read_targets(
    path: Path, mode: str | None = None, parameters: Parameters | None = None
) -> list[Wanted]:
    """Targets from a CSV file, see this module's docstring.

    Args:
        path: The file.
        mode: The landing mode of responses that say none, and the only one whose targets count;
            None: every target counts, and a response must say its mode.
        parameters: The vehicle; None: the paper's.

    Raises:
        LandingError: There is no such file, a column is missing or unknown, an id is unknown, comes
            twice or is no number, its mode is missing or another than the id's, a value is not a
            finite number or has the wrong unit, a value of 0 has no scale, or nothing is left. One
            of the paper's scalars is also refused for another vehicle.
    """
    found: dict[str, Wanted] = {}
    others = other_vehicle(parameters) if parameters is not None else []
    for line, row in _rows(path):
        try:
            wanted = _target(row, mode, others)
        except LandingError as e:
            raise LandingError(f"{path}, line {line}: {e}") from None
        if wanted.label in found:
            raise LandingError(f"{path}, line {line}: {wanted.label} is there twice; leave one")
        found[wanted.label] = wanted
    if not found:
        raise LandingError(
            f"{path} holds no targets; write a line for each: id,value,unit, for example "
            "leg[1].main_strut.force.min,-4.3,kN"
        )
    kept = [t for t in found.values() if mode in (None, t.mode)]
    if not kept:
        raise LandingError(f"{path} holds no targets of --mode {mode}; choose the other, or none")
    return kept


def _target(row: dict[str, str], mode: str | None, others: list[str]) -> Wanted:
    for field in NEEDED:
        if not row.get(field):
            raise LandingError(
                f"no {field}; columns are {', '.join(NEEDED)}, and where needed "
                f"{', '.join(COLUMNS[len(NEEDED) :])}"
            )
    printed = {s.id: s for s in printed_scalars()}
    name, own_mode = row["id"], row.get("mode") or None
    if own_mode is not None and own_mode not in MODES:
        raise unknown("landing mode", own_mode, MODES)
    if name in printed:
        wanted = _printed(row, printed[name], own_mode, others)
    else:
        wanted = _response(row, _quantity(name, printed), own_mode or mode)
    if row.get("weight"):
        wanted = replace(wanted, weight=float(parse_value(WEIGHT, row["weight"])))
    return wanted


def _printed(row: dict[str, str], s: Scalar, mode: str | None, others: list[str]) -> Wanted:
    if others:
        raise LandingError(
            f"{s.id} is read in the paper's windows of time, and this is another vehicle "
            f"({others[0]}); name a response, for example leg[3].main_strut.stroke.max"
        )
    if mode not in (None, s.mode):
        raise LandingError(f"{s.id} is a number of {s.mode}, and its mode is {mode}; leave it out")
    q = Quantity(SI_UNITS[s.unit], s.quantity, name=s.id, display_unit=s.unit)
    own = parse_unit(s.unit)
    value = own.from_si(float(parse_value(q, row["value"], _unit(row, "value", q))))
    near_zero = abs(value) < 0.1 * s.scale
    scale = own.from_si(_scale(row, q)) if row.get("scale") else 0.0
    return Wanted(s.id, s.mode, value, scale or (s.scale if near_zero else abs(value)), s.unit)


def _quantity(name: str, printed: Iterable[str]) -> Quantity:
    """The response of this name."""
    known = known_responses()
    if name in OUTPUT_NAMES:
        first, *others = REDUCTIONS
        raise LandingError(
            f"{name} is a curve; name a reading of it, {name}.{first} (or "
            f"{', '.join(f'.{reading}' for reading in others)}), or give it by --series"
        )
    if name not in known:
        raise unknown("scalar or response", name, [*printed, *known])
    if known[name].kind != "real" or name == NO_NUMBER:
        raise LandingError(f"{name} is not a number that varies continuously; name another")
    return known[name]


def _response(row: dict[str, str], q: Quantity, mode: str | None) -> Wanted:
    if mode is None:
        raise LandingError(
            f"{q.name} says no landing mode; add a column mode ({' or '.join(MODES)}), "
            "or choose one for all by --mode"
        )
    unit = _unit(row, "value", q)
    in_si = float(parse_value(q, row["value"], unit))
    own = parse_unit(unit) if unit else None
    value = own.from_si(in_si) if own is not None else in_si
    if row.get("scale"):
        scale_si = _scale(row, q)
        scale = own.from_si(scale_si) if own is not None else scale_si
    elif value:
        scale = abs(value)
    else:
        raise LandingError(
            f"{q.name} = 0 has no size to judge a difference on; give the difference that counts "
            "as 100 % in a column scale"
        )
    return Wanted(q.name, mode, value, scale, unit)


def _scale(row: dict[str, str], q: Quantity) -> float:
    """The scale of a row [SI]."""
    about = replace(q, name=f"scale of {q.name}", lo=-inf, hi=inf)
    scale = to_si(about, row["scale"], _unit(row, "scale", q))
    if not 0.0 < scale < inf:
        raise LandingError(f"{about.name} = {scale:g} {q.unit} must be finite and above 0")
    return scale


def _unit(row: dict[str, str], field: str, q: Quantity) -> str:
    """The unit of a row's value: behind the number, in the heading, or in the column `unit`.

    The column is that of the value; a scale has it where nothing else says its unit.

    Raises:
        LandingError: There is none, and the quantity has a unit, or there are two.
    """
    try:
        behind = split(row[field])[1]
    except UnitError:
        # the value's own reader says why
        behind = ""
    heading, column = row.get(f"{field} unit", ""), row.get("unit", "")
    given = [u for u in (behind, heading, column if field == "value" else "") if u]
    if len(set(given)) > 1:
        raise LandingError(
            f"{field} = {row[field]!r} has the units {' and '.join(given)}; leave one"
        )
    unit = given[0] if given else column
    if not unit and q.unit and field == "value":
        raise LandingError(
            f"no unit of {q.name}; write it in a column unit, or in the heading: "
            f"value [{q.display_unit or q.unit}]"
        )
    return unit


def _rows(path: Path) -> Iterable[tuple[int, dict[str, str]]]:
    """The rows as cells by column; a heading's unit is the cell `value unit` or `scale unit`."""
    names: list[str] = []
    units: dict[str, str] = {}
    missing = f"targets {path} cannot be read: there is no such file"
    for line, row in read_csv(path, "targets", missing):
        cells = [cell.strip() for cell in row]
        if names:
            if len(cells) != len(names):
                raise LandingError(
                    f"{path}, line {line}: {len(cells)} cells for {len(names)} columns; give every "
                    "column a cell, which may be empty, and write numbers with a point"
                )
            yield line, {**units, **dict(zip(names, cells))}
        else:
            names, units = _headings(path, cells)


def _headings(path: Path, cells: list[str]) -> tuple[list[str], dict[str, str]]:
    split_cells = [split_heading(cell) for cell in cells]
    names = [name for name, _ in split_cells]
    units = {f"{name} unit": unit for name, unit in split_cells if unit}
    for name in names:
        if name not in COLUMNS:
            raise LandingError(f"{path}: {unknown('column', name, COLUMNS)}")
        if names.count(name) > 1:
            raise LandingError(f"{path}: column {name} is there {names.count(name)} times")
    for key in units:
        if key not in ("value unit", "scale unit"):
            raise LandingError(f"{path}: column {key.split()[0]} takes no unit in its heading")
    return names, units
