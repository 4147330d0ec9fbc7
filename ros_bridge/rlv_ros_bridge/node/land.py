"""Runs the landing node in a ROS 2 started for it: lands once, or waits for transitions."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rclpy.lifecycle import TransitionCallbackReturn

from rlv_landing.errors import LandingError
from rlv_landing.signals.interrupts import answer

from ..ros.setup import StopFlag, ros_context
from ..ros.spinner import Spinner
from .landing_node import NAMESPACE, LandingNode
from .run_summary import EXIT_RECORDING_FAILED, RunSummary, print_summary

# Period of checking for signals and of updating the progress bar [s].
POLL_SECONDS = 0.02
BAR_FORMAT = "landing {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s [{elapsed}<{remaining}]"


def land(
    changes: Mapping[str, Any], ros_args: Sequence[str], stop: StopFlag, namespace: str = NAMESPACE
) -> RunSummary | None:
    """Runs the landing node once.

    With the parameter `autostart` it lands and ends. Without, it waits for lifecycle transitions
    until it is shut down or a signal comes.

    Args:
        changes: ROS parameters by name; they override those of `ros_args`.
        ros_args: ROS arguments, `--ros-args ...`.
        stop: notes signals, which end the landing.
        namespace: namespace of the node and its topics.

    Returns:
        The figures of the last landing; None where there was none, as after a signal before it.

    Raises:
        LandingError: bad parameters, or the landing failed.
    """
    with ros_context(ros_args) as shared:
        node = LandingNode(changes, namespace, shared)
        try:
            with Spinner(node) as spinner:
                if node.values["autostart"]:
                    return _land_once(node, spinner, stop)
                return _wait_for_transitions(node, spinner, stop)
        finally:
            node.destroy_node()


def _land_once(node: LandingNode, spinner: Spinner, stop: StopFlag) -> RunSummary | None:
    _trigger(node, spinner, node.trigger_configure)
    try:
        if stop:
            return None
        _trigger(node, spinner, node.trigger_activate)
        _wait_for_end(node, stop)
        if node.failure is not None:
            raise node.failure
        if node.state == "active":
            _trigger(node, spinner, node.trigger_deactivate)
        summary = node.summary(stop.number)
    finally:
        if node.state != "finalized":
            spinner.call(node.trigger_shutdown)
    return summary


def _wait_for_transitions(node: LandingNode, spinner: Spinner, stop: StopFlag) -> RunSummary | None:
    while not stop and node.state != "finalized":
        stop.wait(POLL_SECONDS)
    if node.state == "active":
        _trigger(node, spinner, node.trigger_deactivate)
    summary = node.summary(stop.number) if node.has_landed else None
    if node.state != "finalized":
        spinner.call(node.trigger_shutdown)
    return summary


def _trigger(
    node: LandingNode, spinner: Spinner, transition: Callable[[], TransitionCallbackReturn]
) -> None:
    result = spinner.call(transition)
    if result != TransitionCallbackReturn.SUCCESS:
        raise node.failure or LandingError(f"the transition from {node.state} failed")


def _wait_for_end(node: LandingNode, stop: StopFlag) -> None:
    """Waits for the landing's end, an error or a signal; shows a progress bar on a terminal."""
    from tqdm import tqdm

    total = node.values["stop_time"]
    with tqdm(
        total=total, disable=not sys.stderr.isatty(), bar_format=BAR_FORMAT, file=sys.stderr
    ) as bar:
        while not node.ended.wait(POLL_SECONDS) and not stop:
            if node.landing is not None:
                bar.update(node.landing.time - bar.n)
        if node.landing is not None:
            bar.update(node.landing.time - bar.n)


def main() -> int:
    """The entry point for `ros2 run` and `ros2 launch`, where all settings are ROS parameters.

    Returns:
        The exit code: 0 also after a signal that has ended the landing with a complete log, which
        `ros2 launch` else takes for a crash.
    """
    try:
        with StopFlag() as stop:
            summary = land({}, sys.argv[1:], stop)
    except LandingError as e:
        print(f"error: {e}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        # while a parameter file was waited for
        answer()
        return 0
    if summary is None:
        return 0
    print_summary(summary)
    return EXIT_RECORDING_FAILED if summary.recording_error else 0
