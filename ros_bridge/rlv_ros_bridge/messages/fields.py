"""`FIELDS`, the table of the outputs that the fields of messages carry.

Messages are filled and packed by it (`samples.py`) and read back (`columns.py`), and `log verify`
compares logs with it (`expected_fields`). A line here adds an output to a message. Needs no ROS 2.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS, OUTPUT_NAMES

from .axes import (
    about_pitch,
    from_ros,
    in_plane,
    pitch_quaternion,
    specific_force,
    to_ros,
    top_specific_force,
    world_to_body,
    xyz,
    xyzw,
)
from .topics import (
    ACCEL,
    BODY_FRAME,
    CONTACTS,
    FOOTPAD_FRAMES,
    IMU,
    JOINTS,
    ODOM,
    ODOM_FRAME,
    POSE,
    RPY,
    SAMPLED,
    STRUTS,
    TOP_ACCEL,
    TOP_FRAME,
    TOP_IMU,
    TWIST,
    WORLD_FRAME,
    Topic,
    framed,
)
from .wire import NANOSECONDS

Conversion = Callable[..., Sequence[float]]
INDEX = {name: i for i, name in enumerate(OUTPUT_NAMES)}
ELEMENT = re.compile(r"(.+)\[(\d+)\]")


def copied(*numbers: float) -> tuple[float, ...]:
    """The conversion that changes nothing: each field is the output at the same position."""
    return numbers


@dataclass(frozen=True)
class Vehicle:
    """What messages tell of a vehicle beside its outputs.

    Args:
        gravity: gravitational acceleration [m/s2].
        top_height: of the top sensor above the CG [m].
        frame_prefix: is put before the names of its frames.
    """

    gravity: float
    top_height: float
    frame_prefix: str = ""

    @classmethod
    def of(cls, parameters: Parameters, frame_prefix: str = "") -> Vehicle:
        """That of the model's `parameters`."""
        return cls(parameters.ground.gravity, parameters.vehicle.top_height, frame_prefix)


@dataclass(frozen=True)
class Field:
    """Fields of one message that are made of some outputs.

    Args:
        topic: one of `topics.SAMPLED`.
        paths: the fields, all float64: `pose.position.x`, or `position[3]` of an array.
        outputs: the outputs that the fields are made of, SI, the paper's axes.
        write: gives a number for each of `paths` from the values of `outputs`; SI, ROS axes. Its
            result must follow from its arguments alone.
        read: the inverse of `write`, digit for digit. None: the outputs are not read back from
            these fields. Each output is read back from one field only.
        constants: attributes of `Vehicle` that `write` gets after them.
    """

    topic: Topic
    paths: tuple[str, ...]
    outputs: tuple[str, ...]
    write: Conversion = copied
    read: Conversion | None = copied
    constants: tuple[str, ...] = ()

    def conversion(self, vehicle: Vehicle) -> Conversion:
        """Gives a number for each of `paths` from the values of `outputs`, for `vehicle`."""
        if not self.constants:
            return self.write
        constants = tuple(getattr(vehicle, name) for name in self.constants)
        return lambda *values: self.write(*values, *constants)


def strut_outputs(quantity: str) -> tuple[str, ...]:
    """The outputs that are the struts' `quantity`, in the order of `JOINTS`."""
    struts = ("main_strut", "auxiliary_strut")
    return tuple(f"leg[{leg}].{strut}.{quantity}" for leg in LEGS for strut in struts)


def _elements(path: str) -> tuple[str, ...]:
    return tuple(f"{path}[{i}]" for i in range(len(JOINTS)))


def _contact(leg: int, topic: Topic) -> Field:
    force = tuple(f"leg[{leg}].contact.force_{axis}" for axis in "xyz")
    return Field(topic, xyz("wrench.force"), force, write=to_ros, read=from_ros)


def _imu(
    topic: Topic, write: Conversion, outputs: tuple[str, ...], constants: tuple[str, ...]
) -> tuple[Field, ...]:
    """An inertial sensor by REP-145: its attitude in the map, the rest in its own frame."""
    orientation, force = xyzw("orientation"), in_plane("linear_acceleration")
    return (
        Field(topic, orientation, ("body.pitch",), write=pitch_quaternion, read=None),
        Field(topic, about_pitch("angular_velocity"), ("body.pitch_rate",), read=None),
        Field(topic, force, outputs, write=write, read=None, constants=constants),
    )


