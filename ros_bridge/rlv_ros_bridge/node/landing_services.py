"""The landing node's own services: `~/reset` and `~/step`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from std_srvs.srv import Trigger

from rlv_landing.errors import LandingError


def create_landing_services(node: Node, reset: Callable[[], str], step: Callable[[], str]) -> None:
    """Creates `~/reset` and `~/step` (std_srvs/Trigger) on `node`.

    Args:
        node: the landing node.
        reset: acts on the landing, and returns the answer's text. A LandingError becomes the
            answer's text with success = false.
        step: likewise.
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
