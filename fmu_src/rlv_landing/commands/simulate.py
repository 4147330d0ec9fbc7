"""`rlv-landing simulate`: one landing in this process."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..errors import LandingError
from ..landing import DEFAULT_RTOL, METHODS, Landing
from .number_types import Number
from .one_landing import draw_landing, landing_options, landing_progress, landing_text
from .options import (
    HELP_NAMES,
    PICTURES,
    check_writable,
    chosen_parameters,
    input_option,
    parameter_options,
)
from .printing import print_warning


@click.command(context_settings=HELP_NAMES)
@parameter_options
@input_option()
@click.option(
    "--until", type=Number("s"), default=1.0, show_default=True, metavar="S", help="End time [s]."
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
@click.option("--compare", "comparison", is_flag=True, help="Print our numbers beside the paper's.")
@landing_options("FILE.csv|parquet")
def simulate(output: Path | None, plot: Path | None, *, force: bool, **options: Any) -> None:
    """Land in this process and print outcome and peaks.

    \b
    rlv-landing simulate --mode 1-2-1 --compare
    rlv-landing simulate --preset yue2022-table2 --plot landing.png
    rlv-landing simulate --set ground.friction=0.4 --set ground.slope="3 deg" --output landing.csv
    """
    from ..audit.transverse import warning_of
    from ..studies.whole_landing import whole_landing
    from ..tables.history_file import ENDINGS, write_history

    check_writable(output, ENDINGS, force=force)
    check_writable(plot, PICTURES, force=force)
    landing = _landing(options)
    if options["comparison"]:
        _check_comparison(landing, as_json=options["as_json"])
    mode = landing.parameters.drop.mode
    with landing_progress(options["until"]) as show_progress:
        history = whole_landing(
            landing, options["until"], options["every"], decided=False, progress=show_progress
        )
    print_warning(warning_of(history))
    title = f"{mode} landing"
    printed = landing_text(history, title, as_json=options["as_json"])
    if options["comparison"]:
        from ..tables.landing import comparison_table

        printed += comparison_table(history, mode)
    # the files first: they are there even where the reader of standard output has gone
    if output is not None:
        write_history(history, output)
    draw_landing(history, plot, title)
    click.echo(printed, nl=False)


def _check_comparison(landing: Landing, *, as_json: bool) -> None:
    """Check that the landing has the paper's numbers, and that they can be printed."""
    from ..quantities import groups_of

    if as_json:
        raise LandingError(
            "--compare prints a table, and --json has none; leave one out, or take "
            "`rlv-landing validate --json`, which has the paper's numbers"
        )
    groups_of(landing.parameters.drop.mode)


def _landing(options: dict[str, Any]) -> Landing:
    """The landing that the options choose, at its start."""
    from ..choices import parse_pairs

    parameters = chosen_parameters(
        options["preset"], options["file"], options["mode"], options["pairs"]
    )
    interface = parameters.interface
    inputs = parse_pairs(options["inputs"], interface.inputs_by_name, "input")
    return Landing(parameters, rtol=options["rtol"], method=options["method"], inputs=inputs)
