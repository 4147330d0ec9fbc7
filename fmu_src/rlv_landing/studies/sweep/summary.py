"""The summary of a study's results: outcomes, failures, and the spread of each response."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .parts import opened
from .responses import every_response

SHOWN_FAILURES = 5


@dataclass(frozen=True)
class Spread:
    """A response over the landings that have it.

    `count` is their number; `quantiles` are smallest, 5 %, median, 95 % and largest [SI].
    """

    name: str
    unit: str
    count: int
    quantiles: tuple[float, float, float, float, float]

    @property
    def constant(self) -> bool:
        """Whether all landings that have the response have the same value."""
        return self.quantiles[0] == self.quantiles[-1]


@dataclass
class Summary:
    """A study's results.

    Attributes:
        landings: All landings.
        failed: Landings that could not be made.
        failures: Index and reason of the first of these.
        outcomes: Landings by the outcome's name.
        spreads: The spread of each response that is a number and that a landing has.
        texts: Landings by value, of each other response that is a text or a leg's number.
        missing: Responses that no landing has.
    """

    landings: int
    failed: int = 0
    failures: list[tuple[int, str]] = field(default_factory=list)
    outcomes: dict[str, int] = field(default_factory=dict)
    spreads: list[Spread] = field(default_factory=list)
    texts: dict[str, dict[str, int]] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)

    def record(self) -> dict[str, Any]:
        """The same for JSON."""
        names = ("min", "p5", "median", "p95", "max")
        spreads = {
            s.name: {"unit": s.unit, "count": s.count, **dict(zip(names, s.quantiles))}
            for s in self.spreads
        }
        failures = [{"index": index, "error": reason} for index, reason in self.failures]
        return {
            "landings": self.landings,
            "failed": self.failed,
            "failures": failures,
            "outcomes": self.outcomes,
            "responses": spreads,
            "texts": self.texts,
            "missing": self.missing,
            "constant": [s.name for s in self.spreads if s.constant],
        }


def summarise_results(path: Path) -> Summary:
    """The summary of a results file, which is read a column at a time.

    Raises:
        LandingError: The file is damaged.
    """
    with opened(path) as file:
        return _summary(file)


def _summary(file: Any) -> Summary:
    summary = Summary(file.metadata.num_rows)

    def values(name: str) -> list[Any]:
        read: list[Any] = file.read(columns=[name])[name].to_pylist()
        return read

    for index, reason in enumerate(values("error")):
        if reason is not None:
            summary.failed += 1
            if len(summary.failures) < SHOWN_FAILURES:
                summary.failures.append((index, reason))
    known = every_response()
    for name in (n for n in file.schema_arrow.names if n in known):
        found = [v for v in values(name) if v is not None and v == v]
        if not found:
            summary.missing.append(name)
        elif name == "outcome":
            summary.outcomes = _counted(found)
        elif known[name].kind == "string" or name == "outcome.leg":
            summary.texts[name] = _counted(found)
        else:
            summary.spreads.append(_spread(name, known[name].unit, found))
    return summary


def _counted(found: list[Any]) -> dict[str, int]:
    """The number of landings by value."""
    return {str(v): found.count(v) for v in sorted(set(found))}


def _spread(name: str, unit: str, found: list[Any]) -> Spread:
    numbers = np.array(found, dtype=float)
    low, p5, median, p95, high = map(float, np.quantile(numbers, (0.0, 0.05, 0.5, 0.95, 1.0)))
    return Spread(name, unit, len(numbers), (low, p5, median, p95, high))
