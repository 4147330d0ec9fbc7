"""Arguments and results of the laws of the struts and of the ground."""

from typing import NamedTuple


class FluidState(NamedTuple):
    """The liquid with its air in a chamber, relative to that at ambient pressure."""

    P: float  # absolute pressure, above 0 [Pa]
    slope: float  # its derivative by the chamber's state
    v: float  # specific volume, 1 at ambient pressure
    dv: float  # its derivative by the chamber's state [1/Pa]
    h: float  # energy that a flow carries: integral of v over pressure from the ambient one [J/m3]


class Chamber(NamedTuple):
    """Volume of a damper chamber, and its slope."""

    V: float  # above 0 [m3]
    area: float  # derivative of V by the piston's motion that enlarges it [m2]


class StrutForce(NamedTuple):
    """The result of a main strut law.

    A law without an orifice, a seal or a stop gives 0 W for it, one without a liquid 0 kg.
    """

    force: float  # [N] compression positive
    dz1: float  # rate of z1
    dz2: float  # rate of z2
    orifice: float  # dissipated in the orifice [W]
    seal: float  # dissipated by friction of the seal [W]
    stop: float  # dissipated by the end stops [W]
    held: float  # energy held by the strut's medium [J]
    liquid_mass: float  # [kg]
    # x = z2 - z1 decays: a change of x changes dz1 by a1 x and dz2 by -a2 x; 0 where nothing
    # is stiff
    a1: float  # [1/s]
    a2: float  # [1/s]
    mass_1: float  # derivative of liquid_mass by z1 [kg]
    mass_2: float  # and by z2 [kg]


class StrutStatus(NamedTuple):
    """Outputs of a main strut beside its force.

    A law without chambers gives 0 for what they would have.
    """

    held_by_stop: float  # energy held by the end stops [J]
    pressure_upper: float  # [Pa]
    pressure_lower: float  # [Pa]


class AxialForce(NamedTuple):
    """The result of the end stops of a main strut."""

    force: float  # [N] compression positive
    dissipated: float  # [W]


class AuxiliaryForce(NamedTuple):
    """The result of an auxiliary strut law."""

    force: float  # [N] compression positive
    dissipated: float  # [W]
    work: float  # what the law's energy is worked out from: elastic force times elongation [J]


class Bearing(NamedTuple):
    """The spring of a joint with play, at one end of the play."""

    u: float  # elongation of the spring that the faces there press on [m]
    slope: float  # its derivative by the joint's motion


class StrutMotion(NamedTuple):
    """A strut between its joint on the body and the footpad; `e` points to the footpad."""

    stroke: float  # [m] compression positive
    rate: float  # [m/s]
    e_r: float
    e_h: float


class SpaceStrut(NamedTuple):
    """A strut between its joint on the body and a footpad that is free across the leg's plane."""

    stroke: float  # [m] compression positive
    rate: float  # [m/s]
    e_r: float
    e_h: float
    e_t: float


class FootMotion(NamedTuple):
    """A footpad against the ground, in the ground's axes."""

    depth: float  # penetration [m]
    depth_rate: float  # [m/s]
    slip_1: float  # [m/s]
    slip_2: float  # [m/s]


class NormalForce(NamedTuple):
    """The result of the ground's normal law."""

    force: float  # on the footpad along n [N]
    dissipated: float  # [W]
    work: float  # elastic force times penetration [J]


class Friction(NamedTuple):
    """Friction along one direction."""

    force: float  # on the footpad [N]
    rate: float  # of the friction displacement [m/s]


class FrictionBound(NamedTuple):
    """A friction law's states q1, q2 brought back within its slip limit."""

    q1: float
    q2: float


class FrictionForce(NamedTuple):
    """The result of a friction law."""

    f1: float  # on the footpad along 1 [N]
    f2: float  # on the footpad along 2 [N]
    dq1: float  # rate of q1 [m/s]
    dq2: float  # rate of q2 [m/s]
    dissipated: float  # [W]


class GroundForce(NamedTuple):
    """Contact forces of the ground on a footpad, in the ground's axes, and their powers."""

    normal: float  # along n [N]
    f1: float  # along 1 [N]
    f2: float  # along 2 [N]
    dq1: float  # [m/s]
    dq2: float  # [m/s]
    dissipated: float  # by the normal damping [W]
    friction: float  # dissipated by friction [W]
    work: float  # elastic force along n times penetration [J]
