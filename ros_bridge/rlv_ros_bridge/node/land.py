"""Land once, in a ROS 2 started for it: the lifecycle node walks its states by itself; or serve one
that others walk.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rclpy.lifecycle import TransitionCallbackReturn

from rlv_landing.errors import LandingError

from ..ros.setup import StopFlag, ros_context
from ..ros.spinner import Spinner
from .landing_node import NAMESPACE, LandingNode
from .run_summary import RunSummary

# How often signals and the progress are looked after [s].
LOOK_ROUND_SECONDS = 0.02
BAR_FORMAT = "landing {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s [{elapsed}<{remaining}]"


def land(
    changes: Mapping[str, Any], ros_args: Sequence[str], stop: StopFlag, namespace: str = NAMESPACE
) -> RunSummary | None:
    """One landing with the ROS parameters `changes`, in a ROS 2 started for it with `ros_args`; or,
    with `autostart` false, a node that waits for transitions until it is shut down or a signal
    comes. None where there was no landing. Raises LandingError as the node does.
    """
    with ros_context(ros_args):
        node = LandingNode(changes, namespace)
        try:
            with Spinner(node) as spinner:
                if node.values["autostart"]:
                    return _walk(node, spinner, stop)
                return _serve(node, spinner, stop)
        finally:
            node.destroy_node()


def _walk(node: LandingNode, spinner: Spinner, stop: StopFlag) -> RunSummary:
    _do(node, spinner, node.trigger_configure)
    try:
        _do(node, spinner, node.trigger_activate)
        _wait(node, stop)
        if node.failure is not None:
            raise node.failure
        if node.state == "active":
            _do(node, spinner, node.trigger_deactivate)
        summary = node.summary(stop.number)
    finally:
        if node.state != "finalized":
            spinner.call(node.trigger_shutdown)
    return summary


def _serve(node: LandingNode, spinner: Spinner, stop: StopFlag) -> RunSummary | None:
    while not stop and node.state != "finalized":
        stop.wait(LOOK_ROUND_SECONDS)
    if node.state == "active":
        _do(node, spinner, node.trigger_deactivate)
    summary = node.summary(stop.number) if node.has_landed else None
    if node.state != "finalized":
        spinner.call(node.trigger_shutdown)
    return summary


def _do(
    node: LandingNode, spinner: Spinner, transition: Callable[[], TransitionCallbackReturn]
) -> None:
    result = spinner.call(transition)
    if result != TransitionCallbackReturn.SUCCESS:
        raise node.failure or LandingError(f"the transition from {node.state} failed")


def _wait(node: LandingNode, stop: StopFlag) -> None:
    """Returns at the landing's end, at an error or a signal; with a bar that shows how far it is,
    on a terminal.
    """
    from tqdm import tqdm

    total = node.values["stop_time"]
    with tqdm(
        total=total, disable=not sys.stderr.isatty(), bar_format=BAR_FORMAT, file=sys.stderr
    ) as bar:
        while not node.over.wait(LOOK_ROUND_SECONDS) and not stop:
            if node.landing is not None:
                bar.update(node.landing.time - bar.n)
        if node.landing is not None:
            bar.update(node.landing.time - bar.n)


def main() -> int:
    """For `ros2 run`: everything by ROS parameters."""
    try:
        with StopFlag() as stop:
            summary = land({}, sys.argv[1:], stop)
    except LandingError as e:
        print(f"error: {e}", file=sys.stderr)
        return 2
    if summary is None:
        return 128 + stop.number if stop.number else 0
    return 128 + summary.signal if summary.signal else 1 if summary.recording_error else 0
