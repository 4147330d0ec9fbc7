"""The only layout: what kernels take, give and keep, a record each.

In the compiled core a record is a C struct made from the text here.

Frames. Inertial: x forward, y up, z to the right; the origin is that of the ground. Body: the same
axes turned by the pitch, which is clockwise positive; the origin is the body's centre of gravity
(CG). Leg: r radially out and h up from the CG in a plane fixed in the body, t across it. Ground: n
out of the ground, 1 and 2 along it, 1 down the slope and 2 along inertial z.

All fields are numbers. Compiled, a record that stands in an array is handed on by its address, one
that was just made by value.
"""

from enum import IntEnum
from typing import NamedTuple


class Phase(IntEnum):
    """How far a landing has come; toppled: the whole vehicle's CG is beyond the outermost footpad,
    or the body has turned over.
    """

    FALLING = 0
    CONTACT = 1
    SETTLED = 2
    TOPPLED = 3


class Fault(IntEnum):
    """Why a solver cannot go on."""

    NONE = 0
    COLLAPSED = 1
    TOO_MANY_STEPS = 2


# ---- the state of a vehicle: the body, each leg group, then the accounts; and its inputs


class BodyState(NamedTuple):
    """The body in the inertial frame. As rates, the same a second."""

    x: float  # CG [m]
    y: float  # CG [m]
    pitch: float  # [rad]
    vx: float  # [m/s]
    vy: float  # [m/s]
    pitch_rate: float  # [rad/s]


class LegState(NamedTuple):
    """One leg: its footpad in the leg's plane, and what its laws keep.

    As rates, the same a second.
    """

    r: float  # [m]
    h: float  # [m]
    vr: float  # [m/s]
    vh: float  # [m/s]
    z1: float  # the main strut law's own; of a liquid spring the upper chamber's, see `struts.fluid` [Pa]
    z2: float  # the main strut law's own; of a liquid spring the lower chamber's [Pa]
    q1: float  # the friction law's displacement along 1 [m]
    q2: float  # the friction law's displacement along 2 [m]


class Accounts(NamedTuple):
    """Energy [J] dissipated so far, in six ways, and supplied so far, in three, by all legs.

    As rates, powers [W].
    """

    orifice: float
    seal: float
    stop: float
    auxiliary: float
    contact: float
    friction: float
    external: float
    ground: float
    transverse: float


class Inputs(NamedTuple):
    """Load on the body at its CG, and motion of the ground, in the inertial frame."""

    force_x: float  # [N]
    force_y: float  # [N]
    moment: float  # clockwise positive [N m]
    heave: float  # lift of the ground [m]
    heave_rate: float  # [m/s]
    tilt: float  # about the inertial origin, on top of the slope, clockwise positive [rad]
    tilt_rate: float  # [rad/s]


# ---- the models: numbers that a landing does not change, under the paper's symbols, which
# `rlv_landing.quantities` tells the meaning of


class BodyModel(NamedTuple):
    """The body and the ground it comes down on."""

    m_u: float
    I_u: float
    H: float
    at_joint: float  # 1: the body feels the legs' transverse forces at the auxiliary struts' joints; 0: at the footpads
    alpha: float
    g: float


class LegModel(NamedTuple):
    """One leg: all that its struts, its footpad and the ground below it need.

    `Lb`, `Ld` are heights, negative below the CG.
    """

    main_kind: float  # number of the law in `struts.laws.MAIN_STRUTS`
    auxiliary_kind: float  # number of the law in `struts.laws.AUXILIARY_STRUTS`
    friction_kind: float  # number of the law in `ground.laws.FRICTION_LAWS`
    m_d: float
    # main strut: joint and length, liquid spring, seal, end stops
    La: float
    Lb: float
    Lm0: float
    A1: float
    A2: float
    V10: float
    V20: float
    fill: float  # the liquid's mass [kg]
    Pa: float
    rho0: float
    x_air: float
    n_air: float
    B0: float
    kB: float
    CdAo_c: float
    CdAo_r: float
    dP_lam: float
    Fc: float
    kp: float
    Fs: float
    v_str: float
    v_sm: float
    s_max: float
    K_stop: float
    c_stop: float
    # auxiliary strut
    Lc: float
    Ld: float
    Ls0: float
    Ka: float
    ek: float
    Ca: float
    g_t: float
    g_c: float
    k_play: float
    c_play: float
    F_0: float  # force of the joints' faces at stroke 0, which the law leaves out [N]
    U_0: float  # energy of the joints' faces at stroke 0, which the law leaves out [J]
    # ground
    Kg: float
    en: float
    Cgmax: float
    d_ramp: float
    mu: float
    s_r0: float
    ar: float
    b_strib: float
    Cr: float
    v_dir: float
    tau_sr: float
    K_t: float
    zone: float  # [m]
    share_1: (
        float  # part of mu^2 along 1 at rest: 1/2; 1 for a leg that lies in the symmetric plane
    )


