"""`rlv-landing new` and `draw`: the files and the drawing of a vehicle of one's own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..errors import LandingError, one_line
from ..text.durable import writing
from ..text.new_folder import new_folder
from .options import (
    HELP_NAMES,
    PICTURES,
    check_writable,
    chosen_parameters,
    force_option,
)


@click.command(context_settings=HELP_NAMES)
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--like",
    type=click.Choice(["hopper", "stage", "prototype"]),
    default="hopper",
    show_default=True,
    help="The vehicle to begin with: 60 kg, 25 t, or the paper's.",
)
@click.option(
    "--need",
    "pairs",
    metavar="NAME=VALUE",
    multiple=True,
    help='A number of yours, SI or with a unit: --need mass="3 t". Repeat.',
)
@click.option("--needs", "listed", is_flag=True, help="List the needs with their values; no files.")
def new(folder: Path, like: str, pairs: tuple[str, ...], *, listed: bool) -> None:
    """Write the files of a vehicle of your own to a new FOLDER.

    From mass, size, sink speed and allowed load factor, the needs, come the legs' geometry,
    and the dampers' areas, volumes, pressures and orifices, in closed form. vehicle.toml has every
    parameter with the rule it comes from; study.toml, envelope.toml and README.md lead on.

    \b
    rlv-landing new my_hopper --like hopper --need mass="45 kg" --need sink_speed=2
    rlv-landing new my_stage --like stage --need load_factor=3.5
    rlv-landing new my_stage --like stage --needs

    The energy at the sink speed, all legs at once, gives the footpads' travel
    h = V^2/(2 g (0.65 n - 1)) for the load factor n; the legs' geometry gives stroke and force of
    the main struts. See docs/own_vehicle.md.
    """
    from ..choices import parse_pairs
    from ..sizing.needs import NEEDS, needs_like
    from ..sizing.project import PROTOTYPE, prototype_project, sized_project

    name = one_line(folder.resolve().name) or "vehicle"
    given: dict[str, Any] = parse_pairs(pairs, NEEDS, "need")
    if like == PROTOTYPE:
        if given or listed:
            raise LandingError("--like prototype takes no needs: it is the paper's vehicle")
        files = prototype_project(name)
    else:
        needs = needs_like(like, given)
        if listed:
            for need, q in NEEDS.items():
                click.echo(f"{need:14s} {getattr(needs, need):10g} {q.unit:5s} {q.meaning}")
            return
        files = sized_project(name, needs)
    _write(folder, files)
    click.echo(f"{folder}: {', '.join(files)}; {folder / 'README.md'} has the next commands")


def _write(folder: Path, files: dict[str, str]) -> None:
    """Write the files to a folder that is new or empty."""
    with new_folder(folder):
        for name, text in files.items():
            (folder / name).write_bytes(text.encode())


@click.command(context_settings=HELP_NAMES)
@click.argument("vehicle", metavar="VEHICLE.toml|PRESET")
@click.argument("picture", metavar="PICTURE.svg|png|pdf", type=click.Path(path_type=Path))
@force_option("Overwrite the picture if it exists.")
def draw(vehicle: str, picture: Path, *, force: bool) -> None:
    """Draw a vehicle to scale, with all its dimensions named.

    It stands on two opposite legs, struts at full length. Lengths are in m, from the CG.

    \b
    rlv-landing draw my_stage/vehicle.toml stage.svg
    rlv-landing draw yue2022-figures prototype.png
    """
    from ..figures.drawing import save_drawing
    from ..presets import preset_names

    check_writable(picture, PICTURES, force=force)
    preset = vehicle if vehicle in preset_names() else None
    parameters = chosen_parameters(preset, None if preset else vehicle, None, ())
    with writing(picture):
        save_drawing(parameters, picture, preset or _title(Path(vehicle)))
    click.echo(f"drawing: {picture}")


def _title(file: Path) -> str:
    """A file's name, or its folder's where it is the `vehicle.toml` of `rlv-landing new`."""
    return file.resolve().parent.name if file.stem == "vehicle" else file.stem
