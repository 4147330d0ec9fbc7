"""Options that several commands share, and what they come to."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..errors import LandingError

if TYPE_CHECKING:
    from ..parameters import Parameters

F = TypeVar("F", bound=Callable[..., Any])


def parameter_options(command: F) -> F:
    """Options that choose vehicle, ground and drop."""
    options = (
        click.option("--preset", metavar="NAME", help="Named parameters [default: yue2022-figures]; also yue2022-tests, yue2022-table2."),
        click.option("--parameters", "file", metavar="FILE.toml", help="Parameters from a TOML file instead."),
        click.option("--mode", metavar="MODE", help="Landing mode: 2-2 or 1-2-1 (legs that touch first, second, third)."),
        click.option(
            "--set", "pairs", metavar="NAME=VALUE", multiple=True, help='One parameter, SI or with a unit: drop.tilt="-2 deg". Repeat.'
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command


def choose(preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...]) -> tuple[Parameters, tuple[str, ...], str]:
    """For a command that runs both modes unless one is named: the parameters, the modes, and what to call the parameters."""
    from ..choices import choose_parameters, parse_pairs
    from ..parameters import PARAMETER_QUANTITIES
    from ..presets import DEFAULT_PRESET
    from ..quantities import MODES

    values = parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter")
    parameters = choose_parameters(preset, file, mode, values)
    wanted = mode or values.get("drop.mode")
    name = Path(file).name if file is not None else preset or DEFAULT_PRESET
    label = name + "".join(f", {pair}" for pair in pairs)
    return parameters, (parameters.drop.mode,) if wanted else tuple(MODES), label


def check_writable(path: Path | None, ending: str, force: bool) -> None:
    """Raises LandingError unless a file `path` with this ending can be made; one that exists needs `force`."""
    if path is None:
        return
    if path.suffix != ending:
        raise LandingError(f"{path} must end in {ending}")
    if path.exists() and not force:
        raise LandingError(f"{path} exists; --force overwrites it")
    if not path.resolve().parent.is_dir():
        raise LandingError(f"there is no folder {path.parent} to write {path.name} to")
