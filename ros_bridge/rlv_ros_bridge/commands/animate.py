"""The command `rlv-landing animate`: a log, or a landing made on the spot, as a moving picture.

It needs no ROS 2.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rlv_landing.commands.options import check_writable, parameter_options
from rlv_landing.errors import LandingError

from ..logs.libraries import require_log_readers
from ..ros.interruption import ends_tidily
from .log import EXIT_CUT, WIDE

if TYPE_CHECKING:
    from rlv_landing.history import History
    from rlv_landing.parameters import Parameters

LANDED = 1.0


@click.command(context_settings=WIDE)
@click.argument("files", metavar="[LOG] OUTPUT", nargs=-1, type=click.Path(path_type=Path))
@parameter_options
@click.option(
    "--fps", type=float, default=25.0, show_default=True, metavar="N", help="Frames a second."
)
@click.option(
    "--slow-motion",
    type=float,
    default=5.0,
    show_default=True,
    metavar="X",
    help="Times slower than it was.",
)
@click.option("--start", type=float, metavar="SECONDS", help="From this simulation time on.")
@click.option(
    "--end",
    type=float,
    metavar="SECONDS",
    help="Up to this simulation time.  [default: the log's, or 1 s]",
)
@click.option(
    "--view",
    type=click.Choice(["side", "3d"]),
    default="side",
    show_default=True,
    help="The symmetric plane, or space.",
)
@click.option(
    "--width", type=int, default=960, show_default=True, metavar="PIXELS", help="Of the picture."
)
@click.option("--force", is_flag=True, help="Overwrite a file that exists.")
def animate(
    files: tuple[Path, ...], preset: str | None, file: str | None, mode: str | None, pairs: tuple[str, ...],
    force: bool, **film: Any,
) -> None:  # fmt: skip
    """Draw a landing as a moving picture, OUTPUT.gif or OUTPUT.mp4: the vehicle beside force and
    stroke, with a mark that moves.

    LOG is a log's folder or file, or a rosbag2 recording of the same topics. Without LOG the
    landing that the options name is made first. With LOG, options that name a vehicle are for
    recordings that do not carry their parameters.

    \b
    Examples:
      rlv-landing animate logs/20260131T120000Z-2-2 landing.mp4
      rlv-landing animate --mode 1-2-1 landing.gif --slow-motion 10 --end 0.5 --view 3d

    Exit codes: 0 written, 2 bad input, 3 written but the log is cut or damaged, 130 or 143 ended by
        SIGINT or SIGTERM: no file is left.
    """
    from tqdm import tqdm

    from rlv_landing.figures.animation import ENDINGS, Film, save_animation

    if not 1 <= len(files) <= 2:
        raise LandingError(
            f"{len(files)} files given; name one to write, OUTPUT.gif or OUTPUT.mp4, and before it, if you like, a log"
        )
    output = files[-1]
    if output.suffix not in ENDINGS:
        raise LandingError(f"{output} must end in {' or '.join(ENDINGS)}")
    check_writable(output, output.suffix, force=force)
    given = (preset, file, mode, pairs)
    cut = False
    if len(files) == 2:
        history, parameters, cut = landing_of_log(files[0], given)
        title = files[0].name
    else:
        history, parameters = _landed(given, film["end"])
        title = f"{parameters.drop.mode} landing"
    with ends_tidily(), tqdm(unit="frame", desc="drawing", disable=not sys.stderr.isatty()) as bar:

        def tell(done: int, frames: int) -> None:
            bar.total = frames
            bar.update(done - bar.n)

        made = save_animation(history, parameters, output, title, Film(**film), tell)
    click.echo(
        f"{output}: {made.frames} frames at {made.fps:.4g} a second, {film['slow_motion']:g} times slower than it was"
    )
    if cut:
        tell_drawn(files[0])
        sys.exit(EXIT_CUT)


def tell_drawn(log: Path) -> None:
    """Warns that not all of the log is there."""
    click.echo(
        f"warning: {log} is cut or damaged; what is whole was drawn, `rlv-landing log recover` saves it",
        err=True,
    )


def _landed(given: tuple[Any, ...], end: float | None) -> tuple[History, Parameters]:
    from rlv_landing import Landing

    parameters = _chosen(given)
    until = LANDED if end is None else end
    if not 0.0 < until <= 60.0:
        raise LandingError(f"--end = {until:g} s is outside (0, 60] s")
    return Landing(parameters).run(until, 1e-3), parameters


def landing_of_log(path: Path, given: tuple[Any, ...]) -> tuple[History, Parameters, bool]:
    """The landing in the log at `path`, its vehicle, and whether the log is cut or damaged;
    `given`: options that name a vehicle.

    Raises LandingError: no such log, no landing in it, or a vehicle that is named both ways or not
        at all.
    """
    require_log_readers()
    from ..logs.bag_reader import open_log
    from ..logs.history import read_history
    from ..messages.topics import APPLIED_GROUND, resolve

    reader = open_log(path)
    history, _ = read_history(reader)
    ground = resolve(reader.namespace, APPLIED_GROUND.name)
    if ground in reader.channels and next(iter(reader.messages([ground])), None) is not None:
        click.echo("warning: the ground was moved in this landing; it is drawn at rest", err=True)
    named = any(given)
    if history.parameters is not None:
        if named:
            raise LandingError(
                f"{path} carries its parameters; leave --preset, --parameters, --mode and --set out"
            )
        return history, history.parameters, reader.cut
    if not named:
        raise LandingError(
            f"{path} does not carry the vehicle's parameters; name them by --parameters FILE.toml, or --preset and --mode"
        )
    return history, _chosen(given), reader.cut


def _chosen(given: tuple[Any, ...]) -> Parameters:
    from rlv_landing.choices import choose_parameters, parse_pairs
    from rlv_landing.parameters import PARAMETER_QUANTITIES

    preset, file, mode, pairs = given
    return choose_parameters(
        preset, file, mode, parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter")
    )
