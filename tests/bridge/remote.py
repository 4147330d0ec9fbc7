"""The landing node as another participant sees it: services, parameters, inputs and lifecycle."""

from __future__ import annotations

import os
from types import TracebackType
from typing import Any

import rclpy
from bridge_tools import TIMEOUT
from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.msg import (
    Parameter,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_srvs.srv import Trigger

CONFIGURE, CLEANUP = Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_CLEANUP
ACTIVATE, DEACTIVATE = Transition.TRANSITION_ACTIVATE, Transition.TRANSITION_DEACTIVATE
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Remote:
    """A ROS participant of its own on `domain`, to be entered, that talks to the node `name`."""

    def __init__(self, domain: int, name: str = "/landing/landing_node") -> None:
        self._domain = domain
        self.name = name

    def __enter__(self) -> Remote:
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        self.context = Context()
        rclpy.init(context=self.context, domain_id=self._domain)
        self.node = Node("remote", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self._clients: dict[str, Any] = {}
        return self

    def diagnostics(self) -> list[dict[str, str]]:
        """A growing list: the first status of each message of /diagnostics from now on."""
        received: list[dict[str, str]] = []
        self.node.create_subscription(
            DiagnosticArray,
            "/diagnostics",
            lambda m: received.append({v.key: v.value for v in m.status[0].values}),
            10,
        )
        return received

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """The answer of the node's service."""
        full = f"{self.name}/{service}"
        if full not in self._clients:
            self._clients[full] = self.node.create_client(kind, full)
            assert self._clients[full].wait_for_service(TIMEOUT), full
        future = self._clients[full].call_async(request)
        self.executor.spin_until_future_complete(future, timeout_sec=TIMEOUT)
        assert future.done(), full
        return future.result()

    def change(self, transition: int) -> bool:
        """Triggers a transition of the lifecycle; whether it succeeded."""
        return bool(
            self.call(
                ChangeState,
                "change_state",
                ChangeState.Request(transition=Transition(id=transition)),
            ).success
        )

    def shut_down(self) -> None:
        """The lifecycle's shutdown, which has a number for each state.

        The node may be gone before it answers.
        """
        number = {"unconfigured": 5, "inactive": 6, "active": 7}[self.state()]
        self._clients[f"{self.name}/change_state"].call_async(
            ChangeState.Request(transition=Transition(id=number))
        )

    def state(self) -> str:
        """The lifecycle's state."""
        return str(self.call(GetState, "get_state", GetState.Request()).current_state.label)

    def trigger(self, service: str) -> tuple[bool, str]:
        """The answer of `~/reset` or `~/step`: success and message."""
        answer = self.call(Trigger, service, Trigger.Request())
        return bool(answer.success), str(answer.message)

    def set(self, **values: Any) -> list[SetParametersResult]:
        """Sets parameters one by one, and gives the results; `__` in a name stands for a dot."""
        return list(
            self.call(
                SetParameters,
                "set_parameters",
                SetParameters.Request(parameters=parameters(values)),
            ).results
        )

    def set_together(self, **values: Any) -> SetParametersResult:
        """Sets parameters at once, and gives the result."""
        request = SetParametersAtomically.Request(parameters=parameters(values))
        return self.call(SetParametersAtomically, "set_parameters_atomically", request).result

    def get(self, *names: str) -> list[Any]:
        """Parameters' values."""
        found = self.call(
            GetParameters, "get_parameters", GetParameters.Request(names=list(names))
        ).values
        return [rclpy.parameter.parameter_value_to_python(v) for v in found]

    def describe(self, *names: str) -> list[ParameterDescriptor]:
        """Parameters' descriptors."""
        return list(
            self.call(
                DescribeParameters,
                "describe_parameters",
                DescribeParameters.Request(names=list(names)),
            ).descriptors
        )

    def names(self) -> set[str]:
        """All parameters."""
        return set(
            self.call(ListParameters, "list_parameters", ListParameters.Request()).result.names
        )

    def first(self, kind: Any, topic: str, qos: Any = LATCHED) -> Any:
        """The first message that comes on `topic`."""
        received: list[Any] = []
        subscription = self.node.create_subscription(kind, topic, received.append, qos)
        self.until(lambda: bool(received))
        self.node.destroy_subscription(subscription)
        return received[0]

    def until(self, happened: Any) -> None:
        """Spins until `happened()` is true."""
        end = self.node.get_clock().now().nanoseconds + TIMEOUT * 1e9
        while not happened():
            assert self.node.get_clock().now().nanoseconds < end, "it did not happen in time"
            self.executor.spin_once(timeout_sec=0.05)


def parameters(values: dict[str, Any]) -> list[Parameter]:
    kinds = {
        bool: (ParameterType.PARAMETER_BOOL, "bool_value"),
        int: (ParameterType.PARAMETER_INTEGER, "integer_value"),
        float: (ParameterType.PARAMETER_DOUBLE, "double_value"),
        str: (ParameterType.PARAMETER_STRING, "string_value"),
    }
    made = []
    for name, value in values.items():
        number, field = kinds[type(value)]
        made.append(
            Parameter(
                name=name.replace("__", "."), value=ParameterValue(type=number, **{field: value})
            )
        )
    return made
