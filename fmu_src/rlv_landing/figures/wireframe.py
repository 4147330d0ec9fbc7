"""The vehicle as lines in space at the samples of a landing, for figures and viewers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ..history import History
from ..parameters import Parameters
from ..parameters.surroundings import read_points
from ..quantities import SPACE, TRIPOD
from ..touchdown import footpad_between, leg_directions, tripod_footpad

Lines = NDArray[np.float64]
RING = 24


def wireframe(
    history: History, parameters: Parameters, rows: Sequence[int] | NDArray[np.intp]
) -> dict[str, Lines]:
    """The vehicle at `rows` of `history`, in the paper's inertial axes.

    The axes are x forward, y up, z right. Footpads are where struts of the logged strokes meet, so
    that logs, which have no column for them, can be drawn as well.

    Args:
        history: The landing's columns over time.
        parameters: The vehicle.
        rows: The samples' indices.

    Returns:
        Arrays (rows, lines, points, 3) [m] by part: `outline`, the body's rectangle in the
        symmetric plane; `hull`, its rings and the rectangle across; `main` and `auxiliary`, the
        struts from joint to footpad by leg, of a tripod both auxiliary struts as one line over the
        footpad; `feet`, the footpads; `points`, the body's that meet the ground, where it has such.
    """
    m, a = parameters.main_strut, parameters.auxiliary_strut
    half, bottom, top = (
        min(m.joint_radius, a.joint_radius),
        -max(m.joint_depth, a.joint_depth),
        parameters.vehicle.top_height,
    )
    corners = np.array(
        [(-half, bottom), (half, bottom), (half, top), (-half, top), (-half, bottom)]
    )
    turn = np.linspace(0.0, 2.0 * np.pi, RING + 1)
    rings = [
        np.stack([half * np.cos(turn), np.full_like(turn, h), half * np.sin(turn)], axis=-1)
        for h in (bottom, top)
    ]
    across = np.stack([np.zeros(5), corners[:, 1], corners[:, 0]], axis=-1)
    across = np.concatenate([across, np.repeat(across[-1:], RING - 4, axis=0)])
    outline = np.stack([corners[:, 0], corners[:, 1], np.zeros(5)], axis=-1)
    in_space = parameters.drop.mode == SPACE
    directions = leg_directions(parameters)
    legs = [
        _leg(history, parameters.of_leg(leg) if in_space else parameters, leg, direction, rows)
        for leg, direction in directions.items()
    ]
    main, auxiliary = (np.stack(lines, axis=1) for lines in zip(*legs))
    parts = {
        "outline": outline[None, None],
        "hull": np.stack([*rings, across])[None],
        "main": main,
        "auxiliary": auxiliary,
    }
    parts["feet"] = main[:, :, 1:]
    if in_space:
        v = parameters.vehicle
        if points := read_points(v.body_points):
            parts["points"] = np.array(points)[None, :, None]
        cg = np.array([v.cg_offset_x, 0.0, v.cg_offset_z])
        return {name: _turned(history, rows, lines - cg) for name, lines in parts.items()}
    return {name: _in_inertial_axes(history, rows, points) for name, points in parts.items()}


def _leg(
    history: History,
    own: Parameters,
    leg: int,
    direction: tuple[float, float],
    rows: Sequence[int] | NDArray[np.intp],
) -> tuple[Lines, Lines]:
    """The main strut (rows, 2, 3) and the auxiliary struts (rows, points, 3), body axes [m].

    Args:
        history: The landing's columns over time.
        own: The parameters as the leg has them.
        leg: Its number.
        direction: Sine and cosine of its azimuth.
        rows: The samples' indices.
    """
    sine, cosine = direction
    m, a = own.main_strut, own.auxiliary_strut
    axes = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
    tripod = own.leg.kind == TRIPOD
    strokes = {"main_strut": m.length, "auxiliary_strut": a.length}
    strokes |= {"auxiliary_strut_2": a.length} if tripod else {}
    lengths = [
        length - history[f"leg[{leg}].{strut}.stroke"][rows] for strut, length in strokes.items()
    ]
    found = [tuple(map(float, row)) for row in zip(*lengths)]
    if tripod:
        feet = np.array([tripod_footpad(own, *row) for row in found])
    else:
        feet = np.array([(*footpad_between(own, *row), 0.0) for row in found])

    def line(radius: float, depth: float, *sides: float) -> Lines:
        joints = [np.tile((radius, -depth, side), (len(feet), 1)) for side in sides]
        ends: Lines = np.stack([joints[0], feet, *joints[1:]], axis=1) @ axes
        return ends

    sides = (a.joint_spread, -a.joint_spread) if tripod else (0.0,)
    return line(m.joint_radius, m.joint_depth, 0.0), line(a.joint_radius, a.joint_depth, *sides)


def contact_forces(
    history: History, parameters: Parameters, rows: Sequence[int] | NDArray[np.intp]
) -> Lines:
    """The ground's forces on the footpads at `rows`: (rows, legs, 3) [N], inertial axes."""
    legs = [
        [history[f"leg[{leg}].contact.force_{axis}"][rows] for axis in "xyz"]
        for leg in leg_directions(parameters)
    ]
    forces: Lines = np.array(legs).transpose(2, 0, 1)
    return forces


def ground_height(
    parameters: Parameters, x: NDArray[np.float64], z: NDArray[np.float64] | float = 0.0
) -> NDArray[np.float64]:
    """Height [m] at `x`, `z` [m] of the plane of the ground at rest.

    A positive slope falls along x, in space in its direction.
    """
    ground = parameters.ground
    towards = ground.slope_direction
    way = np.cos(towards) * x + np.sin(towards) * z
    height: NDArray[np.float64] = -np.tan(ground.slope) * way
    return height


def _turned(history: History, rows: Sequence[int] | NDArray[np.intp], points: Lines) -> Lines:
    """Points of the body in a landing in space; arguments as for `_in_inertial_axes`."""
    place = np.column_stack([history[f"body.{axis}"][rows] for axis in "xyz"])
    turns = Rotation.from_quat(
        np.column_stack([history[f"body.q_{part}"][rows] for part in "xyzw"])
    ).as_matrix()
    turned: Lines = points @ np.swapaxes(turns, 1, 2)[:, None]
    return turned + place[:, None, None, :]


def _in_inertial_axes(
    history: History, rows: Sequence[int] | NDArray[np.intp], points: Lines
) -> Lines:
    """Points of the body in inertial axes.

    Args:
        history: The landing's columns over time.
        rows: The samples' indices.
        points: Points in body axes from the CG, (1 or rows, lines, points, 3).
    """
    x, y, pitch = (history[f"body.{name}"][rows][:, None, None] for name in ("x", "y", "pitch"))
    sine, cosine = np.sin(pitch), np.cos(pitch)
    bx, by, bz = np.moveaxis(points, -1, 0)
    return np.stack(
        np.broadcast_arrays(x + bx * cosine + by * sine, y - bx * sine + by * cosine, bz), axis=-1
    )
