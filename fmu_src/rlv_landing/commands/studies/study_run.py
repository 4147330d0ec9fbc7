"""The options of `sweep`, `sensitivity` and `montecarlo`, and the run of a study's landings."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ...errors import LandingError, one_line
from ...signals.interrupts import answer
from ...text.durable import unwritable
from ..number_types import NumberRange
from ..options import add_options, json_option, workers_option
from ..printing import FAILED, INTERRUPTED, exit_code, print_warning

if TYPE_CHECKING:
    from ...studies.montecarlo.run import MonteCarloTask
    from ...studies.sweep.result_files import Results
    from ...studies.sweep.sweep import Engine, Failures
    from ...studies.sweep.sweep_row import Plan, Task

F = TypeVar("F", bound=Callable[..., Any])
# called with the number of landings done, and label and reason of those that failed
Progress = Callable[[int, "Failures"], object]


@dataclass(frozen=True)
class RunOptions:
    """The options of `run_options`: results folder, workers or cluster, checks and printing.

    `workers` and `scheduler` exclude each other; `timeout` [s] is for scheduler and workers.
    """

    results: Path | None
    resume: bool
    workers: int | None
    scheduler: str | None
    timeout: float
    strict: bool
    dry_run: bool
    as_json: bool


def run_options(command: F) -> F:
    """Add the options of `RunOptions`."""
    options = (
        click.option(
            "--results",
            type=click.Path(path_type=Path),
            metavar="FOLDER",
            help="Folder for the results [default: the study's name].",
        ),
        click.option(
            "--resume",
            is_flag=True,
            help="Continue with the study in --results; refused if the study has changed.",
        ),
        workers_option(),
        click.option(
            "--scheduler",
            metavar="ADDRESS",
            help="Run on the Dask cluster of this scheduler, for example tcp://host:8786.",
        ),
        click.option(
            "--timeout",
            default=10.0,
            show_default=True,
            type=NumberRange(0.1, 86400.0, unit="s"),
            metavar="S",
            help="Longest wait for scheduler or workers [s].",
        ),
        click.option(
            "--strict",
            is_flag=True,
            help="Check every row before the first landing; end at the first that fails.",
        ),
        click.option(
            "--dry-run",
            is_flag=True,
            help="Print number of landings, first rows and estimated time; run nothing.",
        ),
        json_option(),
    )
    return add_options(command, options)


def output_option() -> Callable[[F], F]:
    """The option --output: a file of one's own with all rows."""
    return click.option(
        "-o",
        "--output",
        metavar="FILE.csv|parquet",
        type=click.Path(path_type=Path),
        help="Write the rows to this file, too (SI units).",
    )


@contextmanager
def engine_for(plan: Plan, options: RunOptions) -> Iterator[Engine]:
    """Threads of this process, or the cluster that --scheduler names.

    Raises:
        LandingError: Both --workers and --scheduler, or a cluster that cannot be used.
    """
    if options.scheduler is None:
        from ...studies.sweep.sweep import threads

        with threads(plan, options.workers) as engine:
            yield engine
    else:
        from ...studies.sweep.cluster import cluster

        if options.workers is not None:
            raise LandingError(
                "--workers counts threads here; a cluster has its own, "
                "so leave --workers or --scheduler out"
            )
        with cluster(plan, options.scheduler, options.timeout) as engine:
            yield engine


def warn_of_joint(task: Task) -> None:
    """Print a warning where landings of the study have the transverse load at the joint."""
    from ...audit.transverse import study_warning

    study = task.study
    base = study.parameters.for_mode(study.modes[0]) if study.modes else study.parameters
    print_warning(study_warning(base, task.design.columns, task.plan.inputs))


def run_task(task: Task, folder: Path, options: RunOptions) -> Path:
    """Run a study's landings with progress on a terminal.

    The program exits with 1 or 130 where the study cannot be completed.

    Returns:
        The file that holds all rows.

    Raises:
        LandingError: The results folder or the scheduler cannot be used, or --strict refuses a row.
    """
    from ...studies.sweep.result_files import Results
    from ...studies.sweep.sweep import Sweep

    _check(task, options)
    with engine_for(task.plan, options) as engine:
        results = Results(folder, task, resume=options.resume)

        def make(show: Progress) -> None:
            Sweep(task, results, show, strict=options.strict).run(engine)

        return _run_or_exit(task, results, make, len(task))


def run_montecarlo(task: MonteCarloTask, folder: Path, options: RunOptions) -> Path:
    """Make the runs of a Monte Carlo until there are enough; else as `run_task`."""
    from ...studies.montecarlo.run import Tally, run_all

    _check(task, options)
    with engine_for(task.plan, options) as engine:
        results = Tally(folder, task, resume=options.resume)

        def make(show: Progress) -> None:
            run_all(task, results, engine, show, strict=options.strict)

        return _run_or_exit(task, results, make, task.montecarlo.samples)


def _check(task: Task, options: RunOptions) -> None:
    """Check that the machine has what the landings need; with --strict, check every row."""
    from ...studies.sweep.sweep import check_all

    _check_effort(task, options)
    if options.strict:
        check_all(task)


def _check_effort(task: Task, options: RunOptions) -> None:
    """Refuse landings that this machine has not the memory or the time for.

    Raises:
        LandingError: They need too much. The time on a cluster is not known here.
    """
    from ...studies.study_effort import check_landings
    from ...workers import default_workers

    plan = task.plan
    check_landings(
        len(task),
        options.workers or default_workers(),
        plan.until,
        plan.every,
        decided=plan.until is None,
        timed=options.scheduler is None,
    )


def _run_or_exit(
    task: Task, results: Results, make: Callable[[Progress], None], total: int
) -> Path:
    """Make landings, of which there are so many in `total`, and join their rows."""
    from tqdm import tqdm

    from ...studies.sweep.sweep import LostError

    failed = 0
    with tqdm(
        total=total,
        initial=results.rows_done,
        desc=task.study.name,
        unit=" landings",
        disable=not sys.stderr.isatty(),
    ) as bar:

        def show_progress(done: int, failures: Failures) -> None:
            nonlocal failed
            failed += len(failures)
            if failures:
                bar.set_postfix_str(f"{failed} failed")
            bar.update(done)

        try:
            with results:
                make(show_progress)
                return results.finish()
        except KeyboardInterrupt:
            answer()
            reason, status = "interrupted", INTERRUPTED
        except OSError as e:
            refused = unwritable(results.folder, e, "name another by --results", kept=True)
            reason, status = f"error: {refused}", exit_code(e)
        except (LostError, LandingError) as e:
            reason, status = f"error: {e}", FAILED
    click.echo(
        one_line(
            f"{reason}; {results.rows_done} of {total} landings are kept in {results.folder}, "
            "--resume continues"
        ),
        err=True,
    )
    sys.exit(status)
