"""`rlv-landing sweep`: a study of many landings."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .study_run import Where, run_options, run_task

if TYPE_CHECKING:
    from ..studies.sweep.row import Task


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("study", metavar="STUDY.toml", type=click.Path(path_type=Path))
@run_options
def sweep(
    study: Path, results: Path | None, resume: bool, workers: int | None, scheduler: str | None, timeout: float, strict: bool,
    dry_run: bool, as_json: bool,
) -> None:  # fmt: skip
    """Land once for every point of a study and keep one row of responses a landing, as Parquet.

    The study says what varies (any parameter, drop quantity or constant input), how points are
    drawn, and what is taken off each landing:

    \b
    [study]
    method = "lhs"                          # or sobol, grid, table = "states.csv"
    samples = 500
    responses = ["outcome", "margin.*", "leg[*].main_strut.force.min"]      # default: some 80
    [set]
    ground.friction = 0.4
    [[factor]]
    name = "drop.tilt"
    unit = "deg"
    low = -5.0
    high = 5.0

    \b
    rlv-landing sweep study.toml --dry-run
    rlv-landing sweep study.toml --results folder
    rlv-landing sweep study.toml --results folder --resume
    rlv-landing sweep study.toml --scheduler tcp://host:8786

    The same study gives the same rows, in the order of their index, on any number of threads or
    workers. The folder holds results.parquet in the end, and parts of it until then: Ctrl-C, kill
    -9 or a full disk lose seconds of work at most, --resume goes on. A landing that cannot be made
    is a row with its reason in the column `error`. docs/studies.md has every key.

    Exit codes: 0 done, 1 ended before its time (a full disk, a lost cluster, --strict), 2 bad
        input, 130 interrupted.
    """
    from ..studies.sweep.row import Task
    from ..studies.sweep.study import read_study

    read = read_study(study)
    task = Task(read, read.design)
    if dry_run:
        show_plan(task, workers, as_json)
        return
    folder = results if results is not None else Path(read.name)
    path = run_task(task, folder, Where(resume, workers, scheduler, timeout, strict))
    from ..studies.sweep.summary import summarise_results
    from ..tables.sweep_tables import summary_table

    summary = summarise_results(path)
    if as_json:
        click.echo(
            json.dumps(
                {"study": read.name, "results": str(path), **summary.record()},
                indent=1,
                allow_nan=False,
            )
        )
    else:
        click.echo(summary_table(read.name, summary), nl=False)
        click.echo(f"results: {path}")


def show_plan(task: Task, workers: int | None, as_json: bool, notes: tuple[str, ...] = ()) -> None:
    """Print how many landings a study makes, its first rows, and how long it may take by one timed
    landing.
    """
    from ..tables.sweep_tables import FIRST_ROWS, plan_table
    from ..workers import default_workers

    count = workers or default_workers()
    notes = (*notes, *task.study.notes)
    values = task.rows(0, 1)[0]
    task.plan.row(values)
    start = time.perf_counter()
    row = task.plan.row(values)
    seconds = time.perf_counter() - start
    estimate = seconds * len(task) / count
    if as_json:
        first = task.rows(0, min(FIRST_ROWS, len(task)))
        record: dict[str, Any] = {
            "study": task.study.name, "landings": len(task), "samples": len(task.design), "first": first,
            "responses": list(task.plan.responses), "seconds_one": seconds, "workers": count, "seconds_estimated": estimate,
            "error": row[1], "notes": list(notes),
        }  # fmt: skip
        click.echo(json.dumps(record, indent=1))
        return
    click.echo(plan_table(task), nl=False)
    click.echo(f"{len(task)} landings, {len(task.plan.responses)} responses each")
    click.echo(
        f"the first took {seconds * 1e3:.1f} ms: about {_duration(estimate)} on {count} threads, if they have a core each"
    )
    for note in (*notes, *([f"the first landing fails: {row[1]}"] if row[1] is not None else [])):
        click.echo(f"note: {note}")


def _duration(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.1f} s"
    return f"{seconds / 60.0:.1f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
