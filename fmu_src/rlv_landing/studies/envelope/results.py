"""An envelope as JSON and CSV, and the parts of its boundary that share a critical condition."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from math import isfinite
from pathlib import Path
from typing import Any

from ...quantities import shown
from ...text.durable import text_of, whole_file, write_durably
from ..criteria import CRITERIA, FAILED
from ..limits import LIMITS
from ..outcome import SEVERITY
from .judged_landing import JudgedLanding
from .search import Critical, Envelope, Family
from .study import EnvelopeStudy

# an envelope's landings end at rest
NAMES = (*(name for name in SEVERITY if name != "standing"), FAILED)
COLUMNS = ("condition", "outcome", "outcome_time", "leg", "limit", "limit_leg", "limit_time")


@dataclass(frozen=True)
class Stretch:
    """Consecutive points of a boundary line with the same critical `condition`."""

    condition: str
    points: tuple[Critical, ...]


def stretches(line: Sequence[Critical]) -> list[Stretch]:
    """The stretches of a boundary line, in order."""
    return [
        Stretch(condition, tuple(points))
        for condition, points in groupby(line, lambda c: c.landing.condition)
    ]


def verdict(family: Family, criterion: str) -> str:
    """The verdict in words: boundary found, all stable, or all lost."""
    if family.lines:
        return "boundary found"
    return (
        "all lost"
        if all(landing.lost(criterion) for _, _, landing in family.landings)
        else "all stable"
    )


def lost_text(study: EnvelopeStudy) -> str:
    """What counts as lost in words, with the limits if the criterion is to pass one."""
    if study.criterion != "limit":
        return CRITERIA[study.criterion]
    limits = []
    for name, value in study.limits.items():
        unit, size = shown(LIMITS[name])
        limits.append(f"{name} {value / size:g} {unit}".rstrip())
    return f"{CRITERIA['limit']} ({', '.join(limits)})"


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
                "boundary": [[_critical_record(c) for c in line] for line in f.lines],
                "landings": [
                    {"x": x, "y": y, **_landing_record(landing)} for x, y, landing in f.landings
                ],
            }
            for f in envelope.families
        ],
    }


def _critical_record(c: Critical) -> dict[str, Any]:
    return {
        "x": c.x,
        "y": c.y,
        "stable": c.stable,
        "lost": c.lost,
        "condition": c.landing.condition,
        **_landing_record(c.landing),
    }


def _landing_record(landing: JudgedLanding) -> dict[str, Any]:
    return {
        k: None if isinstance(v, float) and not isfinite(v) else v
        for k, v in asdict(landing).items()
    }


def write_json(envelope: Envelope, path: Path) -> None:
    """Write `record` to a JSON file, whole or not at all."""
    text = json.dumps(record(envelope), indent=1, allow_nan=False) + "\n"
    write_durably(path, text.encode())


def write_csv(envelope: Envelope, path: Path) -> None:
    """Write the boundary's points to a CSV file, a line for each, in SI units, or nothing.

    The columns are the family's values, the number of the boundary line, the point, the last stable
    landing and the first lost one beside it, and the outcome of the latter.
    """
    study = envelope.study
    family_names = list(envelope.families[0].values)
    axes = (study.x.name, study.y.name)
    with whole_file(path) as file, text_of(file) as f:
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
                    limit = c.landing.first_limit
                    passed = (
                        (limit.name, limit.leg, limit.time) if limit is not None else ("", "", "")
                    )
                    outcome = (
                        c.landing.condition,
                        c.landing.name,
                        c.landing.time,
                        c.landing.leg,
                        *passed,
                    )
                    writer.writerow(
                        [*family.values.values(), number, c.x, c.y, *c.stable, *c.lost, *outcome]
                    )
