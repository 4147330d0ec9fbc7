"""Quality of service as rclpy takes it, and what is created with it on a node.

Each can be overridden by the parameters `qos_overrides.TOPIC.publisher.POLICY` and
`...subscription.POLICY` of the node.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from warnings import catch_warnings, simplefilter

from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileException,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.qos_overriding_options import (
    InvalidQosOverridesError,
    QosCallbackResult,
    QoSOverridingOptions,
)

from rlv_landing.errors import LandingError, reason_of

from .qos import MOST_KEPT, Qos

OVERRIDABLE = (
    QoSPolicyKind.HISTORY,
    QoSPolicyKind.DEPTH,
    QoSPolicyKind.RELIABILITY,
    QoSPolicyKind.DURABILITY,
)
RELIABILITY = {
    "reliable": ReliabilityPolicy.RELIABLE,
    "best_effort": ReliabilityPolicy.BEST_EFFORT,
}
# What rclpy raises of an override that it does not take.
REFUSALS = (
    InvalidQosOverridesError,
    ParameterException,
    InvalidQoSProfileException,
    RuntimeError,
    ValueError,
    TypeError,
    AssertionError,
)
DURABILITY = {
    "volatile": DurabilityPolicy.VOLATILE,
    "transient_local": DurabilityPolicy.TRANSIENT_LOCAL,
}


def qos_profile(qos: Qos) -> QoSProfile:
    """The rclpy profile of `qos`."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=qos.depth,
        reliability=RELIABILITY.get(qos.reliability, ReliabilityPolicy.RELIABLE),
        durability=DURABILITY.get(qos.durability, DurabilityPolicy.VOLATILE),
    )


def create_publisher(node: Node, kind: Any, name: str, qos: Qos) -> tuple[Any, Qos]:
    """Creates a publisher whose quality of service the node's parameters may override.

    Args:
        node: has the publisher.
        kind: class of the messages.
        name: full name of the topic.
        qos: the quality of service without overrides.

    Returns:
        The publisher, and the quality of service that it offers.

    Raises:
        LandingError: an override is not valid.
    """
    profile = qos_profile(qos)
    publisher = _created(node.create_publisher, name, kind, name, profile)
    return publisher, _qos(profile)


def create_subscription(
    node: Node, kind: Any, name: str, callback: Callable[[Any], object], qos: Qos
) -> Any:
    """Creates a subscription whose quality of service the node's parameters may override.

    Args:
        node: has the subscription.
        kind: class of the messages.
        name: of the topic, full or relative to the node's namespace.
        callback: called with each message.
        qos: the quality of service without overrides.

    Raises:
        LandingError: an override is not valid.
    """
    return _created(node.create_subscription, name, kind, name, callback, qos_profile(qos))


def _created(create: Callable[..., Any], name: str, *arguments: Any) -> Any:
    options = QoSOverridingOptions(OVERRIDABLE, callback=_check)
    try:
        with catch_warnings():
            # of a depth of 0, which is refused
            simplefilter("ignore", UserWarning)
            return create(*arguments, qos_overriding_options=options)
    except REFUSALS as e:
        raise LandingError(f"qos_overrides of {name}: {reason_of(e)}") from None


def _check(profile: QoSProfile) -> QosCallbackResult:
    """Whether a profile with its overrides is one that the bridge's publishers can keep."""
    reason = ""
    if profile.history != HistoryPolicy.KEEP_LAST:
        reason = "history must be keep_last: what keeps all waits for its slowest subscriber"
    elif not 1 <= profile.depth <= MOST_KEPT:
        reason = f"depth = {profile.depth} is outside [1, {MOST_KEPT}]"
    elif profile.reliability not in RELIABILITY.values():
        reason = f"reliability is not one of {', '.join(RELIABILITY)}"
    elif profile.durability not in DURABILITY.values():
        reason = f"durability is not one of {', '.join(DURABILITY)}"
    return QosCallbackResult(successful=not reason, reason=reason)


def _qos(profile: QoSProfile) -> Qos:
    return Qos(
        reliability=next(n for n, p in RELIABILITY.items() if p == profile.reliability),
        durability=next(n for n, p in DURABILITY.items() if p == profile.durability),
        depth=profile.depth,
    )
