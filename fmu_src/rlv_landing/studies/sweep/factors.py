"""The factors of a study: the quantities that vary, their units and distributions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, floor, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import LandingError, unknown
from ...parameters import check_value
from ...parameters.space import WHOLE_NUMBERS
from ...quantities import Quantity, shown
from ...text.values import check_together, is_number, to_si, unit_of
from .. import toml_keys
from ..variables import VARIABLES, variable

Array = NDArray[np.float64]
# most points of a study
LARGEST = 100_000_000
DISTRIBUTIONS = {
    "uniform": ("low", "high", "count"),
    "normal": ("mean", "deviation", "low", "high"),
    "choice": ("values",),
}
ALL_KEYS = ("name", "unit", "distribution", "low", "high", "count", "mean", "deviation", "values")


@dataclass(frozen=True)
class Factor:
    """One factor, all numbers in SI; `unit` is the one that the study gave, for printing.

    - uniform: evenly between `low` and `high`; in a grid `count` levels, both ends included.
    - normal: `mean` and `deviation`, cut off at `low` and `high`.
    - choice: each of `values` with the same probability.

    Of parameters that are whole numbers, uniform is each of them, and normal the nearest.
    """

    quantity: Quantity
    unit: str
    distribution: str
    low: float = 0.0
    high: float = 0.0
    mean: float = 0.0
    deviation: float = 0.0
    count: int = 0
    values: tuple[float | str, ...] = ()

    @property
    def name(self) -> str:
        """The quantity's name."""
        return self.quantity.name

    @property
    def _is_whole(self) -> bool:
        return self.name in WHOLE_NUMBERS

    def quantiles(self, probabilities: Array) -> NDArray[Any]:
        """The distribution's quantiles at `probabilities`, 0 to 1."""
        if self.distribution == "choice":
            which = np.minimum((probabilities * len(self.values)).astype(int), len(self.values) - 1)
            chosen: NDArray[Any] = column(self.values)[which]
            return chosen
        if self.distribution == "normal":
            from scipy.stats import truncnorm

            low, high = (
                (self.low - self.mean) / self.deviation,
                (self.high - self.mean) / self.deviation,
            )
            drawn: Array = truncnorm.ppf(probabilities, low, high, self.mean, self.deviation)
            return np.clip(np.rint(drawn) if self._is_whole else drawn, self.low, self.high)
        if self._is_whole:
            first, count = ceil(self.low), floor(self.high) - ceil(self.low) + 1
            steps: Array = np.minimum(np.floor(count * probabilities), count - 1)
            return first + steps
        return np.clip(self.low + (self.high - self.low) * probabilities, self.low, self.high)

    def levels(self) -> NDArray[Any]:
        """The values of a grid.

        Raises:
            LandingError: The factor has no levels.
        """
        count = self.level_count()
        if self.distribution == "choice":
            return column(self.values)
        return np.linspace(self.low, self.high, count)

    def level_count(self) -> int:
        """The number of values of a grid.

        Raises:
            LandingError: The factor has no levels.
        """
        if self.distribution == "choice":
            return len(self.values)
        if self.distribution == "uniform" and self.count:
            return self.count
        raise LandingError(
            f"factor {self.name}: a grid needs values = [...], or low, high and count"
        )

    def record(self) -> dict[str, Any]:
        """Everything that decides the values, in SI, for the study's fingerprint and for JSON."""
        keys = DISTRIBUTIONS[self.distribution]
        return {
            "name": self.name,
            "distribution": self.distribution,
            **{k: getattr(self, k) for k in keys},
        }


def column(values: Any) -> NDArray[Any]:
    """Values as an array: of floats, or of objects where a text is among them."""
    values = list(values)
    return np.array(values, dtype=object if any(isinstance(v, str) for v in values) else float)


