"""Options and settings that several commands share, and the parameters that they choose."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import click

from ..errors import LandingError, nearest, reason_of
from .number_types import Number, WholeNumber

if TYPE_CHECKING:
    from ..parameters import Parameters

F = TypeVar("F", bound=Callable[..., Any])
# command groups and commands answer to both
HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"]}
# the same, for commands whose help has long examples
WIDE: dict[str, Any] = {**HELP_NAMES, "max_content_width": 120}
MOST_WORKERS = 1024
# what figures are written as
PICTURES = (".png", ".svg", ".pdf")


class Group(click.Group):
    """A group of commands that names the nearest where there is no such command.

    Without a command it prints its help, whichever version of click is installed.
    """

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """The arguments that are left; without any, the help and the end."""
        if not args and self.no_args_is_help and not ctx.resilient_parsing:
            click.echo(ctx.get_help())
            ctx.exit()
        return super().parse_args(ctx, args)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """The command that the arguments name, as click expects it.

        Raises:
            LandingError: There is no such command.
        """
        if args and self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            group = f"rlv-landing {self.name}" if ctx.parent else "rlv-landing"
            raise LandingError(
                f"there is no command {args[0]!r}{nearest(args[0], self.list_commands(ctx))}; "
                f"`{group} --help` lists them"
            )
        return super().resolve_command(ctx, args)


class Option(Protocol):
    """Adds an option to a command."""

    def __call__(self, command: F, /) -> F:
        """The command with the option."""


def json_option(help_text: str = "Print as JSON.") -> Option:
    """`--json`, which is the parameter `as_json`."""
    return click.option("--json", "as_json", is_flag=True, help=help_text)


def force_option(help_text: str = "Overwrite files that exist.") -> Option:
    """`--force`, for what `check_writable` refuses."""
    return click.option("--force", is_flag=True, help=help_text)


def plot_option() -> Option:
    """`--plot`: the overview of a landing."""
    return click.option(
        "--plot",
        metavar="FILE.png|svg|pdf",
        type=click.Path(path_type=Path),
        help="Draw forces, strokes and acceleration.",
    )


def every_option(default: float) -> Option:
    """Declare `--every`, the time between samples [s]."""
    return click.option(
        "--every",
        type=Number("s"),
        default=default,
        show_default=True,
        metavar="S",
        help="Time between samples [s].",
    )


def start_option() -> Option:
    """`--start` of the part of a landing that is drawn or written [s]."""
    return click.option(
        "--start", type=Number("s"), metavar="SECONDS", help="From this simulation time on."
    )


def set_option() -> Option:
    """`--set`, which is the parameter `pairs`."""
    return click.option(
        "--set",
        "pairs",
        metavar="NAME=VALUE",
        multiple=True,
        help='One parameter, SI or with a unit: drop.tilt="-2 deg". Repeat.',
    )


def input_option() -> Option:
    """`--input` of constant inputs, which is the parameter `inputs`."""
    return click.option(
        "--input",
        "inputs",
        metavar="NAME=VALUE",
        multiple=True,
        help="A constant input: external.force_x=500, ground.tilt='2 deg'. Repeat.",
    )


def workers_option(what: str = "Threads") -> Option:
    """`--workers`, None where all cores are meant; `what` is what is counted."""
    return click.option(
        "--workers", type=WholeNumber(1, MOST_WORKERS), help=f"{what} [default: all cores]."
    )


def parameter_options(command: F) -> F:
    """Add the options that choose vehicle, ground and drop: `preset, file, mode, pairs`."""
    options = (
        click.option(
            "--preset",
            metavar="NAME",
            help="Named parameters [default: yue2022-figures]; also yue2022-tests, yue2022-table2.",
        ),
        click.option(
            "--parameters", "file", metavar="FILE.toml", help="Parameters from a TOML file instead."
        ),
        click.option(
            "--mode",
            metavar="MODE",
            help="Landing mode: 2-2 or 1-2-1 (legs that touch first, second, third), or space.",
        ),
        set_option(),
    )
    return add_options(command, options)


def add_options(command: F, options: tuple[Option, ...]) -> F:
    """Add options to a command in the order in which its help lists them."""
    for option in reversed(options):
        command = option(command)
    return command


def chosen_parameters(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...]
) -> Parameters:
    """The parameters that the options of `parameter_options` choose, for one landing mode.

    Raises:
        LandingError: An option names what does not exist or cannot be.
    """
    from ..choices import choose_parameters, parse_pairs
    from ..parameters import PARAMETER_QUANTITIES

    values = parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter")
    return choose_parameters(preset, file, mode, values)


def choose(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...]
) -> tuple[Parameters, tuple[str, ...], str]:
    """The parameters, modes and label for a command that runs both modes unless one is named.

    A vehicle of landings in space has that mode alone.

    Raises:
        LandingError: An option names what does not exist or cannot be.
    """
    from ..choices import choose_parameters, parse_pairs
    from ..parameters import PARAMETER_QUANTITIES
    from ..presets import DEFAULT_PRESET
    from ..quantities import MODES, SPACE

    values = parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter")
    parameters = choose_parameters(preset, file, mode, values)
    wanted = mode or values.get("drop.mode") or parameters.drop.mode == SPACE
    name = Path(file).name if file is not None else preset or DEFAULT_PRESET
    label = name + "".join(f", {pair}" for pair in pairs)
    return parameters, (parameters.drop.mode,) if wanted else tuple(MODES), label


def choose_symmetric(
    preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...]
) -> tuple[Parameters, tuple[str, ...], str]:
    """What `choose` gives, for a command that knows symmetric landings only.

    Raises:
        LandingError: An option names what does not exist or cannot be, or the landing is in space.
    """
    from ..quantities import groups_of

    parameters, modes, label = choose(preset, file, mode, pairs)
    for each in modes:
        groups_of(each)
    return parameters, modes, label


def check_writable(path: Path | None, ending: str | tuple[str, ...], *, force: bool) -> None:
    """Check that a file can be made at `path`; None is not checked.

    Args:
        path: The file.
        ending: Its ending, or those allowed.
        force: Whether it may exist.

    Raises:
        LandingError: The ending is another, the folder is missing, there is something else than a
            file, or the file exists and `force` is not given.
    """
    if path is None:
        return
    endings = (ending,) if isinstance(ending, str) else ending
    if path.suffix not in endings:
        raise LandingError(f"{path} must end in {' or '.join(endings)}")
    try:
        exists, folder = os.path.lexists(path), path.resolve().parent.is_dir()
        file = not path.exists() or path.is_file()
    except OSError as e:
        raise LandingError(f"{path} cannot be written: {reason_of(e)}") from None
    if not file:
        raise LandingError(f"{path} is there and is no file; name another")
    if exists and not force:
        raise LandingError(f"{path} exists; --force overwrites it")
    if not folder:
        raise LandingError(f"there is no folder {path.parent} to write {path.name} to")
