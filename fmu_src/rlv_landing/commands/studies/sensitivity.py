"""`rlv-landing sensitivity`: Sobol indices of a study's responses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ...errors import first_of
from ...text.durable import writing
from ..number_types import NumberRange, WholeNumber
from ..options import HELP_NAMES, PICTURES, check_writable
from ..printing import print_json
from .study_run import RunOptions, run_options, run_task, warn_of_joint
from .sweep import show_plan


@click.command(context_settings=HELP_NAMES)
@click.argument("study", metavar="STUDY.toml", type=click.Path(path_type=Path))
@click.argument("responses", metavar="[RESPONSE...]", nargs=-1)
@run_options
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    metavar="FILE.png|svg|pdf",
    help="Bars [default: sensitivity.png in the results].",
)
@click.option(
    "--level",
    default=0.95,
    show_default=True,
    type=NumberRange(0.5, 0.999),
    help="Confidence of the intervals.",
)
@click.option(
    "--resamples",
    default=999,
    show_default=True,
    type=WholeNumber(99, 100_000),
    help="Bootstrap resamples.",
)
def sensitivity(
    study: Path,
    responses: tuple[str, ...],
    plot: Path | None,
    level: float,
    resamples: int,
    **options: Any,
) -> None:
    """Compute Sobol indices of a study's responses: each factor's part of the variance.

    The first-order index counts the factor alone, the total index with all others. The study is
    one of `rlv-landing sweep`, with two [[factor]] or more and samples = a power of 2. It takes
    samples * (factors + 2) landings in each mode, on all cores or a Dask cluster, and --resume
    continues. RESPONSE is one of the study's; without one, all that are of the whole vehicle
    rather than of one leg are taken. Intervals are bootstrapped.

    \b
    rlv-landing sensitivity study.toml --dry-run
    rlv-landing sensitivity study.toml margin.stability_min legs.main_strut.force.min
    rlv-landing sensitivity study.toml --resume --level 0.9 --json

    The folder (default: the study's name and -sensitivity) has results.parquet and the bars. More
    responses of a study that is done need no further landings: name them and --resume. Exit codes
    are those of sweep.
    """
    from ...figures.sensitivity_figure import save_bars
    from ...studies.study_effort import check_indices
    from ...studies.sweep.sensitivity import (
        indices_of,
        left_out,
        numeric_responses,
        sobol_design,
    )
    from ...studies.sweep.study import read_study
    from ...studies.sweep.sweep_row import Task
    from ...tables.sweep_tables import indices_table

    run = RunOptions(**options)
    check_writable(plot, PICTURES, force=True)
    read = read_study(study)
    wanted = numeric_responses(read, responses)
    task = Task(read, sobol_design(read))
    warn_of_joint(task)
    if run.dry_run:
        show_plan(task, run)
        return
    check_indices(read.samples, len(read.factors), len(wanted), resamples)
    folder = run.results or Path(f"{read.name}-sensitivity")
    path = run_task(task, folder, run)
    found = indices_of(path, read, wanted, level, resamples)
    picture = plot or folder / "sensitivity.png"
    with writing(picture):
        save_bars(found, picture, f"{read.name}: Sobol indices")
    if run.as_json:
        print_json(
            {
                "study": read.name,
                "results": str(path),
                "plot": str(picture),
                "level": level,
                "responses": [f.record() for f in found],
            }
        )
    else:
        click.echo(indices_table(found, level), nl=False)
        if left := left_out(read, wanted):
            click.echo(
                f"without indices of {len(left)} more ({first_of(left)}): name them, and --resume"
            )
        click.echo(f"results: {path}\nbars: {picture}")
