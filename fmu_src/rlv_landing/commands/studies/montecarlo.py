"""`rlv-landing montecarlo`: dispersed landings, and the difference of two such studies."""

from __future__ import annotations

import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import LandingError
from ...text.durable import write_durably, writing
from ..number_types import NumberRange, WholeNumber
from ..one_landing import draw_landing, landing_text
from ..options import HELP_NAMES, PICTURES, check_writable, force_option, plot_option
from ..printing import FAILED, json_text, print_json
from .study_run import RunOptions, output_option, run_montecarlo, run_options, warn_of_joint
from .sweep import show_plan

if TYPE_CHECKING:
    from ...studies.montecarlo.run import MonteCarloTask
    from ...studies.montecarlo.study import MonteCarlo


@click.command(context_settings=HELP_NAMES)
@click.argument("study", metavar="STUDY.toml", required=False, type=click.Path(path_type=Path))
@output_option()
@run_options
@click.option(
    "--samples",
    type=WholeNumber(1, 100_000_000),
    metavar="N",
    help="The most runs, for the file's.",
)
@click.option(
    "--html",
    type=click.Path(path_type=Path),
    metavar="FILE.html",
    help="The report [default: report.html in the results].",
)
@click.option("--no-report", is_flag=True, help="Write no report.")
@click.option("--run", "again", type=WholeNumber(0), metavar="K", help="Land run K alone, again.")
@click.option(
    "--toml",
    type=click.Path(path_type=Path),
    metavar="FILE.toml",
    help="With --run: write its parameters.",
)
@plot_option()
@click.option(
    "--diff",
    nargs=2,
    type=click.Path(path_type=Path),
    metavar="A B",
    help="Compare the results folders of two studies, A before and B after.",
)
@click.option(
    "--tolerance",
    default=1e-3,
    show_default=True,
    type=NumberRange(0.0, 1.0),
    metavar="PART",
    help="With --diff: change of a load that counts, in parts of its largest magnitude.",
)
@force_option("Overwrite an output, report, picture or TOML file that exists.")
def montecarlo(
    study: Path | None, diff: tuple[Path, Path] | None, again: int | None, **options: Any
) -> None:
    """Land many times from dispersed states; rate of success, causes of loss, loads, worst cases.

    \b
    [montecarlo]
    parameters = "mine.toml"
    mode = "space"
    samples = 2000          # at most
    width = 0.02            # enough where the rate of success is known to 2 %
    [[factor]]              # what varies by itself, as in a sweep
    name = "drop.heading"
    unit = "deg"
    low = -180.0
    high = 180.0
    [covariance]            # what is normal together; or [table], samples in a file
    names = ["drop.tilt", "drop.roll", "drop.vertical_velocity"]
    units = ["deg", "deg", "m/s"]
    mean = [0.0, 0.0, -1.4]
    deviation = [1.0, 1.0, 0.2]
    correlation = [[1.0, 0.0, 0.3], [0.0, 1.0, 0.0], [0.3, 0.0, 1.0]]

    \b
    rlv-landing montecarlo study.toml --dry-run
    rlv-landing montecarlo study.toml --results baseline --output rows.csv
    rlv-landing montecarlo study.toml --results baseline --samples 10000 --resume
    rlv-landing montecarlo study.toml --run 1234 --plot worst.png
    rlv-landing montecarlo --diff baseline changed

    Run k of a seed is the same whatever the number of runs, the threads, or where one resumed. The
    folder has results.parquet, summary.json, and the report, one page of HTML. A landing that
    cannot be made counts as lost. docs/montecarlo.md has every key.

    Exit codes: 0 done, or --diff finds the same; 1 ended before its time, or --diff finds other
    outcomes or loads; 2 bad input, 130 interrupted.
    """
    from ...tables.rows_file import ENDINGS, write_rows

    toml, plot, force = options.pop("toml"), options.pop("plot"), options.pop("force")
    samples, html, tolerance = (options.pop(name) for name in ("samples", "html", "tolerance"))
    no_report, output = options.pop("no_report"), options.pop("output")
    run = RunOptions(**options)
    if diff is not None:
        if study is not None or again is not None:
            raise LandingError("--diff compares two results folders; leave the study and --run out")
        _compare(diff, tolerance, as_json=run.as_json)
        return
    if study is None:
        raise LandingError("name a study, STUDY.toml, or two results folders by --diff A B")
    if again is None and (toml is not None or plot is not None):
        raise LandingError("--toml and --plot are of one run; name it by --run K")
    if output is not None and again is not None:
        raise LandingError("--output has the rows of all runs, and --run lands one; leave one out")
    if html is not None and no_report:
        raise LandingError("--html names a report, and --no-report writes none; leave one out")
    written = ((output, ENDINGS), (html, ".html"), (toml, ".toml"), (plot, PICTURES))
    for path, ending in written:
        check_writable(path, ending, force=force)
    task = _task(study, samples)
    if again is not None:
        _land_again(task, again, toml, plot, as_json=run.as_json)
        return
    warn_of_joint(task)
    if run.dry_run:
        task.runs.count = task.montecarlo.samples
        show_plan(task, run)
        return
    folder = run.results or Path(task.study.name)
    path = run_montecarlo(task, folder, run)
    if output is not None:
        write_rows(path, output)
    _tell(task, study, path, None if no_report else html or folder / "report.html", run)


