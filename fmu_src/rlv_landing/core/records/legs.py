"""Forces and outputs of one leg, and its footpad's loads."""

from typing import NamedTuple


class LegForces(NamedTuple):
    """Forces of one leg, rates of its laws' states, and powers [W].

    Strut forces are in the leg's plane, the ground's force is in the ground's axes.
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
    # of the struts on the body about the CG, in the leg's plane, from h towards r positive [N m]
    moment: float
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
    auxiliary_work: float  # see AuxiliaryForce [J]
    contact_work: float  # see GroundForce [J]


class AcrossForces(NamedTuple):
    """What a leg on three struts has beside its `LegForces`, the leg's axes.

    Those have the main strut and the first auxiliary strut, with their parts in the leg's plane.
    """

    stroke: float  # second auxiliary strut [m]
    rate: float  # [m/s]
    force: float  # [N] compression positive
    dissipated: float  # by it [W]
    r: float  # its force on the footpad along r [N]
    h: float  # along h [N]
    t: float  # all struts' force on the footpad along t [N]
    # of the struts on the body about the legs' axis at the CG's height [N m]
    moment_r: float  # of all struts
    moment_h: float  # of all struts
    moment: float  # of the second auxiliary strut, as in LegForces


class FootLoads(NamedTuple):
    """A footpad and the ground's force on it, both inertial."""

    x: float  # [m]
    y: float  # [m]
    z: float  # [m]
    depth: float  # penetration [m]
    contact_x: float  # [N]
    contact_y: float  # [N]
    contact_z: float  # [N]
    ground: float  # power of the moving ground [W]


class LegStatus(NamedTuple):
    """Outputs of a leg beside its forces: energies held [J], and the main strut's chambers."""

    stop: float
    auxiliary: float
    contact: float
    friction: float
    pressure_upper: float  # [Pa]
    pressure_lower: float  # [Pa]
