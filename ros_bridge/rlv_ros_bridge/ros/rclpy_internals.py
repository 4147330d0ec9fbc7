"""The private parts of rclpy that the bridge uses, all of them.

rclpy offers no public way to the same information, and another version may change them. The tests
of this file hold them to the installed version.
"""

from __future__ import annotations

from typing import Any

from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node


def parameter_overrides(node: Node) -> dict[str, Any]:
    """All parameter values from the command line, parameter files and the constructor, by name.

    rclpy's public interface gives an override only once its parameter is declared. It ignores
    overrides of undeclared parameters silently, so a misspelt name would not be noticed.
    """
    return {name: p.value for name, p in node._parameter_overrides.items()}


def lifecycle_state(node: LifecycleNode) -> str:
    """The label of the node's lifecycle state, as in `lifecycle_msgs/msg/State`.

    rclpy gives it by the service `~/get_state` only, which the node's own thread cannot wait for.
    """
    return str(node._state_machine.current_state[1])