def _task(study: Path, samples: int | None) -> MonteCarloTask:
    """The runs of the study, at most so many `samples` if they are given."""
    from ...studies.montecarlo.run import MonteCarloTask
    from ...studies.montecarlo.study import read_montecarlo

    read = read_montecarlo(study)
    return MonteCarloTask(read if samples is None else _with_samples(read, samples))


def _with_samples(read: MonteCarlo, samples: int) -> MonteCarlo:
    table = read.dispersions.table
    if table is not None and not table.at_random and samples > len(table.design):
        raise LandingError(
            f"--samples {samples} is more than the table has rows, {len(table.design)}; "
            'take fewer, or draw = "at random"'
        )
    return replace(read, samples=samples)


def _tell(
    task: MonteCarloTask, study: Path, path: Path, report: Path | None, run: RunOptions
) -> None:
    """Print and write what came of the runs, whose rows are in the file `path`."""
    from ...figures.montecarlo_report.page import write
    from ...studies.montecarlo.difference import SUMMARY
    from ...studies.montecarlo.summary import summarise
    from ...tables.montecarlo_tables import montecarlo_tables

    read, folder = task.montecarlo, path.parent
    found = summarise(path, read)
    record = {"criterion": read.criterion, **found.record()}
    again = f"rlv-landing montecarlo {shlex.quote(str(study))} --run "
    with writing(folder / SUMMARY):
        write_durably(folder / SUMMARY, (json_text(record) + "\n").encode())
    if report is not None:
        write(found, read, path, again, report)
    if run.as_json:
        shown = None if report is None else str(report)
        print_json({"results": str(path), "report": shown, **record})
    else:
        click.echo(montecarlo_tables(found, again), nl=False)
        click.echo(f"results: {path}" + (f"\nreport: {report}" if report is not None else ""))


def _land_again(
    task: MonteCarloTask, run: int, toml: Path | None, plot: Path | None, *, as_json: bool
) -> None:
    """Land one run of the study, and print its outcome and peaks."""
    from ...presets import to_toml
    from ...studies.montecarlo.run import values_of
    from ...studies.variables import is_parameter

    table = task.montecarlo.dispersions.table
    if table is not None and not table.at_random and run >= len(table.design):
        raise LandingError(f"--run {run} is beyond the table's last row, {len(table.design) - 1}")
    values = values_of(task, run)
    landing = task.plan.landing(values)
    history = task.plan.history(landing)
    title = f"{task.study.name}, run {run} of seed {task.study.seed}"
    if toml is not None:
        with writing(toml):
            write_durably(toml, to_toml(landing.parameters).encode())
    draw_landing(history, plot, title)
    click.echo(landing_text(history, title, as_json=as_json), nl=False)
    inputs = {**task.plan.inputs, **{n: v for n, v in values.items() if not is_parameter(n)}}
    if toml is not None and not as_json:
        options = "".join(f" --input {name}={value!r}" for name, value in inputs.items())
        ways = f"--until {float(history.time[-1])!r} --rtol {task.plan.rtol!r}{options}"
        click.echo(f"rlv-landing simulate --parameters {shlex.quote(str(toml))} {ways}")


def _compare(folders: tuple[Path, Path], tolerance: float, *, as_json: bool) -> None:
    """Print what differs between two studies; exit code 1 if anything does."""
    from ...studies.montecarlo.difference import difference, read_side
    from ...tables.montecarlo_tables import difference_tables

    before, after = (read_side(folder) for folder in folders)
    found = difference(before, after, tolerance)
    if as_json:
        print_json(found.record())
    else:
        click.echo(difference_tables(found), nl=False)
    if not found.same:
        sys.exit(FAILED)
