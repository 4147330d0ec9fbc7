"""`rlv-landing simulate`: one landing in this process."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from ..errors import LandingError
from ..landing import DEFAULT_RTOL, METHODS, Landing
from .options import check_writable, parameter_options


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@parameter_options
@click.option(
    "--input",
    "inputs",
    metavar="NAME=VALUE",
    multiple=True,
    help="A constant input: external.force_x=500, ground.tilt='2 deg'. Repeat.",
)
@click.option("--until", default=1.0, show_default=True, metavar="S", help="End time [s].")
@click.option(
    "--every", default=1e-3, show_default=True, metavar="S", help="Time between samples [s]."
)
@click.option(
    "--rtol", default=DEFAULT_RTOL, show_default=True, help="Relative tolerance of the integrator."
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
def simulate(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...], inputs: tuple[str, ...], until: float, every: float,
    rtol: float, method: str, output: Path | None, plot: Path | None, comparison: bool, as_json: bool, force: bool,
) -> None:  # fmt: skip
    """Land in this process and print outcome and peaks.

    \b
    rlv-landing simulate --mode 1-2-1 --compare
    rlv-landing simulate --preset yue2022-table2 --plot landing.png
    rlv-landing simulate --set ground.friction=0.4 --set ground.slope="3 deg" --output landing.csv
    """
    from tqdm import tqdm

    from ..choices import choose_parameters, parse_pairs
    from ..parameters import PARAMETER_QUANTITIES
    from ..quantities import INPUT_QUANTITIES

    for path, ending in ((output, ".csv"), (plot, ".png")):
        check_writable(path, ending, force)
    parameters = choose_parameters(
        preset, file, mode, parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter")
    )
    driven = parse_pairs(inputs, {q.name: q for q in INPUT_QUANTITIES}, "input")
    landing = Landing(parameters, rtol=rtol, method=method, inputs=driven)
    with tqdm(
        total=until,
        unit="s",
        desc="landing",
        disable=not sys.stderr.isatty(),
        bar_format="{l_bar}{bar}| {n:.2f}/{total:.2f} s",
    ) as bar:
        history = landing.run(until, every, lambda t: bar.update(t - bar.n))
    title = f"{parameters.drop.mode} landing"
    if as_json:
        from ..summary import summarise

        click.echo(json.dumps(summarise(history), indent=1))
    else:
        from ..tables.landing import summary_table

        click.echo(summary_table(history, title), nl=False)
    if comparison:
        from ..tables.landing import comparison_table

        click.echo(comparison_table(history, parameters.drop.mode), nl=False)
    try:
        if output is not None:
            history.to_csv(output)
        if plot is not None:
            from ..figures.plots import save_overview

            save_overview(history, plot, title)
    except OSError as e:
        raise LandingError(
            f"{e.filename or output or plot} cannot be written: {e.strerror or e}"
        ) from None
