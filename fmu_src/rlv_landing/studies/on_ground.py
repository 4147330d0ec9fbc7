"""Where the vehicle is above the ground, which may move: footpads, body joints, and its edges."""

from __future__ import annotations

from functools import lru_cache
from math import atan2, hypot, pi

import numpy as np
from numpy.typing import NDArray

from ..assembly import DeckMotion
from ..history import History
from ..parameters import Parameters
from ..quantities import SPACE, TRIPOD, azimuth, groups_of
from ..touchdown import AT_REST, GroundMotion, leg_directions
from ..validation.first_contact import first_contact

Array = NDArray[np.float64]
# two footpads nearer to each other than this are one corner [m]
ONE_CORNER = 1e-9


def counted_legs(parameters: Parameters) -> tuple[int, ...]:
    """The legs that are judged: in space all, else the first of each group of mirror images."""
    if parameters.drop.mode == SPACE:
        return tuple(range(1, int(parameters.vehicle.legs) + 1))
    return tuple(leg for leg, _ in _firsts(parameters.drop.mode))


@lru_cache
def _firsts(mode: str) -> tuple[tuple[int, float], ...]:
    """The first leg of each group of a symmetric landing, and the cosine of its azimuth."""
    groups = sorted((min(leg for leg, _ in g.legs), azimuth(g.azimuth)[1]) for g in groups_of(mode))
    return tuple(groups)


def slip(history: History, leg: int) -> Array:
    """Distance [m] of the footpad from its first contact, relative to the ground, to the end.

    It is empty for a footpad that never touches.
    """
    contact = first_contact(history, leg)
    if contact is None:
        return np.empty(0)
    names = [f"leg[{leg}].footpad.{axis}" for axis in "xyz"]
    place = np.stack([history[name][contact.sample :] for name in names])
    first = np.array([[contact.value(history, name)] for name in names])
    way = _seen_from_ground(history, place, history.time[contact.sample :])
    way = way - _seen_from_ground(history, first, np.array([contact.time]))
    distance: Array = np.sqrt((way**2).sum(axis=0))
    return distance


def joint_clearance(history: History) -> float:
    """Least height [m] above the ground, along its normal, of the auxiliary struts' body joints."""
    p = _parameters(history)
    radius, depth = p.auxiliary_strut.joint_radius, p.auxiliary_strut.joint_depth
    body = np.stack([history["body.x"], history["body.y"], np.zeros(len(history))])
    if p.drop.mode != SPACE:
        height = _seen_from_ground(history, body, history.time)[1]
        turned = history["body.pitch"] - _slope(history, history.time)
        height, sine = height - depth * np.cos(turned), np.sin(turned)
        heights = [height - radius * c * sine for _, c in _firsts(p.drop.mode)]
        return min(_least(history.time, h) for h in heights)
    body[2] = history["body.z"]
    turn = _turns(*(history[f"body.q_{k}"] for k in "wxyz"))
    normal = np.array(_normal(p))
    height = normal @ _seen_from_ground(history, body, history.time)
    # the normal in the body's axes
    upward = _in_inertial_axes(history, normal)
    upwards = (turn * (upward[:, None] if upward.ndim > 1 else upward[:, None, None])).sum(axis=0)
    found = []
    for leg, (s, c) in leg_directions(p).items():
        strut = p.of_leg(leg).auxiliary_strut
        spread = strut.joint_spread
        for t in (spread, -spread) if p.leg.kind == TRIPOD else (0.0,):
            joint = np.array([
                strut.joint_radius * c - t * s - p.vehicle.cg_offset_x,
                -strut.joint_depth,
                strut.joint_radius * s + t * c - p.vehicle.cg_offset_z,
            ])  # fmt: skip
            found.append(_least(history.time, height + joint @ upwards))
    return min(found)


def crossed_edge(history: History) -> tuple[str, float] | None:
    """The edge of the footpads' polygon that the CG of a vehicle in space is beyond at the end.

    Returns:
        The edge's legs, "legs 1, 2", and the direction across the edge outwards [rad], from
        inertial x towards z; None where the CG is inside, or there is no polygon.
    """
    p = _parameters(history)
    feet = [p.of_leg(leg).vehicle.footpad_mass for leg in history.legs]
    places = [
        (float(history[f"leg[{leg}].footpad.x"][-1]), float(history[f"leg[{leg}].footpad.z"][-1]))
        for leg in history.legs
    ]
    x, z = (
        (
            p.vehicle.mass * float(history[f"body.{axis}"][-1])
            + sum(m * q[k] for m, q in zip(feet, places))
        )
        / p.whole_mass
        for k, axis in enumerate("xz")
    )
    nearest = (0.0, "", 0.0)
    for i, a in enumerate(places):
        for j, b in enumerate(places):
            along = (b[0] - a[0], b[1] - a[1])
            length = hypot(*along)
            if length < ONE_CORNER or not _is_edge(a, along, length, places):
                continue
            inside = (along[0] * (z - a[1]) - along[1] * (x - a[0])) / length
            legs = sorted((history.legs[i], history.legs[j]))
            edge = f"legs {legs[0]}, {legs[1]}"
            nearest = min(nearest, (inside, edge, atan2(-along[0], along[1])))
    inside, edge, direction = nearest
    return (edge, direction) if inside < 0.0 else None


