"""The struts of a leg as two bodies each, for formats that have no tendons."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..errors import LandingError
from ..quantities import RADIAL, TRIPOD
from .linear import Linear
from .mechanism import LegMechanism, Vector

# of a strut's rod, whose mass the model does not have [kg], [kg m2]
ROD_MASS, ROD_INERTIA = 1e-3, 1e-6
# of a body: its products are 0
POINT = np.eye(3) * ROD_INERTIA
# how far a strut may be drawn out that no stop holds [m]
FAR = 10.0


class Rod(NamedTuple):
    """A strut: it turns about the leg's axis at `joint`, and is shorter by its stroke.

    Attributes:
        name: Of the strut, as `leg1_main`.
        joint: Place on the body [m].
        foot: Place of the footpad [m].
        along: Direction of a positive stroke, from the footpad to the joint.
        linear: Its spring and damper.
        least: Least stroke [m].
        most: Largest stroke [m].
    """

    name: str
    joint: Vector
    foot: Vector
    along: Vector
    linear: Linear
    least: float
    most: float

    @property
    def free_stroke(self) -> float:
        """The stroke at which the spring bears nothing [m]."""
        return -self.linear.preload / self.linear.stiffness


def rods(leg: LegMechanism) -> tuple[Rod, Rod]:
    """The main and the auxiliary strut of a leg.

    Raises:
        LandingError: It is a tripod, whose rods turn about no one axis.
    """
    if len(leg.auxiliary_joints) > 1:
        raise LandingError(
            f"leg.kind = {TRIPOD} is exported as MJCF alone: rods of SDF and URDF turn about one "
            f"axis; write --mjcf, or leg.kind = {RADIAL}"
        )
    return (
        _rod(leg, "main", leg.main_joint, leg.main, leg.stroke_max),
        _rod(leg, "auxiliary", leg.auxiliary_joints[0], leg.auxiliary, FAR),
    )


def _rod(leg: LegMechanism, name: str, joint: Vector, linear: Linear, most: float) -> Rod:
    way = joint - leg.foot
    return Rod(
        name=f"leg{leg.number}_{name}",
        joint=joint,
        foot=leg.foot,
        along=way / float(np.linalg.norm(way)),
        linear=linear,
        least=0.0 if linear.preload > 0.0 else -FAR,
        most=most,
    )
