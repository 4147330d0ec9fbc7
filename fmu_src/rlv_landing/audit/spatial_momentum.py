"""Momentum of the whole vehicle in space: see `momentum.py`.

It comes from a history's outputs alone. No kernel of the core is used, so that the result is an
independent check.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson
from scipy.spatial.transform import Rotation

from ..history import History
from ..parameters import Parameters
from ..quantities import TRIPOD
from ..touchdown import leg_directions

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SpatialMomentum:
    """Momentum of body and footpads at every sample, inertial axes, arrays (n, 3).

    Attributes:
        linear: Linear momentum [N s].
        about_origin: Angular momentum about the inertial origin [N m s].
        about_cg: Angular momentum about the whole vehicle's CG [N m s].
    """

    linear: Array
    about_origin: Array
    about_cg: Array


def inertia_tensor(parameters: Parameters) -> Array:
    """The upper mass's inertia tensor about its CG [kg m2], body axes, (3, 3)."""
    v = parameters.vehicle
    roll = v.inertia_roll or v.inertia
    yaw = v.inertia_yaw or v.mass * parameters.main_strut.joint_radius**2
    return np.array(
        [
            [roll, v.inertia_xy, v.inertia_xz],
            [v.inertia_xy, yaw, v.inertia_yz],
            [v.inertia_xz, v.inertia_yz, v.inertia],
        ]
    )


def spatial_momentum(history: History, parameters: Parameters) -> SpatialMomentum:
    """The momentum at every sample.

    The history needs the landing's own columns, stroke rates included.
    """
    v = parameters.vehicle
    turn, spin = _attitude(history), _columns(history, "body.spin_")
    place, speed = _place(history), _columns(history, "body.v")
    points = [(v.mass, place, speed)]
    for leg, azimuth in leg_directions(parameters).items():
        foot = _columns(history, f"leg[{leg}].footpad.")
        from_cg = turn.inv().apply(foot - place)
        own = _in_body(history, parameters, leg, azimuth, from_cg) + np.cross(spin, from_cg)
        mass = parameters.of_leg(leg).vehicle.footpad_mass
        points.append((mass, foot, speed + turn.apply(own)))
    linear: Array = np.sum([m * u for m, _, u in points], axis=0)
    turning: Array = np.sum([m * np.cross(x, u) for m, x, u in points], axis=0)
    about_origin = turning + turn.apply(spin @ inertia_tensor(parameters))
    centre = np.sum([m * x for m, x, _ in points], axis=0) / sum(m for m, *_ in points)
    return SpatialMomentum(linear, about_origin, about_origin - np.cross(centre, linear))


def spatial_impulse(history: History, parameters: Parameters) -> SpatialMomentum:
    """The impulse of contact forces and weight since the first sample.

    It is integrated by Simpson's rule over the samples; `about_cg` is left 0.
    """
    v, g = parameters.vehicle, parameters.ground.gravity
    down = np.array([0.0, -g, 0.0])
    loads = [(_place(history), np.tile(v.mass * down, (len(history), 1)))]
    for leg in history.legs:
        weight = parameters.of_leg(leg).vehicle.footpad_mass * down
        force = _columns(history, f"leg[{leg}].contact.force_") + weight
        loads.append((_columns(history, f"leg[{leg}].footpad."), force))
    loads.append((_place(history), _columns(history, "body.strike_force_")))
    force = np.sum([f for _, f in loads], axis=0)
    turning = _columns(history, "body.strike_moment_")
    moment = turning + np.sum([np.cross(x, f) for x, f in loads], axis=0)
    linear, turn = (
        np.asarray(cumulative_simpson(f, x=history.time, axis=0, initial=0.0))
        for f in (force, moment)
    )
    return SpatialMomentum(linear, turn, np.zeros_like(linear))


def _columns(history: History, name: str) -> Array:
    """The vector whose columns' names begin with `name`, (n, 3)."""
    return np.column_stack([history[f"{name}{axis}"] for axis in "xyz"])


def _place(history: History) -> Array:
    return _columns(history, "body.")


def _attitude(history: History) -> Rotation:
    return Rotation.from_quat(np.column_stack([history[f"body.q_{part}"] for part in "xyzw"]))


def _in_body(
    history: History,
    parameters: Parameters,
    leg: int,
    azimuth: tuple[float, float],
    from_cg: Array,
) -> Array:
    """Velocity of a footpad in the body from its struts' rates, body axes, (n, 3)."""
    own = parameters.vehicle
    sine, cosine = azimuth
    x, z = from_cg[:, 0] + own.cg_offset_x, from_cg[:, 2] + own.cg_offset_z
    r, h, t = x * cosine + z * sine, from_cg[:, 1], z * cosine - x * sine
    if parameters.leg.kind == TRIPOD:
        vr, vh, vt = _rates_of_tripod(history, parameters, leg, np.column_stack([r, h, t])).T
        return np.column_stack([vr * cosine - vt * sine, vh, vr * sine + vt * cosine])
    vr, vh = rates_in_plane(history, parameters, leg, r, h)
    return np.column_stack([vr * cosine, vh, vr * sine])


def _rates_of_tripod(history: History, parameters: Parameters, leg: int, foot: Array) -> Array:
    """Velocity of a free footpad, outward, up and across [m/s], from three struts' rates, (n, 3).

    `foot` is its place in these axes from the legs' axis at the height of the CG [m].
    """
    own = parameters.of_leg(leg)
    m, a = own.main_strut, own.auxiliary_strut
    struts = {
        "main_strut": (m.joint_radius, -m.joint_depth, 0.0),
        "auxiliary_strut": (a.joint_radius, -a.joint_depth, a.joint_spread),
        "auxiliary_strut_2": (a.joint_radius, -a.joint_depth, -a.joint_spread),
    }
    ways = np.stack([foot - np.array(joint) for joint in struts.values()], axis=1)
    rates = np.column_stack([-history[f"leg[{leg}].{strut}.stroke_rate"] for strut in struts])
    lengths = np.linalg.norm(ways, axis=2)
    solved: Array = np.linalg.solve(ways, (rates * lengths)[..., None])[..., 0]
    return solved


def rates_in_plane(
    history: History, parameters: Parameters, leg: int, r: Array, h: Array
) -> tuple[Array, Array]:
    """Velocity of a footpad in the leg's plane, outward and up [m/s], from both struts' rates.

    Args:
        history: The landing.
        parameters: Its parameters.
        leg: The leg's number.
        r: The footpad's distance from the body's axis [m], (n,).
        h: Its height above the CG [m], (n,).
    """
    own = parameters.of_leg(leg)
    m, a = own.main_strut, own.auxiliary_strut
    main_r, main_h = r - m.joint_radius, h + m.joint_depth
    aux_r, aux_h = r - a.joint_radius, h + a.joint_depth
    main_rate = -history[f"leg[{leg}].main_strut.stroke_rate"] * np.hypot(main_r, main_h)
    aux_rate = -history[f"leg[{leg}].auxiliary_strut.stroke_rate"] * np.hypot(aux_r, aux_h)
    determinant = main_r * aux_h - main_h * aux_r
    vr = (main_rate * aux_h - aux_rate * main_h) / determinant
    vh = (main_r * aux_rate - aux_r * main_rate) / determinant
    return vr, vh
