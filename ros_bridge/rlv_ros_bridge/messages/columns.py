"""Reads the model's outputs back from messages, digit for digit: the inverse of `samples.py`.

Made from `fields.FIELDS`. Needs no ROS 2: a message is anything with the fields of the ROS message,
rclpy's own object or one decoded from a log.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter
from typing import Any

from rlv_landing.errors import LandingError

from .fields import TOPIC_FIELDS, Conversion, Field, split
from .topics import JOINTS, STRUTS

Reading = Callable[[Any], Sequence[float]]


def _getter(path: str) -> Callable[[Any], float]:
    owner, key = split(path)
    if not isinstance(key, int):
        return attrgetter(path)
    elements, index = attrgetter(owner), key

    def element(message: Any) -> float:
        try:
            return float(elements(message)[index])
        except IndexError:
            raise LandingError(
                f"a message has {len(elements(message))} elements of {owner}; "
                f"a landing's has {path}: the log was made by another program"
            ) from None

    return element


def _check_joints(message: Any) -> None:
    if tuple(message.name) != JOINTS:
        raise LandingError(
            f"the log's struts are called {', '.join(message.name)}; "
            f"a landing's are {', '.join(JOINTS)}"
        )


def _reading(topic: str, fields: Sequence[Field]) -> tuple[tuple[str, ...], Reading]:
    """The outputs that are read back from the messages of `topic`, and how."""
    reads: list[tuple[Conversion, list[Callable[[Any], float]]]] = [
        (f.read, [_getter(path) for path in f.paths]) for f in fields if f.read is not None
    ]
    outputs = tuple(name for f in fields if f.read is not None for name in f.outputs)

    def read(message: Any) -> list[float]:
        if topic == STRUTS.name:
            _check_joints(message)
        return [
            number
            for convert, getters in reads
            for number in convert(*[get(message) for get in getters])
        ]

    return outputs, read


# Relative topic name -> the outputs that are read back from its messages, and how. A reading raises
# LandingError for struts of another vehicle.
READINGS: dict[str, tuple[tuple[str, ...], Reading]] = {
    topic: _reading(topic, fields)
    for topic, fields in TOPIC_FIELDS.items()
    if any(f.read is not None for f in fields)
}

COLUMN_NAMES: tuple[str, ...] = tuple(name for names, _ in READINGS.values() for name in names)


def sample_columns(messages: Mapping[str, Any]) -> dict[str, float]:
    """The outputs that the messages of one instant carry.

    Args:
        messages: relative topic name -> message. Topics without outputs are passed over.

    Returns:
        Output name -> value, SI, the paper's axes.
    """
    values: dict[str, float] = {}
    for topic, message in messages.items():
        if topic in READINGS:
            names, read = READINGS[topic]
            values.update(zip(names, read(message)))
    return values
