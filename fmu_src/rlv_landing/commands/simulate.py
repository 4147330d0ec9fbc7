"""`rlv-landing simulate`: one landing in this process."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..landing import DEFAULT_RTOL, METHODS, Landing
from ..text.durable import writing
from .number_types import Number
from .options import HELP_NAMES, check_writable, chosen_parameters, parameter_options
from .printing import json_text, print_warning

if TYPE_CHECKING:
    from ..history import History


@click.command(context_settings=HELP_NAMES)
@parameter_options
@click.option(
    "--input",
    "inputs",
    metavar="NAME=VALUE",
    multiple=True,
    help="A constant input: external.force_x=500, ground.tilt='2 deg'. Repeat.",
)
@click.option(
    "--until", type=Number("s"), default=1.0, show_default=True, metavar="S", help="End time [s]."
)
@click.option(
    "--every",
    type=Number("s"),
    default=1e-3,
    show_default=True,
    metavar="S",
    help="Time between samples [s].",
)
@click.option(
    "--rtol",
    type=Number(),
    default=DEFAULT_RTOL,
    show_default=True,
    help="Relative tolerance of the integrator.",
)
@click.option(
    "--method",
    type=click.Choice(list(METHODS)),
    default="exponential",
    show_default=True,
    help="Integrator; dormand-prince: the paper's.",
)
@click.option(
    "--output",
    metavar="FILE.csv",
    type=click.Path(path_type=Path),
    help="Write every output at every sample (SI units).",
)
@click.option(
    "--plot",
    metavar="FILE.png",
    type=click.Path(path_type=Path),
    help="Draw forces, strokes and acceleration.",
)
@click.option("--compare", "comparison", is_flag=True, help="Print our numbers beside the paper's.")
@click.option("--json", "as_json", is_flag=True, help="Print outcome and peaks as JSON.")
@click.option("--force", is_flag=True, help="Overwrite files that exist.")
def simulate(output: Path | None, plot: Path | None, *, force: bool, **options: Any) -> None:
    """Land in this process and print outcome and peaks.

    \b
    rlv-landing simulate --mode 1-2-1 --compare
    rlv-landing simulate --preset yue2022-table2 --plot landing.png
    rlv-landing simulate --set ground.friction=0.4 --set ground.slope="3 deg" --output landing.csv
    """
    from ..audit.transverse import warning_of

    for path, ending in ((output, ".csv"), (plot, ".png")):
        check_writable(path, ending, force=force)
    landing = _landing(options)
    mode = landing.parameters.drop.mode
    history = _run(landing, options["until"], options["every"])
    print_warning(warning_of(history))
    printed = _printed(history, mode, options)
    # the files first: they are there even where the reader of standard output has gone
    if output is not None:
        with writing(output):
            history.to_csv(output)
    if plot is not None:
        from ..figures.plots import save_overview

        with writing(plot):
            save_overview(history, plot, f"{mode} landing")
    click.echo(printed, nl=False)


def _printed(history: History, mode: str, options: dict[str, Any]) -> str:
    """The summary as JSON or table, and the comparison with the paper where it is wanted.

    Raises:
        LandingError: The landing cannot be compared with the paper's.
    """
    from ..summary import summarise
    from ..tables.landing import comparison_table, summary_table

    printed = (
        json_text(summarise(history)) + "\n"
        if options["as_json"]
        else summary_table(history, f"{mode} landing")
    )
    return printed + (comparison_table(history, mode) if options["comparison"] else "")


def _landing(options: dict[str, Any]) -> Landing:
    """The landing that the options choose, at its start."""
    from ..choices import parse_pairs
    from ..quantities import INPUT_QUANTITIES

    parameters = chosen_parameters(
        options["preset"], options["file"], options["mode"], options["pairs"]
    )
    quantities = {q.name: q for q in INPUT_QUANTITIES}
    inputs = parse_pairs(options["inputs"], quantities, "input")
    return Landing(parameters, rtol=options["rtol"], method=options["method"], inputs=inputs)


def _run(landing: Landing, until: float, every: float) -> History:
    """Run with progress on a terminal."""
    from tqdm import tqdm

    with tqdm(
        total=until,
        unit="s",
        desc="landing",
        disable=not sys.stderr.isatty(),
        bar_format="{l_bar}{bar}| {n:.2f}/{total:.2f} s",
    ) as bar:
        return landing.run(until, every, lambda t: bar.update(t - bar.n))
