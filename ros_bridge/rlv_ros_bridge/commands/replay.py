"""The command `rlv-landing replay`. ROS 2 and MCAP are imported when it runs."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import click

from rlv_landing.commands.number_types import Number, WholeNumber

from ..ros.arguments import ROS_COMMAND_SETTINGS, split_ros_args
from .log import split_names, warn_incomplete_and_exit


@click.command(context_settings=ROS_COMMAND_SETTINGS)
@click.argument("log", type=click.Path(path_type=Path))
@click.option(
    "--rate",
    type=Number(),
    default=1.0,
    show_default=True,
    metavar="X",
    help="Seconds of the log per second.",
)
@click.option(
    "--loop",
    is_flag=True,
    help="Begin again at the end; stamps and /clock never run backwards.",
)
@click.option(
    "--start",
    type=Number("s"),
    default=0.0,
    show_default=True,
    metavar="SECONDS",
    help="Begin this far into the log.",
)
@click.option(
    "--duration",
    type=Number("s"),
    default=math.inf,
    metavar="SECONDS",
    help="Play this much of the log. Default: to its end.",
)
@click.option(
    "--topics",
    multiple=True,
    metavar="NAME[,NAME...]",
    help="Play only these, full or relative to the namespace. Repeatable.",
)
@click.option(
    "--remap",
    multiple=True,
    metavar="OLD:=NEW",
    help="Play OLD as NEW, full or relative to the namespace. Repeatable.",
)
@click.option(
    "--start-paused", is_flag=True, help="Wait for the space key, or the service ~/resume."
)
@click.option(
    "--clock",
    type=Number("Hz"),
    is_flag=False,
    flag_value=100.0,
    default=0.0,
    metavar="[HZ]",
    help="Publish /clock, at 100 Hz or HZ.",
)
@click.option(
    "--wait-for-subscribers",
    type=WholeNumber(),
    default=0,
    show_default=True,
    metavar="N",
    help="Start when N are matched on `struts`.",
)
@click.option(
    "--wait-timeout",
    type=Number("s"),
    default=30.0,
    show_default=True,
    metavar="SECONDS",
    help="Longest wait for them.",
)
@click.option(
    "--start-delay",
    type=Number("s"),
    default=0.0,
    show_default=True,
    metavar="SECONDS",
    help="Wait for so long after that; /clock is held meanwhile.",
)
@click.argument("ros_args", nargs=-1, type=click.UNPROCESSED)
def replay(log: Path, topics: tuple[str, ...], ros_args: tuple[str, ...], **options: Any) -> None:
    """Play a log back with its original timing: LOG is a log's folder or an .mcap file.

    The recorded bytes are published, in the log's order, with the recorded quality of service.

    \b
    Keys, on a terminal:
      space        pause, resume       right     one message more, in a pause
      up, down     rate times 1.1, divided by it
      q, Ctrl-C    end

    \b
    Examples:
      rlv-landing replay logs/20260131T120000Z-2-2
      rlv-landing replay logs/20260131T120000Z-2-2 --rate 0.1 --topics struts,pose --clock
      rlv-landing replay run1_0.mcap --start 0.08 --duration 0.2 --loop
      rlv-landing replay run1 --topics applied/ground --remap applied/ground:=ground
          (moves the ground of another landing)

    Exit codes: 0 played, or ended by q, 2 bad input, 3 played but the log is cut, 130, 143 or 129
    after SIGINT, SIGTERM or SIGHUP.
    """
    from ..ros.setup import StopFlag, require_ros

    with StopFlag() as stop:
        require_ros()
        from ..replay.replay_node import replay as play
        from ..replay.selection import ReplayOptions

        chosen = ReplayOptions(path=log, topics=tuple(split_names(topics)), **options)
        summary = play(chosen, split_ros_args(ros_args), stop)
    click.echo(
        f"played {summary.messages} messages; "
        f"lateness {summary.median_lateness * 1e6:.0f} us in the median, "
        f"{summary.p99_lateness * 1e6:.0f} us in 99 % of messages, "
        f"{summary.largest_lateness * 1e3:.2f} ms at most"
        + (f"; {summary.lost:.2f} s lost to stalls" if summary.lost else "")
    )
    if not summary.acknowledged and not summary.signal:
        click.echo("warning: not every reliable subscriber has acknowledged all messages", err=True)
    if summary.signal:
        sys.exit(128 + summary.signal)
    if summary.cut and not summary.quit:
        warn_incomplete_and_exit(log)
