"""The state of a vehicle: the body, each leg group, then the energy accounts; and its inputs."""

from enum import IntEnum
from typing import NamedTuple


class Phase(IntEnum):
    """The phase of a landing.

    Toppled: the whole vehicle's CG is beyond the outermost footpad, or the body has turned over.
    """

    FALLING = 0
    CONTACT = 1
    SETTLED = 2
    TOPPLED = 3


class Fault(IntEnum):
    """The reason why a solver cannot continue."""

    NONE = 0
    COLLAPSED = 1
    TOO_MANY_STEPS = 2
    OFF_GROUND = 3


class BodyState(NamedTuple):
    """The body in the inertial frame. For derivatives, the same fields, each per second."""

    x: float  # CG [m]
    y: float  # CG [m]
    pitch: float  # [rad]
    vx: float  # [m/s]
    vy: float  # [m/s]
    pitch_rate: float  # [rad/s]


class LegState(NamedTuple):
    """One leg: its footpad in the leg's plane, and the states of its laws.

    For derivatives, the same fields, each per second.
    """

    r: float  # [m]
    h: float  # [m]
    vr: float  # [m/s]
    vh: float  # [m/s]
    # states of the main strut law; of a liquid spring its chambers' states [Pa], see `struts.fluid`
    z1: float  # of the upper chamber
    z2: float  # of the lower chamber
    q1: float  # the friction law's displacement along 1 [m]
    q2: float  # the friction law's displacement along 2 [m]


class AcrossState(NamedTuple):
    """A footpad across its leg's plane, where it is free. For derivatives, each per second."""

    t: float  # [m]
    vt: float  # [m/s]


class Accounts(NamedTuple):
    """Energy accounts of all legs [J]: dissipated so far, six fields, and supplied so far, three.

    For derivatives, powers [W].
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
