"""The commands `rlv-landing fmu`: build, info, simulate. They need no ROS 2."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rlv_landing.choices import parse_pairs
from rlv_landing.commands.number_types import Number
from rlv_landing.commands.one_landing import (
    draw_landing,
    landing_options,
    landing_progress,
    landing_text,
)
from rlv_landing.commands.options import (
    HELP_NAMES,
    PICTURES,
    Group,
    check_writable,
    chosen_parameters,
    force_option,
    json_option,
    parameter_options,
    set_option,
)
from rlv_landing.commands.printing import json_text, print_warning
from rlv_landing.errors import LandingError
from rlv_landing.text.files import shown_name

if TYPE_CHECKING:
    from rlv_landing.history import History
    from rlv_landing.parameters import Parameters
    from rlv_landing.quantities import Quantity

    from ..fmu.input_table import Setting

FILE = click.argument("file", type=click.Path(path_type=Path))
# what the build imports, of the extra `fmu`
NEEDED = ("pythonfmu", "fmpy", "latex2mathml")


@click.group(cls=Group, context_settings=HELP_NAMES)
def fmu() -> None:
    """Build the FMU of your own vehicle, look into an FMU, land one. Needs no ROS 2.

    \b
    rlv-landing fmu build --parameters mine.toml --name MyStage -o MyStage.fmu
    rlv-landing fmu info MyStage.fmu
    rlv-landing fmu simulate MyStage.fmu --input gusts.csv --plot landing.png
    """


@fmu.command(context_settings=HELP_NAMES)
@parameter_options
@click.option(
    "--name",
    metavar="NAME",
    default="RlvLanding",
    show_default=True,
    help="Name of the model and of its binary: letters, digits and underscores.",
)
@click.option(
    "--flat-names",
    is_flag=True,
    help="Variables without dots and brackets: leg1_main_strut_force. For hosts that make buses "
    "or arrays of them (Simulink, Hopsan).",
)
@click.option(
    "--fmi", metavar="VERSION", default="2", show_default=True, help="Version of FMI, 2 or 3."
)
@click.option(
    "--pure", is_flag=True, help="Leave the compiled core out: the same digits, ten times as slow."
)
@click.option(
    "--platforms",
    type=click.Choice(["own", "all"]),
    default="own",
    show_default=True,
    help="Binaries for this machine's platform, or for all that Zig compiles for: Linux on x86-64 "
    "and Arm, Windows, macOS.",
)
@click.option(
    "-o",
    "--output",
    metavar="FILE.fmu",
    type=click.Path(path_type=Path),
    help="The FMU [default: NAME.fmu].",
)
@force_option("Overwrite a file that exists.")
def build(
    *,
    output: Path | None,
    force: bool,
    preset: str | None,
    file: str | None,
    mode: str | None,
    pairs: tuple[str, ...],
    **wishes: Any,
) -> None:
    """Build an FMU of your vehicle: its start values, description, drawing and documentation.

    FMPy validates it and lands it once, and the landing is compared with that of this package,
    before the file gets its name. Equal vehicles, names and versions give equal bytes; every other
    FMU has another GUID, and computes by itself beside the others.

    \b
    Examples:
      rlv-landing parameters --toml > mine.toml     (edit it)
      rlv-landing fmu build --parameters mine.toml --name MyStage
      rlv-landing fmu build --preset yue2022-tests --mode 1-2-1 -o tests.fmu
      rlv-landing fmu build --set vehicle.mass="190 kg" --flat-names -o for_simulink.fmu

    Exit codes: 0 built, 1 the build failed, 2 bad input or a file that cannot be written,
    130 interrupted.
    """
    require_build()
    from fmu_build.wanted import Wanted

    parameters = chosen_parameters(preset, file, mode, pairs)
    wishes["fmi"] = wishes["fmi"].removesuffix(".0")
    wanted = Wanted(parameters, _source(preset, file, pairs), **wishes)
    target = output or Path(f"{wanted.name}.fmu")
    check_writable(target, ".fmu", force=force)
    from fmu_build.build import build as build_fmu

    click.echo("\n".join(build_fmu(target, wanted)))


def build_default(file: Path) -> None:
    """Build the FMU of the default vehicle, with the compiled core if there is one.

    Args:
        file: The FMU; its folder is made.

    Raises:
        LandingError: What the build needs is missing, or the file cannot be written.
    """
    require_build()
    from fmu_build.build import build as build_fmu
    from fmu_build.wanted import Wanted
    from rlv_landing.core import COMPILED

    build_fmu(file, Wanted(pure=not COMPILED))


def require_build() -> None:
    """Check that what the build needs is installed.

    Raises:
        LandingError: It is not.
    """
    for module in NEEDED:
        if find_spec(module) is None:
            raise LandingError(
                f"building an FMU needs {module}, which is missing; "
                'install it with pip install "rlv-landing[fmu]"'
            )


def _source(preset: str | None, file: str | None, pairs: tuple[str, ...]) -> str:
    """Where the vehicle comes from, for the FMU's description."""
    name = shown_name(Path(file)) if file is not None else preset or ""
    return ", ".join([*([name] if name else []), *pairs])


