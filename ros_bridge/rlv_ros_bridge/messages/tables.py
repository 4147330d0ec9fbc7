"""The table of fields of each interface, and what it says of a message. Needs no ROS 2."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from rlv_landing.quantities import Interface

from .fields import FIELDS, Field, Vehicle, elements, in_space
from .topics import (
    ACCEL,
    BODY_FRAME,
    IMU,
    ODOM,
    ODOM_FRAME,
    POSE,
    RPY,
    STRUTS,
    TOP_ACCEL,
    TOP_FRAME,
    TOP_IMU,
    TWIST,
    WORLD_FRAME,
    LegTopics,
    Topic,
    framed,
    topics_of,
)
from .wire import NANOSECONDS

ELEMENT = re.compile(r"(.+)\[(\d+)\]")


@dataclass(frozen=True, eq=False)
class Table:
    """What the messages of a landing carry.

    Attributes:
        fields: the fields, in the order of the columns of logs.
        topics: the topics and frames.
        fields_of: relative topic name -> its fields.
        texts: the fields that hold the same text in every sample, by topic.
        index: the position of each output in a sample.
    """

    fields: tuple[Field, ...]
    topics: LegTopics
    fields_of: Mapping[str, tuple[Field, ...]]
    texts: Mapping[Topic, Mapping[str, str]]
    index: Mapping[str, int]

    def indices(self, *outputs: str) -> tuple[int, ...]:
        """The positions of `outputs` in a sample, which is in the interface's order."""
        return tuple(self.index[name] for name in outputs)

    @property
    def needed(self) -> frozenset[str]:
        """The outputs that messages are made of."""
        return frozenset(output for field in self.fields for output in field.outputs)


@cache
def table_of(interface: Interface) -> Table:
    """What the messages of a landing with this interface carry."""
    topics = topics_of(interface.legs, interface.leg_kind)
    fields = FIELDS
    if interface.in_space:
        fields = in_space(interface.legs, interface.leg_kind)
    joints = dict(zip(elements("name", len(topics.joints)), topics.joints))
    return Table(
        fields=fields,
        topics=topics,
        fields_of={t.name: tuple(f for f in fields if f.topic == t) for t in topics.sampled},
        texts={
            STRUTS: {"header.frame_id": BODY_FRAME, **joints},
            **{t: {"header.frame_id": WORLD_FRAME} for t in (POSE, RPY, TWIST, ACCEL)},
            **{
                topic: {"header.frame_id": frame}
                for topic, frame in zip(topics.contacts, topics.footpad_frames)
            },
            IMU: {"header.frame_id": BODY_FRAME},
            **{t: {"header.frame_id": TOP_FRAME} for t in (TOP_ACCEL, TOP_IMU)},
            ODOM: {"header.frame_id": ODOM_FRAME, "child_frame_id": BODY_FRAME},
        },
        index={name: i for i, name in enumerate(interface.output_names)},
    )


def texts(topic: Topic, vehicle: Vehicle) -> dict[str, str]:
    """The texts in every message of `topic`, by path."""
    return {
        path: framed(vehicle.frame_prefix, text) if path.endswith("frame_id") else text
        for path, text in table_of(vehicle.interface).texts.get(topic, {}).items()
    }


def split(path: str) -> tuple[str, str | int]:
    """The path of what holds a field ("" for the message), and the field's name or index in it."""
    element = ELEMENT.fullmatch(path)
    if element:
        return element[1], int(element[2])
    owner, _, name = path.rpartition(".")
    return owner, name


def expected_numbers(topic: str, values: Mapping[str, float], vehicle: Vehicle) -> dict[str, float]:
    """The numbers of the message of `topic` (relative), by path, at the sample `values`.

    Args:
        topic: one of `Table.fields_of`.
        values: outputs by name, SI, the paper's axes.
        vehicle: what messages tell beside them.

    Returns:
        Path -> number, SI, ROS axes. A field that is not named is 0.
    """
    return {
        path: number
        for field in table_of(vehicle.interface).fields_of[topic]
        for path, number in zip(
            field.paths, field.conversion(vehicle)(*(values[o] for o in field.outputs))
        )
    }


def expected_fields(
    topic: str, values: Mapping[str, float], nanoseconds: int, vehicle: Vehicle
) -> dict[str, Any]:
    """All fields of the message of `topic` (relative), by path, at the sample `values`.

    Args:
        topic: one of `Table.fields_of`.
        values: outputs by name, SI, the paper's axes.
        nanoseconds: simulation time of the sample [ns].
        vehicle: what messages tell beside them.

    Returns:
        Path -> number or text. A field that is not named is 0, or empty.
    """
    seconds, rest = divmod(nanoseconds, NANOSECONDS)
    stamp = {"header.stamp.sec": seconds, "header.stamp.nanosec": rest}
    sampled = table_of(vehicle.interface).topics.sampled
    named = texts(next(t for t in sampled if t.name == topic), vehicle)
    return {**expected_numbers(topic, values, vehicle), **named, **stamp}


def leaves(message: Any, at: str = "") -> Iterator[tuple[str, Any]]:
    """Every number and text in a decoded message, by the path to it."""
    if isinstance(message, (list, tuple, array)):
        for i, element in enumerate(message):
            yield from leaves(element, f"{at}[{i}]")
    elif hasattr(message, "__slots__"):
        for name in message.__slots__:
            yield from leaves(getattr(message, name), f"{at}.{name}" if at else name)
    else:
        yield at, message
