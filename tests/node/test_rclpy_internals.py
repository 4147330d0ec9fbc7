"""The private parts of rclpy give what the node relies on."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.lifecycle import LifecycleNode
from rclpy.parameter import Parameter

from rlv_ros_bridge.ros.rclpy_internals import lifecycle_state, parameter_overrides


@pytest.fixture
def context(domain: int) -> Iterator[Context]:
    """A ROS 2 of the test's own."""
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    yield context
    rclpy.shutdown(context=context)


def test_overrides_of_undeclared_parameters_are_seen_and_the_constructor_wins(
    context: Context,
) -> None:
    node = rclpy.create_node(
        "overridden",
        context=context,
        cli_args=["--ros-args", "-p", "mode:=1-2-1", "-p", "count:=3", "-p", "misspelt:=true"],
        parameter_overrides=[Parameter("count", value=4)],
    )
    try:
        assert parameter_overrides(node) == {"mode": "1-2-1", "count": 4, "misspelt": True}
        assert not node.has_parameter("misspelt")
    finally:
        node.destroy_node()


def test_the_state_follows_the_transitions(context: Context) -> None:
    node = LifecycleNode("managed", context=context)
    try:
        states = [lifecycle_state(node)]
        for trigger in (
            node.trigger_configure,
            node.trigger_activate,
            node.trigger_deactivate,
            node.trigger_cleanup,
            node.trigger_shutdown,
        ):
            trigger()
            states.append(lifecycle_state(node))
    finally:
        node.destroy_node()
    assert states == [
        "unconfigured",
        "inactive",
        "active",
        "inactive",
        "unconfigured",
        "finalized",
    ]
