"""The study of an envelope: two axes, families, and the criterion by which a landing is lost.

It is read from TOML and checked before anything lands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from math import ceil, log2, pi, prod
from pathlib import Path
from typing import Any

from ...choices import choose_parameters
from ...effort import check_duration, check_memory
from ...errors import LandingError, unknown
from ...parameters import PARAMETER_QUANTITIES, Parameters, check_value
from ...presets import to_toml
from ...quantities import Quantity
from ...text.values import check_together, is_number, parse_value, parse_values
from .. import toml_keys
from ..criteria import CRITERIA
from ..limits import LIMITS
from ..outcome import DEFAULT_SLIDE, SLIDE
from ..variables import (
    POLAR,
    VARIABLES,
    check_legs,
    check_variables,
    is_parameter,
    resolved,
    variable,
)
from .boundary import Lattice

FINEST = 20
LEGS = "vehicle.legs"
# a boundary: 9 landings or more of 1 ms or more; its values, landings and parameters
LEAST_SECONDS = 9e-3
BYTES_PER_FAMILY = 1000.0
TABLES = ("envelope", "set", "limits", "x", "y", "families")
UNTIL = Quantity(
    "s", "latest end of a landing that is neither at rest nor toppled", 0.1, 3600.0, name="until"
)
NUMBERS = {
    q.name: q
    for q in (
        Quantity("s", "time between samples", 1e-5, 0.1, name="every", default=1e-3),
        Quantity(
            "", "relative tolerance of the integrator", 1e-12, 1e-2, name="rtol", default=1e-5
        ),
        SLIDE,
    )
}
KEYS = ("preset", "parameters", "mode", "criterion", "cells", "levels", "until", *NUMBERS)
AXIS_KEYS = ("name", "low", "high", "tolerance")


@dataclass(frozen=True)
class Axis:
    """A quantity from `low` to `high`, its boundary found to `tolerance`, all in SI.

    Raises:
        LandingError: The quantity is unknown or has no numbers, the bounds are not allowed or not
            in order, or the tolerance is not above 0, above the range or below 2^-20 of it.
    """

    name: str
    low: float
    high: float
    tolerance: float

    def __post_init__(self) -> None:
        q = variable(self.name, "quantity for an axis")
        if q.choices:
            raise _no_axis(q)
        for value in (self.low, self.high):
            check_value(q, value)
        if not self.low < self.high:
            raise LandingError(
                f"{q.name}: low = {self.low:g} must be below high = {self.high:g} {q.unit}".rstrip()
            )
        least = (self.high - self.low) / 2**FINEST
        if not least <= self.tolerance <= self.high - self.low:
            raise LandingError(
                f"{q.name}: tolerance = {self.tolerance:g} {q.unit}".rstrip()
                + f" is outside [{least:g}, {self.high - self.low:g}] {q.unit}".rstrip()
                + "; give the resolution that you need"
            )

    @property
    def quantity(self) -> Quantity:
        """The quantity that is varied."""
        return VARIABLES[self.name]


@dataclass(frozen=True)
class EnvelopeStudy:
    """Everything that decides an envelope; values in SI.

    The flight before the first contact is left out: the axes are states at first contact.
    `families` are values by name, one boundary each; `polar` are a constant speed or direction.

    Raises:
        LandingError: A criterion or limit is unknown, `limit` has no limits, cells or levels are
            out of bounds, a quantity is both varied and set, or a family makes no vehicle.
    """

    parameters: Parameters
    x: Axis
    y: Axis
    families: tuple[Mapping[str, float | str], ...] = ({},)
    inputs: Mapping[str, float] = field(default_factory=dict)
    polar: Mapping[str, float] = field(default_factory=dict)
    criterion: str = "toppled"
    limits: Mapping[str, float] = field(default_factory=dict)
    cells: int = 8
    levels: int = 2
    until: float | None = None
    every: float = 1e-3
    rtol: float = 1e-5
    slide: float = DEFAULT_SLIDE

    def __post_init__(self) -> None:
        if self.criterion not in CRITERIA:
            raise unknown("criterion", self.criterion, CRITERIA)
        if self.criterion == "limit" and not self.limits:
            raise LandingError(
                'criterion = limit needs limits, for example [limits] main_strut.force = "20 kN"'
            )
        for name, value, lo, hi in (("cells", self.cells, 2, 256), ("levels", self.levels, 0, 6)):
            if not lo <= value <= hi:
                raise LandingError(f"{name} = {value} is outside [{lo}, {hi}]")
        given = [self.x.name, self.y.name, *(self.families[0] if self.families else ())]
        for name in given:
            if given.count(name) > 1:
                raise LandingError(f"{name} is given twice, as an axis or in families; leave one")
        check_legs(given, self.most_legs)
        for family in self.families:
            check_variables([*given, *self.inputs, *self.polar], [self.mode_of(family)])
            self.parameters_with(family)

    def parameters_with(self, values: Mapping[str, Any]) -> Parameters:
        """The parameters with those of `values` that are parameters.

        The landing starts at its first contact.
        """
        base = self.parameters.for_mode(self.mode_of(values))
        changed = resolved({**self.polar, **values}, base)
        own = {name: value for name, value in changed.items() if name in PARAMETER_QUANTITIES}
        return base.with_values({"drop.contact_time": 0.0, **own})

    def mode_of(self, values: Mapping[str, Any]) -> str:
        """The landing mode of these values."""
        return str(values.get("drop.mode", self.parameters.drop.mode))

    @property
    def most_legs(self) -> int:
        """The legs of the vehicle; where they vary, the most."""
        varied = [axis.high for axis in (self.x, self.y) if axis.name == LEGS]
        given = [float(family[LEGS]) for family in self.families if LEGS in family]
        return int(max(varied or given or [self.parameters.vehicle.legs]))

    @property
    def is_polar(self) -> bool:
        """Whether the axes are a direction along x, of one turn at most, and a speed along y."""
        turn = self.x.high - self.x.low
        polar = (self.y.name, self.x.name) == POLAR
        return polar and turn <= 2.0 * pi * (1.0 + 1e-9)

    @property
    def lattice(self) -> Lattice:
        """The fine lattice, whose unit along each axis is at most the axis' tolerance."""

        def steps(axis: Axis) -> int:
            halvings = ceil(log2((axis.high - axis.low) / self.cells / axis.tolerance))
            return int(2 ** max(self.levels, halvings))

        return Lattice(self.cells, self.levels, (steps(self.x), steps(self.y)))

    @property
    def fewest_landings(self) -> int:
        """The number of landings at the corners of all coarse cells, which all are made."""
        return len(self.families) * (self.cells + 1) ** 2

    def values_at(self, x: float, y: float) -> tuple[float, float]:
        """The values (x, y) [SI] of a point of the fine lattice."""
        width, height = self.lattice.size
        return (
            self.x.low + (self.x.high - self.x.low) * x / width,
            self.y.low + (self.y.high - self.y.low) * y / height,
        )

    def record(self) -> dict[str, Any]:
        """Everything that decides the results, for a file and for comparing studies."""
        return {
            "x": vars(self.x),
            "y": vars(self.y),
            "families": [dict(f) for f in self.families],
            "inputs": {**self.inputs, **self.polar},
            "criterion": self.criterion,
            "limits": dict(self.limits),
            "cells": self.cells,
            "levels": self.levels,
            "until": self.until,
            "every": self.every,
            "rtol": self.rtol,
            "slide": self.slide,
            "parameters": to_toml(self.parameters, comments=False),
        }


