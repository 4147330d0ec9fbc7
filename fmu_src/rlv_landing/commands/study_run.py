"""What `sweep` and `sensitivity` share: options, and running a study to its end or to whatever ends
it.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..errors import LandingError

if TYPE_CHECKING:
    from ..studies.sweep.row import Plan, Task
    from ..studies.sweep.sweep import Engine, Failed

F = TypeVar("F", bound=Callable[..., Any])
FAILED, INTERRUPTED = 1, 130


@dataclass(frozen=True)
class Where:
    """How and where landings run, as the options say."""

    resume: bool
    workers: int | None
    scheduler: str | None
    timeout: float
    strict: bool


def run_options(command: F) -> F:
    """Options that say where results go and landings run."""
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
            help="Go on with the study in --results; refused if the study has changed.",
        ),
        click.option("--workers", type=click.IntRange(1), help="Threads [default: all cores]."),
        click.option(
            "--scheduler",
            metavar="ADDRESS",
            help="Run on the Dask cluster of this scheduler, for example tcp://host:8786.",
        ),
        click.option(
            "--timeout",
            default=10.0,
            show_default=True,
            type=click.FloatRange(0.1),
            metavar="S",
            help="Wait so long for scheduler or workers [s].",
        ),
        click.option(
            "--strict",
            is_flag=True,
            help="Check every row before the first landing; end at the first that fails.",
        ),
        click.option(
            "--dry-run",
            is_flag=True,
            help="Print the plan: how many landings, the first rows, the time it may take; run nothing.",
        ),
        click.option("--json", "as_json", is_flag=True, help="Print as JSON."),
    )
    for option in reversed(options):
        command = option(command)
    return command


@contextmanager
def engine_for(plan: Plan, where: Where) -> Iterator[Engine]:
    """Threads, or the cluster that --scheduler names."""
    if where.scheduler is None:
        from ..studies.sweep.sweep import threads

        with threads(plan, where.workers) as engine:
            yield engine
    else:
        from ..studies.sweep.cluster import cluster

        if where.workers is not None:
            raise LandingError(
                "--workers counts threads here; a cluster has its own, so leave --workers or --scheduler out"
            )
        with cluster(plan, where.scheduler, where.timeout) as engine:
            yield engine


def run_task(task: Task, folder: Path, where: Where) -> Path:
    """Run a study's landings, with progress on a terminal; the file that holds their rows.

    Ends the program where it cannot go on: 1, 130.

    Raises LandingError for what the user can set right: the results folder, the scheduler, a row
        that --strict refuses.
    """
    from tqdm import tqdm

    from ..studies.sweep.result_files import Results
    from ..studies.sweep.sweep import LostError, Sweep, check_all

    if where.strict:
        check_all(task)
    # SIGTERM ends as Ctrl-C does: with everything written
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with engine_for(task.plan, where) as engine:
        results = Results(
            folder, task.about(), task.study.text, task.quantities(), len(task), where.resume
        )
        failed = 0
        with tqdm(
            total=len(task),
            initial=results.rows_done,
            desc=task.study.name,
            unit=" landings",
            disable=not sys.stderr.isatty(),
        ) as bar:

            def tell(done: int, failures: Failed) -> None:
                nonlocal failed
                failed += len(failures)
                if failures:
                    bar.set_postfix_str(f"{failed} failed")
                bar.update(done)

            try:
                with results:
                    Sweep(task, results, tell, where.strict).run(engine)
                    return results.finish()
            except KeyboardInterrupt:
                ended, status = "interrupted", INTERRUPTED
            except OSError as e:
                ended, status = (
                    f"error: {folder} cannot be written: {e.strerror or e}; make room",
                    FAILED,
                )
            except (LostError, LandingError) as e:
                ended, status = f"error: {e}", FAILED
    click.echo(
        f"{ended}; {results.rows_done} of {len(task)} landings are kept in {folder}, --resume goes on",
        err=True,
    )
    sys.exit(status)
