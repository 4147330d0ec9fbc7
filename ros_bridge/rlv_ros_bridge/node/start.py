"""The entry point for `ros2 run`, which imports ROS 2 when it runs."""

from __future__ import annotations

from rlv_landing.signals.start import end_at_once


def main() -> int:
    """Runs the landing node; the exit code."""
    # Before the imports, in whose midst Ctrl-C would be lost.
    end_at_once()
    from .land import main as run_main

    return run_main()
