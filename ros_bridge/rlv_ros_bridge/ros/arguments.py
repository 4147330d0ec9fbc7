"""Separates ROS arguments from the options of the bridge's commands."""

from __future__ import annotations

from typing import Any

import click

from rlv_landing.commands.options import WIDE
from rlv_landing.errors import LandingError, nearest

# Click settings of commands that hand `--ros-args ...` on to ROS 2.
ROS_COMMAND_SETTINGS: dict[str, Any] = {
    **WIDE,
    "ignore_unknown_options": True,
}


def split_ros_args(arguments: tuple[str, ...]) -> list[str]:
    """The arguments from `--ros-args` on.

    Args:
        arguments: what click has not taken as an option.

    Raises:
        LandingError: an argument that is neither an option nor follows `--ros-args`.
    """
    if arguments and arguments[0] != "--ros-args":
        parameters = click.get_current_context().command.params
        known = [option for p in parameters for option in p.opts if option.startswith("--")]
        hint = (
            nearest(arguments[0], [*known, "--ros-args"])
            or "; options are shown by --help, ROS's own follow --ros-args"
        )
        raise LandingError(f"unknown argument {arguments[0]!r}{hint}")
    return list(arguments)
