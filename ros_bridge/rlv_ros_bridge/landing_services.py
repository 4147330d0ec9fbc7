"""The landing node's own services: `~/reset` and `~/step`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from std_srvs.srv import Trigger

from rlv_landing.errors import LandingError

if TYPE_CHECKING:
    from .landing_node import LandingNode


def offer_services(node: LandingNode) -> None:
    """Makes the services (std_srvs/Trigger). Their answers say the time that was reached, or why nothing was done."""
    node.create_service(Trigger, "~/reset", lambda _, response: _answer(node, node.reset, response))
    node.create_service(Trigger, "~/step", lambda _, response: _answer(node, node.step, response))


def _answer(node: LandingNode, action: Callable[[], str], response: Any) -> Any:
    try:
        response.message = action()
        response.success = True
    except LandingError as e:
        response.success, response.message = False, str(e)
        node.get_logger().warning(str(e))
    return response
