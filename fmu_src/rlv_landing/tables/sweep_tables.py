"""The tables of a sweep: its plan, its results and its Sobol indices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..studies.sweep.sensitivity import Indices
from ..studies.sweep.summary import Summary
from ..studies.sweep.sweep_row import Task
from .landing import new_table, render

FIRST_ROWS = 5


def plan_table(task: Task) -> str:
    """The first rows of a study, values in SI."""
    table = new_table(
        f"the first of {len(task)} landings",
        ("index",),
        [f"{q.name} [{q.unit}]" for q in task.quantities()[: len(task.names)]],
    )
    for index, values in enumerate(task.rows(0, min(FIRST_ROWS, len(task)))):
        table.add_row(str(index), *map(_text, values.values()))
    return render(table)


def summary_table(name: str, summary: Summary) -> str:
    """Outcomes, failures, and the spread of each response."""
    table = new_table(
        f"{name}: {summary.landings} landings",
        ("response", "unit"),
        ("landings", "min", "5 %", "median", "95 %", "max"),
    )
    shown = [s for s in summary.spreads if not s.name.startswith("leg[")] or summary.spreads
    for s in shown:
        table.add_row(s.name.replace("[", r"\["), s.unit, str(s.count), *map(_text, s.quantiles))
    lines = (
        [", ".join(f"{count} {outcome}" for outcome, count in summary.outcomes.items())]
        if summary.outcomes
        else []
    )
    if len(shown) < len(summary.spreads):
        lines.append(
            f"{len(summary.spreads) - len(shown)} more, of single legs, "
            "are in the results and in --json"
        )
    if summary.failed:
        lines.append(f"{summary.failed} failed; column `error` says why, the first:")
        lines += [f"  landing {index}: {reason}" for index, reason in summary.failures]
    return (render(table) if summary.spreads else "") + "".join(f"{line}\n" for line in lines)


def indices_table(found: Sequence[Indices], level: float) -> str:
    """First-order and total indices of every response and factor, with their intervals."""
    table = new_table(
        f"Sobol indices, {100.0 * level:g} % intervals",
        ("response", "mode", "factor"),
        ("first order", "from", "to", "total", "from", "to"),
    )
    lines = []
    for f in found:
        if np.isnan(f.total).any():
            lines.append(
                f"{f.response}, {f.mode}: no indices: "
                + ("it does not vary" if f.used == f.samples else _incomplete(f))
            )
            continue
        if f.used < f.samples:
            lines.append(f"{f.response}, {f.mode}: {_incomplete(f)}; others replace the rest")
        for factor, first, total in zip(f.factors, f.first, f.total):
            table.add_row(
                f.response.replace("[", r"\["),
                f.mode,
                factor,
                *(f"{v:.3f}" for v in (*first, *total)),
            )
        table.add_section()
    return render(table) + "".join(f"{line}\n" for line in lines)


def _incomplete(found: Indices) -> str:
    return f"{found.used} of {found.samples} samples have it"


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