class LegPlace(NamedTuple):
    """Where a leg group stands on the body, and how many legs (mirror images of each other) it
    stands for.
    """

    sin_g: float  # sine of the azimuth
    cos_g: float  # cosine of the azimuth
    legs: float


# ---- what the laws of a leg give


class FluidState(NamedTuple):
    """The liquid with its air in a chamber, relative to that at ambient pressure."""

    P: float  # absolute pressure, above 0 [Pa]
    slope: float  # its derivative by the chamber's state
    v: float  # specific volume, 1 at ambient pressure
    dv: float  # its derivative by the chamber's state [1/Pa]
    h: float  # energy that a flow carries: integral of v over pressure from the ambient one [J/m3]


class Chamber(NamedTuple):
    """A chamber's volume."""

    V: float  # above 0 [m3]
    area: float  # how fast it grows with the piston's motion away [m2]


class StrutForce(NamedTuple):
    """What a main strut law gives.

    A law without a passage, a seal or a stop gives 0 W for it, one without a liquid 0 kg.
    """

    force: float  # [N] compression positive
    dz1: float  # rate of z1
    dz2: float  # rate of z2
    orifice: float  # dissipated in the passage [W]
    seal: float  # dissipated by friction of the seal [W]
    stop: float  # dissipated by the end stops [W]
    held: float  # energy held by the strut's medium [J]
    liquid_mass: float  # [kg]
    a1: float  # x = z2 - z1 decays: a change of x changes dz1 by a1 x [1/s]; 0 where nothing is stiff
    a2: float  # and dz2 by -a2 x [1/s]; 0 where nothing is stiff
    mass_1: float  # derivative of liquid_mass by z1 [kg]
    mass_2: float  # and by z2 [kg]


class StrutStatus(NamedTuple):
    """What is read of a main strut beside its force.

    A law without chambers gives 0 for what they would have.
    """

    held_by_stop: float  # energy held by the end stops [J]
    pressure_upper: float  # [Pa]
    pressure_lower: float  # [Pa]


class AxialForce(NamedTuple):
    """What an auxiliary strut law gives, and the end stops of a main strut."""

    force: float  # [N] compression positive
    dissipated: float  # [W]


class Bearing(NamedTuple):
    """How far the faces of a joint with play have come to bear on one side."""

    u: float  # elongation of what they press on [m]
    slope: float  # its derivative by the joint's motion


class StrutMotion(NamedTuple):
    """A strut between its joint on the body and the footpad; `e` points to the footpad."""

    stroke: float  # [m] compression positive
    rate: float  # [m/s]
    e_r: float
    e_h: float


class FootMotion(NamedTuple):
    """A footpad against the ground, in the ground's axes."""

    depth: float  # penetration [m]
    depth_rate: float  # [m/s]
    slip_1: float  # [m/s]
    slip_2: float  # [m/s]


class NormalForce(NamedTuple):
    """What the ground's normal law gives."""

    force: float  # on the footpad along n [N]
    dissipated: float  # [W]


class Friction(NamedTuple):
    """Friction along one direction."""

    force: float  # on the footpad [N]
    rate: float  # of the displacement [m/s]


class FrictionBound(NamedTuple):
    """A friction law's states where it lets them be."""

    q1: float
    q2: float


class FrictionForce(NamedTuple):
    """What a friction law gives."""

    f1: float  # on the footpad along 1 [N]
    f2: float  # on the footpad along 2 [N]
    dq1: float  # rate of q1 [m/s]
    dq2: float  # rate of q2 [m/s]
    dissipated: float  # [W]


class GroundForce(NamedTuple):
    """All that the ground does to a footpad, in the ground's axes."""

    normal: float  # along n [N]
    f1: float  # along 1 [N]
    f2: float  # along 2 [N]
    dq1: float  # [m/s]
    dq2: float  # [m/s]
    dissipated: float  # by the normal damping [W]
    friction: float  # dissipated by friction [W]


class LegForces(NamedTuple):
    """All that one leg does: strut forces in its plane, the ground's force in the ground's axes,
    rates of its laws' states, powers [W].
    """

    stroke: float  # main strut [m]
    stroke_rate: float  # [m/s]
    main: float  # its force [N] compression positive
    auxiliary_stroke: float  # [m]
    auxiliary_rate: float  # [m/s]
    auxiliary: float  # its force [N] compression positive
    main_r: float  # main strut's force on the footpad along r [N]
    main_h: float  # along h [N]
    auxiliary_r: float  # auxiliary strut's force on the footpad along r [N]
    auxiliary_h: float  # along h [N]
    moment: float  # of the struts on the body about the CG, in the leg's plane, from h towards r positive [N m]
    normal: float  # the ground's force on the footpad along n [N]
    f1: float  # along 1 [N]
    f2: float  # along 2 [N]
    dz1: float
    dz2: float
    dq1: float  # [m/s]
    dq2: float  # [m/s]
    a1: float  # see StrutForce [1/s]
    a2: float  # [1/s]
    orifice: float
    seal: float
    stop: float
    auxiliary_dissipated: float
    contact: float  # dissipated by the ground's normal damping
    friction: float  # dissipated by friction
    held: float  # energy held by the main strut's medium [J]
    liquid_mass: float  # [kg]
    mass_1: float  # see StrutForce
    mass_2: float


