"""`python -m rlv_ros_bridge node|replay|log|animate|view|fmu`: the bridge's commands alone."""

from __future__ import annotations

import sys

import click

from rlv_landing.cli import run as run_group
from rlv_landing.commands.options import HELP_NAMES, Group

from .commands.animate import animate
from .commands.fmu import fmu
from .commands.log import log
from .commands.node import node
from .commands.replay import replay
from .commands.view import view


@click.group(cls=Group, context_settings=HELP_NAMES)
def main() -> None:
    """Land, record and replay with ROS 2."""


main.add_command(node)
main.add_command(replay)
main.add_command(log)
main.add_command(animate)
main.add_command(view)
main.add_command(fmu)


def run() -> int:
    """Runs a command; an error of the user is one line on standard error. The exit code."""
    return run_group(main, "rlv_ros_bridge")


if __name__ == "__main__":
    sys.exit(run())