def study_from(document: Mapping[str, Any], folder: Path = Path()) -> EnvelopeStudy:
    """A study from its TOML document; `docs/envelope.md` has every key.

    Args:
        document: The document.
        folder: The folder in which a parameter file that it names lies.

    Raises:
        LandingError: Unknown keys or names, wrong units, values out of bounds, no axes, or an empty
            family.
    """
    toml_keys.refuse_unknown(document, TABLES, "table")
    keys = toml_keys.table(document, "envelope")
    toml_keys.refuse_unknown(keys, KEYS, "key of [envelope]")
    fixed = toml_keys.values(toml_keys.table(document, "set"), VARIABLES, "quantity in [set]")
    families = read_families(toml_keys.by_dotted_name(toml_keys.table(document, "families")))
    x, y = _axis(document, "x"), _axis(document, "y")
    for name in (x.name, y.name, *families[0]):
        if name in fixed:
            raise LandingError(f"{name} is both set and varied; leave one")
    file = folder / toml_keys.text(keys, "parameters", "") if "parameters" in keys else None
    preset = toml_keys.text(keys, "preset", "") if "preset" in keys else None
    mode = toml_keys.text(keys, "mode", "") if "mode" in keys else None
    parameters = choose_parameters(
        preset, file, mode, {n: v for n, v in fixed.items() if n in PARAMETER_QUANTITIES}
    )
    limits = toml_keys.values(toml_keys.table(document, "limits"), LIMITS, "limit")
    numbers = {name: toml_keys.number(keys, q) for name, q in NUMBERS.items()}
    return EnvelopeStudy(
        parameters,
        x,
        y,
        families,
        inputs={n: float(v) for n, v in fixed.items() if not is_parameter(n)},
        polar={n: float(v) for n, v in fixed.items() if n in POLAR},
        criterion=toml_keys.text(keys, "criterion", "toppled"),
        limits={name: float(v) for name, v in limits.items()},
        cells=toml_keys.integer(keys, "cells", 8, 2, 256),
        levels=toml_keys.integer(keys, "levels", 2, 0, 6),
        until=toml_keys.number(keys, UNTIL) if "until" in keys else None,
        **numbers,
    )