class LegStatus(NamedTuple):
    """What is read of a leg beside its forces: energies held [J], and the main strut's chambers."""

    stop: float
    auxiliary: float
    contact: float
    friction: float
    pressure_upper: float  # [Pa]
    pressure_lower: float  # [Pa]


# ---- the planar body's own


class Turn(NamedTuple):
    """Sine and cosine of the pitch and of the ground's slope."""

    sin_p: float
    cos_p: float
    sin_a: float
    cos_a: float


class Attitude(NamedTuple):
    """How the planar body stands, and how it is accelerated along its axis."""

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
    """What one leg does in the planar body's motion."""

    foot_x: float  # footpad, inertial [m]
    foot_y: float  # [m]
    foot_z: float  # [m]
    depth: float  # penetration [m]
    contact_x: float  # the ground's force on the footpad, inertial [N]
    contact_y: float  # [N]
    contact_z: float  # [N]
    radial: float  # all forces on the footpad but the transverse one along r [N]
    vertical: float  # along h [N]
    tangential: float  # along t [N]
    body_x: float  # the struts' force on the body, body axes [N]
    body_y: float  # [N]
    moment: float  # and moment about its CG, clockwise positive [N m]
    ground: float  # power of the moving ground [W]


class BodyAcceleration(NamedTuple):
    """The body's acceleration along its own axes."""

    x: float  # [m/s2]
    y: float  # [m/s2]
    pitch: float  # [rad/s2]


class HeldEnergy(NamedTuple):
    """Where the mechanical energy [J] of the vehicle is."""

    kinetic: float
    potential: float
    liquid: float
    auxiliary: float
    contact: float
    friction: float
    stop: float


# ---- what a user sees, in the order of `rlv_landing.quantities`; strut forces are negative in
# compression here


class BodyOutputs(NamedTuple):
    """The quantities `body.*`."""

    x: float
    y: float
    pitch: float
    vx: float
    vy: float
    pitch_rate: float
    ax: float
    ay: float
    pitch_acceleration: float
    top_axial_acceleration: float


class EnergyOutputs(NamedTuple):
    """The quantities `energy.*` [J]."""

    kinetic: float
    potential: float
    liquid: float
    auxiliary: float
    contact: float
    friction: float
    stop: float
    dissipated_orifice: float
    dissipated_seal: float
    dissipated_stop: float
    dissipated_auxiliary: float
    dissipated_contact: float
    dissipated_friction: float
    work_external: float
    work_ground: float
    work_transverse: float
    dissipated: float
    balance: float


class StatusOutputs(NamedTuple):
    """The quantities `status.*`."""

    phase: float
    stability_margin: float


class LegOutputs(NamedTuple):
    """The quantities of one leg."""

    main_strut_force: float
    main_strut_stroke: float
    main_strut_stroke_rate: float
    main_strut_pressure_upper: float
    main_strut_pressure_lower: float
    main_strut_liquid_mass: float
    auxiliary_strut_force: float
    auxiliary_strut_stroke: float
    auxiliary_strut_stroke_rate: float
    footpad_x: float
    footpad_y: float
    footpad_z: float
    contact_force_x: float
    contact_force_y: float
    contact_force_z: float
    contact_force: float
    contact_penetration: float
    contact_active: float


# ---- the solvers' own


class StiffPair(NamedTuple):
    """Two states `i`, `j` whose difference x = y_j - y_i decays: a change of x changes y_i' by a1 x
    and y_j' by -a2 x.
    """

    i: int
    j: int
    a1: float  # [1/s]
    a2: float  # [1/s]


class PhiWeights(NamedTuple):
    """Weights of one stiff pair in an exponential step: of the rates at its start, at the stage
    before, or at the stages 2 to 4.
    """

    a21: float
    a31: float
    a32: float
    a41: float
    a43: float
    b1: float
    b23: float
    b4: float


class Bend(NamedTuple):
    """A quantity at three times one after the other."""

    t0: float  # [s]
    v0: float
    t1: float  # [s]
    v1: float
    t2: float  # [s]
    v2: float


class Crest(NamedTuple):
    """Where and how high a quantity is at most."""

    t: float  # [s]
    value: float
