"""Values of quantities from what users write: numbers in SI, or texts with a unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from ..errors import LandingError
from ..parameters import check_value
from ..quantities import Quantity, shown
from .units import DIMENSIONLESS, Unit, UnitError, parse_unit, split

_HEADING = re.compile(r"\s*(\S+?)\s*(?:\[([^\[\]]*)\])?\s*")


def parse_value(q: Quantity, value: Any, unit: str = "") -> float | str:
    """The value of the quantity `q` in SI, from a number or a text such as "-2 deg".

    Args:
        q: The quantity.
        value: The number or text.
        unit: The unit of numbers, and of texts without one; an empty one is SI.

    Raises:
        LandingError: No number, an unknown unit, a unit of another dimension, or out of bounds.
    """
    if q.kind == "string" or not is_number(value):
        return check_value(q, value)
    return check_value(q, to_si(q, value, unit))


def parse_values(q: Quantity, values: Sequence[Any]) -> list[float | str]:
    """The values of `q` in SI that are given together, as `parse_value` and `check_together`."""
    check_together(q, [v for v in values if is_number(v)])
    return [parse_value(q, value) for value in values]


def is_number(value: Any) -> bool:
    """Whether a value from TOML can be a number: one, or a text."""
    return isinstance(value, (int, float, str)) and not isinstance(value, bool)


def check_together(q: Quantity, values: Sequence[Any]) -> None:
    """Check values that are given together, such as the ends of a range: all have a unit, or none.

    In "-10..10 deg" the first would be in SI. A zero needs no unit.

    Raises:
        LandingError: One has a unit and another has none, or as `to_si`.
    """
    if q.kind == "string":
        return
    in_si = [to_si(q, v) for v in values]
    with_unit = [v for v in values if _has_unit(v)]
    bare = [v for v, si in zip(values, in_si) if si != 0.0 and not _has_unit(v)]
    if bare and with_unit:
        raise LandingError(
            f"{q.name} = {bare[0]} has no unit, and {with_unit[0]!r} beside it has one; "
            "give every value its unit"
        )


def to_si(q: Quantity, value: float | str, unit: str = "") -> float:
    """A number or text as a value of `q` in SI, whose bounds are not checked; as `parse_value`.

    Raises:
        LandingError: No number, an unknown unit, a unit of another dimension, or beyond the largest
            float; or `q` is a text.
    """
    if q.kind == "string":
        raise LandingError(f"{q.name} is a text and has no number; give it as a fixed value")
    if isinstance(value, str):
        return _from_text(q, value, unit)
    return number_in_si(q, value, unit_of(q, unit))


def unit_of(q: Quantity, unit: str) -> Unit:
    """A unit in which `q` can be given; an empty one is SI.

    Raises:
        LandingError: The unit is unknown or of another dimension.
    """
    own = parse_unit(q.unit) if q.unit else DIMENSIONLESS
    if not unit.strip():
        return own
    try:
        found = parse_unit(unit)
    except UnitError as e:
        raise _no_value(q, f"1 {unit}", e) from None
    if found.dimension != own.dimension:
        raise _wrong_unit(q, f"1 {unit}")
    return found


def number_in_si(q: Quantity, number: float, unit: Unit) -> float:
    """A number of `q` in `unit`, in SI; NaN and infinity stay what they are.

    Raises:
        LandingError: The value is beyond the largest or the smallest float.
    """
    try:
        return unit.to_si(repr(float(number)))
    except (OverflowError, UnitError) as e:
        reason = e if isinstance(e, UnitError) else "it is beyond the largest number, 1.8e308"
        raise LandingError(f"{q.name}: {reason}; give it in {q.unit or 'plain numbers'}") from None


def split_heading(heading: str) -> tuple[str, str]:
    """Name and unit of a column's heading: `drop.tilt [deg]`; the unit is empty where none is.

    The brackets of a leg's number belong to the name.
    """
    found = _HEADING.fullmatch(heading)
    return (found[1], found[2] or "") if found else (heading.strip(), "")


def check_row(values: Sequence[str], headings: Sequence[object]) -> None:
    """Check that a row of a table has a value under each heading.

    Raises:
        LandingError: It has more or fewer.
    """
    if len(values) != len(headings):
        raise LandingError(
            f"{len(values)} values under {len(headings)} headings; give every column a value, "
            "with a point and no comma in it"
        )


def _from_text(q: Quantity, text: str, default: str) -> float:
    try:
        number, unit = split(text)
        if not unit:
            return unit_of(q, default).to_si(number)
        found = parse_unit(unit)
        value = found.to_si(number)
    except UnitError as e:
        raise _no_value(q, text, e) from None
    if found.dimension != unit_of(q, "").dimension:
        raise _wrong_unit(q, text)
    return value


def _has_unit(value: Any) -> bool:
    return isinstance(value, str) and bool(split(value)[1])


def _no_value(q: Quantity, text: str, reason: UnitError) -> LandingError:
    return LandingError(
        f"{q.name} = {text!r} is not a number with a unit: {reason}; write for example {example(q)}"
    )


def _wrong_unit(q: Quantity, text: str) -> LandingError:
    return LandingError(
        f"{q.name} = {text!r} has the wrong unit; give it in {q.unit or 'plain numbers'}, "
        f"or as text in {q.display_unit or q.unit or '%'}"
    )


def example(q: Quantity) -> str:
    """A value of `q` as a user may write it: its default, in the unit that people read."""
    unit, size = shown(q)
    value = f"{float(q.default) / size:g}"
    return f'"{value} {unit}"' if unit else value