def lean(history: History) -> float:
    """Direction in which the body's axis leans at the end [rad], from inertial x towards z."""
    w, x, y, z = (float(history[f"body.q_{k}"][-1]) for k in "wxyz")
    return atan2(2.0 * (y * z + w * x), 2.0 * (x * y - w * z))


def towards(history: History) -> str:
    """The side to which a vehicle that toppled at the end went: +x or -x, or over which legs."""
    p = _parameters(history)
    if p.drop.mode == SPACE:
        edge = crossed_edge(history)
        return edge[0] if edge is not None else f"{lean(history) * 180.0 / pi:.0f} deg"
    slope = _slope(history, history.time)
    last = slope if isinstance(slope, float) else float(slope[-1])
    return "+x" if history["body.pitch"][-1] > last else "-x"


def _is_edge(
    a: tuple[float, float],
    along: tuple[float, float],
    length: float,
    places: list[tuple[float, float]],
) -> bool:
    """Whether no footpad is beyond the line from `a` `along` another one."""
    return all(
        along[0] * (c[1] - a[1]) - along[1] * (c[0] - a[0]) >= -ONE_CORNER * length for c in places
    )


def _parameters(history: History) -> Parameters:
    assert history.parameters is not None
    return history.parameters


def _slope(history: History, time: Array) -> Array | float:
    """Slope of the ground of a symmetric landing, with its tilt [rad], (n,), at times [s]."""
    slope = _parameters(history).ground.slope
    if history.ground == AT_REST or not isinstance(history.ground, GroundMotion):
        return slope
    return slope + history.ground.at(time - history.time[0])[1]


def _normal(p: Parameters) -> tuple[float, float, float]:
    """The ground's normal in the deck's axes, in space."""
    g = p.ground
    sine, cosine = np.sin(g.slope), np.cos(g.slope)
    return sine * np.cos(g.slope_direction), cosine, sine * np.sin(g.slope_direction)


def _seen_from_ground(history: History, place: Array, time: Array) -> Array:
    """Inertial places [m], (3, n), at times [s], (n,), in the axes of the ground as it moves.

    In a symmetric landing the second axis is the ground's normal. In space they are the deck's, to
    which the ground may be inclined.
    """
    ground, t = history.ground, time - history.time[0]
    if isinstance(ground, DeckMotion):
        surge, heave, sway, roll, yaw, tilt = ground.places(t)
        moved = place - np.stack([surge, heave, sway])
        seen: Array = np.einsum("jin,jn->in", _deck_turn(tilt, roll, yaw), moved)
        return seen
    x, y, z = place
    if _parameters(history).drop.mode == SPACE:
        return place
    slope = _slope(history, time)
    if ground != AT_REST:
        y = y - ground.at(t)[0]
    return np.stack([
        x * np.cos(slope) - y * np.sin(slope),
        x * np.sin(slope) + y * np.cos(slope),
        z,
    ])  # fmt: skip


def _in_inertial_axes(history: History, normal: Array) -> Array:
    """A direction of the deck's axes, (3,), in inertial ones: (3,) at rest, else (3, n)."""
    ground = history.ground
    if not isinstance(ground, DeckMotion):
        return normal
    _, _, _, roll, yaw, tilt = ground.places(history.time - history.time[0])
    turn = _deck_turn(tilt, roll, yaw)
    found: Array = np.einsum("jin,i->jn", turn, normal)
    return found


def _deck_turn(tilt: Array, roll: Array, yaw: Array) -> Array:
    """Rotations from the deck's to inertial axes, (3, 3, n): yaw, roll, then clockwise tilt."""
    zero, one = np.zeros_like(tilt), np.ones_like(tilt)
    (sy, cy), (sr, cr), (st, ct) = ((np.sin(a), np.cos(a)) for a in (yaw, roll, tilt))
    by_yaw = np.array([[cy, zero, sy], [zero, one, zero], [-sy, zero, cy]])
    by_roll = np.array([[one, zero, zero], [zero, cr, -sr], [zero, sr, cr]])
    by_tilt = np.array([[ct, st, zero], [-st, ct, zero], [zero, zero, one]])
    turn: Array = np.einsum("ijn,jkn,kln->iln", by_tilt, by_roll, by_yaw)
    return turn


def _turns(w: Array, x: Array, y: Array, z: Array) -> Array:
    """Rotations of quaternions, body to inertial axes, (3, 3, n)."""
    return np.array([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ])  # fmt: skip


def _least(time: Array, values: Array) -> float:
    """The least of a smooth quantity, by the parabola through the three lowest at even times."""
    i = int(values.argmin())
    if not 0 < i < len(values) - 1:
        return float(values[i])
    steps = sorted((float(time[i + 1] - time[i]), float(time[i] - time[i - 1])))
    if steps[1] > 1.001 * steps[0]:
        return float(values[i])
    before, least, after = values[i - 1 : i + 2].tolist()
    bend = before - 2.0 * least + after
    return float(least - 0.125 * (after - before) ** 2 / bend) if bend > 0.0 else float(least)
