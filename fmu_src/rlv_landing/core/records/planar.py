"""Records of the planar body: attitude, footpads, loads and accelerations."""

from typing import NamedTuple


class Turn(NamedTuple):
    """Sine and cosine of the pitch and of the ground's slope."""

    sin_p: float
    cos_p: float
    sin_a: float
    cos_a: float


class Attitude(NamedTuple):
    """Attitude of the planar body, and its acceleration along its axis."""

    sin_p: float
    cos_p: float
    along: float  # acceleration of the CG along the body's y [m/s2]


class FootPoint(NamedTuple):
    """A footpad in the inertial frame, and the ground's velocity there."""

    x: float  # [m]
    y: float  # [m]
    z: float  # [m]
    vx: float  # [m/s]
    vy: float  # [m/s]
    vz: float  # [m/s]
    ground_vx: float  # [m/s]
    ground_vy: float  # [m/s]


class PlanarLoads(NamedTuple):
    """Loads of one leg in the planar body's motion."""

    radial: float  # all forces on the footpad but the transverse one along r [N]
    vertical: float  # along h [N]
    tangential: float  # along t [N]
    body_x: float  # the struts' force on the body, body axes [N]
    body_y: float  # [N]
    moment: float  # and moment about its CG, clockwise positive [N m]


class BodyAcceleration(NamedTuple):
    """The body's acceleration along its own axes."""

    x: float  # [m/s2]
    y: float  # [m/s2]
    pitch: float  # [rad/s2]


class FrameAcceleration(NamedTuple):
    """Acceleration along the body's axes of a footpad at rest in its leg's plane."""

    x: float  # [m/s2]
    y: float  # [m/s2]
