"""The kernels' vehicle, and its state at the start, from the user's parameters."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping
from typing import cast

from .core import (
    AUXILIARY_STRUTS,
    FRICTION_LAWS,
    MAIN_STRUTS,
    Accounts,
    BodyModel,
    BodyState,
    Exponential,
    Inputs,
    LegModel,
    LegPlace,
    LegState,
    Planar,
    Solver,
)
from .core.access import BALANCE, BODY_OUTPUTS
from .core.struts.fluid import fluid
from .core.struts.kinds import auxiliary_strut, auxiliary_strut_energy
from .parameters import PARAMETER_QUANTITIES, Parameters
from .quantities import LEGS, MODES, azimuth
from .touchdown import AT_REST, FreeFlight, GroundMotion

# Typical size of each state: the absolute part of the error that is allowed is rtol times this.
# Accounts count in no error; theirs is what the energy balance is measured by.
BODY_SCALE = BodyState(x=0.1, y=0.1, pitch=0.1, vx=1.0, vy=1.0, pitch_rate=1.0)
LEG_SCALE = LegState(r=0.1, h=0.1, vr=1.0, vh=1.0, z1=1e5, z2=1e5, q1=1e-3, q2=1e-3)
# [J], of a vehicle that has none
LEAST_ENERGY = 1e-3
# [m/s2], so that a footpad's stiffness does not depend on where the vehicle lands
STANDARD_GRAVITY = 9.80665
# A smaller friction coefficient counts as 0: it is less than the integrator's tolerance, and its
# displacement of some nanometres would need millions of steps.
LEAST_FRICTION = 1e-7
NO_ENERGY = Accounts(*(0.0 for _ in Accounts._fields))
NO_INPUTS = Inputs(*(0.0 for _ in Inputs._fields))
# the states whose error is relative to their own size as well: the liquid's pressures
BODY_RELATIVE = BodyState(x=0.0, y=0.0, pitch=0.0, vx=0.0, vy=0.0, pitch_rate=0.0)
LEG_RELATIVE = LegState(r=0.0, h=0.0, vr=0.0, vh=0.0, z1=1.0, z2=1.0, q1=0.0, q2=0.0)


# the names of parameters by their symbols, which are the models' names for them
BY_SYMBOL = {q.symbol: name for name, q in PARAMETER_QUANTITIES.items() if q.symbol}


def flat_state(body: BodyState, legs: Iterable[LegState], accounts: Accounts) -> array[float]:
    """The numbers of a state: the body's, each leg group's, the accounts."""
    return array("d", [*body, *(number for leg in legs for number in leg), *accounts])


def body_model(parameters: Parameters) -> BodyModel:
    """The body's numbers."""
    at_joint = 1.0 if parameters.vehicle.transverse_load_at == "joint" else 0.0
    return BodyModel(**_by_symbol(parameters, BodyModel._fields, {"at_joint": at_joint}))


def leg_models(parameters: Parameters) -> list[LegModel]:
    """The numbers of each leg group of the parameters' landing mode."""
    strut = parameters.auxiliary_strut
    play = strut.play_tension + strut.play_compression > 0.0
    mu = parameters.ground.friction
    own = {
        "main_kind": _place(MAIN_STRUTS, parameters.main_strut.kind),
        "auxiliary_kind": _place(AUXILIARY_STRUTS, "elastic-with-play" if play else "elastic"),
        "friction_kind": _place(FRICTION_LAWS, parameters.ground.friction_law),
        "mu": mu if mu >= LEAST_FRICTION else 0.0,
        "fill": liquid_fill(parameters),
        "K_t": tangential_stiffness(parameters),
        "zone": parameters.ground.slip_zone * parameters.ground.stick_displacement,
        "Lb": -parameters.main_strut.joint_depth,
        "Ld": -parameters.auxiliary_strut.joint_depth,
    }
    own |= {"F_0": 0.0, "U_0": 0.0, "share_1": 0.5}
    common = bearing_nothing_at_rest(LegModel(**_by_symbol(parameters, LegModel._fields, own)))
    return [
        common._replace(share_1=1.0 if place.sin_g == 0.0 else 0.5)
        for place in leg_places(parameters)
    ]


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
    mass = vehicle.mass + vehicle.footpad_mass * len(LEGS)
    moving = 0.5 * mass * (drop.horizontal_velocity**2 + drop.vertical_velocity**2)
    turning = 0.5 * vehicle.inertia * drop.pitch_rate**2
    fall = mass * parameters.ground.gravity * 0.1 * parameters.main_strut.length
    return max(moving + turning + fall, LEAST_ENERGY)


