"""What the bridge's commands pass on to ROS 2."""

from __future__ import annotations

from typing import Any

import click

from rlv_landing.errors import LandingError, nearest

PASS_ON: dict[str, Any] = {
    "ignore_unknown_options": True,
    "help_option_names": ["-h", "--help"],
    "max_content_width": 120,
}


def split_ros_args(arguments: tuple[str, ...]) -> list[str]:
    """The ROS arguments among those left over. Raises LandingError for others."""
    if arguments and arguments[0] != "--ros-args":
        known = [
            o
            for p in click.get_current_context().command.params
            for o in p.opts
            if o.startswith("--")
        ]
        hint = (
            nearest(arguments[0], [*known, "--ros-args"])
            or "; options are shown by --help, ROS's own follow --ros-args"
        )
        raise LandingError(f"unknown argument {arguments[0]!r}{hint}")
    return list(arguments)
