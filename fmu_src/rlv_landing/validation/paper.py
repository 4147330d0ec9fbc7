"""The numbers that Yue, Lin, Zheng and Du (2022) print in section 5, beside those of a landing.

`reading.py` defines how each is read from a landing. Here is the scale on which a difference is
judged: the printed simulation value itself, or its curve's largest where the value is near zero.
Times are from the start of the landing, as the paper's axes.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np

from ..history import History
from ..parameters import PARAMETER_QUANTITIES, Parameters
from .own_reading import OwnReading
from .reading import RUN_AFTER_CONTACT, Reading

__all__ = [
    "MEANINGS",
    "RUN_AFTER_CONTACT",
    "Comparison",
    "Reading",
    "Scalar",
    "compare",
    "counts",
    "other_vehicle",
    "paper_counts_against_test",
    "printed_scalars",
    "reading_of",
]

NUMBERS = Path(__file__).with_name("paper_numbers.csv")
NEAR_ZERO = 0.1
LEVELS = (5, 10, 20)
NAN = float("nan")


@dataclass(frozen=True)
class Scalar:
    """One printed number.

    `simulation` and up to two tests are in `unit` (s, N, mm, m/s2); NaN where none is printed.
    """

    id: str
    mode: str
    quantity: str
    leg: int
    event: str
    unit: str
    simulation: float
    test_a: float
    test_b: float

    @property
    def test(self) -> float:
        """The mean of the printed tests; NaN where there is none."""
        tests = [v for v in (self.test_a, self.test_b) if not np.isnan(v)]
        return sum(tests) / len(tests) if tests else NAN

    @property
    def near_zero(self) -> bool:
        """Whether the printed simulation is near zero.

        That is below 10 % of the largest printed of the same quantity, unit and mode.
        """
        return abs(self.simulation) < NEAR_ZERO * _curve_scale(self.quantity, self.unit, self.mode)

    @property
    def scale(self) -> float:
        """The scale of differences from this scalar.

        It is |simulation|, or its curve's largest printed value where the scalar is near zero.
        """
        return (
            _curve_scale(self.quantity, self.unit, self.mode)
            if self.near_zero
            else abs(self.simulation)
        )

    @property
    def paper_error_test(self) -> float:
        """The paper's own (simulation - test)/scale, a fraction; NaN without a test."""
        return (self.simulation - self.test) / self.scale


@dataclass(frozen=True)
class Comparison:
    """One printed number beside ours.

    Errors are fractions of the scalar's `scale`, one scale for simulation and test alike.
    """

    scalar: Scalar
    ours: float

    @property
    def error(self) -> float:
        """(ours - simulation)/scale."""
        return (self.ours - self.scalar.simulation) / self.scalar.scale

    @property
    def error_test(self) -> float:
        """(ours - test)/scale; NaN where the paper prints no test."""
        return (self.ours - self.scalar.test) / self.scalar.scale


@cache
def printed_scalars() -> tuple[Scalar, ...]:
    """The 48 printed scalars."""
    with NUMBERS.open(newline="", encoding="utf-8") as f:
        rows = list(csv.DictReader(f))

    def number(text: str) -> float:
        return float(text) if text else NAN

    return tuple(
        Scalar(r["id"], r["mode"], r["quantity"], int(r["leg"] or 0), r["event"], r["unit"],
               number(r["simulation"]), number(r["test_a"]), number(r["test_b"]))
        for r in rows
    )  # fmt: skip


@cache
def _curve_scale(quantity: str, unit: str, mode: str) -> float:
    return max(
        abs(s.simulation)
        for s in printed_scalars()
        if (s.quantity, s.unit, s.mode) == (quantity, unit, mode)
    )


