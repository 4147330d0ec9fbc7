"""`rlv-landing sweep`: a study of many landings."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..options import HELP_NAMES, check_writable, force_option
from ..printing import print_json
from .study_run import RunOptions, output_option, run_options, run_task, warn_of_joint

if TYPE_CHECKING:
    from ...studies.sweep.sweep_row import Task


@click.command(context_settings=HELP_NAMES)
@click.argument("study", metavar="STUDY.toml", type=click.Path(path_type=Path))
@output_option()
@force_option("Overwrite --output if it exists.")
@run_options
def sweep(study: Path, *, output: Path | None, force: bool, **options: Any) -> None:
    """Land once for every point of a study and keep a row of responses for each, as Parquet.

    The study names what varies (any parameter, drop quantity or constant input), how points are
    drawn, and which responses are taken from each landing:

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
    rlv-landing sweep study.toml --results folder --output rows.csv
    rlv-landing sweep study.toml --results folder --resume
    rlv-landing sweep study.toml --scheduler tcp://host:8786

    The same study gives the same rows, in the order of their index, on any number of threads or
    workers. The folder has results.parquet at the end, and parts of it until then. Ctrl-C, kill -9
    or a full disk lose seconds of work at most, and --resume continues. A landing that cannot be
    made is a row with its reason in the column `error`. docs/studies.md has every key.

    Exit codes: 0 done, 1 ended before its time (a full disk, a lost cluster, --strict), 2 bad
    input, 130 interrupted.
    """
    from ...studies.sweep.study import read_study
    from ...studies.sweep.summary import summarise_results
    from ...studies.sweep.sweep_row import Task
    from ...tables.rows_file import ENDINGS, write_rows
    from ...tables.sweep_tables import summary_table

    check_writable(output, ENDINGS, force=force)
    run = RunOptions(**options)
    read = read_study(study)
    task = Task(read, read.design)
    warn_of_joint(task)
    if run.dry_run:
        show_plan(task, run)
        return
    path = run_task(task, run.results or Path(read.name), run)
    if output is not None:
        write_rows(path, output)
    summary = summarise_results(path)
    if run.as_json:
        print_json({"study": read.name, "results": str(path), **summary.record()})
    else:
        click.echo(summary_table(read.name, summary), nl=False)
        click.echo(f"results: {path}{f', {output}' if output is not None else ''}")


def show_plan(task: Task, options: RunOptions) -> None:
    """Print a study's number of landings, first rows and the time estimated from one landing."""
    from ...tables.sweep_tables import FIRST_ROWS, plan_table
    from ...workers import default_workers

    workers = options.workers or default_workers()
    seconds, error = _timed_landing(task)
    estimate = seconds * len(task) / workers
    if options.as_json:
        record: dict[str, Any] = {
            "study": task.study.name,
            "landings": len(task),
            "samples": len(task.design),
            "first": task.rows(0, min(FIRST_ROWS, len(task))),
            "responses": list(task.plan.responses),
            "seconds_one": seconds,
            "workers": workers,
            "seconds_estimated": estimate,
            "error": error,
            "notes": task.study.notes,
        }
        # a table of states may have gaps: NaN is printed, as its row is
        click.echo(json.dumps(record, indent=1))
        return
    click.echo(plan_table(task), nl=False)
    click.echo(f"{len(task)} landings, {len(task.plan.responses)} responses each")
    click.echo(
        f"the first took {seconds * 1e3:.1f} ms: about {_duration(estimate)} on {workers} threads, "
        "if they have a core each"
    )
    failure = [f"the first landing fails: {error}"] if error is not None else []
    for note in (*task.study.notes, *failure):
        click.echo(f"note: {note}")


def _timed_landing(task: Task) -> tuple[float, str | None]:
    """Wall time [s] of a study's first landing, made twice, and its error."""
    values = task.rows(0, 1)[0]
    task.plan.sweep_row(values)
    start = time.perf_counter()
    _, error, *_ = task.plan.sweep_row(values)
    return time.perf_counter() - start, error


def _duration(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.1f} s"
    return f"{seconds / 60.0:.1f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
