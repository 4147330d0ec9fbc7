"""The command `rlv-landing animate`: a landing as a moving picture. It needs no ROS 2."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import click

from rlv_landing.commands.number_types import Number, WholeNumber
from rlv_landing.commands.options import (
    WIDE,
    check_writable,
    force_option,
    parameter_options,
    start_option,
)
from rlv_landing.errors import LandingError
from rlv_landing.text.files import shown_name

from .landing_source import VehicleOptions, compute_landing, read_landing, warn_incomplete
from .log import EXIT_CUT


@click.command(context_settings=WIDE)
@click.argument("files", metavar="[LOG] OUTPUT", nargs=-1, type=click.Path(path_type=Path))
@parameter_options
@click.option(
    "--fps", type=Number(), default=25.0, show_default=True, metavar="N", help="Frames a second."
)
@click.option(
    "--slow-motion",
    type=Number(),
    default=5.0,
    show_default=True,
    metavar="X",
    help="Times slower than it was.",
)
@start_option()
@click.option(
    "--end",
    type=Number("s"),
    metavar="SECONDS",
    help="Up to this simulation time.  [default: the log's, or 1 s]",
)
@click.option(
    "--view",
    type=click.Choice(["side", "3d"]),
    help="Along z, or in perspective.  [default: 3d in space, else side]",
)
@click.option(
    "--width",
    type=WholeNumber(),
    default=960,
    show_default=True,
    metavar="PIXELS",
    help="Of the picture.",
)
@force_option("Overwrite a file that exists.")
def animate(files: tuple[Path, ...], *, force: bool, **options: Any) -> None:
    """Draw a landing as a moving picture, OUTPUT.gif or OUTPUT.mp4.

    It shows the vehicle beside force and stroke, with a mark that moves.

    LOG is a log's folder or file, or a rosbag2 recording of the same topics. Without LOG the
    landing that the options name is computed first. With LOG, options that name a vehicle are for
    recordings that do not carry their parameters.

    \b
    Examples:
      rlv-landing animate logs/20260131T120000Z-2-2 landing.mp4
      rlv-landing animate --mode 1-2-1 landing.gif --slow-motion 10 --end 0.5 --view 3d

    Exit codes: 0 written, 2 bad input, 3 written but the log is cut or damaged, 130, 143 or
    129 ended by SIGINT, SIGTERM or SIGHUP: no file is left.
    """
    from tqdm import tqdm

    from rlv_landing.figures.animation import ENDINGS, Film, save_animation

    if not 1 <= len(files) <= 2:
        raise LandingError(
            f"{len(files)} files given; "
            "name one to write, OUTPUT.gif or OUTPUT.mp4, and before it, if you like, a log"
        )
    output = files[-1]
    if output.suffix not in ENDINGS:
        raise LandingError(f"{output} must end in {' or '.join(ENDINGS)}")
    check_writable(output, output.suffix, force=force)
    vehicle = VehicleOptions.pop_from(options)
    film = Film(**options)
    cut = False
    if len(files) == 2:
        shown = None
        if film.start is not None or film.end is not None:
            shown = film.start or 0.0, math.inf if film.end is None else film.end
        history, parameters, cut = read_landing(files[0], vehicle, shown)
        title = shown_name(files[0])
    else:
        history, parameters = compute_landing(vehicle, film.end)
        title = f"{parameters.drop.mode} landing"
    hidden = not sys.stderr.isatty()
    with tqdm(unit="frame", desc="drawing", disable=hidden) as bar:

        def show_progress(done: int, frames: int) -> None:
            bar.total = frames
            bar.update(done - bar.n)

        made = save_animation(history, parameters, output, title, film, show_progress)
    click.echo(
        f"{output}: {made.frames} frames at {made.fps:.4g} a second, "
        f"{film.slow_motion:g} times slower than it was"
    )
    if cut:
        warn_incomplete(files[0])
        sys.exit(EXIT_CUT)
