"""The bridge's commands `node` and `replay`. What needs ROS 2, FMPy or MCAP is imported when a command runs."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import click

from rlv_landing.choices import parse_pairs
from rlv_landing.errors import LandingError, nearest
from rlv_landing.parameters import PARAMETER_QUANTITIES

from .log_cli import tell_cut

PASS_ON: dict[str, Any] = {"ignore_unknown_options": True, "help_option_names": ["-h", "--help"], "max_content_width": 120}
EXIT_RECORDING_FAILED = 1


def split_ros_args(arguments: tuple[str, ...]) -> list[str]:
    """The ROS arguments among those left over. Raises LandingError for others."""
    if arguments and arguments[0] != "--ros-args":
        known = [o for p in click.get_current_context().command.params for o in p.opts if o.startswith("--")]
        hint = nearest(arguments[0], [*known, "--ros-args"]) or "; options are shown by --help, ROS's own follow --ros-args"
        raise LandingError(f"unknown argument {arguments[0]!r}{hint}")
    return list(arguments)


@click.command(context_settings=PASS_ON)
@click.option("--mode", metavar="2-2|1-2-1", help="Landing mode. Default: the parameters' own (2-2).")
@click.option("--preset", metavar="NAME", help="Preset of parameters. Default: yue2022-figures.")
@click.option("--parameters", "parameters_file", metavar="FILE.toml", help="Parameters from a TOML file, instead of a preset.")
@click.option("--set", "changes", metavar="NAME=VALUE", multiple=True, help='Change a parameter (SI, or as "-2 deg"). Repeatable.')
@click.option("--fmu", metavar="FILE", help="The FMU to step. Default: build/RlvLanding.fmu.")
@click.option("--realtime-factor", type=float, metavar="X", help="1: real time (default); 0: as fast as possible.")
@click.option("--step", "step_size", type=float, metavar="SECONDS", help="Communication step and publishing period. Default: 0.001.")
@click.option("--stop-time", type=float, metavar="SECONDS", help="End of the landing. Default: 1.")
@click.option("--record", metavar="FOLDER", help="Record to this folder, which must not exist yet.")
@click.option("--log-root", metavar="FOLDER", default="logs", show_default=True, help="Record below this folder, as UTC time and mode.")
@click.option("--no-record", is_flag=True, help="Do not record.")
@click.option("--namespace", metavar="NAME", default="landing", show_default=True, help="Namespace of node and topics.")
@click.option("--wait-for-subscribers", type=int, metavar="N", help="Start when N subscriptions on `struts` are matched. Default: 0.")
@click.option("--wait-timeout", type=float, metavar="SECONDS", help="Longest wait for them. Default: 30.")
@click.option("--report", is_flag=True, help="Afterwards print our peaks beside the paper's, and write landing.png beside the log.")
@click.argument("ros_args", nargs=-1, type=click.UNPROCESSED)
def node(
    changes: tuple[str, ...],
    record: str | None,
    log_root: str,
    no_record: bool,
    namespace: str,
    report: bool,
    ros_args: tuple[str, ...],
    **given: Any,
) -> None:
    """Land once as a ROS 2 node: step the FMU, publish every sample, record to MCAP.

    Topics below the namespace: struts, pose, rpy, twist, odom, accel, top/accel, leg_1..4/contact, markers; and /clock, /diagnostics.
    SI units; x forward, y left, z up; stamps are simulation time.

    \b
    Examples:
      rlv-landing node --mode 2-2 --report
      rlv-landing node --preset yue2022-table2 --set vehicle.mass=200 --set "drop.tilt=-2 deg"
      rlv-landing node --realtime-factor 0 --record /data/run1
      rlv-landing node --no-record --ros-args --log-level warn

    Exit codes: 0 landed, 1 recording failed on the way, 2 bad input, 130 or 143 after SIGINT or SIGTERM (the log is complete all the same).
    """
    from .ros_setup import StopFlag, require_ros

    with StopFlag() as stop:
        passed_on = split_ros_args(ros_args)
        if no_record and (record or report):
            raise LandingError(f"--no-record and {'--record' if record else '--report'} contradict each other; leave one out")
        where = {} if no_record else {"record": record} if record else {"log_root": log_root}
        chosen = {name: value for name, value in given.items() if value is not None}
        changed = parse_pairs(changes, PARAMETER_QUANTITIES, "parameter")
        require_ros()
        from .landing_node import land

        summary = land({**chosen, **where, **changed}, passed_on, stop, namespace)
    _tell_landing(summary)
    if report and summary.folder is not None:
        _report(summary.folder)
    if summary.signal:
        sys.exit(128 + summary.signal)
    if summary.recording_error:
        sys.exit(EXIT_RECORDING_FAILED)


def _tell_landing(summary: Any) -> None:
    click.echo(
        f"{summary.end}: {summary.samples} samples, {summary.simulated:g} s in {summary.wall:.2f} s (real-time factor "
        f"{summary.realtime_factor:.2f}); {summary.late_steps} steps late, lateness {summary.median_lateness * 1e6:.0f} us in the median, "
        f"{summary.largest_lateness * 1e3:.2f} ms at most"
    )
    if summary.lost:
        click.echo(f"warning: {summary.lost:.2f} s of wall time were lost to stalls and not made good", err=True)
    if not summary.acknowledged:
        click.echo("warning: not every reliable subscriber has acknowledged all samples", err=True)
    if summary.folder is not None:
        click.echo(f"log: {summary.folder}")
    if summary.recording_error:
        click.echo(f"error: {summary.recording_error}; what was written can be read with `rlv-landing log info {summary.folder}`", err=True)


def _report(folder: Path) -> None:
    from rlv_landing.plots import save_overview
    from rlv_landing.tables import comparison_table

    from .log_reader import LogReader

    reader = LogReader(folder)
    history = reader.history()
    mode = reader.metadata["mode"]
    click.echo(comparison_table(history, mode))
    picture = folder / "landing.png"
    save_overview(history, picture, f"{reader.metadata.get('preset', '')}, mode {mode}")
    click.echo(f"picture: {picture}")


@click.command(context_settings=PASS_ON)
@click.argument("log", type=click.Path(path_type=Path))
@click.option("--rate", type=float, default=1.0, show_default=True, metavar="X", help="Seconds of the log per second.")
@click.option("--loop", is_flag=True, help="Begin again at the end; stamps and /clock go on, they never run backwards.")
@click.option("--start", type=float, default=0.0, show_default=True, metavar="SECONDS", help="Begin this far into the log.")
@click.option("--duration", type=float, default=math.inf, metavar="SECONDS", help="Play this much of the log. Default: to its end.")
@click.option("--topics", multiple=True, metavar="NAME[,NAME...]", help="Play only these, full or relative to the namespace. Repeatable.")
@click.option("--clock", type=float, is_flag=False, flag_value=100.0, default=0.0, metavar="[HZ]", help="Publish /clock, at 100 Hz or HZ.")
@click.option("--wait-for-subscribers", type=int, default=0, show_default=True, metavar="N", help="Start when N are matched on `struts`.")
@click.option("--wait-timeout", type=float, default=30.0, show_default=True, metavar="SECONDS", help="Longest wait for them.")
@click.argument("ros_args", nargs=-1, type=click.UNPROCESSED)
def replay(log: Path, topics: tuple[str, ...], ros_args: tuple[str, ...], **options: Any) -> None:
    """Play a log back with its original timing: LOG is a log's folder or an .mcap file.

    The very bytes that were recorded go out, in the log's order, with the recorded quality of service.

    \b
    Examples:
      rlv-landing replay logs/20260131T120000Z-2-2
      rlv-landing replay logs/20260131T120000Z-2-2 --rate 0.1 --topics struts,pose --clock
      rlv-landing replay run1_0.mcap --start 0.08 --duration 0.2 --loop

    Exit codes: 0 played, 2 bad input, 3 played but the log is cut, 130 or 143 after SIGINT or SIGTERM.
    """
    from .ros_setup import StopFlag, require_ros

    with StopFlag() as stop:
        require_ros()
        from .replay_node import ReplayOptions
        from .replay_node import replay as play

        names = tuple(name.strip() for given in topics for name in given.split(",") if name.strip())
        summary = play(ReplayOptions(path=log, topics=names, **options), split_ros_args(ros_args), stop)
    click.echo(
        f"played {summary.messages} messages; lateness {summary.median_lateness * 1e6:.0f} us in the median, "
        f"{summary.largest_lateness * 1e3:.2f} ms at most"
    )
    if not summary.acknowledged:
        click.echo("warning: not every reliable subscriber has acknowledged all messages", err=True)
    if summary.signal:
        sys.exit(128 + summary.signal)
    if summary.cut:
        tell_cut(log)
