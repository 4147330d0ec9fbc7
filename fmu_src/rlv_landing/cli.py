"""The command line `rlv-landing`. Commands of the ROS 2 bridge join by the entry-point group `rlv_landing.commands`."""

from __future__ import annotations

import json
import sys
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import click

from . import __version__
from .commands.audit import audit
from .commands.envelope import envelope
from .commands.identify import identify
from .commands.options import check_writable, parameter_options
from .commands.sensitivity import sensitivity
from .commands.sweep import sweep
from .commands.validate import validate
from .errors import LandingError, nearest
from .landing import DEFAULT_RTOL, METHODS, Landing

BAD_INPUT = 2
INTERRUPTED = 130


class Commands(click.Group):
    """Our commands and those that other packages add, loaded when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted({*super().list_commands(ctx), *(e.name for e in entry_points(group="rlv_landing.commands"))})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        own = super().get_command(ctx, cmd_name)
        if own is not None:
            return own
        for entry in entry_points(group="rlv_landing.commands", name=cmd_name):
            command: click.Command = entry.load()
            return command
        return None

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        if args and self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            raise LandingError(
                f"there is no command {args[0]!r}{nearest(args[0], self.list_commands(ctx))}; `rlv-landing --help` lists them"
            )
        return super().resolve_command(ctx, args)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="rlv-landing")
def cli() -> None:
    """Touchdown of a vertical-landing rocket stage on four legs.

    \b
    rlv-landing simulate --mode 1-2-1 --compare        land in this process; compare with the paper
    rlv-landing parameters --toml > mine.toml          a parameter file to edit
    rlv-landing validate --html report.html            every printed number and figure beside ours
    rlv-landing identify --work identification         estimate what the paper does not print, or your vehicle's own
    rlv-landing audit                                  energy, mass, momentum, rest, convergence
    rlv-landing sweep study.toml                       many landings: factors in, a row of responses each
    rlv-landing sensitivity study.toml                 which factors the responses depend on: Sobol indices
    rlv-landing envelope examples/envelope.toml        where landings turn from stable to lost, and what is critical there
    rlv-landing node --mode 2-2                        the ROS 2 node: steps the FMU, publishes, records
    rlv-landing log info logs/NAME                     what a log holds
    rlv-landing view logs/NAME                         a log, or the live topics, in a browser
    rlv-landing animate logs/NAME landing.mp4          a log, or a landing, as a moving picture
    rlv-landing replay logs/NAME                       publish it again

    SI units and radians throughout; a value may carry its unit: --set drop.tilt="-2 deg".
    Exit codes: 0 done, 2 bad input, 1 failed, 130 interrupted.
    """


@cli.command()
@parameter_options
@click.option(
    "--input", "inputs", metavar="NAME=VALUE", multiple=True, help="A constant input: external.force_x=500, ground.tilt='2 deg'. Repeat."
)
@click.option("--until", default=1.0, show_default=True, metavar="S", help="End time [s].")
@click.option("--every", default=1e-3, show_default=True, metavar="S", help="Time between samples [s].")
@click.option("--rtol", default=DEFAULT_RTOL, show_default=True, help="Relative tolerance of the integrator.")
@click.option(
    "--method", type=click.Choice(list(METHODS)), default="exponential", show_default=True, help="Integrator; dormand-prince: the paper's."
)
@click.option("--output", metavar="FILE.csv", type=click.Path(path_type=Path), help="Write every output at every sample (SI units).")
@click.option("--plot", metavar="FILE.png", type=click.Path(path_type=Path), help="Draw forces, strokes and acceleration.")
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

    from .choices import choose_parameters, parse_pairs
    from .parameters import PARAMETER_QUANTITIES
    from .quantities import INPUT_QUANTITIES

    for path, ending in ((output, ".csv"), (plot, ".png")):
        check_writable(path, ending, force)
    parameters = choose_parameters(preset, file, mode, parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter"))
    landing = Landing(parameters, rtol=rtol, method=method)
    landing.set_inputs(parse_pairs(inputs, {q.name: q for q in INPUT_QUANTITIES}, "input"))
    with tqdm(
        total=until, unit="s", desc="landing", disable=not sys.stderr.isatty(), bar_format="{l_bar}{bar}| {n:.2f}/{total:.2f} s"
    ) as bar:
        history = landing.run(until, every, lambda t: bar.update(t - bar.n))
    title = f"{parameters.drop.mode} landing"
    if as_json:
        from .summary import summarise

        click.echo(json.dumps(summarise(history), indent=1))
    else:
        from .tables import summary_table

        click.echo(summary_table(history, title), nl=False)
    if comparison:
        from .tables import comparison_table

        click.echo(comparison_table(history, parameters.drop.mode), nl=False)
    try:
        if output is not None:
            history.to_csv(output)
        if plot is not None:
            from .plots import save_overview

            save_overview(history, plot, title)
    except OSError as e:
        raise LandingError(f"{e.filename or output or plot} cannot be written: {e.strerror or e}") from None


@cli.command()
@parameter_options
@click.option("--toml", is_flag=True, help="As a TOML file that --parameters takes back.")
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
@click.option("--inputs", "what", flag_value="inputs", help="List the inputs instead.")
@click.option("--outputs", "what", flag_value="outputs", help="List the outputs instead.")
def parameters(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...], toml: bool, as_json: bool, what: str | None
) -> None:
    """Print the table of parameters: value, unit, bounds, where it comes from (paper, derived, closure, identified), meaning.

    \b
    rlv-landing parameters --preset yue2022-table2 --mode 1-2-1
    rlv-landing parameters --toml > mine.toml
    """
    from .choices import choose_parameters, parse_pairs
    from .parameters import PARAMETER_QUANTITIES
    from .presets import to_toml
    from .quantities import INPUT_QUANTITIES, OUTPUT_QUANTITIES
    from .tables import parameter_records, parameter_table, quantity_table

    if what is not None:
        quantities = INPUT_QUANTITIES if what == "inputs" else OUTPUT_QUANTITIES
        if as_json:
            click.echo(json.dumps([{"name": q.name, "unit": q.unit, "meaning": q.meaning} for q in quantities], indent=1))
        else:
            click.echo(quantity_table(what, quantities), nl=False)
        return
    chosen = choose_parameters(preset, file, mode, parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter"))
    if toml:
        click.echo(to_toml(chosen), nl=False)
    elif as_json:
        click.echo(json.dumps(parameter_records(chosen), indent=1))
    else:
        click.echo(parameter_table(chosen), nl=False)


cli.add_command(validate)
cli.add_command(audit)
cli.add_command(identify)
cli.add_command(sweep)
cli.add_command(sensitivity)
cli.add_command(envelope)


def main() -> None:
    """Run the command line; errors of the user's are one line on standard error."""
    try:
        status = cli.main(standalone_mode=False)
    except LandingError as e:
        click.echo(f"error: {e}", err=True)
        status = BAD_INPUT
    except click.ClickException as e:
        click.echo(f"error: {e.format_message()}", err=True)
        status = BAD_INPUT
    except (click.Abort, KeyboardInterrupt):
        click.echo("interrupted", err=True)
        status = INTERRUPTED
    except BrokenPipeError:
        status = 0
    sys.exit(status if isinstance(status, int) else 0)
