"""The summary of a Monte Carlo: rate of success, causes of loss, grades, loads, worst landings."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..criteria import FAILED, is_lost
from ..sweep.parts import opened
from ..sweep.responses import known_responses
from .grades import LOST, UNGRADED, grade_of
from .intervals import order_statistics, wilson
from .study import MonteCarlo, low_is_bad, severity

LEG = re.compile(r"^leg\[\d\]\.")
# sectors of the directions of toppling, the first about +x
SECTORS = 12


@dataclass(frozen=True)
class Percentile:
    """What so many `percent` of the landings do not go beyond, with its interval [SI].

    An end of the interval that so few landings do not show is None.
    """

    percent: float
    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Load:
    """A response over the landings that have it.

    Attributes:
        name: The response.
        unit: Its unit.
        runs: The landings that have it.
        percentiles: Its percentiles, from the harmless end to the bad one.
        worst: The run and the value of the worst landings, the worst first.
    """

    name: str
    unit: str
    runs: int
    percentiles: tuple[Percentile, ...]
    worst: tuple[tuple[int, float], ...]

    @property
    def word(self) -> str:
        """Which end is the bad one."""
        return "smallest" if low_is_bad(self.name) else "largest"


@dataclass(frozen=True)
class Summary:
    """The results of a Monte Carlo.

    Attributes:
        name: The study's name.
        seed: Its seed.
        runs: The runs made.
        successes: Those not lost.
        level: Confidence of the intervals.
        interval: Wilson's interval of the rate of success.
        outcomes: Runs by outcome; `failed` are those that could not be made.
        causes: Lost runs by cause, the most frequent first.
        directions: Runs that toppled in space, by sector of the direction, the first about +x.
        grades: Runs by grade, the best first; empty without grades.
        loads: The loads.
        failures: The first runs that could not be made, and why.
    """

    name: str
    seed: int
    runs: int
    successes: int
    level: float
    interval: tuple[float, float]
    outcomes: Mapping[str, int]
    causes: Mapping[str, int]
    directions: tuple[int, ...]
    grades: Mapping[str, int]
    loads: tuple[Load, ...]
    failures: tuple[tuple[int, str], ...]

    @property
    def rate(self) -> float:
        """The rate of success."""
        return self.successes / self.runs if self.runs else 0.0

    def record(self) -> dict[str, Any]:
        """The same for JSON."""
        low, high = self.interval
        return {
            "study": self.name,
            "seed": self.seed,
            "runs": self.runs,
            "successes": self.successes,
            "rate": self.rate,
            "interval": {"level": self.level, "low": low, "high": high},
            "outcomes": dict(self.outcomes),
            "causes": dict(self.causes),
            "directions": list(self.directions),
            "grades": dict(self.grades),
            "loads": {
                load.name: {
                    "unit": load.unit,
                    "runs": load.runs,
                    "percentiles": [vars(p) for p in load.percentiles],
                    "worst": [{"run": run, "value": value} for run, value in load.worst],
                }
                for load in self.loads
            },
            "failures": [{"run": run, "error": error} for run, error in self.failures],
        }


def summarise(path: Path, study: MonteCarlo) -> Summary:
    """The summary of a results file.

    Raises:
        LandingError: The file is damaged.
    """
    rows = read_rows(path, study)
    outcomes = [FAILED if row["error"] is not None else row["outcome"] for row in rows]
    lost = [lost_run(row, study.criterion) for row in rows]
    successes = len(rows) - sum(lost)
    causes = Counter(cause(row, study.criterion) for row, is_one in zip(rows, lost) if is_one)
    grades = [grade_of(study.grades, row, lost=is_one) for row, is_one in zip(rows, lost)]
    names = (*(g.name for g in study.grades), UNGRADED, LOST)
    failures = [(row["index"], row["error"]) for row in rows if row["error"] is not None]
    return Summary(
        name=study.sweep.name,
        seed=study.sweep.seed,
        runs=len(rows),
        successes=successes,
        level=study.level,
        interval=wilson(successes, len(rows), study.level),
        outcomes=dict(Counter(outcomes).most_common()),
        causes=dict(sorted(causes.items(), key=lambda item: (-item[1], item[0]))),
        directions=_directions(rows),
        grades={name: grades.count(name) for name in names} if study.grades else {},
        loads=tuple(_load(name, rows, study) for name in study.loads),
        failures=tuple(failures[:5]),
    )


def read_rows(path: Path, study: MonteCarlo) -> list[dict[str, Any]]:
    """The rows of a results file: index, error, and the study's responses.

    Raises:
        LandingError: The file is damaged.
    """
    with opened(path) as file:
        rows: list[dict[str, Any]] = file.read(
            columns=["index", "error", *study.sweep.responses]
        ).to_pylist()
    return rows


def lost_run(row: Mapping[str, Any], criterion: str) -> bool:
    """Whether a run is lost."""
    name = FAILED if row["error"] is not None else row["outcome"]
    return is_lost(criterion, name, limit_passed=row["outcome.first_limit"] is not None)


def cause(row: Mapping[str, Any], criterion: str) -> str:
    """Why a lost run was lost."""
    if row["error"] is not None:
        return FAILED
    name = str(row["outcome"])
    if not is_lost(criterion, name, limit_passed=False):
        return f"passed {LEG.sub('', str(row['outcome.first_limit']))}"
    if name != "toppled" or "outcome.edge" not in row:
        return name
    edge = row["outcome.edge"]
    return f"toppled over {edge}" if edge is not None else "turned over"


def _directions(rows: Sequence[Mapping[str, Any]]) -> tuple[int, ...]:
    found = [0] * SECTORS
    width = 2.0 * np.pi / SECTORS
    for row in rows:
        direction = row.get("outcome.direction")
        if direction is not None:
            found[round(direction / width) % SECTORS] += 1
    return tuple(found) if any(found) else ()


def _load(name: str, rows: Sequence[Mapping[str, Any]], study: MonteCarlo) -> Load:
    known = known_responses(study.interface)[name]
    have = [(severity(name, row[name]), row["index"]) for row in rows if row[name] is not None]
    # of equal values the earlier run is the worse
    ranked = sorted(have, key=lambda item: (item[0], -item[1]))
    values = [value for value, _ in ranked]
    sign = -1.0 if low_is_bad(name) else 1.0

    def at(place: int | None) -> float | None:
        return None if place is None else sign * values[place]

    percentiles = []
    for percent in study.percentiles if values else ():
        place, low, high = order_statistics(len(values), percent / 100.0, study.level)
        ends = (at(low), at(high)) if sign > 0.0 else (at(high), at(low))
        percentiles.append(Percentile(percent, sign * values[place], *ends))
    worst = [(run, sign * value) for value, run in ranked[: -study.worst - 1 : -1]]
    return Load(name, known.unit, len(values), tuple(percentiles), tuple(worst))
