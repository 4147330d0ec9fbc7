"""Inputs of a landing over time, from a CSV file.

The first row has headings: `time`, and names of inputs with their units in brackets (default SI),
`external.force_x [kN]`. Times ascend. An input is linear between its rows; before the first it has
the first one's value, after the last the last one's. Two rows of one time are a jump. Where the
ground's rates have no columns, they are the slopes of its positions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from math import ceil, floor, inf, isfinite
from pathlib import Path
from typing import NamedTuple

from rlv_landing.errors import LandingError, unknown
from rlv_landing.inputs.driven import RATE_INPUTS
from rlv_landing.parameters import check_value
from rlv_landing.quantities import INPUTS_BY_NAME, Quantity
from rlv_landing.text.files import read_csv
from rlv_landing.text.units import Unit, UnitError, parse_number
from rlv_landing.text.values import check_row, number_in_si, split_heading, unit_of

TIME = Quantity("s", "time since the start", 0.0, inf, name="time")


class Setting(NamedTuple):
    """Inputs that are set at a time [s]: values by name [SI], and rates by name [SI/s]."""

    time: float
    values: dict[str, float]
    rates: dict[str, float]


@dataclass(frozen=True)
class InputTable:
    """Values of inputs over time.

    Attributes:
        times: The times [s], ascending.
        columns: The values by input [SI], one a time.
    """

    times: list[float]
    columns: dict[str, list[float]]

    def settings(self) -> list[Setting]:
        """What is set, in the order of time, the first at 0."""
        found = []
        for i, time in enumerate(self.times):
            values = {name: column[i] for name, column in self.columns.items()}
            found.append(Setting(time, values, self._rates(i)))
        first = found[0]
        if first.time > 0.0:
            found.insert(0, Setting(0.0, first.values, dict.fromkeys(first.rates, 0.0)))
        return found

    def _rates(self, i: int) -> dict[str, float]:
        """The rates of the inputs from row `i` to the next."""
        last = i + 1 == len(self.times)
        interval = inf if last else self.times[i + 1] - self.times[i]
        rates = {}
        for name, column in self.columns.items():
            if RATE_INPUTS.get(name) in self.columns or name in RATE_INPUTS.values():
                continue
            step = 0.0 if last else column[i + 1] - column[i]
            rates[name] = step / interval if interval > 0.0 else 0.0
        return rates


def read_inputs(path: Path, inputs: Mapping[str, Quantity] = INPUTS_BY_NAME) -> InputTable:
    """The table in a CSV file, see this module's docstring.

    Args:
        path: The file.
        inputs: The inputs that there are, by name.

    Raises:
        LandingError: The file is missing or cannot be read, a column is missing, unknown or
            doubled, a unit is wrong, a value is no number or out of bounds, times do not ascend,
            or there are no rows.
    """
    names: list[str] = []
    units: list[Unit] = []
    rows: list[list[float]] = []
    for line, cells in read_csv(path, "table of inputs"):
        if not names:
            names, units = _headings(path, cells, inputs)
            continue
        try:
            rows.append(_values([inputs.get(name, TIME) for name in names], units, cells))
            if len(rows) > 1 and rows[-1][0] < rows[-2][0]:
                raise LandingError(
                    f"time = {rows[-1][0]:g} s comes after {rows[-2][0]:g} s; sort the rows by time"
                )
        except LandingError as e:
            raise LandingError(f"{path}, line {line}: {e}") from None
    if not rows:
        raise LandingError(f"{path} has no rows of inputs")
    order = [i for i, name in enumerate(names) if name != TIME.name]
    return InputTable([row[0] for row in rows], {names[i]: [row[i] for row in rows] for i in order})


def _headings(
    path: Path, cells: list[str], inputs: Mapping[str, Quantity]
) -> tuple[list[str], list[Unit]]:
    names, units = [], []
    for heading in cells:
        name, unit = split_heading(heading)
        try:
            if name != TIME.name and name not in inputs:
                raise unknown("input", name, [TIME.name, *inputs])
            units.append(unit_of(inputs.get(name, TIME), unit))
        except LandingError as e:
            raise LandingError(f"{path}, column {heading!r}: {e}") from None
        if name in names:
            raise LandingError(f"{path} has two columns of {name}; leave one")
        names.append(name)
    if names[0] != TIME.name or len(names) == 1:
        raise LandingError(
            f"{path} must have a column time [s] first, and behind it columns of inputs, "
            "for example external.force_x [kN]"
        )
    return names, units


def _values(quantities: list[Quantity], units: list[Unit], cells: list[str]) -> list[float]:
    check_row(cells, [q.name for q in quantities])
    values = []
    for q, unit, text in zip(quantities, units, cells):
        try:
            number = parse_number(text.strip())
        except UnitError as e:
            raise LandingError(f"{q.name} = {text.strip()!r} is no number: {e}") from None
        value = float(check_value(q, number_in_si(q, number, unit)))
        if not isfinite(value):
            raise LandingError(f"{q.name} = {value:g} {q.unit} must be finite")
        values.append(value)
    return values


def sloped(settings: Sequence[Setting]) -> list[str]:
    """The inputs that have rates which are no inputs of their own, by name."""
    rates = (name for s in settings for name, rate in s.rates.items() if rate != 0.0)
    return [name for name in dict.fromkeys(rates) if name not in RATE_INPUTS]


def in_steps(settings: Sequence[Setting], step: float, until: float) -> Iterator[Setting]:
    """What is set where `sloped` inputs cannot have rates: their means in each step.

    Args:
        settings: What is set, in the order of time.
        step: The length of the steps [s], which begin at its multiples.
        until: The end [s], after which nothing is set.
    """
    for setting, following in pairwise([*settings, Setting(until, {}, {})]):
        if setting.time >= until:
            return
        rates = {name: setting.rates[name] for name in sloped([setting])}
        others = {name: rate for name, rate in setting.rates.items() if name in RATE_INPUTS}
        time, end, values = setting.time, min(following.time, until), setting.values
        first = floor(time / step * (1.0 + 1e-12) + 1e-9) + 1
        last = ceil(end / step * (1.0 - 1e-12) - 1e-9) if rates else first
        edges = chain([time], (k * step for k in range(first, last)), [end])
        for start, stop in pairwise(edges):
            means = {
                name: values[name] + rate * ((start + stop) / 2.0 - time)
                for name, rate in rates.items()
            }
            whole = start == time
            yield Setting(start, {**(values if whole else {}), **means}, others if whole else {})


def constants(values: Mapping[str, float | str]) -> list[Setting]:
    """Inputs that keep their values by name [SI]."""
    return [Setting(0.0, {name: float(value) for name, value in values.items()}, {})]
