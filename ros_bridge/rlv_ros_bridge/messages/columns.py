"""Messages back to the model's outputs: the inverse of `messages.py`, digit for digit.

Needs no ROS 2.

A message here is anything with the fields of the ROS message: rclpy's own object or one decoded
    from a log.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rlv_landing.errors import LandingError
from rlv_landing.quantities import LEGS

from .axes import from_ros
from .topics import ACCEL, CONTACTS, JOINTS, POSE, RPY, STRUTS, TOP_ACCEL, TWIST

Reading = Callable[[Any], Sequence[float]]


def _struts(message: Any) -> list[float]:
    if tuple(message.name) != JOINTS:
        raise LandingError(
            f"the log's struts are called {', '.join(message.name)}; a landing's are {', '.join(JOINTS)}"
        )
    return [*message.position, *message.velocity, *message.effort]


def _strut_names() -> list[str]:
    struts = [f"leg[{leg}].{strut}" for leg in LEGS for strut in ("main_strut", "auxiliary_strut")]
    return [f"{strut}.{what}" for what in ("stroke", "stroke_rate", "force") for strut in struts]


def _in_plane(vector: Any) -> tuple[float, float]:
    x, y, _ = from_ros(vector.x, vector.y, vector.z)
    return x, y


# topic -> the outputs that its messages carry, and how to read them
READINGS: dict[str, tuple[Sequence[str], Reading]] = {
    STRUTS.name: (_strut_names(), _struts),
    POSE.name: (("body.x", "body.y"), lambda m: _in_plane(m.pose.position)),
    RPY.name: (("body.pitch",), lambda m: (m.vector.y,)),
    TWIST.name: (
        ("body.vx", "body.vy", "body.pitch_rate"),
        lambda m: (*_in_plane(m.twist.linear), m.twist.angular.y),
    ),
    ACCEL.name: (
        ("body.ax", "body.ay", "body.pitch_acceleration"),
        lambda m: (*_in_plane(m.accel.linear), m.accel.angular.y),
    ),
    TOP_ACCEL.name: (("body.top_axial_acceleration",), lambda m: (m.accel.linear.z,)),
    **{
        topic.name: (
            tuple(f"leg[{leg}].contact.force_{axis}" for axis in "xyz"),
            lambda m: from_ros(m.wrench.force.x, m.wrench.force.y, m.wrench.force.z),
        )
        for leg, topic in zip(LEGS, CONTACTS)
    },
}

COLUMN_NAMES: tuple[str, ...] = tuple(name for names, _ in READINGS.values() for name in names)


def sample_columns(messages: Mapping[str, Any]) -> dict[str, float]:
    """The outputs that `messages` (relative topic name -> message, of one instant) carry, by name."""
    values: dict[str, float] = {}
    for topic, message in messages.items():
        if topic in READINGS:
            names, reading = READINGS[topic]
            values.update(zip(names, reading(message)))
    return values
