"""The facts beside a parameter's meaning in its declaration.

A parameter is a field of a group: `name: Annotated[type, meaning, facts] = default`.
"""

from __future__ import annotations

from ..quantities import Quantity
from ..quantities.quantity import Source


def real(
    unit: str,
    lo: float,
    hi: float,
    symbol: str = "",
    source: Source = "closure",
    display_unit: str = "",
) -> Quantity:
    """A number in the SI `unit` from `lo` to `hi`; see `Quantity` for the others."""
    return Quantity(unit, "", lo, hi, symbol, source, display_unit)


def text(*choices: str, source: Source = "closure") -> Quantity:
    """One of the texts `choices`."""
    return Quantity("", "", source=source, choices=choices)


def listed(source: Source = "closure") -> Quantity:
    """A text with a form of its own: a list of values."""
    return Quantity("", "", source=source, kind="string")
