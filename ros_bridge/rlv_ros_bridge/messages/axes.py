"""The one place where the paper's axes are turned into ROS's, and back.

The paper: x forward, y up, z right, pitch clockwise positive in the x-y plane. ROS (REP-103): x
forward, y left, z up. So the paper's pitch is a positive turn about ROS +y: nose down.
"""

from __future__ import annotations

from math import cos, sin

from rlv_landing.core.records import Vector
from rlv_landing.core.vectors import added, cross, rotation, to_body, to_inertial

# The coordinate across the body's plane. With this sign it turns into 0.0, not -0.0.
IN_PLANE = -0.0


def to_ros(x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of the paper's axes in ROS axes; exact: no digit changes."""
    return x, -z, y


def from_ros(x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of ROS axes in the paper's axes: the inverse of `to_ros`."""
    return x, z, -y


def pitch_quaternion(pitch: float) -> tuple[float, float, float, float]:
    """The attitude (x, y, z, w) in ROS axes of a body at the paper's `pitch` [rad]."""
    return 0.0, sin(0.5 * pitch), 0.0, cos(0.5 * pitch)


def world_to_body(x: float, z: float, pitch: float) -> tuple[float, float]:
    """A vector in the body's plane, from the frame of the map to that of the body.

    Args:
        x: forward in the map, ROS axes.
        z: up in the map, ROS axes.
        pitch: the body's, clockwise positive [rad].

    Returns:
        The vector's x and z in the body's frame, ROS axes, in the unit of `x` and `z`.
    """
    s, c = sin(pitch), cos(pitch)
    return c * x - s * z, s * x + c * z


def specific_force(ax: float, ay: float, pitch: float, gravity: float) -> tuple[float, float]:
    """What an accelerometer at the CG feels: the acceleration less that of gravity. Derived.

    Args:
        ax: acceleration of the CG forward in the map [m/s2].
        ay: acceleration of the CG up [m/s2].
        pitch: the body's, clockwise positive [rad].
        gravity: gravitational acceleration [m/s2].

    Returns:
        Its x and z in the body's frame, ROS axes [m/s2].
    """
    return world_to_body(ax, ay + gravity, pitch)


def top_specific_force(
    ax: float, ay: float, pitch: float, *turning_and_place: float
) -> tuple[float, float]:
    """What an accelerometer at the top of the rigid body feels. Derived.

    Args:
        ax: acceleration of the CG forward in the map [m/s2].
        ay: acceleration of the CG up [m/s2].
        pitch: the body's, clockwise positive [rad].
        turning_and_place: rate [rad/s] and acceleration [rad/s2] of the pitch, gravitational
            acceleration [m/s2], and the sensor's height above the CG along the body's axis [m].

    Returns:
        Its x and z in the body's frame, ROS axes [m/s2].
    """
    rate, acceleration, gravity, height = turning_and_place
    x, z = specific_force(ax, ay, pitch, gravity)
    return x + acceleration * height, z - rate * rate * height


def xyz(path: str) -> tuple[str, str, str]:
    """The fields of the vector at `path` of a message, in the order of `to_ros`."""
    return f"{path}.x", f"{path}.y", f"{path}.z"


def xyzw(path: str) -> tuple[str, str, str, str]:
    """The fields of the quaternion at `path` of a message, in the order of `pitch_quaternion`."""
    return f"{path}.x", f"{path}.y", f"{path}.z", f"{path}.w"


def in_plane(path: str) -> tuple[str, str]:
    """The fields that the paper's x and y (up) are in the vector at `path` of a message."""
    return f"{path}.x", f"{path}.z"


def about_pitch(path: str) -> tuple[str]:
    """The field that a turn or moment in the pitch's sense is in the vector at `path`."""
    return (f"{path}.y",)


def ros_quaternion(w: float, x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """The attitude (x, y, z, w) in ROS axes of a body at the paper's quaternion; exact."""
    return *to_ros(x, y, z), w


def paper_quaternion(x: float, y: float, z: float, w: float) -> tuple[float, float, float, float]:
    """The inverse of `ros_quaternion`."""
    return w, *from_ros(x, y, z)


def in_map(x: float, y: float, z: float, *quaternion: float) -> tuple[float, float, float]:
    """A vector of the body's frame in that of the map, ROS axes.

    Args:
        x: in the paper's axes.
        y: in the paper's axes.
        z: in the paper's axes.
        quaternion: the body's attitude w, x, y, z in the paper's axes.
    """
    return to_ros(*to_inertial(rotation(*quaternion), Vector(x, y, z)))


def in_body(x: float, y: float, z: float, *quaternion: float) -> tuple[float, float, float]:
    """A vector of the map in the body's frame, ROS axes; arguments as of `in_map`."""
    return to_ros(*to_body(rotation(*quaternion), Vector(x, y, z)))


def spatial_specific_force(
    ax: float, ay: float, az: float, *attitude_and_gravity: float
) -> tuple[float, float, float]:
    """What an accelerometer at the CG of a body in space feels, in the body's frame. Derived.

    Args:
        ax: acceleration of the CG in the paper's axes [m/s2].
        ay: up [m/s2].
        az: to the right [m/s2].
        attitude_and_gravity: the quaternion w, x, y, z, and the gravitational acceleration [m/s2].

    Returns:
        x, y, z in ROS axes [m/s2].
    """
    *quaternion, gravity = attitude_and_gravity
    return in_body(ax, ay + gravity, az, *quaternion)


def spatial_top_specific_force(*numbers: float) -> tuple[float, float, float]:
    """What an accelerometer at the top of a body in space feels, in the body's frame. Derived.

    Args:
        numbers: acceleration of the CG x, y, z [m/s2], the quaternion w, x, y, z, angular velocity
            [rad/s] and angular acceleration [rad/s2] in body axes, all in the paper's axes; the
            gravitational acceleration [m/s2], and the sensor's height above the CG [m].

    Returns:
        x, y, z in ROS axes [m/s2].
    """
    gravity, height = numbers[13:]
    up, spin, turning = Vector(0.0, height, 0.0), Vector(*numbers[7:10]), Vector(*numbers[10:13])
    by_turning = to_ros(*added(cross(turning, up), cross(spin, cross(spin, up))))
    x, y, z = spatial_specific_force(*numbers[:7], gravity)
    return x + by_turning[0], y + by_turning[1], z + by_turning[2]
