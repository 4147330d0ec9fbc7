"""Vectors and rotations of space."""

from __future__ import annotations

from math import sqrt

from .records import Rotation, Vector


def dot(a: Vector, b: Vector) -> float:
    """The scalar product."""
    return a.x * b.x + a.y * b.y + a.z * b.z


def cross(a: Vector, b: Vector) -> Vector:
    """The vector product."""
    return Vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


def added(a: Vector, b: Vector) -> Vector:
    """The sum."""
    return Vector(a.x + b.x, a.y + b.y, a.z + b.z)


def less(a: Vector, b: Vector) -> Vector:
    """The difference `a` - `b`."""
    return Vector(a.x - b.x, a.y - b.y, a.z - b.z)


def scaled(a: Vector, part: float) -> Vector:
    """`a` times a number."""
    return Vector(a.x * part, a.y * part, a.z * part)


def rotation(w: float, x: float, y: float, z: float) -> Rotation:
    """The rotation of a quaternion, which need not have length 1."""
    s = 2.0 / (w * w + x * x + y * y + z * z)
    return Rotation(
        x_x=1.0 - s * (y * y + z * z),
        x_y=s * (x * y + w * z),
        x_z=s * (x * z - w * y),
        y_x=s * (x * y - w * z),
        y_y=1.0 - s * (x * x + z * z),
        y_z=s * (y * z + w * x),
        z_x=s * (x * z + w * y),
        z_y=s * (y * z - w * x),
        z_z=1.0 - s * (x * x + y * y),
    )


def length_of(w: float, x: float, y: float, z: float) -> float:
    """The length of a quaternion."""
    return sqrt(w * w + x * x + y * y + z * z)


def to_inertial(r: Rotation, v: Vector) -> Vector:
    """A vector of body axes in inertial axes."""
    return Vector(
        r.x_x * v.x + r.y_x * v.y + r.z_x * v.z,
        r.x_y * v.x + r.y_y * v.y + r.z_y * v.z,
        r.x_z * v.x + r.y_z * v.y + r.z_z * v.z,
    )


def to_body(r: Rotation, v: Vector) -> Vector:
    """A vector of inertial axes in body axes."""
    return Vector(
        r.x_x * v.x + r.x_y * v.y + r.x_z * v.z,
        r.y_x * v.x + r.y_y * v.y + r.y_z * v.z,
        r.z_x * v.x + r.z_y * v.y + r.z_z * v.z,
    )


def solved(x: Vector, y: Vector, z: Vector, right: Vector) -> Vector:
    """The vector whose products with `x`, `y`, `z` are `right`, by Cramer's rule."""
    by_x = cross(y, z)
    by_y = cross(z, x)
    by_z = cross(x, y)
    total = added(added(scaled(by_x, right.x), scaled(by_y, right.y)), scaled(by_z, right.z))
    return scaled(total, 1.0 / dot(x, by_x))
