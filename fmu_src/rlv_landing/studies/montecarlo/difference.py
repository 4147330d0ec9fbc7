"""What differs between two Monte Carlo studies, run by run where these are the same runs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LandingError, reason_of
from ...text.files import read_record
from ..criteria import CRITERIA, FAILED, is_lost
from ..sweep.factors import Array
from ..sweep.parts import opened
from ..sweep.responses import every_response
from ..sweep.result_files import RESULTS
from .intervals import wilson
from .study import low_is_bad

SUMMARY = "summary.json"
# what two studies say of themselves and that decides no landing
NO_CHANGE = ("fingerprint", "points")
SHOWN = 5


@dataclass(frozen=True)
class Side:
    """One of the studies: its results, and what decides them."""

    path: Path
    about: Mapping[str, Any]
    rows: tuple[Mapping[str, Any], ...]
    criterion: str
    level: float
    loads: tuple[str, ...]

    @property
    def lost(self) -> dict[int, bool]:
        """Whether each run was lost."""
        return {
            row["index"]: is_lost(
                self.criterion,
                FAILED if row["error"] is not None else row["outcome"],
                limit_passed=row["outcome.first_limit"] is not None,
            )
            for row in self.rows
        }

    @property
    def interval(self) -> tuple[float, float, float]:
        """The rate of success, and its interval."""
        lost = list(self.lost.values())
        successes = len(lost) - sum(lost)
        return (successes / len(lost) if lost else 0.0, *wilson(successes, len(lost), self.level))


@dataclass(frozen=True)
class LoadChange:
    """How a load changed.

    Attributes:
        name: The response.
        unit: Its unit.
        medians: Its medians in both studies.
        extremes: Its worst values in both.
        largest: The largest change of a run, in parts of the load's largest magnitude; NaN where
            the runs are others.
        run: That run; None without any.
    """

    name: str
    unit: str
    medians: tuple[float, float]
    extremes: tuple[float, float]
    largest: float
    run: int | None


@dataclass(frozen=True)
class Difference:
    """What differs between two studies.

    Attributes:
        sides: The studies.
        settings: What decides the landings and is not the same: name, before, after.
        paired: Runs that both have and that start from the same values.
        saved: Runs lost in the first study alone.
        newly_lost: Runs lost in the second alone.
        outcomes: Runs whose outcome is another.
        loads: The loads that both have.
        tolerance: The change of a load that counts, in parts of its largest magnitude.
    """

    sides: tuple[Side, Side]
    settings: tuple[tuple[str, str, str], ...]
    paired: int
    saved: tuple[int, ...]
    newly_lost: tuple[int, ...]
    outcomes: tuple[int, ...]
    loads: tuple[LoadChange, ...]
    tolerance: float

    @property
    def same(self) -> bool:
        """Whether both have the same runs, outcomes, and loads to the tolerance."""
        a, b = self.sides
        return (
            self.paired == len(a.rows) == len(b.rows)
            and not self.outcomes
            and all(load.largest <= self.tolerance for load in self.loads)
        )

    def record(self) -> dict[str, Any]:
        """The same for JSON."""
        rates = [side.interval for side in self.sides]
        return {
            "same": self.same,
            "tolerance": self.tolerance,
            "studies": [str(side.path) for side in self.sides],
            "runs": [len(side.rows) for side in self.sides],
            "rates": [{"rate": rate, "low": low, "high": high} for rate, low, high in rates],
            "settings": [dict(zip(("name", "before", "after"), s)) for s in self.settings],
            "paired": self.paired,
            "saved": list(self.saved),
            "newly_lost": list(self.newly_lost),
            "outcomes_changed": list(self.outcomes),
            "loads": {
                load.name: {
                    "unit": load.unit,
                    "medians": list(load.medians),
                    "extremes": list(load.extremes),
                    "largest_change": None if np.isnan(load.largest) else load.largest,
                    "run": load.run,
                }
                for load in self.loads
            },
        }


def read_side(folder: Path) -> Side:
    """The results in a folder.

    Raises:
        LandingError: There are no results of a Monte Carlo, or they are damaged.
    """
    path = folder / RESULTS
    if not path.is_file():
        raise LandingError(f"{folder} has no {RESULTS}; name the results folder of a Monte Carlo")
    with opened(path) as file:
        try:
            about = json.loads((file.schema_arrow.metadata or {})[b"study.json"])
        except (KeyError, ValueError, RecursionError):
            about = None
        if not isinstance(about, dict) or "dispersions" not in about:
            raise LandingError(f"{path} is no result of a Monte Carlo; name another folder")
        rows = tuple(file.read().to_pylist())
    try:
        summary = read_record(folder / SUMMARY)
        criterion, level = str(summary["criterion"]), float(summary["interval"]["level"])
        loads = tuple(str(name) for name in summary["loads"])
        known = every_response()
        if criterion not in CRITERIA or not all(n in known and n in rows[0] for n in loads):
            raise ValueError("it is not that of the results")
    except (OSError, ValueError, KeyError, TypeError, IndexError) as e:
        raise LandingError(
            f"{folder / SUMMARY} cannot be read ({reason_of(e)}); --resume writes it anew"
        ) from None
    return Side(folder, about, rows, criterion, level, loads)


def difference(before: Side, after: Side, tolerance: float) -> Difference:
    """What differs between two studies; each judges its own runs."""
    names = [n for n in before.about["responses"] if n in after.about["responses"]]
    a, b = ({row["index"]: row for row in side.rows} for side in (before, after))
    paired = []
    if _same_values(before, after):
        paired = sorted(a.keys() & b.keys())
    lost_a, lost_b = before.lost, after.lost
    return Difference(
        sides=(before, after),
        settings=tuple(_settings(before.about, after.about)),
        paired=len(paired),
        saved=tuple(k for k in paired if lost_a[k] and not lost_b[k]),
        newly_lost=tuple(k for k in paired if lost_b[k] and not lost_a[k]),
        outcomes=tuple(k for k in paired if _outcome(a[k]) != _outcome(b[k])),
        loads=tuple(
            _load(name, a, b, paired) for name in before.loads if name in names
        ),
        tolerance=tolerance,
    )  # fmt: skip


def _outcome(row: Mapping[str, Any]) -> Any:
    return FAILED if row["error"] is not None else row["outcome"]


def _same_values(before: Side, after: Side) -> bool:
    """Whether a run of both studies starts from the same dispersed values."""
    return bool(before.about["points"] == after.about["points"])


def _settings(a: Mapping[str, Any], b: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """What decides the landings and is not the same."""
    found = []
    for key in dict.fromkeys((*a, *b)):
        if key in NO_CHANGE or a.get(key) == b.get(key):
            continue
        if key == "parameters":
            lines = [_named_lines(str(side.get(key, ""))) for side in (a, b)]
            before, after = sorted(lines[0] - lines[1]), sorted(lines[1] - lines[0])
            found.append((key, "; ".join(before), "; ".join(after)))
        else:
            found.append((key, json.dumps(a.get(key)), json.dumps(b.get(key))))
    return found


def _named_lines(toml: str) -> set[str]:
    """The lines of a parameter file, each with its table's name before it."""
    table, found = "", set()
    for line in toml.splitlines():
        if line.startswith("["):
            table = f"{line.strip('[]')}."
        elif line:
            found.add(f"{table}{line}")
    return found


def _load(
    name: str,
    a: Mapping[int, Mapping[str, Any]],
    b: Mapping[int, Mapping[str, Any]],
    paired: Sequence[int],
) -> LoadChange:
    values = [_numbers(side.values(), name) for side in (a, b)]
    worst = np.min if low_is_bad(name) else np.max
    medians = [float(np.median(v)) if len(v) else np.nan for v in values]
    extremes = [float(worst(v)) if len(v) else np.nan for v in values]
    largest, run = float("nan"), None
    both = [k for k in paired if a[k][name] is not None and b[k][name] is not None]
    if both:
        change = np.abs([a[k][name] - b[k][name] for k in both])
        size = max(float(np.abs(v).max()) for v in values if len(v)) or 1.0
        largest, run = float(change.max()) / size, both[int(change.argmax())]
    unit = every_response()[name].unit
    return LoadChange(
        name, unit, (medians[0], medians[1]), (extremes[0], extremes[1]), largest, run
    )


def _numbers(rows: Any, name: str) -> Array:
    return np.array([row[name] for row in rows if row[name] is not None], dtype=float)
