"""The one place where the paper's axes are turned into ROS's, and back."""

from __future__ import annotations

from math import cos, sin

# The coordinate across the body's plane. With this sign it turns into 0.0, not -0.0.
IN_PLANE = -0.0


def to_ros(x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of the paper's axes (x forward, y up, z right) in REP-103 axes (x forward, y left, z
    up). Exact: no digit changes.
    """
    return x, -z, y


def from_ros(x: float, y: float, z: float) -> tuple[float, float, float]:
    """The inverse of `to_ros`."""
    return x, z, -y


def pitch_quaternion(pitch: float) -> tuple[float, float, float, float]:
    """(x, y, z, w) of the attitude.

    The paper's pitch, clockwise positive [rad], is a positive turn about ROS +y: nose down.
    """
    return 0.0, sin(0.5 * pitch), 0.0, cos(0.5 * pitch)


def world_to_body(x: float, z: float, pitch: float) -> tuple[float, float]:
    """The in-plane vector (x, z) of the map, ROS axes, seen from the body that is turned by `pitch`
    [rad].
    """
    s, c = sin(pitch), cos(pitch)
    return c * x - s * z, s * x + c * z
