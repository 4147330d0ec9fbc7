"""The bridge's commands `replay` and `log`. What needs ROS 2, FMPy or MCAP is imported when a command runs."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import click

from rlv_landing.errors import LandingError

from .ros_args import PASS_ON, split_ros_args

EXIT_CUT = 3


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
        _tell_cut(log)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
def log() -> None:
    """Look into recorded logs. Needs no ROS 2."""


@log.command(context_settings={"max_content_width": 120})
@click.argument("log", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="As JSON: times in s, forces in N, strokes in m.")
def info(log: Path, as_json: bool) -> None:
    """What a log holds: LOG is a log's folder or an .mcap file, complete or cut.

    \b
    Examples:
      rlv-landing log info logs/20260131T120000Z-2-2
      rlv-landing log info run1_0.mcap --json

    Exit codes: 0 complete, 2 no such log or not MCAP, 3 read but cut.
    """
    try:
        import mcap  # noqa: F401
        import mcap_ros2  # noqa: F401
    except ImportError as e:
        raise LandingError(f'reading logs needs mcap ({e}); install it with pip install "rlv-landing[ros]"') from None
    from .log_info import log_info
    from .log_reader import LogReader

    found = log_info(LogReader(log))
    click.echo(json.dumps(found.as_dict(), indent=2) if as_json else found.text())
    if not found.complete:
        _tell_cut(log)


def _tell_cut(log: Path) -> None:
    click.echo(f"warning: {log} is cut: its writer did not finish it; all up to there was read", err=True)
    sys.exit(EXIT_CUT)
