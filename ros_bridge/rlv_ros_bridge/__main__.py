"""`python -m rlv_ros_bridge node|replay|log|animate|view`: the bridge's commands alone."""

from __future__ import annotations

import sys

import click

from rlv_landing.errors import LandingError

from .commands.animate import animate
from .commands.log import log
from .commands.node import node
from .commands.replay import replay
from .commands.view import view


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
def main() -> None:
    """Land, record and replay with ROS 2."""


main.add_command(node)
main.add_command(replay)
main.add_command(log)
main.add_command(animate)
main.add_command(view)


def run() -> int:
    """Runs a command; a LandingError becomes one line on stderr and exit code 2."""
    try:
        main.main(prog_name="rlv_ros_bridge", standalone_mode=True)
    except LandingError as e:
        print(f"error: {e}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(run())