def tangential_stiffness(parameters: Parameters) -> float:
    """Stiffness of a sticking footpad along the ground [N/m] (closure).

    It is `ground.tangential_stiffness`; 0 stands for the weight of the whole vehicle (at standard
    gravity) over the stick displacement.
    """
    given, vehicle = parameters.ground.tangential_stiffness, parameters.vehicle
    if given > 0.0:
        return given
    mass = vehicle.mass + vehicle.footpad_mass * len(LEGS)
    return mass * STANDARD_GRAVITY / parameters.ground.stick_displacement


def leg_places(parameters: Parameters) -> list[LegPlace]:
    """Place and number of legs of each leg group of the parameters' landing mode."""
    return [
        LegPlace(*azimuth(group.azimuth), float(len(group.legs)))
        for group in MODES[parameters.drop.mode]
    ]


def build_system(parameters: Parameters, kind: type[Planar] = Planar) -> Planar:
    """The vehicle on its ground, for the parameters' landing mode.

    Args:
        parameters: The parameters of the landing.
        kind: The class of the compiled or of the pure core.
    """
    legs = leg_models(parameters)
    energy = touchdown_energy(parameters)
    scale = flat_state(
        BODY_SCALE, [LEG_SCALE] * len(legs), Accounts(*(energy for _ in Accounts._fields))
    )
    relative = flat_state(BODY_RELATIVE, [LEG_RELATIVE] * len(legs), NO_ENERGY)
    return kind(body_model(parameters), legs, leg_places(parameters), scale, relative)


def ground_motion(inputs: Inputs, rates: Inputs) -> GroundMotion:
    """The motion of the ground from the time on at which the inputs have these values and rates."""
    return GroundMotion(
        inputs.heave,
        inputs.heave_rate,
        rates.heave_rate,
        inputs.tilt,
        inputs.tilt_rate,
        rates.tilt_rate,
    )


def start_state(parameters: Parameters, ground: GroundMotion = AT_REST) -> array[float]:
    """The state at time 0.

    It is the state at the first contact, taken back along the free flight of the rigid vehicle. At
    the first contact the ground's origin lies below the CG, and the lowest footpad just touches.

    Args:
        parameters: The parameters of the landing.
        ground: The motion of the ground from time 0 on.

    Raises:
        LandingError: As `FreeFlight.start`.
    """
    flight = FreeFlight(parameters, ground)
    body = BodyState(*flight.start())
    radius, height = flight.footpad
    charge = parameters.main_strut.charge_pressure
    leg = LegState(r=radius, h=height, vr=0.0, vh=0.0, z1=charge, z2=charge, q1=0.0, q2=0.0)
    return flat_state(body, [leg] * len(MODES[parameters.drop.mode]), NO_ENERGY)


def new_solver(
    parameters: Parameters,
    rtol: float,
    method: type[Solver] = Exponential,
    kind: type[Planar] = Planar,
) -> Solver:
    """A solver at the start of the parameters' landing.

    Args:
        parameters: The parameters of the landing.
        rtol: Relative tolerance.
        method: The integration method, of the same core as `kind`.
        kind: The vehicle's class, of the compiled or of the pure core.
    """
    solver = method(build_system(parameters, kind), rtol)
    begin(solver, parameters)
    return solver


def begin(
    solver: Solver, parameters: Parameters, inputs: Inputs = NO_INPUTS, rates: Inputs = NO_INPUTS
) -> None:
    """Take a solver to the start of the parameters' landing.

    The time, the counts and the energy balance are 0 then.

    Args:
        solver: A solver of `build_system(parameters)`.
        parameters: The parameters of the landing.
        inputs: The inputs at time 0.
        rates: Their rates.

    Raises:
        LandingError: As `start_state`; nothing is changed then.
    """
    for target, numbers in (
        (solver.y, start_state(parameters, ground_motion(inputs, rates))),
        (solver.u, inputs),
        (solver.u_rate, rates),
    ):
        for i, value in enumerate(numbers):
            target[i] = value
    system = cast(Planar, solver.system)
    system.energy_start = system.most_balance = 0.0
    solver.t_input = 0.0
    outputs = array("d", bytes(8 * system.row))
    solver.outputs_at(0.0, array("d", solver.y), outputs)
    system.energy_start = outputs[BODY_OUTPUTS + BALANCE]
    solver.start(0.0)


def _place(laws: Mapping[str, object], kind: str) -> float:
    """The number that a `LegModel` has for the law `kind`."""
    return float(sorted(laws).index(kind))


def _by_symbol(
    parameters: Parameters, fields: Iterable[str], own: Mapping[str, float]
) -> dict[str, float]:
    """The `fields` of a model: its `own`, and by their symbols those of the parameters."""
    return {
        field: float(own[field] if field in own else parameters[BY_SYMBOL[field]])
        for field in fields
    }
