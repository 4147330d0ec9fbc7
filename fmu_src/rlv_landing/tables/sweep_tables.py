"""The tables of a sweep: its plan, its results and its Sobol indices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..studies.sweep.sensitivity import WIDEST, Indices
from ..studies.sweep.summary import Summary
from ..studies.sweep.sweep_row import Task
from .rendering import new_table, render

FIRST_ROWS = 5


def plan_table(task: Task) -> str:
    """The first rows of a study, values in SI."""
    table = new_table(
        f"the first of {len(task)} landings",
        ("index",),
        [
            f"{q.name} [{q.unit}]" if q.unit else q.name
            for q in task.quantities()[: len(task.names)]
        ],
    )
    for index, values in enumerate(task.rows(0, min(FIRST_ROWS, len(task)))):
        table.add_row(str(index), *map(_text, values.values()))
    return render(table, 200)


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
    lines += [
        f"{name}: {', '.join(f'{count} {value}' for value, count in counts.items())}"
        for name, counts in summary.texts.items()
    ]
    constant = [s.name for s in summary.spreads if s.constant and s.count > 1]
    if constant:
        lines.append(f"the same in all landings that have it: {', '.join(constant)}")
    if summary.missing:
        lines.append(f"no landing has: {', '.join(summary.missing)}")
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
        ("",),
    )
    lines = []
    for f in found:
        if f.reason:
            lines.append(f"{f.response}, {f.mode}: no indices: {f.reason}")
            continue
        if f.used < f.samples:
            lines.append(
                f"{f.response}, {f.mode}: {f.used} of {f.samples} samples have it; "
                "others replace the rest"
            )
        for k, (factor, first, total) in enumerate(zip(f.factors, f.first, f.total)):
            table.add_row(
                f.response.replace("[", r"\["),
                f.mode,
                factor,
                *(f"{v:.3f}" for v in (*first, *total)),
                "" if f.enough(k) else "too few samples",
            )
        table.add_section()
    if any(not f.reason and not f.enough(k) for f in found for k in range(len(f.factors))):
        lines.append(
            f"too few samples: an interval wider than {WIDEST:g} or outside 0 to 1; "
            f"take more than {found[0].samples}, for example {4 * found[0].samples}"
        )
    shown = render(table, 160) if table.rows else ""
    return shown + "".join(f"{line}\n" for line in lines)


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
