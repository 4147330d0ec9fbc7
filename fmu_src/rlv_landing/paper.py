"""The numbers that Yue, Lin, Zheng and Du (2022) print in their section 5, and how each is read off a landing.

What a printed scalar is taken to mean is written here once. Times are from the start of the landing, as the paper's axes.
"""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import LandingError
from .history import History

NUMBERS = Path(__file__).with_name("paper_numbers.csv")
FIRST_PEAK_WINDOW = 0.012
STROKE_WINDOW = 0.22
REBOUND_WINDOW = 0.25
UNLOADED = -250.0
RUN_AFTER_CONTACT = 0.8
NAN = float("nan")


@dataclass(frozen=True)
class Scalar:
    """One printed number: `simulation` and up to two tests, in `unit` (s, N, mm, m/s2); NaN where none is printed."""

    id: str
    mode: str
    quantity: str
    leg: int
    event: str
    unit: str
    simulation: float
    test_a: float
    test_b: float


@dataclass(frozen=True)
class Comparison:
    """One printed number beside ours; `error` is (ours - simulation)/|simulation|, a fraction."""

    scalar: Scalar
    ours: float

    @property
    def error(self) -> float:
        return (self.ours - self.scalar.simulation) / abs(self.scalar.simulation)


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


class Reading:
    """Reads the printed scalars off one landing's history (at least 0.8 s after the first contact, sampled at 1 kHz or finer)."""

    def __init__(self, history: History) -> None:
        self.h = history
        self.t = history.time
        self._contact = {leg: self._contact_time(leg) for leg in (1, 2, 3, 4)}
        first = min(self._contact.values())
        if not np.isfinite(first):
            raise LandingError("no footpad touches the ground in this history; run it longer")
        self.end = first + RUN_AFTER_CONTACT
        if self.t[-1] < self.end - 1e-3:
            raise LandingError(f"the history ends at {self.t[-1]:g} s; the paper's scalars need it until {self.end:g} s")

    def _contact_time(self, leg: int) -> float:
        depth = f"leg[{leg}].contact.penetration"
        d = self.h[depth] if depth in self.h else self.h[f"leg[{leg}].contact.force_y"]
        touching = np.flatnonzero(d > 0.0)
        if not len(touching):
            return float("inf")
        i = int(touching[0])
        if i == 0 or depth not in self.h:
            return float(self.t[i])
        return float(self.t[i - 1] + (self.t[i] - self.t[i - 1]) * d[i - 1] / (d[i - 1] - d[i]))

    def _between(self, start: float, end: float) -> NDArray[np.intp]:
        return np.flatnonzero((self.t >= start) & (self.t <= end))

    def contact_time(self, leg: int) -> float:
        """The penetration passes 0."""
        return self._contact[leg]

    def contact_force(self, leg: int) -> float:
        """The most negative strut force within 12 ms after that leg's contact."""
        t = self._contact[leg]
        return float(self._force(leg)[self._between(t, t + FIRST_PEAK_WINDOW)].min())

    def _force(self, leg: int) -> NDArray[np.float64]:
        return self.h[f"leg[{leg}].main_strut.force"]

    def _stroke(self, leg: int) -> NDArray[np.float64]:
        return self.h[f"leg[{leg}].main_strut.stroke"]

    def _auxiliary(self, leg: int) -> NDArray[np.float64]:
        return self.h[f"leg[{leg}].auxiliary_strut.force"]

    def _maximum(self, leg: int) -> int:
        t = self._contact[leg]
        window = self._between(t, t + STROKE_WINDOW)
        return int(window[np.argmax(self._stroke(leg)[window])])

    def maximum_stroke(self, leg: int) -> float:
        """Largest stroke within 0.22 s after contact [mm]."""
        return float(1e3 * self._stroke(leg)[self._maximum(leg)])

    def maximum_stroke_time(self, leg: int) -> float:
        """Its time [s]."""
        return float(self.t[self._maximum(leg)])

    def maximum_stroke_force(self, leg: int) -> float:
        """The strut force then [N]."""
        return float(self._force(leg)[self._maximum(leg)])

    def _first(self, condition: NDArray[np.bool_], start: float) -> float:
        found = np.flatnonzero(condition & (self.t >= start))
        return float(self.t[found[0]]) if len(found) else NAN

    def unloaded_from(self, leg: int) -> float:
        """First time after the maximum stroke with the force above -250 N."""
        return self._first(self._force(leg) > UNLOADED, self.maximum_stroke_time(leg))

    def unloaded_until(self, leg: int) -> float:
        """First time at least 40 ms later with the force below -250 N."""
        return self._first(self._force(leg) < UNLOADED, self.unloaded_from(leg) + 0.04)

    def _rebound(self, leg: int) -> int:
        t = self.maximum_stroke_time(leg)
        window = self._between(t, t + REBOUND_WINDOW)
        return int(window[np.argmin(self._stroke(leg)[window])])

    def rebound_stroke(self, leg: int) -> float:
        """Smallest stroke within 0.25 s after the maximum [mm]."""
        return float(1e3 * self._stroke(leg)[self._rebound(leg)])

    def rebound_time(self, leg: int) -> float:
        """Its time [s]."""
        return float(self.t[self._rebound(leg)])

    def settled_stroke(self, leg: int) -> float:
        """Mean stroke over the last 0.15 s of the 0.8 s after first contact [mm]."""
        return float(1e3 * self._stroke(leg)[self._between(self.end - 0.15, self.end)].mean())

    def _first_valley(self, leg: int) -> int:
        window = self._between(self._contact[leg] + FIRST_PEAK_WINDOW, self.maximum_stroke_time(leg) - 0.02)
        return int(window[np.argmin(self._force(leg)[window])]) if len(window) else -1

    def first_valley_force(self, leg: int) -> float:
        """Most negative strut force from 12 ms after contact to 20 ms before the maximum stroke [N]."""
        i = self._first_valley(leg)
        return float(self._force(leg)[i]) if i >= 0 else NAN

    def first_valley_time(self, leg: int) -> float:
        """Its time [s]."""
        i = self._first_valley(leg)
        return float(self.t[i]) if i >= 0 else NAN

    def auxiliary_compression(self, leg: int) -> float:
        """Smallest auxiliary strut force within 30 ms after contact [N]."""
        t = self._contact[leg]
        return float(self._auxiliary(leg)[self._between(t, t + 0.03)].min())

    def auxiliary_tension(self, leg: int) -> float:
        """Largest auxiliary strut force of all [N]."""
        return float(self._auxiliary(leg)[self._between(0.0, self.end)].max())

    def _auxiliary_peak_time(self, leg: int, start: float, end: float) -> float:
        window = self._between(start, end)
        return float(self.t[window[np.argmax(self._auxiliary(leg)[window])]])

    def auxiliary_first_peak_time(self, leg: int) -> float:
        """Time of the largest auxiliary strut force until 0.306 s."""
        return self._auxiliary_peak_time(leg, self._contact[leg], 0.306)

    def auxiliary_second_peak_time(self, leg: int) -> float:
        """Time of the largest auxiliary strut force from 0.31 to 0.40 s."""
        return self._auxiliary_peak_time(leg, 0.31, 0.40)

    def _acceleration(self, leg: int) -> int:
        t = self._contact[leg]
        window = self._between(t, t + FIRST_PEAK_WINDOW)
        return int(window[np.argmax(self.h["body.top_axial_acceleration"][window])])

    def acceleration_peak(self, leg: int) -> float:
        """Largest axial acceleration at the top within 12 ms after that leg's contact [m/s2]."""
        return float(self.h["body.top_axial_acceleration"][self._acceleration(leg)])

    def acceleration_peak_time(self, leg: int) -> float:
        """Its time [s]."""
        return float(self.t[self._acceleration(leg)])

    def rest_time(self, _leg: int) -> float:
        """Last time the pitch is more than 0.5 deg off its mean over the last 0.1 s."""
        pitch = self.h["body.pitch"]
        settled = pitch[self._between(self.end - 0.1, self.end)].mean()
        moving = np.flatnonzero((np.abs(pitch - settled) > np.radians(0.5)) & (self.t <= self.end))
        return float(self.t[moving[-1]]) if len(moving) else 0.0


# what each printed scalar is: the id's end, and the leg whose contact it follows where the paper's row names none
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
    """Every scalar that the paper prints for `mode`, beside ours. Raises LandingError where the history is too short."""
    reading = Reading(history)
    found = []
    for scalar in printed_scalars():
        if scalar.mode == mode:
            read, leg = MEANINGS[scalar.id]
            found.append(Comparison(scalar, read(reading, leg)))
    return found


def counts(comparisons: list[Comparison]) -> dict[str, int]:
    """How many scalars are within 5, 10 and 20 % of the paper's simulation, and how many there are."""
    errors = [abs(c.error) for c in comparisons]
    return {**{f"within_{p}": sum(e <= p / 100.0 for e in errors) for p in (5, 10, 20)}, "of": len(errors)}
