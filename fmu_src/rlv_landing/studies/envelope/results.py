"""An envelope as JSON and CSV, and the runs of its boundary that share a critical condition."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from math import isfinite
from pathlib import Path
from typing import Any

from ..outcome import SEVERITY
from .landed import FAILED, Landed
from .search import Critical, Envelope, Family

NAMES = (*SEVERITY, FAILED)
COLUMNS = ("condition", "outcome", "outcome_time", "leg", "limit", "limit_leg", "limit_time")


@dataclass(frozen=True)
class Run:
    """Consecutive points of a boundary line with the same critical `condition`."""

    condition: str
    points: tuple[Critical, ...]


def runs(line: Sequence[Critical]) -> list[Run]:
    """The runs of a boundary line, in order."""
    return [
        Run(condition, tuple(points))
        for condition, points in groupby(line, lambda c: c.landed.condition)
    ]


def verdict(family: Family, criterion: str) -> str:
    """In a word: a boundary, all stable, or all lost."""
    if family.lines:
        return "boundary found"
    return (
        "all lost"
        if all(landed.lost(criterion) for _, _, landed in family.landings)
        else "all stable"
    )


def record(envelope: Envelope) -> dict[str, Any]:
    """The whole result for JSON, all values in SI."""
    study = envelope.study
    return {
        "study": study.record(),
        "landings": envelope.landings,
        "uniform_grid": envelope.uniform,
        "saved": envelope.uniform / envelope.landings,
        "families": [
            {
                "values": dict(f.values),
                "verdict": verdict(f, study.criterion),
                "outcomes": {name: f.count(name) for name in NAMES},
                "boundary": [[_critical(c) for c in line] for line in f.lines],
                "landings": [{"x": x, "y": y, **_landed(landed)} for x, y, landed in f.landings],
            }
            for f in envelope.families
        ],
    }


def _critical(c: Critical) -> dict[str, Any]:
    return {
        "x": c.x,
        "y": c.y,
        "stable": c.stable,
        "lost": c.lost,
        "condition": c.landed.condition,
        **_landed(c.landed),
    }


def _landed(landed: Landed) -> dict[str, Any]:
    return {
        k: None if isinstance(v, float) and not isfinite(v) else v
        for k, v in asdict(landed).items()
    }


def write_json(envelope: Envelope, path: Path) -> None:
    """Write `record`."""
    path.write_text(
        json.dumps(record(envelope), indent=1, allow_nan=False) + "\n", encoding="utf-8"
    )


def write_csv(envelope: Envelope, path: Path) -> None:
    """Write the boundary's points, a line each: the family's values, the number of the line, the
    point, the last landing that holds and the first that is lost beside it, and what became of the
    latter. SI units.
    """
    study = envelope.study
    family_names = list(envelope.families[0].values)
    axes = (study.x.name, study.y.name)
    with path.open("w", newline="", encoding="utf-8") as f:
        writer = csv.writer(f)
        writer.writerow(
            [
                *family_names,
                "line",
                *axes,
                *(f"{a} {end}" for end in ("stable", "lost") for a in axes),
                *COLUMNS,
            ]
        )
        for family in envelope.families:
            for number, line in enumerate(family.lines, 1):
                for c in line:
                    limit = c.landed.first_limit
                    passed = (
                        (limit.name, limit.leg, limit.time) if limit is not None else ("", "", "")
                    )
                    told = (c.landed.condition, c.landed.name, c.landed.time, c.landed.leg, *passed)
                    writer.writerow(
                        [*family.values.values(), number, c.x, c.y, *c.stable, *c.lost, *told]
                    )