@fmu.command(context_settings=HELP_NAMES)
@FILE
@json_option("Print as JSON; starts in the unit given.")
def info(file: Path, *, as_json: bool) -> None:
    """Show what is in an FMU: model, platforms, GUID, and every variable with unit and start.

    Of ours also the vehicle and its touchdown, and whether the core is compiled. FILE may be any
    FMU that FMPy reads.

    \b
    Examples:
      rlv-landing fmu info mine.fmu
      rlv-landing fmu info other.fmu --json

    Exit codes: 0 shown, 2 no such file, or no FMU.
    """
    from ..fmu.info import fmu_info

    found = fmu_info(file)
    click.echo(json_text(found.as_dict()) if as_json else found.text(), nl=as_json)


@fmu.command(context_settings=HELP_NAMES)
@FILE
@click.option(
    "--input",
    "inputs",
    metavar="FILE.csv|NAME=VALUE",
    multiple=True,
    help="Inputs over time: columns time [s], external.force_x [kN], ...; linear between rows. "
    "Or a constant one; repeat.",
)
@set_option()
@click.option(
    "--until", type=Number("s"), metavar="S", help="End time [s] [default: the FMU's own]."
)
@landing_options("FILE.csv|parquet")
def simulate(
    file: Path,
    *,
    output: Path | None,
    plot: Path | None,
    as_json: bool,
    force: bool,
    **options: Any,
) -> None:
    """Land one of our FMUs once through FMPy; print outcome and peaks.

    The result is that of `rlv-landing simulate` with the same parameters and inputs. An FMU of FMI
    3.0 gets linear loads in steps of at most 1 ms.

    \b
    Examples:
      rlv-landing fmu simulate mine.fmu --plot landing.png
      rlv-landing fmu simulate mine.fmu --input gusts.csv --output landing.csv
      rlv-landing fmu simulate mine.fmu --set drop.tilt="-2 deg" --input external.force_x="2 kN"

    Exit codes: 0 landed, 1 a file could not be written, 2 bad input or the FMU refuses,
    130 interrupted.
    """
    from rlv_landing.audit.transverse import warning_of
    from rlv_landing.tables.history_file import ENDINGS, write_history

    check_writable(output, ENDINGS, force=force)
    check_writable(plot, PICTURES, force=force)
    history, name = _landed(file, options)
    print_warning(warning_of(history))
    assert history.parameters is not None
    title = f"{name}: {history.parameters.drop.mode} landing"
    printed = landing_text(history, title, as_json=as_json)
    if output is not None:
        write_history(history, output)
    draw_landing(history, plot, title)
    click.echo(printed, nl=False)


def _landed(file: Path, options: dict[str, Any]) -> tuple[History, str]:
    """The landing that the options choose, with progress on a terminal; the model's name."""
    from rlv_landing.parameters import PARAMETER_QUANTITIES

    from ..fmu.description import interface_in, read_description, vehicle_of
    from ..fmu.input_table import sloped
    from ..fmu.landing import land_fmu

    description = read_description(file)
    values = parse_pairs(options["pairs"], PARAMETER_QUANTITIES, "parameter")
    parameters: Parameters = vehicle_of(description, values)
    inputs = _inputs(options["inputs"], interface_in(description).inputs_by_name)
    if description.fmiVersion == "3.0" and (names := sloped(inputs)):
        print_warning(
            f"FMI 3.0 has no rates of inputs; {', '.join(names)} is set in steps of at most 1 ms, "
            "at the mean of each; an FMU of FMI 2.0 gets the slope"
        )
    until = options["until"]
    if until is None:
        until = _own_end(description, file)
    with landing_progress(until) as show_progress:
        history = land_fmu(file, parameters, inputs, until, options["every"], show_progress)
    return history, description.modelName


def _own_end(description: Any, file: Path) -> float:
    """The end of the FMU's default experiment [s].

    Raises:
        LandingError: The description has none.
    """
    end = description.defaultExperiment and description.defaultExperiment.stopTime
    if end is None:
        raise LandingError(f"{file} has no end of its own; give one, for example --until 1")
    return float(end)


def _inputs(given: tuple[str, ...], inputs: dict[str, Quantity]) -> list[Setting]:
    """What is set: a table, and constant inputs beside it.

    Args:
        given: What is given of both.
        inputs: The inputs that the FMU has, by name.

    Raises:
        LandingError: There are two tables, an input is in both, or one of them is wrong.
    """
    from ..fmu.input_table import constants, read_inputs

    files = [text for text in given if "=" not in text]
    if len(files) > 1:
        raise LandingError(f"give one table of inputs, not {len(files)}; join them")
    values = parse_pairs([text for text in given if "=" in text], inputs, "input")
    if not files:
        return constants(values) if values else []
    table = read_inputs(Path(files[0]), inputs)
    for name in values:
        if name in table.columns:
            raise LandingError(f"{name} is given as a constant and by {files[0]}; leave one")
    return [*(constants(values) if values else []), *table.settings()]
