"""The tables of an envelope."""

from __future__ import annotations

from ..audit.rest import LONGEST_WAIT
from ..quantities import shown
from ..studies.envelope.results import NAMES, lost_text, stretches, verdict
from ..studies.envelope.search import Envelope, Family
from ..studies.sweep.factors import value_text
from .rendering import new_table, render


def envelope_tables(found: Envelope) -> str:
    """Outcomes by family, critical conditions along the boundaries, and the number of landings."""
    study = found.study
    table = new_table(
        f"{study.x.name} and {study.y.name}; lost: {lost_text(study)}",
        ("family",),
        ("landings", "lost", *NAMES),
        ("",),
    )
    for f in found.families:
        table.add_row(
            _family(f),
            str(len(f.landings)),
            str(sum(landing.lost(study.criterion) for _, _, landing in f.landings) or "-"),
            *(str(f.count(name) or "-") for name in NAMES),
            verdict(f, study.criterion),
        )
    (unit_x, sx), (unit_y, sy) = shown(study.x.quantity), shown(study.y.quantity)
    critical = new_table(
        f"critical condition along each boundary, as (x [{unit_x or 1}], y [{unit_y or 1}])",
        ("family", "from", "to", "condition"),
        ("points",),
    )
    for f in found.families:
        for line in f.lines:
            for stretch in stretches(line):
                ends = [
                    f"({c.x / sx:.4g}, {c.y / sy:.4g})"
                    for c in (stretch.points[0], stretch.points[-1])
                ]
                critical.add_row(_family(f), *ends, stretch.condition, str(len(stretch.points)))
    open_ended = sum(f.count("moving") for f in found.families)
    parts = [
        render(table, 170),
        render(critical, 170) if any(f.lines for f in found.families) else "",
    ]
    if open_ended:
        parts.append(
            f"{open_ended} landings were neither at rest nor toppled at "
            f"{LONGEST_WAIT if study.until is None else study.until:g} s and count as not toppled\n"
        )
    parts.append(
        f"{found.landings} landings; a uniform grid of the same resolution takes {found.uniform}, "
        f"{found.uniform / found.landings:.0f} times as many\n"
        f"an island that lies within one of the {study.cells} x {study.cells} coarse cells "
        "and touches no corner is not found; --cells\n"
    )
    return "".join(parts)


def _family(f: Family) -> str:
    return (
        ", ".join(f"{name} = {value_text(name, value)}" for name, value in f.values.items())
        or "all"
    )
