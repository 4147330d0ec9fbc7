"""The table of the outputs that the fields of messages carry: `FIELDS`, and in space `in_space`.

Messages are filled and packed by it (`samples.py`) and read back (`columns.py`), and `log verify`
compares logs with it (`expected_fields`). A line here adds an output to a message. Needs no ROS 2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS, MODES, RADIAL, Interface, interface_of

from .axes import (
    about_pitch,
    from_ros,
    in_body,
    in_map,
    in_plane,
    paper_quaternion,
    pitch_quaternion,
    ros_quaternion,
    spatial_specific_force,
    spatial_top_specific_force,
    specific_force,
    to_ros,
    top_specific_force,
    world_to_body,
    xyz,
    xyzw,
)
from .topics import (
    ACCEL,
    IMU,
    ODOM,
    POSE,
    RPY,
    STRUTS,
    STRUTS_OF,
    TOP_ACCEL,
    TOP_IMU,
    TWIST,
    Topic,
    topics_of,
)

Conversion = Callable[..., Sequence[float]]
# the interface of symmetric landings
IN_A_PLANE = interface_of(min(MODES))


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
        interface: its outputs.
    """

    gravity: float
    top_height: float
    frame_prefix: str = ""
    interface: Interface = IN_A_PLANE

    @classmethod
    def of(cls, parameters: Parameters, frame_prefix: str = "") -> Vehicle:
        """That of the model's `parameters`."""
        vehicle = parameters.vehicle
        interface = parameters.interface
        return cls(parameters.ground.gravity, vehicle.top_height, frame_prefix, interface)


@dataclass(frozen=True)
class Field:
    """Fields of one message that are made of some outputs.

    Args:
        topic: one of `LegTopics.sampled`.
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


def strut_outputs(quantity: str, legs: Sequence[int] = LEGS, kind: str = RADIAL) -> tuple[str, ...]:
    """The outputs that are the struts' `quantity`, in the order of `LegTopics.joints`."""
    return tuple(f"leg[{leg}].{strut}.{quantity}" for leg in legs for strut in STRUTS_OF[kind])


def elements(path: str, count: int) -> tuple[str, ...]:
    """The paths of the elements of an array."""
    return tuple(f"{path}[{i}]" for i in range(count))


def _struts(legs: Sequence[int], kind: str = RADIAL) -> tuple[Field, ...]:
    count = len(STRUTS_OF[kind]) * len(legs)
    return tuple(
        Field(STRUTS, elements(what, count), strut_outputs(quantity, legs, kind))
        for what, quantity in (
            ("position", "stroke"),
            ("velocity", "stroke_rate"),
            ("effort", "force"),
        )
    )


def _contacts(legs: tuple[int, ...]) -> tuple[Field, ...]:
    return tuple(
        Field(
            topic,
            xyz("wrench.force"),
            tuple(f"leg[{leg}].contact.force_{axis}" for axis in "xyz"),
            write=to_ros,
            read=from_ros,
        )
        for leg, topic in zip(legs, topics_of(legs).contacts)
    )


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
    *_struts(LEGS),
    Field(POSE, in_plane("pose.position"), ("body.x", "body.y")),
    Field(POSE, xyzw("pose.orientation"), ("body.pitch",), write=pitch_quaternion, read=None),
    Field(RPY, about_pitch("vector"), ("body.pitch",)),
    Field(TWIST, in_plane("twist.linear"), ("body.vx", "body.vy")),
    Field(TWIST, about_pitch("twist.angular"), ("body.pitch_rate",)),
    Field(ACCEL, in_plane("accel.linear"), ("body.ax", "body.ay")),
    Field(ACCEL, about_pitch("accel.angular"), ("body.pitch_acceleration",)),
    Field(TOP_ACCEL, ("accel.linear.z",), ("body.top_axial_acceleration",)),
    *_contacts(LEGS),
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

PLACE = ("body.x", "body.y", "body.z")
QUATERNION = tuple(f"body.q_{part}" for part in "wxyz")
SPEED = ("body.vx", "body.vy", "body.vz")
ACCELERATION = ("body.ax", "body.ay", "body.az")
SPIN, TURNING = (
    tuple(f"body.{what}_{axis}" for axis in "xyz") for what in ("spin", "spin_acceleration")
)


def _spatial_imu(
    topic: Topic, write: Conversion, outputs: tuple[str, ...], constants: tuple[str, ...]
) -> tuple[Field, ...]:
    """As `_imu`, of a body in space."""
    orientation, force = xyzw("orientation"), xyz("linear_acceleration")
    return (
        Field(topic, orientation, QUATERNION, write=ros_quaternion, read=None),
        Field(topic, xyz("angular_velocity"), SPIN, write=to_ros, read=None),
        Field(topic, force, outputs, write=write, read=None, constants=constants),
    )


def in_space(legs: tuple[int, ...], kind: str = RADIAL) -> tuple[Field, ...]:
    """The table of a landing in space on these `legs` of a kind.

    `rpy` has the landing's own angles, which need not be those that REP-103 makes of the attitude.
    The spin is read back from odometry, whose twist is in the body's frame, as the model has it.
    """
    turned_pose, turned_odom = xyzw("pose.orientation"), xyzw("pose.pose.orientation")
    linear, angular = xyz("twist.twist.linear"), xyz("twist.twist.angular")
    return (
        *_struts(legs, kind),
        Field(POSE, xyz("pose.position"), PLACE, write=to_ros, read=from_ros),
        Field(POSE, turned_pose, QUATERNION, write=ros_quaternion, read=paper_quaternion),
        Field(RPY, xyz("vector"), ("body.roll", "body.pitch", "body.heading")),
        Field(TWIST, xyz("twist.linear"), SPEED, write=to_ros, read=from_ros),
        Field(TWIST, xyz("twist.angular"), (*SPIN, *QUATERNION), write=in_map, read=None),
        Field(ACCEL, xyz("accel.linear"), ACCELERATION, write=to_ros, read=from_ros),
        Field(ACCEL, xyz("accel.angular"), (*TURNING, *QUATERNION), write=in_map, read=None),
        Field(TOP_ACCEL, ("accel.linear.z",), ("body.top_axial_acceleration",)),
        *_contacts(legs),
        Field(ODOM, xyz("pose.pose.position"), PLACE, write=to_ros, read=None),
        Field(ODOM, turned_odom, QUATERNION, write=ros_quaternion, read=None),
        Field(ODOM, linear, (*SPEED, *QUATERNION), write=in_body, read=None),
        Field(ODOM, angular, SPIN, write=to_ros, read=from_ros),
        *_spatial_imu(IMU, spatial_specific_force, (*ACCELERATION, *QUATERNION), ("gravity",)),
        *_spatial_imu(
            TOP_IMU,
            spatial_top_specific_force,
            (*ACCELERATION, *QUATERNION, *SPIN, *TURNING),
            ("gravity", "top_height"),
        ),
    )
