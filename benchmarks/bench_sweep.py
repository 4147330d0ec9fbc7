"""Time of a sweep by its number of landings: `python benchmarks/bench_sweep.py 100 1000 10000`.

Each count is swept in a process of its own by `rlv-landing sweep`, on all cores. The study is a
Latin hypercube over touchdown states, sink rate, friction and slope, both modes in turn, 1 s of
landing at 1 kHz, with all default responses.

It prints wall time, processor time, landings a second and the largest resident memory, then the
parts of a landing's processor time, and appends rows to `results.jsonl`.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.table import Table
from rows import append_rows
from rows import start as begin

from rlv_landing.studies.sweep.result_files import PART_ROWS, Results
from rlv_landing.studies.sweep.study import read_study
from rlv_landing.studies.sweep.sweep import THREAD_ROWS
from rlv_landing.studies.sweep.sweep_row import Task
from rlv_landing.workers import default_workers

STUDY = """
[study]
name = "bench"
method = "lhs"
samples = {samples}
until = {until}
[set]
drop.contact_time = 0.0
[[factor]]
name = "drop.mode"
values = ["2-2", "1-2-1"]
[[factor]]
name = "drop.tilt"
unit = "deg"
low = -5.0
high = 5.0
[[factor]]
name = "drop.pitch_rate"
unit = "deg/s"
low = -10.0
high = 10.0
[[factor]]
name = "drop.horizontal_velocity"
low = -0.5
high = 0.5
[[factor]]
name = "drop.vertical_velocity"
low = -2.0
high = -1.0
[[factor]]
name = "ground.friction"
low = 0.2
high = 0.6
[[factor]]
name = "ground.slope"
unit = "deg"
low = -2.0
high = 2.0
"""
SWEEP = (
    "import sys; from rlv_landing.cli import main; "
    "sys.argv = ['rlv-landing', 'sweep', *sys.argv[1:]]; main()"
)
REPEATS = 40


def swept(study: Path, folder: Path, workers: int) -> dict[str, float]:
    """Run one sweep in a process of its own.

    Returns:
        Wall and processor time [s], and largest resident memory [MB].
    """
    start = time.perf_counter()
    child = os.posix_spawn(
        sys.executable,
        [
            sys.executable,
            "-c",
            SWEEP,
            str(study),
            "--results",
            str(folder),
            "--workers",
            str(workers),
        ],
        os.environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
    )
    _, status, usage = os.wait4(child, 0)
    if status:
        raise SystemExit(f"the sweep ended with {os.waitstatus_to_exitcode(status)}")
    return {
        "seconds": time.perf_counter() - start,
        "processor": usage.ru_utime + usage.ru_stime,
        "memory": usage.ru_maxrss / 1024.0,
    }


def best(work: Callable[[], Any]) -> float:
    """The least processor time [ms] of this thread for one call of `work`."""
    least = float("inf")
    for _ in range(REPEATS):
        start = time.thread_time()
        work()
        least = min(least, time.thread_time() - start)
    return 1e3 * least


def parts(study: Path) -> dict[str, float]:
    """The parts of one landing's processor time [ms], each the best of many."""
    read = read_study(study)
    task = Task(read, read.design)
    plan = task.plan
    values = task.rows(0, 1)[0]
    history = plan.history(plan.landing(values))

    def run() -> None:
        plan.history(plan.landing(values))

    set_up = best(lambda: plan.landing(values))
    landed = best(run) - set_up
    measured = best(lambda: plan.measure(history, 0))
    with ThreadPoolExecutor(1) as pool:
        handed = best(lambda: pool.submit(task.rows, 0, THREAD_ROWS).result()) / THREAD_ROWS
    with tempfile.TemporaryDirectory() as folder:
        results = Results(Path(folder) / "r", task)
        row = [0, 0, 0, *values.values(), *plan.sweep_row(values)]
        block = [[i, *row[1:]] for i in range(PART_ROWS - 1)]

        def write() -> None:
            results.add(block)
            results.flush()

        written = best(write) / len(block)
        results.__exit__(None, None, None)
    return {
        "set up": set_up,
        "integrate and sample": landed,
        "responses": measured,
        "hand over": handed,
        "write": written,
    }


def print_tables(
    rows: list[dict[str, Any]], counts: tuple[int, ...], spent: dict[str, float]
) -> None:
    """Print the times of all sweeps and the parts of a landing's."""
    console = Console(width=110)
    title = f"landings of {rows[0]['until']:g} s on {rows[0]['workers']} threads"
    table = Table(title=title, title_justify="left")
    for column in (
        "landings",
        "wall [s]",
        "processor [s]",
        "landings/s",
        "processor/landing [ms]",
        "memory [MB]",
    ):
        table.add_column(column, justify="right")
    for count, row in zip(counts, rows):
        cells = (
            row["seconds"],
            row["processor"],
            count / row["seconds"],
            1e3 * row["processor"] / count,
            row["memory"],
        )
        table.add_row(str(count), *(f"{v:.1f}" for v in cells))
    console.print(table)
    for what, value in spent.items():
        console.print(f"{what:>22}: {value:.3f} ms a landing")


@click.command()
@click.argument("counts", nargs=-1, type=click.IntRange(1))
@click.option("--until", default=1.0, show_default=True, help="End of each landing [s].")
@click.option("--workers", default=default_workers(), show_default=True, help="Threads.")
@click.option(
    "--keep/--no-keep", default=True, show_default=True, help="Append the rows to results.jsonl."
)
def main(counts: tuple[int, ...], until: float, workers: int, *, keep: bool) -> None:
    """Sweep COUNTS landings each [default: 100 1000]."""
    begin()
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        study = Path(name) / "bench.toml"
        for count in counts or (100, 1000):
            study.write_text(STUDY.format(samples=count, until=until))
            rows.append(
                {
                    "case": f"sweep of {count}",
                    "workers": workers,
                    "until": until,
                    **swept(study, Path(name) / str(count), workers),
                }
            )
        spent = parts(study)
    print_tables(rows, counts or (100, 1000), spent)
    if keep:
        append_rows([*rows, {"case": "parts of a swept landing [ms]", "until": until, **spent}])


if __name__ == "__main__":
    main()
