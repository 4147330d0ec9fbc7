"""The vehicle's frames for `/tf`: the body in the map, and the links on it as in the URDF.

Needs no ROS 2.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, sin
from xml.etree import ElementTree

from rlv_landing.parameters import Parameters

from .axes import IN_PLANE, pitch_quaternion, ros_quaternion, to_ros
from .fields import PLACE, QUATERNION, strut_outputs
from .robot_description import robot_description
from .tables import table_of
from .topics import BODY_FRAME, ODOM_FRAME, WORLD_FRAME, framed
from .wire import NANOSECONDS, SENTINEL_STAMP, MessageLayout, padded, sentinel_numbers

Point = tuple[float, float, float]
Turn = tuple[float, float, float, float]
# Encapsulation of plain CDR, little-endian.
NOWHERE, NO_TURN = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
LITTLE_ENDIAN_CDR = b"\x00\x01\x00\x00"


@dataclass(frozen=True)
class Transform:
    """The frame `child` in `parent`: translation x, y, z [m] and rotation x, y, z, w."""

    parent: str
    child: str
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]


class Transforms:
    """Makes the messages of `/tf`: `map` to `odom` to `base_link`, and every joint of the URDF.

    A strut's joint is moved by its stroke. The frames of the footpads, in which the contact forces
    are given, are in `odom` and have its axes.

    Args:
        parameters: the vehicle.
        frame_prefix: is put before the names of its frames.
    """

    def __init__(self, parameters: Parameters, frame_prefix: str = "") -> None:
        joints = list(ElementTree.fromstring(robot_description(parameters)).iter("joint"))
        interface = parameters.interface
        table, legs = table_of(interface), interface.legs
        names, pads = table.topics.joints, table.topics.footpad_frames
        self._in_space = interface.in_space
        own = (*PLACE, *QUATERNION) if self._in_space else ("body.x", "body.y", "body.pitch")
        self._body = table.indices(*own)
        self._strokes = table.indices(*strut_outputs("stroke", legs, interface.leg_kind))
        self._lengths = [
            _vector(j, "xyz")[2] for name in names for j in joints if j.get("name") == name
        ]
        self._footpads = [
            table.indices(*(f"leg[{leg}].footpad.{axis}" for axis in "xyz")) for leg in legs
        ]
        count = len(self._pose([1.0] * len(interface.outputs)))
        sentinels = sentinel_numbers(count + len(names) + 3 * len(legs))
        moved = dict(zip(names, sentinels[count:]))
        feet = sentinels[count + len(names) :]
        frames = [
            Transform(WORLD_FRAME, ODOM_FRAME, NOWHERE, NO_TURN),
            Transform(ODOM_FRAME, BODY_FRAME, *self._placed(sentinels[:count])),
            *(_transform(joint, moved) for joint in joints),
            *(
                Transform(ODOM_FRAME, frame, (feet[i], feet[i + 1], feet[i + 2]), NO_TURN)
                for frame, i in zip(pads, range(0, len(feet), 3))
            ),
        ]
        frames = [
            replace(t, parent=framed(frame_prefix, t.parent), child=framed(frame_prefix, t.child))
            for t in frames
        ]
        self._layout = MessageLayout([serialised(frames, SENTINEL_STAMP)], sentinels)

    def _pose(self, values: Sequence[float]) -> list[float]:
        """The numbers of the body's place and attitude that are not 0 in every sample."""
        if self._in_space:
            x, y, z, *quaternion = (values[i] for i in self._body)
            return [*to_ros(x, y, z), *ros_quaternion(*quaternion)]
        x, y, pitch = (values[i] for i in self._body)
        forward, _, up = to_ros(x, y, IN_PLANE)
        _, qy, _, qw = pitch_quaternion(pitch)
        return [forward, up, qy, qw]

    def _placed(self, pose: Sequence[float]) -> tuple[Point, Turn]:
        """Translation and rotation of the body by the numbers of `_pose`."""
        if self._in_space:
            x, y, z, qx, qy, qz, qw = pose
            return (x, y, z), (qx, qy, qz, qw)
        x, z, qy, qw = pose
        return (x, 0.0, z), (0.0, qy, 0.0, qw)

    def pack(self, nanoseconds: int, values: Sequence[float]) -> bytes:
        """The message of a sample, serialised.

        Args:
            nanoseconds: simulation time of the sample [ns].
            values: all outputs in the order of the vehicle's interface, SI, the paper's axes.
        """
        struts = [length - values[i] for length, i in zip(self._lengths, self._strokes)]
        feet = (n for at in self._footpads for n in to_ros(*(values[i] for i in at)))
        return self._layout.pack(nanoseconds, [*self._pose(values), *struts, *feet])


def serialised(transforms: Sequence[Transform], nanoseconds: int) -> bytes:
    """A `tf2_msgs/msg/TFMessage` of `transforms`, all at the stamp `nanoseconds`, in CDR."""
    data = bytearray(struct.pack("<I", len(transforms)))
    for t in transforms:
        data += bytes(-len(data) % 4) + struct.pack("<iI", *divmod(nanoseconds, NANOSECONDS))
        for text in (t.parent.encode(), t.child.encode()):
            data += bytes(-len(data) % 4) + struct.pack("<I", len(text) + 1) + text + b"\0"
        data += bytes(-len(data) % 8) + struct.pack("<7d", *t.translation, *t.rotation)
    return padded(LITTLE_ENDIAN_CDR + bytes(data))


def _transform(joint: ElementTree.Element, moved: dict[str, float]) -> Transform:
    parent, child = (joint.find(end) for end in ("parent", "child"))
    assert parent is not None
    assert child is not None
    x, y, z = _vector(joint, "xyz")
    translation = (x, y, moved.get(joint.attrib["name"], z))
    rotation = _quaternion(*_vector(joint, "rpy"))
    return Transform(parent.attrib["link"], child.attrib["link"], translation, rotation)


def _vector(joint: ElementTree.Element, name: str) -> tuple[float, float, float]:
    origin = joint.find("origin")
    assert origin is not None
    x, y, z = map(float, origin.attrib[name].split())
    return x, y, z


def _quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """The rotation (x, y, z, w) by URDF's angles: about the parent's x, then its y, then its z."""
    (sr, cr), (sp, cp), (sy, cy) = (
        (sin(0.5 * angle), cos(0.5 * angle)) for angle in (roll, pitch, yaw)
    )
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