# the reading of each printed scalar by its id, and the leg that is read
MEANINGS: dict[str, tuple[Callable[[Reading, int], float], int]] = {
    "22-fm1-td": (Reading.contact_force, 1),
    "22-fm1-max": (Reading.maximum_stroke_force, 1),
    "22-fm1-off": (Reading.unloaded_from, 1),
    "22-fm1-off2": (Reading.unloaded_until, 1),
    "22-fm3-td": (Reading.contact_force, 3),
    "22-fm3-td-t": (Reading.contact_time, 3),
    "22-fm3-max": (Reading.maximum_stroke_force, 3),
    "22-fm3-max-t": (Reading.maximum_stroke_time, 3),
    "22-s1-on": (Reading.contact_time, 1),
    "22-s1-reb-t": (Reading.rebound_time, 1),
    "22-s1-reb": (Reading.rebound_stroke, 1),
    "22-s3-max": (Reading.maximum_stroke, 3),
    "22-s3-end": (Reading.settled_stroke, 3),
    "22-fa1-comp": (Reading.auxiliary_compression, 1),
    "22-fa1-tens": (Reading.auxiliary_tension, 1),
    "22-a-pk1": (Reading.acceleration_peak, 1),
    "22-a-pk1-t": (Reading.acceleration_peak_time, 1),
    "22-a-pk2": (Reading.acceleration_peak, 3),
    "22-a-pk2-t": (Reading.acceleration_peak_time, 3),
    "22-rest": (Reading.rest_time, 0),
    "121-fm1-td": (Reading.contact_force, 1),
    "121-fm1-max": (Reading.maximum_stroke_force, 1),
    "121-fm1-max-t": (Reading.maximum_stroke_time, 1),
    "121-fm1-off": (Reading.unloaded_from, 1),
    "121-fm1-off2": (Reading.unloaded_until, 1),
    "121-fm2-td-t": (Reading.contact_time, 2),
    "121-fm2-td": (Reading.contact_force, 2),
    "121-fm2-max": (Reading.maximum_stroke_force, 2),
    "121-fm2-max-t": (Reading.maximum_stroke_time, 2),
    "121-fm3-v1": (Reading.first_valley_force, 3),
    "121-fm3-v1-t": (Reading.first_valley_time, 3),
    "121-fm3-v2": (Reading.maximum_stroke_force, 3),
    "121-fm3-v2-t": (Reading.maximum_stroke_time, 3),
    "121-s1-max": (Reading.maximum_stroke, 1),
    "121-s2-max": (Reading.maximum_stroke, 2),
    "121-s3-max": (Reading.maximum_stroke, 3),
    "121-fa1-tens": (Reading.auxiliary_tension, 1),
    "121-fa2-tens": (Reading.auxiliary_tension, 2),
    "121-fa3-tens": (Reading.auxiliary_tension, 3),
    "121-fa3-pk1-t": (Reading.auxiliary_first_peak_time, 3),
    "121-fa3-pk2-t": (Reading.auxiliary_second_peak_time, 3),
    "121-a-pk1": (Reading.acceleration_peak, 1),
    "121-a-pk1-t": (Reading.acceleration_peak_time, 1),
    "121-a-pk2": (Reading.acceleration_peak, 2),
    "121-a-pk2-t": (Reading.acceleration_peak_time, 2),
    "121-a-pk3": (Reading.acceleration_peak, 3),
    "121-a-pk3-t": (Reading.acceleration_peak_time, 3),
    "121-rest": (Reading.rest_time, 0),
}


def compare(history: History, mode: str) -> list[Comparison]:
    """Every scalar that the paper prints for `mode`, beside ours.

    Raises:
        LandingError: The history is too short.
    """
    reading = reading_of(history)
    found = []
    for scalar in printed_scalars():
        if scalar.mode == mode:
            read, leg = MEANINGS[scalar.id]
            found.append(Comparison(scalar, read(reading, leg)))
    return found


def reading_of(history: History) -> Reading:
    """The reading of a landing: in the paper's windows of time only if it is the paper's vehicle.

    A history without parameters is read as the paper's.

    Raises:
        LandingError: No footpad touches, or the history of the paper's vehicle is too short.
    """
    other = history.parameters is not None and other_vehicle(history.parameters)
    return OwnReading(history) if other else Reading(history)


def other_vehicle(parameters: Parameters) -> list[str]:
    """The masses and lengths of the paper's Table 1 that `parameters` have otherwise.

    Where there are any, the comparison is of two vehicles. Each is a text such as
    `vehicle.mass = 25000 kg for 178 kg`.
    """
    printed = Parameters()
    return [
        f"{name} = {value:g} {unit} for {printed[name]:g} {unit}"
        for name, value in parameters.items()
        if not isinstance(value, str)
        and printed.source(name) == "paper"
        and (unit := PARAMETER_QUANTITIES[name].unit) in ("kg", "m")
        and value != printed[name]
    ]


def counts(
    comparisons: Iterable[Comparison], against: Literal["simulation", "test"] = "simulation"
) -> dict[str, int]:
    """The numbers of scalars within 5, 10 and 20 % of the paper, and of all that count.

    Scalars that the landing does not have (NaN) count as missed. Against tests, scalars without a
    printed test do not count.

    Args:
        comparisons: Printed numbers beside ours.
        against: The paper's simulation or its test.
    """
    if against == "test":
        return _counts(c.error_test for c in comparisons if not np.isnan(c.scalar.test))
    return _counts(c.error for c in comparisons)


def paper_counts_against_test(mode: str | None = None) -> dict[str, int]:
    """The counts of the paper's own simulation against its tests.

    Args:
        mode: The landing mode; None for both.
    """
    return _counts(
        s.paper_error_test
        for s in printed_scalars()
        if mode in (None, s.mode) and not np.isnan(s.test)
    )


def _counts(errors: Iterable[float]) -> dict[str, int]:
    sizes = [abs(e) for e in errors]
    return {**{f"within_{p}": sum(e <= p / 100.0 for e in sizes) for p in LEVELS}, "of": len(sizes)}
