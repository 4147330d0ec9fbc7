"""The entry point for `ros2 run`, which imports ROS 2 when it runs."""

from __future__ import annotations

import os

from rlv_landing.signals.handlers import Handlers


def main() -> int:
    """Runs the landing node; the exit code."""
    # Before the imports, in whose midst an exception would be lost. Who ends a node by a signal has
    # not seen it crash: so the exit code is 0.
    Handlers(lambda number, frame: os._exit(0)).set()
    from .land import main as run_main

    return run_main()
