"""`python -m rlv_ros_bridge`: the bridge's commands alone, as `commands/group.py` lists them."""

from __future__ import annotations

import sys

from rlv_landing.signals.start import end_at_once


def run() -> int:
    """Runs a command; an error of the user is one line on standard error. The exit code."""
    # Before the imports, in whose midst Ctrl-C would be lost.
    end_at_once()
    from .commands.group import run as run_group

    return run_group()


if __name__ == "__main__":
    sys.exit(run())
