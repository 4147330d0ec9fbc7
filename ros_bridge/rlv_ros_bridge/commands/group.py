"""The group of the bridge's commands, alone."""

from __future__ import annotations

import click

from rlv_landing.cli.group import run as run_group
from rlv_landing.commands.options import HELP_NAMES, Group

from .animate import animate
from .fmu import fmu
from .log import log
from .node import node
from .replay import replay
from .view import view


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
