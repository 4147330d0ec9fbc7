"""`rlv-landing sensitivity`: which factors of a study the responses depend on."""

from __future__ import annotations

import json
from pathlib import Path

import click

from .options import check_writable
from .study_run import Where, run_options, run_task
from .sweep import show_plan


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("study", metavar="STUDY.toml", type=click.Path(path_type=Path))
@click.argument("responses", metavar="[RESPONSE...]", nargs=-1)
@run_options
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    metavar="FILE.png",
    help="Bars [default: sensitivity.png in the results].",
)
@click.option(
    "--level",
    default=0.95,
    show_default=True,
    type=click.FloatRange(0.5, 0.999),
    help="Confidence of the intervals.",
)
@click.option(
    "--resamples",
    default=999,
    show_default=True,
    type=click.IntRange(99, 100_000),
    help="Bootstrap resamples.",
)
def sensitivity(
    study: Path, responses: tuple[str, ...], results: Path | None, resume: bool, workers: int | None, scheduler: str | None, timeout: float,
    strict: bool, dry_run: bool, as_json: bool, plot: Path | None, level: float, resamples: int,
) -> None:  # fmt: skip
    """Sobol indices of a study's responses: how much of the variance each factor brings, alone
    (first order) and with others (total).

    The study is one of `rlv-landing sweep`, with two [[factor]] or more and samples = a power of 2;
    it takes samples * (factors + 2) landings in each mode, on all cores or a Dask cluster, and
    --resume goes on. RESPONSE is one of the study's; when none is named, all that are of the whole
    vehicle rather than of one leg. Intervals are bootstrapped.

    \b
    rlv-landing sensitivity study.toml --dry-run
    rlv-landing sensitivity study.toml margin.stability_min legs.main_strut.force.min
    rlv-landing sensitivity study.toml --resume --level 0.9 --json

    The folder (default: the study's name and -sensitivity) holds results.parquet and the bars. More
    responses of a study that is done need no further landings: name them and --resume. Exit codes
    as for sweep.
    """
    from ..figures.sensitivity_figure import save_bars
    from ..studies.sweep.row import Task
    from ..studies.sweep.sensitivity import indices_of, numeric_responses, sobol_design
    from ..studies.sweep.study import read_study
    from ..tables.sweep_tables import indices_table

    check_writable(plot, ".png", force=True)
    read = read_study(study)
    wanted = numeric_responses(read, responses)
    task = Task(read, sobol_design(read))
    if dry_run:
        show_plan(task, workers, as_json)
        return
    folder = results if results is not None else Path(f"{read.name}-sensitivity")
    path = run_task(task, folder, Where(resume, workers, scheduler, timeout, strict))
    found = indices_of(path, read, wanted, level, resamples)
    picture = plot if plot is not None else folder / "sensitivity.png"
    save_bars(found, picture, f"{read.name}: Sobol indices")
    if as_json:
        record = {
            "study": read.name,
            "results": str(path),
            "plot": str(picture),
            "level": level,
            "responses": [f.record() for f in found],
        }
        click.echo(json.dumps(record, indent=1, allow_nan=False))
    else:
        click.echo(indices_table(found, level), nl=False)
        click.echo(f"results: {path}\nbars: {picture}")
