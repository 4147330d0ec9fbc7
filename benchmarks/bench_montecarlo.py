"""Time of Monte Carlo landings in space: `python benchmarks/bench_montecarlo.py 2000`.

The study is `examples/touchdown_study/montecarlo.toml`: each landing until it is decided, and once
until 1 s after its first contact. It is run by `rlv-landing montecarlo` on all cores, in a process
of its own. The time of 100,000 landings is so many times that of one: not measured, but scaled.

It prints wall and processor time of a landing, and what parts of the processor time are the
integration, the start of a landing, and its responses; and appends rows to `results.jsonl`.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.table import Table
from rows import append_rows
from rows import start as begin

from rlv_landing.studies.montecarlo.run import MonteCarloTask
from rlv_landing.studies.montecarlo.study import read_montecarlo
from rlv_landing.workers import default_workers

STUDY = Path(__file__).parent.parent / "examples" / "touchdown_study" / "montecarlo.toml"
RUN = (
    "import sys; from rlv_landing.cli import main; "
    "sys.argv = ['rlv-landing', 'montecarlo', *sys.argv[1:]]; main()"
)
SCALED_TO = 100_000
# landings whose parts are timed
TIMED = 50


def study_for(until: float | None, folder: Path) -> Path:
    """The study without a stop before all runs, each landing to its decision or `until` [s]."""
    text = STUDY.read_text(encoding="utf-8").replace("width = 0.04\n", "")
    if until is not None:
        text = text.replace("[montecarlo]\n", f"[montecarlo]\nuntil = {until}\n")
    path = folder / f"until-{until}.toml"
    path.write_text(text, encoding="utf-8")
    return path


def made(study: Path, count: int, workers: int) -> tuple[float, float]:
    """Wall and processor time [s] of so many runs by the command, its start included."""
    start = time.perf_counter()
    arguments = [
        *(sys.executable, "-c", RUN, str(study), "--samples", str(count), "--no-report"),
        *("--results", str(study.with_suffix("")), "--workers", str(workers)),
    ]
    child = os.posix_spawn(
        sys.executable,
        arguments,
        os.environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
    )
    _, status, usage = os.wait4(child, 0)
    if status:
        raise SystemExit(f"montecarlo ended with {os.waitstatus_to_exitcode(status)}")
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime


def parts(study: Path) -> dict[str, float]:
    """The parts of a landing's processor time [ms], and its right-hand sides, in the mean."""
    task = MonteCarloTask(read_montecarlo(study))
    plan, spent = task.plan, dict.fromkeys(("set up", "integrate and sample", "responses"), 0.0)
    calls = 0
    for values in task.rows(0, TIMED):
        times = [time.thread_time()]
        landing = plan.landing(values)
        times.append(time.thread_time())
        history = plan.history(landing)
        times.append(time.thread_time())
        plan.measure(history, 0)
        times.append(time.thread_time())
        for name, first, last in zip(spent, times, times[1:]):
            spent[name] += 1e3 * (last - first) / TIMED
        calls += landing.statistics["rhs_calls"]
    return {**spent, "right-hand sides": calls / TIMED}


@click.command()
@click.argument("count", default=1000, type=click.IntRange(1))
@click.option("--workers", default=default_workers(), show_default=True, help="Threads.")
@click.option(
    "--keep/--no-keep", default=True, show_default=True, help="Append the rows to results.jsonl."
)
def main(count: int, workers: int, *, keep: bool) -> None:
    """Land COUNT times [default: 1000] in both ways."""
    begin()
    table = Table(title=f"{count} landings in space on {workers} threads", title_justify="left")
    columns = (
        "until",
        "wall/landing [ms]",
        "processor/landing [ms]",
        f"{SCALED_TO:,} landings, scaled [min]",
        "set up [ms]",
        "integrate, sample [ms]",
        "responses [ms]",
        "right-hand sides",
    )
    for column in columns:
        table.add_column(column, justify="right")
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        for until, word in ((None, "decided"), (1.0, "1 s")):
            study = study_for(until, Path(name))
            wall, processor = made(study, count, workers)
            spent = parts(study)
            minutes = SCALED_TO * wall / count / 60.0
            row = {"count": count, "workers": workers, "seconds": wall, "processor": processor}
            rows.append({"case": f"montecarlo until {word}", "minutes": minutes, **row, **spent})
            cells = (1e3 * wall / count, 1e3 * processor / count, minutes, *spent.values())
            table.add_row(word, *(f"{v:.1f}" for v in cells))
    Console(width=140).print(table)
    if keep:
        append_rows(rows)


if __name__ == "__main__":
    main()
