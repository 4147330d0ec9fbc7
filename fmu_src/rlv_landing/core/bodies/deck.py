"""The ground as the spatial body meets it: a plane on a deck that moves in all six directions."""

from __future__ import annotations

from math import cos, sin

from ..records import Deck, FootMotion, SpatialInputs, SpatialModel, Vector
from ..vectors import added, cross, dot, less


def on_deck(v: Vector, u: SpatialInputs) -> Vector:
    """A vector of the deck's axes in inertial axes.

    The deck is turned by its yaw about y, then by its roll about x, then clockwise by its tilt
    about z.
    """
    s = sin(u.yaw)
    c = cos(u.yaw)
    x = c * v.x + s * v.z
    z = c * v.z - s * v.x
    s = sin(u.roll)
    c = cos(u.roll)
    y = c * v.y - s * z
    z = s * v.y + c * z
    s = sin(u.tilt)
    c = cos(u.tilt)
    return Vector(c * x + s * y, c * y - s * x, z)


def deck_spin(u: SpatialInputs) -> Vector:
    """Angular velocity of the deck [rad/s], inertial axes."""
    s = sin(u.roll)
    c = cos(u.roll)
    # the yaw's axis is tilted and rolled, the roll's is tilted
    x = u.roll_rate
    y = c * u.yaw_rate
    z = s * u.yaw_rate
    s = sin(u.tilt)
    c = cos(u.tilt)
    return Vector(c * x + s * y, c * y - s * x, z - u.tilt_rate)


def deck_of(u: SpatialInputs, p: SpatialModel) -> Deck:
    """The ground at the inputs `u`."""
    return Deck(
        origin=Vector(u.surge, u.heave, u.sway),
        velocity=Vector(u.surge_rate, u.heave_rate, u.sway_rate),
        spin=deck_spin(u),
        down=on_deck(Vector(p.down_x, p.down_y, p.down_z), u),
        along=on_deck(Vector(p.along_x, 0.0, p.along_z), u),
        normal=on_deck(Vector(p.normal_x, p.normal_y, p.normal_z), u),
    )


def deck_velocity(deck: Deck, point: Vector) -> Vector:
    """The ground's velocity [m/s] at an inertial point."""
    return added(deck.velocity, cross(deck.spin, less(point, deck.origin)))


def motion_on_deck(deck: Deck, point: Vector, velocity: Vector) -> FootMotion:
    """A point against the ground, by its velocity relative to the ground."""
    return FootMotion(
        -dot(less(point, deck.origin), deck.normal),
        -dot(velocity, deck.normal),
        dot(velocity, deck.down),
        dot(velocity, deck.along),
    )
