"""The struts of a leg as two bodies each, for formats that have no tendons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .linear import Linear
from .mechanism import LegMechanism, Vector

# of a strut's rod, whose mass the model does not have [kg], [kg m2]
ROD_MASS, ROD_INERTIA = 1e-3, 1e-6
# of a body: its products are 0
POINT = np.eye(3) * ROD_INERTIA
# how far a strut may be drawn out that no stop holds [m]
FAR = 10.0


class Rod(NamedTuple):
    """A strut: it turns about its axes at `joint`, and is shorter by its stroke.

    Attributes:
        name: Of the strut, as `leg1_main`.
        joint: Place on the body [m].
        foot: Place of the footpad [m].
        along: Direction of a positive stroke, from the footpad to the joint.
        axes: Directions of the axes about which it turns: the leg's; of a tripod also one across.
        linear: Its spring and damper.
        least: Least stroke [m].
        most: Largest stroke [m].
    """

    name: str
    joint: Vector
    foot: Vector
    along: Vector
    axes: Sequence[Vector]
    linear: Linear
    least: float
    most: float

    @property
    def free_stroke(self) -> float:
        """The stroke at which the spring bears nothing [m]."""
        return -self.linear.preload / self.linear.stiffness


def rods(leg: LegMechanism) -> list[Rod]:
    """The struts of a leg: the main one, the auxiliary one that carries the footpad, the others."""
    joints = leg.auxiliary_joints
    names = ["auxiliary"] if len(joints) == 1 else [f"auxiliary{k + 1}" for k in range(len(joints))]
    return [
        _rod(leg, "main", leg.main_joint, leg.main, leg.stroke_max),
        *(_rod(leg, name, joint, leg.auxiliary, FAR) for name, joint in zip(names, joints)),
    ]


def _rod(leg: LegMechanism, name: str, joint: Vector, linear: Linear, most: float) -> Rod:
    way = joint - leg.foot
    along = way / float(np.linalg.norm(way))
    axes = [leg.axis]
    if len(leg.auxiliary_joints) > 1:
        second = np.cross(along, leg.axis)
        axes.append(second / float(np.linalg.norm(second)))
    return Rod(
        name=f"leg{leg.number}_{name}",
        joint=joint,
        foot=leg.foot,
        along=along,
        axes=axes,
        linear=linear,
        least=0.0 if linear.preload > 0.0 else -FAR,
        most=most,
    )
