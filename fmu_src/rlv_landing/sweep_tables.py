"""Plans and results of sweeps, as people read them in a terminal."""

from __future__ import annotations

from typing import Any

from .studies.row import Task
from .studies.sweep_summary import Summary
from .tables import new_table, render

FIRST_ROWS = 5


def plan_table(task: Task) -> str:
    """The first rows of a study, values in SI."""
    table = new_table(
        f"the first of {len(task)} landings", ("index",), [f"{q.name} [{q.unit}]" for q in task.quantities()[: len(task.names)]]
    )
    for index, values in enumerate(task.rows(0, min(FIRST_ROWS, len(task)))):
        table.add_row(str(index), *map(_text, values.values()))
    return render(table)


def summary_table(name: str, summary: Summary) -> str:
    """Outcomes, failures, and the spread of each response."""
    table = new_table(f"{name}: {summary.landings} landings", ("response", "unit"), ("landings", "min", "5 %", "median", "95 %", "max"))
    for s in summary.spreads:
        table.add_row(s.name.replace("[", r"\["), s.unit, str(s.count), *map(_text, s.quantiles))
    lines = [", ".join(f"{count} {outcome}" for outcome, count in summary.outcomes.items())] if summary.outcomes else []
    if summary.failed:
        lines.append(f"{summary.failed} failed; column `error` says why, the first:")
        lines += [f"  landing {index}: {reason}" for index, reason in summary.failures]
    return (render(table) if summary.spreads else "") + "".join(f"{line}\n" for line in lines)


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