def read_families(keys: Mapping[str, Any]) -> tuple[dict[str, float | str], ...]:
    """Every combination of the values given by name; one empty family where there are none."""
    toml_keys.refuse_unknown(keys, VARIABLES, "quantity in [families]")
    columns: list[Sequence[float | str]] = []
    for name, values in keys.items():
        if not isinstance(values, (list, tuple)) or not values:
            raise LandingError(
                f"families: {name} = {values!r} must be a list of one value or more, "
                'for example ["0 deg", "5 deg"]'
            )
        column = parse_values(VARIABLES[name], values)
        if len(set(column)) < len(column):
            raise LandingError(f"families: {name} = {values} names a value twice")
        columns.append(column)
    count = prod(map(len, columns))
    remedy = "take fewer values"
    check_duration(f"families of {count:.12g} boundaries", LEAST_SECONDS * count, remedy)
    check_memory(f"families of {count:.12g} boundaries", BYTES_PER_FAMILY * count, remedy)
    return tuple(dict(zip(keys, chosen)) for chosen in product(*columns))


def _axis(document: Mapping[str, Any], key: str) -> Axis:
    keys = toml_keys.table(document, key)
    toml_keys.refuse_unknown(keys, AXIS_KEYS, f"key of [{key}]")
    for needed in ("name", "low", "high"):
        if needed not in keys:
            raise LandingError(
                f'[{key}] has no {needed}; an axis is name = "drop.tilt", low = "-10 deg", '
                'high = "10 deg", tolerance = "0.5 deg"'
            )
    q = variable(toml_keys.text(keys, "name", ""), "quantity for an axis")
    if q.choices:
        raise _no_axis(q)
    given = [keys[key] for key in ("low", "high", "tolerance") if key in keys]
    check_together(q, [v for v in given if is_number(v)])
    low, high = (float(parse_value(q, keys[bound])) for bound in ("low", "high"))
    tolerance = (high - low) / 128.0
    if "tolerance" in keys:
        tolerance = float(parse_value(replace(q, lo=0.0, hi=float("inf")), keys["tolerance"]))
    return Axis(q.name, low, high, tolerance)


def _no_axis(q: Quantity) -> LandingError:
    return LandingError(
        f"{q.name} is one of {', '.join(q.choices)} and cannot be an axis; make it a family"
    )