# Columns of logs are in this order. Odometry repeats what other topics carry, so it is not read
# back. Its twist is in the body's frame, by nav_msgs/Odometry's definition.
FIELDS: tuple[Field, ...] = (
    Field(STRUTS, _elements("position"), strut_outputs("stroke")),
    Field(STRUTS, _elements("velocity"), strut_outputs("stroke_rate")),
    Field(STRUTS, _elements("effort"), strut_outputs("force")),
    Field(POSE, in_plane("pose.position"), ("body.x", "body.y")),
    Field(POSE, xyzw("pose.orientation"), ("body.pitch",), write=pitch_quaternion, read=None),
    Field(RPY, about_pitch("vector"), ("body.pitch",)),
    Field(TWIST, in_plane("twist.linear"), ("body.vx", "body.vy")),
    Field(TWIST, about_pitch("twist.angular"), ("body.pitch_rate",)),
    Field(ACCEL, in_plane("accel.linear"), ("body.ax", "body.ay")),
    Field(ACCEL, about_pitch("accel.angular"), ("body.pitch_acceleration",)),
    Field(TOP_ACCEL, ("accel.linear.z",), ("body.top_axial_acceleration",)),
    *(_contact(leg, topic) for leg, topic in zip(LEGS, CONTACTS)),
    Field(ODOM, in_plane("pose.pose.position"), ("body.x", "body.y"), read=None),
    Field(ODOM, xyzw("pose.pose.orientation"), ("body.pitch",), write=pitch_quaternion, read=None),
    Field(
        ODOM,
        in_plane("twist.twist.linear"),
        ("body.vx", "body.vy", "body.pitch"),
        write=world_to_body,
        read=None,
    ),
    Field(ODOM, about_pitch("twist.twist.angular"), ("body.pitch_rate",), read=None),
    *_imu(IMU, specific_force, ("body.ax", "body.ay", "body.pitch"), ("gravity",)),
    *_imu(
        TOP_IMU,
        top_specific_force,
        ("body.ax", "body.ay", "body.pitch", "body.pitch_rate", "body.pitch_acceleration"),
        ("gravity", "top_height"),
    ),
)

# The fields that hold the same text in every sample.
TEXTS: dict[Topic, dict[str, str]] = {
    STRUTS: {"header.frame_id": BODY_FRAME, **dict(zip(_elements("name"), JOINTS))},
    **{t: {"header.frame_id": WORLD_FRAME} for t in (POSE, RPY, TWIST, ACCEL)},
    **{t: {"header.frame_id": frame} for t, frame in zip(CONTACTS, FOOTPAD_FRAMES)},
    IMU: {"header.frame_id": BODY_FRAME},
    **{t: {"header.frame_id": TOP_FRAME} for t in (TOP_ACCEL, TOP_IMU)},
    ODOM: {"header.frame_id": ODOM_FRAME, "child_frame_id": BODY_FRAME},
}

# Relative topic name -> its fields, and the topic.
TOPIC_FIELDS = {t.name: tuple(f for f in FIELDS if f.topic == t) for t in SAMPLED}
_TOPICS = {t.name: t for t in SAMPLED}


def texts(topic: Topic, vehicle: Vehicle) -> dict[str, str]:
    """The texts in every message of `topic`, by path."""
    return {
        path: framed(vehicle.frame_prefix, text) if path.endswith("frame_id") else text
        for path, text in TEXTS.get(topic, {}).items()
    }


def indices(*outputs: str) -> tuple[int, ...]:
    """The positions of `outputs` in a sample, which is in the order of `OUTPUT_NAMES`."""
    return tuple(INDEX[name] for name in outputs)


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
        topic: one of `TOPIC_FIELDS`.
        values: outputs by name, SI, the paper's axes.
        vehicle: what messages tell beside them.

    Returns:
        Path -> number, SI, ROS axes. A field that is not named is 0.
    """
    return {
        path: number
        for field in TOPIC_FIELDS[topic]
        for path, number in zip(
            field.paths, field.conversion(vehicle)(*(values[o] for o in field.outputs))
        )
    }


def expected_fields(
    topic: str, values: Mapping[str, float], nanoseconds: int, vehicle: Vehicle
) -> dict[str, Any]:
    """All fields of the message of `topic` (relative), by path, at the sample `values`.

    Args:
        topic: one of `TOPIC_FIELDS`.
        values: outputs by name, SI, the paper's axes.
        nanoseconds: simulation time of the sample [ns].
        vehicle: what messages tell beside them.

    Returns:
        Path -> number or text. A field that is not named is 0, or empty.
    """
    seconds, rest = divmod(nanoseconds, NANOSECONDS)
    stamp = {"header.stamp.sec": seconds, "header.stamp.nanosec": rest}
    named = texts(_TOPICS[topic], vehicle)
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
