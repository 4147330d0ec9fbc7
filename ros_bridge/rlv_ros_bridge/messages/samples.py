"""A sample of the landing as ROS messages: SI units, REP-103 axes, stamps in simulation time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import AccelStamped, PoseStamped, TwistStamped, Vector3Stamped, WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from rlv_landing.quantities import LEGS, OUTPUT_NAMES

from . import topics
from .axes import IN_PLANE, pitch_quaternion, to_ros, world_to_body
from .topics import BODY_FRAME, JOINTS, TOP_FRAME, WORLD_FRAME, Topic
from .wire import NANOSECONDS as NANOSECONDS
from .wire import PROBE_STAMP, WireFrame, probe_numbers

INDEX = {name: i for i, name in enumerate(OUTPUT_NAMES)}


def set_stamp(stamp: Time, nanoseconds: int) -> None:
    """Sets a stamp from a count of nanoseconds."""
    stamp.sec, stamp.nanosec = divmod(nanoseconds, NANOSECONDS)


def set_vector(target: Any, vector: tuple[float, float, float]) -> None:
    """Sets x, y, z of a Point or Vector3."""
    target.x, target.y, target.z = vector


def columns(*names: str) -> tuple[int, ...]:
    """Where the outputs `names` stand in a sample."""
    return tuple(INDEX[name] for name in names)


def strut_columns(what: str) -> tuple[int, ...]:
    """Where the eight struts' `what` stands in a sample, in the order of `JOINTS`."""
    return columns(
        *(
            f"leg[{leg}].{strut}.{what}"
            for leg in LEGS
            for strut in ("main_strut", "auxiliary_strut")
        )
    )


class SampleMessages:
    """The messages that go out at every step.

    The message objects are made once and filled again for each sample.
    """

    def __init__(self) -> None:
        self._position = strut_columns("stroke")
        self._velocity = strut_columns("stroke_rate")
        self._effort = strut_columns("force")
        self._body = columns(
            "body.x", "body.y", "body.pitch", "body.vx", "body.vy", "body.pitch_rate"
        )
        self._acceleration = columns(
            "body.ax", "body.ay", "body.pitch_acceleration", "body.top_axial_acceleration"
        )
        self._contact = [
            columns(*(f"leg[{leg}].contact.force_{axis}" for axis in "xyz")) for leg in LEGS
        ]
        self.struts = JointState(name=list(JOINTS))
        self.pose = PoseStamped()
        self.rpy = Vector3Stamped()
        self.twist = TwistStamped()
        self.accel = AccelStamped()
        self.top_accel = AccelStamped()
        self.contacts = [WrenchStamped() for _ in LEGS]
        self.odom = Odometry(child_frame_id=BODY_FRAME)
        self.clock = Clock()
        self.struts.header.frame_id = BODY_FRAME
        self.top_accel.header.frame_id = TOP_FRAME
        for message in (self.pose, self.rpy, self.twist, self.accel, self.odom, *self.contacts):
            message.header.frame_id = WORLD_FRAME
        self.messages: tuple[tuple[Topic, Any], ...] = (
            (topics.STRUTS, self.struts),
            (topics.POSE, self.pose),
            (topics.RPY, self.rpy),
            (topics.TWIST, self.twist),
            (topics.ACCEL, self.accel),
            (topics.TOP_ACCEL, self.top_accel),
            *zip(topics.CONTACTS, self.contacts),
            (topics.ODOM, self.odom),
        )
        # One stamp object for all: setting it stamps every message.
        self._stamp = Time()
        self.clock.clock = self._stamp
        for _, message in self.messages:
            message.header.stamp = self._stamp

    def fill(self, nanoseconds: int, values: Sequence[float]) -> None:
        """Take the sample `values` (in the order of `OUTPUT_NAMES`) at the simulation time
        `nanoseconds`.
        """
        set_stamp(self._stamp, nanoseconds)
        struts = self.struts
        struts.position = [values[i] for i in self._position]
        struts.velocity = [values[i] for i in self._velocity]
        struts.effort = [values[i] for i in self._effort]
        self._fill_motion(*(values[i] for i in self._body))
        ax, ay, pitch_acceleration, top = (values[i] for i in self._acceleration)
        set_vector(self.accel.accel.linear, to_ros(ax, ay, IN_PLANE))
        self.accel.accel.angular.y = pitch_acceleration
        self.top_accel.accel.linear.z = top
        for contact, (x, y, z) in zip(self.contacts, self._contact):
            set_vector(contact.wrench.force, to_ros(values[x], values[y], values[z]))

    def _fill_motion(
        self, x: float, y: float, pitch: float, vx: float, vy: float, pitch_rate: float
    ) -> None:
        position, velocity = to_ros(x, y, IN_PLANE), to_ros(vx, vy, IN_PLANE)
        qx, qy, qz, qw = pitch_quaternion(pitch)
        for pose in (self.pose.pose, self.odom.pose.pose):
            set_vector(pose.position, position)
            q = pose.orientation
            q.x, q.y, q.z, q.w = qx, qy, qz, qw
        self.rpy.vector.y = pitch
        set_vector(self.twist.twist.linear, velocity)
        self.twist.twist.angular.y = pitch_rate
        # Odometry's twist is in the child frame, by its own definition.
        twist = self.odom.twist.twist
        twist.linear.x, twist.linear.z = world_to_body(velocity[0], velocity[2], pitch)
        twist.angular.y = pitch_rate


class SampleBytes:
    """The serialised messages of `SampleMessages` without the message objects: the same bytes, at a
    fraction of the cost.

    `topics` are in the order of the messages; `places` tell where each one's message stands in what
    `pack` gives, `heads`, by topic, what comes before it (see `WireFrame`).
    """

    def __init__(self, heads: Mapping[Topic, bytes] | None = None) -> None:
        messages = SampleMessages()
        probe = probe_numbers(len(OUTPUT_NAMES))
        messages.fill(PROBE_STAMP, probe)
        self._pitch, self._vx, self._vy = columns("body.pitch", "body.vx", "body.vy")
        self._turned = columns(*(f"leg[{leg}].contact.force_z" for leg in LEGS))
        self.topics: tuple[Topic, ...] = (topics.CLOCK, *(topic for topic, _ in messages.messages))
        sent = (messages.clock, *(message for _, message in messages.messages))
        begun = [(heads or {}).get(topic, b"") for topic in self.topics]
        self._frame = WireFrame([serialize_message(m) for m in sent], self._numbers(probe), begun)
        self.places = self._frame.places

    def _numbers(self, values: Sequence[float]) -> list[float]:
        """The sample, and after it what the messages carry that is not in it."""
        pitch = values[self._pitch]
        _, qy, _, qw = pitch_quaternion(pitch)
        vx, _, vz = to_ros(values[self._vx], values[self._vy], IN_PLANE)
        return [
            *values,
            qy,
            qw,
            *world_to_body(vx, vz, pitch),
            *[to_ros(0.0, 0.0, values[i])[1] for i in self._turned],
        ]

    def pack(self, nanoseconds: int, values: Sequence[float], count: int = 0) -> bytes:
        """The messages of the sample `values` at the simulation time `nanoseconds`; `count` is for
        their heads.
        """
        return self._frame.pack(nanoseconds, self._numbers(values), count)
