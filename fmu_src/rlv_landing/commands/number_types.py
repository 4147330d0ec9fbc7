"""Types of options: numbers, with or without a unit, and whole numbers.

They read texts as `rlv_landing.text.units` does. Python's own `float` and `int` do not: those take
underscores and digits of every script.
"""

from __future__ import annotations

import re
from typing import Any

import click

from ..text.units import DIMENSIONLESS, UnitError, parse_unit, split

# whole numbers of more digits are no count of anything
MOST_DIGITS = 18
_WHOLE = re.compile(r"\s*[+-]?[0-9]+\s*")


class Number(click.types.FloatParamType):
    """A number in the SI unit `unit`, or a text with a unit of its dimension: "500 ms"."""

    def __init__(self, unit: str = "") -> None:
        super().__init__()
        self.unit = unit

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number in SI."""
        return _in_si(self, value, self.unit, param, ctx)


class NumberRange(click.FloatRange):
    """A `Number` between `lowest` and `highest` [SI]."""

    def __init__(
        self, lowest: float | None = None, highest: float | None = None, unit: str = ""
    ) -> None:
        super().__init__(lowest, highest)
        self.unit = unit

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number in SI, within the range."""
        number: float = super().convert(_in_si(self, value, self.unit, param, ctx), param, ctx)
        return number


class WholeNumber(click.IntRange):
    """A whole number of at most 18 digits, within a range where one is given."""

    def _describe_range(self) -> str:
        return "" if self.min is None and self.max is None else super()._describe_range()

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """The number, within the range."""
        number: int = super().convert(_digits(self, value, param, ctx), param, ctx)
        return number


def _digits(
    kind: click.types.IntParamType,
    value: Any,
    param: click.Parameter | None,
    ctx: click.Context | None,
) -> Any:
    """`value`, if it is a number, or a text of decimal digits; fails otherwise."""
    if isinstance(value, str):
        if not _WHOLE.fullmatch(value):
            kind.fail(f"{value!r} is not a valid integer.", param, ctx)
        if len(value.strip()) > MOST_DIGITS:
            years = len(value.strip()) - 11
            kind.fail(
                f"{value!r} has more than {MOST_DIGITS} digits; so many steps of 1 ms "
                f"would take 10^{years} years or more.",
                param,
                ctx,
            )
    return value


def _in_si(
    kind: click.types.FloatParamType,
    value: Any,
    own: str,
    param: click.Parameter | None,
    ctx: click.Context | None,
) -> float:
    if not isinstance(value, str):
        return float(value)
    wanted = parse_unit(own) if own else DIMENSIONLESS
    try:
        number, unit = split(value)
        found = parse_unit(unit) if unit else wanted
        if found.dimension != wanted.dimension:
            raise UnitError(f"give it in {own or 'plain numbers'}")
        return found.to_si(number)
    except UnitError as e:
        kind.fail(f"{value!r} is not a valid float: {e}.", param, ctx)
