"""Reads the model's outputs back from messages, digit for digit: the inverse of `samples.py`.

Made from the table of fields. Needs no ROS 2: a message is anything with the fields of the ROS
message, rclpy's own object or one decoded from a log.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from operator import attrgetter
from typing import Any

from rlv_landing.errors import LandingError
from rlv_landing.quantities import Interface

from .fields import IN_A_PLANE, Conversion, Field
from .tables import split, table_of
from .topics import POSE, STRUTS

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


def _check_joints(message: Any, joints: tuple[str, ...]) -> None:
    if tuple(message.name) != joints:
        raise LandingError(
            f"the log's struts are called {', '.join(message.name)}; "
            f"a landing's are {', '.join(joints)}"
        )


def _check_in_plane(message: Any) -> None:
    """Checks that a pose is one of a symmetric landing."""
    place, turn = message.pose.position, message.pose.orientation
    if place.y or turn.x or turn.z:
        raise LandingError(
            "the vehicle leaves its plane: this is a landing in space, which is read with its "
            "parameters only; a log of rlv-landing's node carries them"
        )


def _reading(
    topic: str, fields: Sequence[Field], joints: tuple[str, ...], *, in_space: bool
) -> tuple[tuple[str, ...], Reading]:
    """The outputs that are read back from the messages of `topic`, and how."""
    reads: list[tuple[Conversion, list[Callable[[Any], float]]]] = [
        (f.read, [_getter(path) for path in f.paths]) for f in fields if f.read is not None
    ]
    outputs = tuple(name for f in fields if f.read is not None for name in f.outputs)

    def read(message: Any) -> list[float]:
        if topic == STRUTS.name:
            _check_joints(message, joints)
        elif topic == POSE.name and not in_space:
            _check_in_plane(message)
        return [
            number
            for convert, getters in reads
            for number in convert(*[get(message) for get in getters])
        ]

    return outputs, read


# Relative topic name -> the outputs that are read back from its messages, and how. A reading raises
# LandingError for struts of another vehicle.
Readings = Mapping[str, tuple[tuple[str, ...], Reading]]


@cache
def readings_of(interface: Interface) -> Readings:
    """How the outputs of a landing with this interface are read back."""
    table = table_of(interface)
    return {
        topic: _reading(topic, fields, table.topics.joints, in_space=interface.in_space)
        for topic, fields in table.fields_of.items()
        if any(f.read is not None for f in fields)
    }


# Those of symmetric landings.
READINGS: Readings = readings_of(IN_A_PLANE)
COLUMN_NAMES: tuple[str, ...] = tuple(name for names, _ in READINGS.values() for name in names)


def sample_columns(
    messages: Mapping[str, Any], interface: Interface = IN_A_PLANE
) -> dict[str, float]:
    """The outputs that the messages of one instant carry.

    Args:
        messages: relative topic name -> message. Topics without outputs are passed over.
        interface: the landing's.

    Returns:
        Output name -> value, SI, the paper's axes.
    """
    values: dict[str, float] = {}
    readings = readings_of(interface)
    for topic, message in messages.items():
        if topic in readings:
            names, read = readings[topic]
            values.update(zip(names, read(message)))
    return values
