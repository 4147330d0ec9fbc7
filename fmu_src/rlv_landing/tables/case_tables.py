"""Cases beside our landings, as text."""

from __future__ import annotations

from collections.abc import Sequence

from ..cases.case_file import Case
from ..cases.compare import Result
from ..quantities.quantity import shown
from .rendering import new_table, render

# so many numbers of a case are printed, those nearest to their tolerances
SHOWN = 12


def case_list(cases: Sequence[Case]) -> str:
    """The cases that there are."""
    table = new_table("cases", ("case", "what"), ("numbers",), ("source",))
    for case in cases:
        count = len(case.numbers) + bool(case.outcome)
        table.add_row(case.name, case.title, str(count), case.page)
    return render(table)


def case_tables(results: Sequence[Result], *, every: bool) -> str:
    """The numbers of cases beside ours, where they are from, and why they may differ.

    Args:
        results: The cases, landed.
        every: Whether all numbers are printed, or those nearest to their tolerances.
    """
    return "\n".join(_one(result, every=every) for result in results)


def _one(result: Result, *, every: bool) -> str:
    case = result.case
    compared = result.compared
    if not every:
        compared = tuple(sorted(compared, key=lambda c: c.part, reverse=True)[:SHOWN])
    table = new_table(
        f"{case.name}: {case.title}",
        ("number", "unit"),
        ("theirs", "ours", "difference", "tolerance"),
        ("",),
    )
    for c in compared:
        unit, size = shown(c.number.quantity)
        theirs, tolerance = c.number.theirs / size, c.number.tolerance / size
        ours, off = ("none", "none")
        if c.ours is not None:
            ours, off = f"{c.ours / size:.6g}", f"{c.ours / size - theirs:.2g}"
        told = "ok" if c.within else "MISSED"
        table.add_row(c.number.label, unit, f"{theirs:.6g}", ours, off, f"{tolerance:.2g}", told)
    if case.outcome:
        told = "ok" if result.outcome == case.outcome else "MISSED"
        table.add_row("outcome", "", case.outcome, result.outcome, "", "", told)
    lines = [render(table)]
    left = len(result.compared) - len(compared)
    if left:
        lines.append(f"and {left} numbers nearer; --json has all\n")
    lines.append(f"source: {case.source}" + (f" ({case.page})" if case.page else "") + "\n")
    if case.differences:
        lines.append(f"differences: {case.differences}\n")
    return "".join(lines)
