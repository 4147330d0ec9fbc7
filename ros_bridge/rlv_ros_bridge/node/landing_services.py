"""The landing node's own services: `~/reset` and `~/step`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from std_srvs.srv import Trigger

from rlv_landing.errors import LandingError


def create_landing_services(node: Node, reset: Callable[[], str], step: Callable[[], str]) -> None:
    """Create `~/reset` and `~/step` (std_srvs/Trigger) on `node`.

    `reset` and `step` act on the landing and return the time that was reached, as text. A
    LandingError of theirs is the answer's message with success = false.
    """
    node.create_service(Trigger, "~/reset", lambda _, response: _answer(node, reset, response))
    node.create_service(Trigger, "~/step", lambda _, response: _answer(node, step, response))


def _answer(node: Node, action: Callable[[], str], response: Any) -> Any:
    try:
        response.message = action()
        response.success = True
    except LandingError as e:
        response.success, response.message = False, str(e)
        node.get_logger().warning(str(e))
    return response
