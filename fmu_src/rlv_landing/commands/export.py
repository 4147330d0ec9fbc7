"""`rlv-landing export`: the linearised vehicle for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..errors import LandingError
from ..text.durable import whole_file, writing
from .options import HELP_NAMES, check_writable, chosen_parameters, force_option, parameter_options

FORMATS = {"mjcf": ".xml", "sdf": ".sdf", "urdf": ".urdf"}


@click.command(context_settings=HELP_NAMES)
@parameter_options
@click.option("--mjcf", type=click.Path(path_type=Path), metavar="FILE.xml", help="For MuJoCo.")
@click.option("--sdf", type=click.Path(path_type=Path), metavar="FILE.sdf", help="For Gazebo.")
@click.option("--urdf", type=click.Path(path_type=Path), metavar="FILE.urdf", help="For ROS tools.")
@force_option()
def export(*, force: bool, **options: Any) -> None:
    """Write the vehicle for other simulators, its struts as linear springs and dampers.

    The files have masses, the inertia tensor, joints, footpads, the ground and the start of the
    landing. Liquid springs are linearised at the charge pressure and at the stroke rate of
    touchdown; each file says in its comment how, with the numbers of each leg.

    \b
    rlv-landing export --parameters mine.toml --mjcf stage.xml
    rlv-landing export --mode 1-2-1 --urdf prototype.urdf --sdf prototype.sdf
    """
    from ..exports.mjcf import mjcf
    from ..exports.sdf import sdf
    from ..exports.urdf import urdf

    makers = {"mjcf": mjcf, "sdf": sdf, "urdf": urdf}
    wanted = {name: path for name in FORMATS if (path := options.pop(name)) is not None}
    if not wanted:
        raise LandingError(
            "export writes no file so far; name one or more by --mjcf FILE.xml, --sdf FILE.sdf, "
            "--urdf FILE.urdf"
        )
    for name, path in wanted.items():
        check_writable(path, FORMATS[name], force=force)
    parameters = chosen_parameters(**options)
    texts = {name: makers[name](parameters) for name in wanted}
    for name, path in wanted.items():
        text = texts[name]
        with writing(path), whole_file(path) as file:
            file.write(text.encode())
        click.echo(f"{name.upper()}: {path}")
