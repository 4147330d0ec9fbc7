"""Records of the spatial body (6 DOF): state, inputs, ground, footpads, loads, vectors."""

from typing import NamedTuple


class Vector(NamedTuple):
    """A vector with three components."""

    x: float
    y: float
    z: float


class Rotation(NamedTuple):
    """A rotation: three axes of a body, in inertial axes.

    Those of the ground are 1 down the slope, its normal, and 2.
    """

    x_x: float  # the body's x axis
    x_y: float
    x_z: float
    y_x: float  # its y axis
    y_y: float
    y_z: float
    z_x: float  # its z axis
    z_y: float
    z_z: float


class SpatialState(NamedTuple):
    """The body in space. For derivatives, the same fields, each per second."""

    x: float  # CG, inertial [m]
    y: float  # [m]
    z: float  # [m]
    # attitude: unit quaternion, body to inertial axes
    q_w: float
    q_x: float
    q_y: float
    q_z: float
    vx: float  # velocity of the CG, inertial [m/s]
    vy: float  # [m/s]
    vz: float  # [m/s]
    spin_x: float  # angular velocity, body axes [rad/s]
    spin_y: float  # [rad/s]
    spin_z: float  # [rad/s]


class SpatialModel(NamedTuple):
    """Parameters of the body, and of the ground at rest.

    The CG is off the legs' axis by `cg_x`, `cg_z`. The inertia is that about the CG, body axes.
    """

    m_u: float
    I_x: float  # [kg m2]
    I_y: float  # [kg m2]
    I_z: float  # [kg m2]
    I_xy: float  # products: integral of -x y dm [kg m2]
    I_xz: float  # [kg m2]
    I_yz: float  # [kg m2]
    cg_x: float  # [m]
    cg_z: float  # [m]
    H: float  # of the top sensor above the CG, on the legs' axis [m]
    at_joint: float  # see BodyModel
    tripod: float  # 1: each leg has three struts, and its footpad is free; 0: it keeps in a plane
    g: float
    heading: float  # outputs give the heading within half a turn of it [rad]
    # the ground's axes 1, 2 and its normal n on a deck that is not turned
    down_x: float
    down_y: float
    down_z: float
    along_x: float
    along_z: float
    normal_x: float
    normal_y: float
    normal_z: float


class SpatialInputs(NamedTuple):
    """Loads on the body at its CG, and the motion of the ground, a deck; inertial axes.

    The deck's axes are the inertial ones turned by `ground_yaw` about y, then by `ground_roll`
    about x, then clockwise by `ground_pitch` about z.
    """

    force_x: float  # [N]
    force_y: float  # [N]
    force_z: float  # [N]
    moment_x: float  # [N m]
    moment_y: float  # [N m]
    moment_z: float  # [N m]
    surge: float  # of the deck's origin along x [m]
    surge_rate: float  # [m/s]
    heave: float  # along y [m]
    heave_rate: float  # [m/s]
    sway: float  # along z [m]
    sway_rate: float  # [m/s]
    roll: float  # [rad]
    roll_rate: float  # [rad/s]
    yaw: float  # [rad]
    yaw_rate: float  # [rad/s]
    tilt: float  # clockwise positive [rad]
    tilt_rate: float  # [rad/s]


class DeckTurn(NamedTuple):
    """The deck's angles, with their sines and cosines."""

    yaw: float  # [rad]
    roll: float  # [rad]
    tilt: float  # [rad]
    sin_y: float
    cos_y: float
    sin_r: float
    cos_r: float
    sin_t: float
    cos_t: float


class FootPlace(NamedTuple):
    """A footpad relative to the body."""

    from_cg: Vector  # body axes [m]
    rate: Vector  # its velocity relative to the body, body axes [m/s]


class SpatialLoads(NamedTuple):
    """Loads of one leg in the spatial body's motion, the leg's axes."""

    radial: float  # all forces on the footpad but the transverse one along r [N]
    vertical: float  # along h [N]
    tangential: float  # along t [N]
    # part of the footpad's acceleration by the spin itself: without the parts by accelerations of
    # the CG, of the spin, and of the footpad in its leg
    bias_r: float  # [m/s2]
    bias_h: float
    bias_t: float
    foot_x: float  # footpad from the CG, body axes [m]
    foot_y: float
    foot_z: float


class SpatialAttitude(NamedTuple):
    """The body's acceleration in its own axes."""

    a_x: float  # of the CG [m/s2]
    a_y: float
    a_z: float
    spin_x: float  # [rad/s2]
    spin_y: float
    spin_z: float


class BodyPoint(NamedTuple):
    """A point of the body that meets the ground, from the legs' axis at the CG's height [m]."""

    x: float  # body axes
    y: float
    z: float


class PointState(NamedTuple):
    """The friction law's displacement at a point of the body. For derivatives, each per second."""

    q1: float  # along 1 [m]
    q2: float  # along 2 [m]


class HeightField(NamedTuple):
    """A regular grid of heights above the ground's plane.

    Its coordinates u, v are those of the deck's x, z, turned with the slope; rows go along u.
    """

    columns: float  # nodes of a row; 0: there is none
    rows: float
    u0: float  # the first node [m]
    v0: float
    du: float  # spacings [m]
    dv: float
    sin_d: float  # sine of the slope's direction, which turns the ground's axes 1, 2 to u, v
    cos_d: float


class Cubic(NamedTuple):
    """A cubic at a place."""

    value: float
    slope: float  # its derivative, a spacing


class TerrainHeight(NamedTuple):
    """A height field at a place."""

    height: float  # [m]
    slope_u: float  # [m] a spacing
    slope_v: float


class TerrainPlace(NamedTuple):
    """A place in a height field, in the axes of the ground's plane."""

    depth: float  # below the field, along the plane's normal [m]
    slope_1: float  # of the field along 1
    slope_2: float  # along 2
    outside: float  # 1 beyond the field
