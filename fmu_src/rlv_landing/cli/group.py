"""The command line `rlv-landing`.

Other packages add commands by the entry-point group `rlv_landing.commands`: the ROS 2 bridge does.
"""

from __future__ import annotations

import errno
import os
import sys
from contextlib import suppress
from importlib.metadata import entry_points

import click

from .. import __version__
from ..commands.audit import audit
from ..commands.examples import examples
from ..commands.export import export
from ..commands.identification.identify import identify
from ..commands.options import HELP_NAMES, Group
from ..commands.own_vehicle import draw, new
from ..commands.parameters import parameters
from ..commands.printing import BAD_INPUT, FAILED, exit_code
from ..commands.report import report
from ..commands.simulate import simulate
from ..commands.studies.envelope import envelope
from ..commands.studies.montecarlo import montecarlo
from ..commands.studies.sensitivity import sensitivity
from ..commands.studies.sweep import sweep
from ..commands.validate import validate
from ..core import COMPILED, WHY_NOT_COMPILED
from ..core.freshness import how_to_compile
from ..errors import LandingError, one_line, reason_of
from ..signals.handlers import hung_up
from ..signals.interrupts import answer, interrupts, terminal_left
from ..text.durable import NO_ROOM
from ..text.terminal import make_legible


class Commands(Group):
    """The package's commands, and those of other packages, loaded when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names of all commands, sorted."""
        return sorted(
            {
                *super().list_commands(ctx),
                *(e.name for e in entry_points(group="rlv_landing.commands")),
            }
        )

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of this name; None where there is none."""
        own = super().get_command(ctx, cmd_name)
        if own is not None:
            return own
        for entry in entry_points(group="rlv_landing.commands", name=cmd_name):
            command: click.Command = entry.load()
            return command
        return None


# what is printed where no command is named
FIRST = """\
rlv-landing simulate --plot landing.png     land the paper's drop test: forces, strokes, outcome
rlv-landing new my_vehicle --like hopper    the files of a vehicle of your own, and what to do next
rlv-landing --help                          all commands"""


@click.group(cls=Commands, context_settings=HELP_NAMES, invoke_without_command=True)
@click.version_option(
    __version__,
    prog_name="rlv-landing",
    message=f"%(prog)s, version %(version)s, {'compiled' if COMPILED else 'uncompiled'} core",
)
@click.pass_context
def cli(context: click.Context) -> None:
    """Touchdown of a vertical-landing rocket stage on four legs.

    \b
    rlv-landing simulate --mode 1-2-1 --compare    land in this process; compare with the paper
    rlv-landing new my_vehicle --like hopper       the files of a vehicle of your own; draw shows it
    rlv-landing report mine.toml -o report.html    drawing, margins, loads, curves and audit; or PDF
    rlv-landing examples copy my_examples          studies, FMUs and ROS 2 files to begin with
    rlv-landing parameters --toml > mine.toml      a parameter file to edit
    rlv-landing export --mjcf stage.xml            the linearised vehicle for MuJoCo; SDF, URDF
    rlv-landing validate --html report.html        every printed number and figure beside ours
    rlv-landing validate --case all                landings of others and closed forms beside ours
    rlv-landing identify --work identification     estimate parameters from landings
    rlv-landing audit                              energy, mass, momentum, rest, convergence
    rlv-landing sweep study.toml                   many landings: factors in, rows of responses out
    rlv-landing sensitivity study.toml             Sobol indices of the responses
    rlv-landing montecarlo study.toml              rate of success, causes of loss, worst landings
    rlv-landing envelope examples/envelope.toml    the boundary between stable and lost landings
    rlv-landing fmu build --parameters mine.toml   the FMU of your own vehicle; fmu info, simulate
    rlv-landing node --mode 2-2                    the ROS 2 node: steps the FMU, publishes, records
    rlv-landing log info logs/NAME                 the contents of a log
    rlv-landing view logs/NAME                     a log, or the live topics, in a browser
    rlv-landing animate logs/NAME landing.mp4      a log, or a landing, as a moving picture
    rlv-landing replay logs/NAME                   publish it again

    SI units and radians throughout; a value may carry its unit: --set drop.tilt="-2 deg".
    Exit codes: 0 done, 1 failed, 2 bad input or a file that cannot be written, 130 interrupted.
    """
    if context.invoked_subcommand is None:
        click.echo(FIRST)


OWN = (
    *(new, draw, examples, simulate, report, parameters, export, validate, audit),
    *(identify, sweep, sensitivity, montecarlo, envelope),
)
for command in OWN:
    cli.add_command(command)


def main() -> None:
    """Run the command line; an error of the user is one line on standard error.

    So is the absence of the compiled core, unless RLV_LANDING_PURE asks for it.
    """
    if WHY_NOT_COMPILED:
        click.echo(
            one_line(
                f"the core is not compiled ({WHY_NOT_COMPILED}): the same digits, ten times as "
                f"slow; {how_to_compile()} compiles it"
            ),
            err=True,
        )
    # a notebook's choice for its own pictures, which may not be installed here; ours are files
    os.environ.pop("MPLBACKEND", None)
    sys.exit(run(cli))


def run(group: click.Group, name: str | None = None) -> int:
    """Run a group of commands with the arguments of this process; the exit code.

    Args:
        group: The group.
        name: The program's name in help texts [default: as it was called].
    """
    make_legible()
    with interrupts() as come, terminal_left():
        try:
            come.open()
            status = _run(group, name)
            come.close()
        except (click.Abort, KeyboardInterrupt):
            status = answer()
            click.echo("interrupted", err=True)
    return status


def _run(group: click.Group, name: str | None) -> int:
    try:
        status = group.main(prog_name=name, standalone_mode=False)
    except LandingError as e:
        return _refuse(str(e), BAD_INPUT)
    except click.ClickException as e:
        return _refuse(e.format_message(), BAD_INPUT)
    except BrokenPipeError:
        return 0
    except OSError as e:
        if hung_up():
            raise
        return _refuse_file(e)
    except UnicodeEncodeError as e:
        if not any(0xD800 <= ord(c) <= 0xDFFF for c in e.object):
            raise
        return _refuse(f"{e.object} is a name that is not UTF-8; rename it", BAD_INPUT)
    return status if isinstance(status, int) else 0


def _refuse_file(error: OSError) -> int:
    reason = reason_of(error)
    if error.filename is None:
        full = error.errno in {*NO_ROOM, errno.EIO} and _output_fails()
        where = "standard output cannot be written: " if full else ""
        return _refuse(f"{where}{reason}", FAILED)
    name = os.fsdecode(error.filename) if isinstance(error.filename, bytes) else error.filename
    status = exit_code(error)
    if status == BAD_INPUT:
        return _refuse(f"{name} cannot be used: {reason}; name another", BAD_INPUT)
    return _refuse(f"{name}: {reason}", status)


def _output_fails() -> bool:
    """Whether standard output takes no more; the error does not say of which file it is."""
    try:
        print(flush=True)
    except OSError:
        return True
    return False


def _refuse(message: str, status: int) -> int:
    # standard error may be on a full disk, too
    with suppress(OSError):
        click.echo(one_line(f"error: {message}"), err=True)
    return status