def read_factor(entry: Mapping[str, Any]) -> Factor:
    """A factor from a `[[factor]]` table.

    Raises:
        LandingError: No name or an unknown one, unknown keys, a wrong unit, missing or bad numbers,
            or an empty range.
    """
    if "name" not in entry:
        raise LandingError('a [[factor]] has no name; write for example name = "drop.tilt"')
    q = variable(entry["name"], "factor")
    where = f"factor {q.name}"
    toml_keys.refuse_unknown(entry, ALL_KEYS, f"key of {where}")
    unit = entry.get("unit", "")
    if not isinstance(unit, str):
        raise LandingError(
            f"{where}: unit = {unit!r} must be a text, "
            f'for example unit = "{q.display_unit or q.unit}"'
        )
    distribution = _distribution(entry, where)
    if q.choices and distribution != "choice":
        raise LandingError(f"{where} is one of {', '.join(q.choices)}; give values = [...]")
    if not q.choices:
        unit_of(q, unit)
    count = _count(where, entry.get("count", 0))
    numbers = _Numbers(q, entry, unit)
    unit = unit or q.unit
    if distribution == "choice":
        values = _values(where, entry.get("values"))
        return Factor(q, unit, distribution, values=_choices(q, numbers.all_of(values)))
    mean = deviation = 0.0
    low, high = q.lo, q.hi
    if distribution == "normal":
        mean, deviation = (
            numbers.needed("mean", distribution),
            numbers.needed("deviation", "normal"),
        )
        if not (isfinite(mean) and 0.0 < deviation < float("inf")):
            raise LandingError(
                f"{where}: mean = {mean:g} and deviation = {deviation:g} {q.unit} must be finite, "
                "the deviation above 0"
            )
    if distribution == "uniform" or "low" in entry:
        low = numbers.needed("low", distribution)
    if distribution == "uniform" or "high" in entry:
        high = numbers.needed("high", distribution)
    _check_range(q, low, high, distribution)
    return Factor(q, unit, distribution, low, high, mean, deviation, count)


def _distribution(entry: Mapping[str, Any], where: str) -> str:
    """The distribution of a `[[factor]]` table, none of whose keys belongs to another."""
    distribution = entry.get("distribution", "choice" if "values" in entry else "uniform")
    if not isinstance(distribution, str) or distribution not in DISTRIBUTIONS:
        raise unknown(f"distribution of {where}", distribution, DISTRIBUTIONS)
    for key in entry:
        if key not in ("name", "unit", "distribution", *DISTRIBUTIONS[distribution]):
            raise LandingError(
                f"{where}: {key} does not belong to {distribution}, "
                f"which takes {', '.join(DISTRIBUTIONS[distribution])}"
            )
    return distribution


class _Numbers:
    """The numbers of a `[[factor]]` table, in SI; without `unit`, all have a unit or none."""

    def __init__(self, q: Quantity, entry: Mapping[str, Any], unit: str) -> None:
        self._q, self._entry, self._unit = q, entry, unit
        keys = ("low", "high", "mean", "deviation")
        given = [entry[key] for key in keys if key in entry]
        values = entry.get("values")
        given += values if isinstance(values, list) else []
        numbers = [v for v in given if is_number(v)]
        if not unit:
            check_together(q, numbers)

    def needed(self, key: str, distribution: str) -> float:
        """The number at `key`, whose bounds are not checked."""
        if key not in self._entry:
            raise LandingError(f"factor {self._q.name} has no {key}, which {distribution} needs")
        return self._in_si(key, self._entry[key])

    def all_of(self, values: Sequence[Any]) -> list[float | str]:
        """The values of a choice, whose bounds are not checked."""
        return [v if self._q.choices else self._in_si("values", v) for v in values]

    def _in_si(self, key: str, value: Any) -> float:
        if not is_number(value):
            raise LandingError(
                f"factor {self._q.name}: {key} = {value!r} is not a number; "
                f"give it in {self._unit or self._q.unit or 'plain numbers'}"
            )
        return to_si(self._q, value, self._unit)


def _check_range(q: Quantity, low: float, high: float, distribution: str) -> None:
    if not low < high:
        raise LandingError(
            f"factor {q.name}: the range from low = {low:g} to high = {high:g} {q.unit}".rstrip()
            + " is empty; low must be below high"
        )
    for bound in (low, high):
        if isfinite(bound) or distribution == "uniform":
            check_value(q, bound)
        if q.name in WHOLE_NUMBERS and not bound.is_integer():
            raise LandingError(f"factor {q.name}: {bound:g} is not a whole number")


def _values(where: str, values: Any) -> list[Any]:
    if not isinstance(values, list) or not values:
        raise LandingError(f"{where}: values = {values!r} must be a list of one value or more")
    return values


def _choices(q: Quantity, values: list[float | str]) -> tuple[float | str, ...]:
    checked = tuple(check_value(q, v) for v in values)
    if len(set(checked)) < len(checked):
        raise LandingError(f"factor {q.name}: values = {values} name a value twice")
    return checked


def _count(where: str, count: Any) -> int:
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= (count or 2) <= LARGEST:
        raise LandingError(f"{where}: count = {count!r} must be a whole number from 2 to {LARGEST}")
    return count


def value_text(name: str, value: float | str) -> str:
    """A value in its display unit, with the unit."""
    if isinstance(value, str):
        return value
    unit, scale = shown(VARIABLES[name])
    return f"{value / scale:g} {unit}".rstrip()
