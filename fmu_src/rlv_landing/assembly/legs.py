"""The kernels' legs from the user's parameters: the same for every body."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping, Sequence

from ..core import (
    AUXILIARY_STRUTS,
    FRICTION_LAWS,
    MAIN_STRUTS,
    Accounts,
    AcrossState,
    LegModel,
    LegState,
    PointState,
)
from ..core.struts.fluid import fluid
from ..core.struts.kinds import auxiliary_strut, auxiliary_strut_energy
from ..parameters import PARAMETER_QUANTITIES, Parameters
from ..quantities import TRIPOD

# Typical size of each state: the absolute part of the error that is allowed is rtol times this.
# Accounts count in no error; theirs is what the energy balance is measured by.
LEG_SCALE = LegState(r=0.1, h=0.1, vr=1.0, vh=1.0, z1=1e5, z2=1e5, q1=1e-3, q2=1e-3)
# the states whose error is relative to their own size as well: the liquid's pressures
LEG_RELATIVE = LegState(r=0.0, h=0.0, vr=0.0, vh=0.0, z1=1.0, z2=1.0, q1=0.0, q2=0.0)
POINT_SCALE = PointState(q1=1e-3, q2=1e-3)
AT_REST = PointState(q1=0.0, q2=0.0)
ACROSS_SCALE = AcrossState(t=0.1, vt=1.0)
IN_PLANE = AcrossState(t=0.0, vt=0.0)
# [J], of a vehicle that has none
LEAST_ENERGY = 1e-3
# [m/s2], so that a footpad's stiffness does not depend on where the vehicle lands
STANDARD_GRAVITY = 9.80665
# A smaller friction coefficient counts as 0: it is less than the integrator's tolerance, and its
# displacement of some nanometres would need millions of steps.
LEAST_FRICTION = 1e-7
NO_ENERGY = Accounts(*(0.0 for _ in Accounts._fields))
# the names of parameters by their symbols, which are the models' names for them
BY_SYMBOL = {q.symbol: name for name, q in PARAMETER_QUANTITIES.items() if q.symbol}


def flat_state(
    body: Iterable[float],
    legs: Sequence[LegState],
    accounts: Accounts,
    points: Iterable[PointState] = (),
    across: Iterable[AcrossState] = (),
    work: float = 0.0,
) -> array[float]:
    """The numbers of a state.

    They are the body's, each leg group's, those `across` each leg on three struts, each point's,
    the accounts, and each main strut's `work`.
    """
    records = (n for all_ in (legs, across, points) for one in all_ for n in one)
    return array("d", [*body, *records, *accounts, *([work] * len(legs))])


def state_sizes(
    body_scale: Iterable[float], groups: int, parameters: Parameters, points: int = 0
) -> tuple[array[float], array[float]]:
    """The sizes of a state's numbers, and which numbers count by their own size as well.

    Args:
        body_scale: Typical sizes of the body's numbers.
        groups: How many leg groups there are.
        parameters: The parameters of the landing.
        points: How many points of the body meet the ground.
    """
    body = list(body_scale)
    energy = touchdown_energy(parameters)
    accounts = Accounts(*(energy for _ in Accounts._fields))
    tripods = groups if parameters.leg.kind == TRIPOD else 0
    scale = flat_state(
        body,
        [LEG_SCALE] * groups,
        accounts,
        [POINT_SCALE] * points,
        [ACROSS_SCALE] * tripods,
        energy,
    )
    relative = flat_state(
        [0.0] * len(body),
        [LEG_RELATIVE] * groups,
        NO_ENERGY,
        [AT_REST] * points,
        [IN_PLANE] * tripods,
    )
    return scale, relative


def leg_model(whole: Parameters, leg: int = 0) -> LegModel:
    """The numbers of a leg that does not lie in a symmetric plane.

    Args:
        whole: The parameters of the landing.
        leg: The leg's number; 0: one without values for itself.
    """
    parameters = whole.of_leg(leg)
    strut = parameters.auxiliary_strut
    play = strut.play_tension + strut.play_compression > 0.0
    mu = parameters.ground.friction
    own = {
        "main_kind": law_number(MAIN_STRUTS, parameters.main_strut.kind),
        "auxiliary_kind": law_number(AUXILIARY_STRUTS, "elastic-with-play" if play else "elastic"),
        "friction_kind": law_number(FRICTION_LAWS, parameters.ground.friction_law),
        "mu": mu if mu >= LEAST_FRICTION else 0.0,
        "fill": liquid_fill(parameters),
        "K_t": tangential_stiffness(parameters, whole),
        "zone": parameters.ground.slip_zone * parameters.ground.stick_displacement,
        "Lb": -parameters.main_strut.joint_depth,
        "Ld": -parameters.auxiliary_strut.joint_depth,
    }
    own |= {"F_0": 0.0, "U_0": 0.0, "share_1": 0.5}
    return bearing_nothing_at_rest(LegModel(**by_symbol(parameters, LegModel._fields, own)))


def bearing_nothing_at_rest(leg: LegModel) -> LegModel:
    """The leg with the constants that free its auxiliary strut of force and energy at stroke 0."""
    plain = leg._replace(F_0=0.0, U_0=0.0)
    force = auxiliary_strut(0.0, 0.0, plain).force
    return plain._replace(F_0=force, U_0=auxiliary_strut_energy(0.0, plain))


def liquid_fill(parameters: Parameters) -> float:
    """Mass of the liquid in both chambers [kg]."""
    m = parameters.main_strut
    air = (m.air_fraction, m.air_exponent)
    stiffness = (m.bulk_modulus, m.bulk_modulus_slope)
    charged = fluid(m.charge_pressure, *air, *stiffness, m.ambient_pressure)
    return m.fluid_density * (m.volume_upper + m.volume_lower) / charged.v


def touchdown_energy(parameters: Parameters) -> float:
    """Energy that a landing has to dissipate [J].

    It is the kinetic energy at the first contact, and the weight times a tenth of the main strut's
    length.
    """
    vehicle, drop = parameters.vehicle, parameters.drop
    mass = parameters.whole_mass
    moving = drop.horizontal_velocity**2 + drop.vertical_velocity**2 + drop.lateral_velocity**2
    turning = drop.pitch_rate**2 + drop.roll_rate**2 + drop.yaw_rate**2
    fall = mass * parameters.ground.gravity * 0.1 * parameters.main_strut.length
    return max(0.5 * mass * moving + 0.5 * vehicle.inertia * turning + fall, LEAST_ENERGY)


def tangential_stiffness(parameters: Parameters, whole: Parameters | None = None) -> float:
    """Stiffness of a sticking footpad along the ground [N/m] (closure).

    It is `ground.tangential_stiffness`; 0 stands for the weight of the whole vehicle (at standard
    gravity) over the stick displacement.

    Args:
        parameters: The parameters as the footpad's leg has them.
        whole: Those of the whole vehicle, where they are others.
    """
    given = parameters.ground.tangential_stiffness
    if given > 0.0:
        return given
    mass = (whole or parameters).whole_mass
    return mass * STANDARD_GRAVITY / parameters.ground.stick_displacement


def law_number(laws: Mapping[str, object], kind: str) -> float:
    """The number that a `LegModel` has for the law `kind`."""
    return float(sorted(laws).index(kind))


def by_symbol(
    parameters: Parameters, fields: Iterable[str], own: Mapping[str, float]
) -> dict[str, float]:
    """The `fields` of a model: its `own`, and by their symbols those of the parameters."""
    return {
        field: float(own[field] if field in own else parameters[BY_SYMBOL[field]])
        for field in fields
    }
