"""The vehicle as bodies, joints, springs and dampers, in axes with z up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..assembly.spatial import spatial_model
from ..errors import LandingError
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import SPACE, TRIPOD
from ..touchdown import footpad_at_rest, leg_directions
from .linear import Linear, auxiliary_strut, ground, main_strut

Vector = NDArray[np.float64]
# from the model's axes (y up, z right) to those of other programs (y left, z up)
UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


class LegMechanism(NamedTuple):
    """A leg; points and directions are in the body's axes from its CG [m].

    The footpad turns about the hinge `axis` at the auxiliary strut's joint, and slides along that
    strut. The main strut is a line from its joint to the footpad. The footpad of a tripod is free,
    and its struts are such lines, all three.
    """

    number: int
    main_joint: Vector
    auxiliary_joints: Sequence[Vector]  # one, of a tripod two
    foot: Vector
    axis: Vector
    mass: float  # of the footpad [kg]
    main: Linear
    main_length: float  # [m]
    stroke_max: float  # [m]
    auxiliary: Linear
    auxiliary_length: float  # [m]
    ground: Linear
    friction: float
    inverse_mass: float  # of the footpad to a force, the mean of three directions [1/kg]


class Mechanism(NamedTuple):
    """The vehicle at time 0 of its landing, above its ground at rest."""

    mass: float  # of the body [kg]
    inertia: Vector  # about its CG, (3, 3) [kg m2]
    legs: Sequence[LegMechanism]
    top: Vector  # the sensor's place [m]
    gravity: float  # [m/s2]
    normal: Vector  # of the ground, inertial axes
    place: Vector  # of the CG [m]
    quaternion: Vector  # w, x, y, z, body to inertial axes
    velocity: Vector  # of the CG, inertial axes [m/s]
    spin: Vector  # body axes [rad/s]


def mechanism(parameters: Parameters) -> Mechanism:
    """The linearised vehicle of a landing.

    Raises:
        LandingError: The ground is no plane at rest, or the parameters cannot start.
    """
    for name in ("terrain", "roughness"):
        if getattr(parameters.ground, name):
            raise LandingError(
                f"ground.{name} cannot be exported, the ground is a plane there; leave it out"
            )
    if parameters.sea.wave_height > 0.0:
        raise LandingError(
            f"sea.wave_height = {parameters.sea.wave_height:g} m cannot be exported, the ground is "
            "at rest there; set it to 0"
        )
    body = spatial_model(parameters)
    if parameters.drop.mode != SPACE:
        body = body._replace(cg_x=0.0, cg_z=0.0)
    start = Landing(parameters).outputs()
    tensor = np.array(
        [
            [body.I_x, body.I_xy, body.I_xz],
            [body.I_xy, body.I_y, body.I_yz],
            [body.I_xz, body.I_yz, body.I_z],
        ]
    )
    cg = np.array([body.cg_x, 0.0, body.cg_z])
    legs = [
        _leg(parameters, leg, direction, cg)
        for leg, direction in leg_directions(parameters).items()
    ]
    quaternion, spin = _attitude(start)
    return Mechanism(
        mass=body.m_u,
        inertia=UP @ tensor @ UP.T,
        legs=_with_inverse_masses(body.m_u, UP @ tensor @ UP.T, legs),
        top=UP @ (np.array([0.0, body.H, 0.0]) - cg),
        gravity=body.g,
        normal=UP @ np.array([body.normal_x, body.normal_y, body.normal_z]),
        place=UP @ np.array([start.get(f"body.{axis}", 0.0) for axis in "xyz"]),
        quaternion=np.array([quaternion[0], *(UP @ quaternion[1:])]),
        velocity=UP @ np.array([start.get(f"body.v{axis}", 0.0) for axis in "xyz"]),
        spin=UP @ spin,
    )


def _attitude(start: dict[str, float]) -> tuple[Vector, Vector]:
    """Quaternion (w, x, y, z) and angular velocity in body axes [rad/s], the model's axes."""
    if "body.q_w" in start:
        return (
            np.array([start[f"body.q_{part}"] for part in "wxyz"]),
            np.array([start[f"body.spin_{axis}"] for axis in "xyz"]),
        )
    half = -0.5 * start["body.pitch"]
    return (
        np.array([np.cos(half), 0.0, 0.0, np.sin(half)]),
        np.array([0.0, 0.0, -start["body.pitch_rate"]]),
    )


def _leg(whole: Parameters, leg: int, direction: tuple[float, float], cg: Vector) -> LegMechanism:
    own = whole.of_leg(leg) if whole.drop.mode == SPACE else whole
    sine, cosine = direction

    def at(radius: float, height: float, across: float = 0.0) -> Vector:
        x, z = radius * cosine - across * sine, radius * sine + across * cosine
        point: Vector = UP @ (np.array([x, height, z]) - cg)
        return point

    m, a = own.main_strut, own.auxiliary_strut
    sides = (a.joint_spread, -a.joint_spread) if own.leg.kind == TRIPOD else (0.0,)
    return LegMechanism(
        number=leg,
        main_joint=at(m.joint_radius, -m.joint_depth),
        auxiliary_joints=[at(a.joint_radius, -a.joint_depth, side) for side in sides],
        foot=at(*footpad_at_rest(own)),
        axis=UP @ np.array([-sine, 0.0, cosine]),
        mass=own.vehicle.footpad_mass,
        main=main_strut(own),
        main_length=m.length,
        stroke_max=m.stroke_max,
        auxiliary=auxiliary_strut(own),
        auxiliary_length=a.length,
        ground=ground(own),
        friction=own.ground.friction,
        inverse_mass=0.0,
    )


def _with_inverse_masses(
    mass: float, inertia: Vector, legs: list[LegMechanism]
) -> list[LegMechanism]:
    """The legs with the footpads' inverse masses.

    A force in a leg's plane accelerates its footpad alone; one across it, the body and all feet. A
    tripod's footpad is free in all directions.
    """
    if any(len(leg.auxiliary_joints) > 1 for leg in legs):
        return [leg._replace(inverse_mass=1.0 / leg.mass) for leg in legs]
    matrix = np.zeros((6, 6))
    matrix[:3, :3], matrix[3:, 3:] = mass * np.eye(3), inertia
    ways = [np.concatenate([leg.axis, np.cross(leg.foot, leg.axis)]) for leg in legs]
    for leg, way in zip(legs, ways):
        matrix += leg.mass * np.outer(way, way)
    return [
        leg._replace(
            inverse_mass=(2.0 / leg.mass + float(way @ np.linalg.solve(matrix, way))) / 3.0
        )
        for leg, way in zip(legs, ways)
    ]
