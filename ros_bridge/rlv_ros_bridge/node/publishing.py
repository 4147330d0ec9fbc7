"""The publishers of the landing node, one for each topic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS

from ..messages import topics
from ..messages.message_types import is_installed, message_class
from ..messages.qos import CLOCK, LATCHED, Qos
from ..messages.rclpy_qos import create_publisher
from ..messages.robot_description import robot_description, variables
from ..messages.topics import Topic, resolve, topics_of
from .publish_queue import PublishQueue, TopicPublisher


@dataclass(frozen=True)
class Publishing:
    """The publishers of a node by topic, the queue in front of them, and their topics' full names.

    `names` and `qos`, the quality of service that is offered, also hold topics without a publisher,
    which are only recorded.
    """

    queue: PublishQueue
    publishers: Mapping[Topic, TopicPublisher]
    names: Mapping[Topic, str]
    qos: Mapping[Topic, Qos]

    def describe(self, parameters: Parameters) -> bytes:
        """Publishes the FMU's variables and the vehicle's description.

        Returns:
            The serialised message of the description.
        """
        description: bytes = serialize_message(String(data=robot_description(parameters)))
        self.publishers[topics.VARIABLES].publish(
            serialize_message(String(data=variables(parameters)))
        )
        self.publishers[topics.ROBOT_DESCRIPTION].publish(description)
        return description

    def acknowledging(self) -> list[Any]:
        """The rclpy publishers whose subscribers should acknowledge all samples of a landing."""
        left_out = (*topics.LATCHED, topics.CLOCK)
        return [p.publisher for topic, p in self.publishers.items() if topic not in left_out]


def create_publishing(
    node: Node, qos: Qos, legs: tuple[int, ...] = LEGS, *, clock: bool
) -> Publishing:
    """Creates the landing's publishers on `node`.

    Args:
        node: has the publishers; its parameters may override their quality of service.
        qos: of what is published at every step.
        legs: the numbers of the vehicle's legs.
        clock: also create that of `/clock`.

    Raises:
        LandingError: an override of the quality of service is not valid.
    """
    # A subscriber that waits for a match on `struts` finds the others matched: it comes last.
    others = reversed([t for t in topics_of(legs).recorded if t not in topics.LATCHED])
    profiles = {**dict.fromkeys(topics.LATCHED, LATCHED), **dict.fromkeys(others, qos)}
    if clock:
        profiles[topics.CLOCK] = CLOCK
    queue = PublishQueue()
    publishers: dict[Topic, TopicPublisher] = {}
    names: dict[Topic, str] = {}
    for topic, profile in profiles.items():
        names[topic] = resolve(node.get_namespace(), topic.name)
        if topic is not topics.TF or is_installed(topic.type_name):
            kind = message_class(topic.type_name)
            publisher, profiles[topic] = create_publisher(node, kind, names[topic], profile)
            publishers[topic] = queue.add(TopicPublisher(publisher))
    return Publishing(queue, publishers, names, profiles)
