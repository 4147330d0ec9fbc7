"""The ground as the spatial body meets it: a plane or a height field on a deck that moves."""

from __future__ import annotations

from math import cos, sin, sqrt

from ..records import (
    DeckTurn,
    FootMotion,
    Rotation,
    SpatialInputs,
    SpatialModel,
    TerrainPlace,
    Vector,
)
from ..vectors import added, cross, less, to_body, to_inertial


def deck_turn(u: SpatialInputs) -> DeckTurn:
    """The deck's angles at the inputs `u`."""
    return DeckTurn(
        yaw=u.yaw,
        roll=u.roll,
        tilt=u.tilt,
        sin_y=sin(u.yaw),
        cos_y=cos(u.yaw),
        sin_r=sin(u.roll),
        cos_r=cos(u.roll),
        sin_t=sin(u.tilt),
        cos_t=cos(u.tilt),
    )


def is_turn_at(turn: DeckTurn, u: SpatialInputs) -> bool:
    """Whether the deck's angles are those at the inputs `u`."""
    return turn.yaw == u.yaw and turn.roll == u.roll and turn.tilt == u.tilt


def on_deck(v: Vector, turn: DeckTurn) -> Vector:
    """A vector of the deck's axes in inertial axes.

    The deck is turned by its yaw about y, then by its roll about x, then clockwise by its tilt
    about z.
    """
    x = turn.cos_y * v.x + turn.sin_y * v.z
    yawed = turn.cos_y * v.z - turn.sin_y * v.x
    y = turn.cos_r * v.y - turn.sin_r * yawed
    z = turn.sin_r * v.y + turn.cos_r * yawed
    return Vector(turn.cos_t * x + turn.sin_t * y, turn.cos_t * y - turn.sin_t * x, z)


def ground_axes(turn: DeckTurn, p: SpatialModel) -> Rotation:
    """The ground's axis 1, its normal and its axis 2."""
    down = on_deck(Vector(p.down_x, p.down_y, p.down_z), turn)
    normal = on_deck(Vector(p.normal_x, p.normal_y, p.normal_z), turn)
    along = on_deck(Vector(p.along_x, 0.0, p.along_z), turn)
    return Rotation(
        x_x=down.x,
        x_y=down.y,
        x_z=down.z,
        y_x=normal.x,
        y_y=normal.y,
        y_z=normal.z,
        z_x=along.x,
        z_y=along.y,
        z_z=along.z,
    )


def about_axes(turn: DeckTurn, roll: float, yaw: float, tilt: float) -> Vector:
    """The vector with these parts along the axes of the deck's angles, in inertial axes."""
    # the yaw's axis is tilted and rolled, the roll's is tilted
    x = roll
    y = turn.cos_r * yaw
    z = turn.sin_r * yaw
    return Vector(turn.cos_t * x + turn.sin_t * y, turn.cos_t * y - turn.sin_t * x, z - tilt)


def deck_spin(u: SpatialInputs, turn: DeckTurn) -> Vector:
    """Angular velocity of the deck [rad/s], inertial axes."""
    return about_axes(turn, u.roll_rate, u.yaw_rate, u.tilt_rate)


def deck_spin_rate(u: SpatialInputs, turn: DeckTurn, second: Vector) -> Vector:
    """Angular acceleration of the deck [rad/s2], inertial axes.

    `second` are the second derivatives of roll, yaw and tilt. Tilt carries the roll's axis, both
    carry the yaw's.
    """
    tilting = about_axes(turn, 0.0, 0.0, u.tilt_rate)
    rolling = about_axes(turn, u.roll_rate, 0.0, 0.0)
    yawing = about_axes(turn, 0.0, u.yaw_rate, 0.0)
    carried = added(cross(tilting, rolling), cross(added(tilting, rolling), yawing))
    return added(about_axes(turn, second.x, second.y, second.z), carried)


def from_origin(u: SpatialInputs, point: Vector) -> Vector:
    """An inertial point from the deck's origin [m]."""
    return less(point, Vector(u.surge, u.heave, u.sway))


def deck_velocity(u: SpatialInputs, spin: Vector, place: Vector) -> Vector:
    """The ground's velocity [m/s] at a place from the deck's origin, whose `spin` is in rad/s."""
    return added(Vector(u.surge_rate, u.heave_rate, u.sway_rate), cross(spin, place))


def deck_acceleration(origin: Vector, spin: Vector, spin_rate: Vector, place: Vector) -> Vector:
    """The ground's acceleration [m/s2] at a place from the deck's origin, whose own is `origin`."""
    return added(origin, added(cross(spin_rate, place), cross(spin, cross(spin, place))))


def motion_on_ground(axes: Rotation, place: Vector, velocity: Vector, step: float) -> FootMotion:
    """A place from the deck's origin against the ground, by its velocity relative to it.

    The ground there is a `step` [m] above its plane.
    """
    slip = to_body(axes, velocity)
    depth = step - (axes.y_x * place.x + axes.y_y * place.y + axes.y_z * place.z)
    return FootMotion(depth, -slip.y, slip.x, slip.z)


def steepness(place: TerrainPlace) -> float:
    """The area of a height field at a place, in parts of that of the ground's plane below it."""
    return sqrt(1.0 + place.slope_1 * place.slope_1 + place.slope_2 * place.slope_2)


def local_axes(axes: Rotation, place: TerrainPlace) -> Rotation:
    """The axes of a height field at a place, by the `axes` of the ground's plane.

    Its normal, and 1 and 2 along it: 1 has no part along the plane's axis 2.
    """
    steep = steepness(place)
    along = sqrt(1.0 + place.slope_1 * place.slope_1)
    first = to_inertial(axes, Vector(1.0 / along, place.slope_1 / along, 0.0))
    normal = to_inertial(axes, Vector(-place.slope_1 / steep, 1.0 / steep, -place.slope_2 / steep))
    second = cross(first, normal)
    return Rotation(
        x_x=first.x,
        x_y=first.y,
        x_z=first.z,
        y_x=normal.x,
        y_y=normal.y,
        y_z=normal.z,
        z_x=second.x,
        z_y=second.y,
        z_z=second.z,
    )


def motion_on_terrain(
    axes: Rotation, place: TerrainPlace, velocity: Vector, step: float
) -> FootMotion:
    """A place against a height field, by the field's `axes` there and its relative velocity.

    The depth is measured along the normal of the ground's plane, so that the elastic force is the
    gradient of its energy; the force along the field's normal is larger by its steepness.
    """
    slip = to_body(axes, velocity)
    return FootMotion(step + place.depth, -steepness(place) * slip.y, slip.x, slip.z)
