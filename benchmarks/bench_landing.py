"""Measures a 1 s landing at equal error: the core, the FMU, C, other solvers and MuJoCo.

All run in one process. Writes the table and the picture of `docs/performance.md`, prints the table
and appends one row per solver to `results.jsonl`; of an idle machine and a commit only.
"""

from __future__ import annotations

import os
from itertools import chain
from typing import Any

# one thread, because the thread's processor time is measured
os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"

import fmpy
import mujoco
import numpy as np
import scipy
import sksundae
from c_landing import EXACT, CLanding, disagreement
from other_solvers import OTHERS
from peers import OURS
from problem import Problem
from rich.console import Console
from rich.table import Table
from rows import HERE, append_rows, load, provenance, start
from work_precision import Run, cost, draw, measure

from rlv_landing.core import COMPILED
from rlv_landing.quantities import MODES

DOCS = HERE.parent / "docs"
MARKS = ("<!-- measured by make bench -->\n", "<!-- end of what is measured -->\n")
TARGETS = (1e-3, 1e-2)
HEADINGS = (
    "solver", "ms at 0.1 %", "to core's", "stroke error [um]", "right-hand sides", "to core's",
    "us each", "model", "ms at 1 %", "to core's",
)  # fmt: skip


def check_c_landing(problem: Problem) -> None:
    """End the program if the landing in C differs from the core's."""
    found = disagreement(problem.new_solver(), CLanding(problem.landing().parameters, 1e-5), 1.0)
    if not found <= 1e-9:
        raise SystemExit(
            f"error: the landing in C differs from the core's by {found:.1e} in mode "
            f"{problem.mode}; change c_landing.c as the core has changed"
        )


def digits(value: float, bound: str = "") -> str:
    """Three digits of `value`, after its `bound` (≤ or >) if it has one."""
    return f"{bound} {value:.3g}".strip() if value < 1000.0 else f"{bound} {value:.0f}".strip()


def line_of(runs: list[Run], core: list[Run], call: float) -> list[str]:
    """One line of the table: a peer beside the core.

    Args:
        runs: The peer's runs at all tolerances.
        core: The core's runs.
        call: Time of one of the core's right-hand sides [s].
    """
    (at, loose), (base, base_loose) = (
        [cost(own, target) for target in TARGETS] for own in (runs, core)
    )
    peer = runs[0].peer
    failed = [f"{r.tolerance:g}" for r in runs if r.failure]
    line = [peer.name + f" (no end at {', '.join(failed)})" * bool(failed)]
    line += [
        digits(1e3 * at.seconds, at.bound),
        digits(at.seconds / base.seconds, at.bound),
        digits(1e6 * at.stroke),
    ]
    if peer.kind == "simulator":
        line += [f"{at.calls:.0f} steps", "", "", ""]
    else:
        share = f"{100.0 * call * at.calls / at.seconds:.0f} %" if peer.kind == "other" else ""
        line += [
            f"{at.calls:.0f}",
            digits(at.calls / base.calls, at.bound),
            f"{1e6 * at.seconds / at.calls:.2f}",
            share,
        ]
    return [
        *line,
        digits(1e3 * loose.seconds, loose.bound),
        digits(loose.seconds / base_loose.seconds, loose.bound),
    ]


def row_of(mode: str, runs: list[Run], loads: list[float]) -> dict[str, Any]:
    """A peer's row in `results.jsonl`.

    It has the cost at the first target, and tolerance, seconds, calls and errors of every run.
    """
    at = cost(runs, TARGETS[0])
    curve = [
        [r.tolerance, r.seconds, r.calls, r.error.peaks, r.error.stroke]
        for r in runs
        if r.error and not r.failure
    ]
    return {
        "case": f"{mode} {runs[0].peer.name}",
        "error": TARGETS[0],
        "bound": at.bound,
        "seconds": at.seconds,
        "rhs_calls": round(at.calls),
        "stroke_error": at.stroke,
        "curve": curve,
        "failures": {f"{r.tolerance:g}": r.failure for r in runs if r.failure},
        "load": loads,
    }


def report(console: Console, lines: dict[str, list[list[str]]], note: str) -> None:
    """Print the tables; where they are kept, write them to `docs/performance.md` too."""
    text = f"Measured on {note}.\n"
    for mode, table_lines in lines.items():
        table = Table(
            title=f"1 s landing in mode {mode} at equal error of the peaks", title_justify="left"
        )
        for heading in HEADINGS:
            table.add_column(heading, justify="left" if heading == HEADINGS[0] else "right")
        for line in table_lines:
            table.add_row(*line)
        console.print(table)
        text += (
            f"\nMode {mode}:\n\n| {' | '.join(HEADINGS)} |\n|---|{'---:|' * (len(HEADINGS) - 1)}\n"
        )
        text += "".join(f"| {' | '.join(line)} |\n" for line in table_lines)
    console.print(note)
    if start().unfit:
        return
    page = DOCS / "performance.md"
    before, _, rest = page.read_text(encoding="utf-8").partition(MARKS[0])
    page.write_text(
        before + MARKS[0] + text + MARKS[1] + rest.partition(MARKS[1])[2], encoding="utf-8"
    )


def main() -> None:
    """Measure all solvers in both modes, report, and append the rows."""
    if not COMPILED:
        raise SystemExit("error: the core is not compiled here; run make")
    console, loads = Console(width=160), [start().load]
    runs: dict[str, list[list[Run]]] = {}
    for mode in MODES:
        problem = Problem(mode)
        check_c_landing(problem)
        with console.status(f"{mode}: reference") as status:
            found = measure((*OURS, *OTHERS), problem, status.update)
        runs[mode] = [[r for r in found if r.peer is peer] for peer in (*OURS, *OTHERS)]
    loads.append(load())
    lines = {}
    for mode, own in runs.items():
        fixed = cost(own[1], TARGETS[0])
        lines[mode] = [line_of(peer, own[0], fixed.seconds / fixed.calls) for peer in own]
    append_rows([row_of(mode, peer, loads) for mode, own in runs.items() for peer in own])
    stamp, modules = provenance(), (np, scipy, sksundae, mujoco, fmpy)
    versions = ", ".join(f"{module.__name__} {module.__version__}" for module in modules)
    machine = (
        f"{stamp['cpu']}, load {loads[0]:.1f} before and {loads[1]:.1f} after "
        f"on {os.cpu_count()} cores"
    )
    report(
        console,
        lines,
        f"{machine}; commit {stamp['commit']}, Python {stamp['python']}, {versions}; "
        f"`gcc {' '.join(EXACT)}`",
    )
    if start().unfit:
        return
    draw(
        {mode: [*chain(*own)] for mode, own in runs.items()},
        DOCS / "work-precision.png",
        f"commit {stamp['commit']}, {machine}",
    )


if __name__ == "__main__":
    main()
