"""The kernels' vehicle, and its state at the start, from the user's parameters."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping

from .core import (
    AUXILIARY_STRUTS,
    FRICTION_LAWS,
    MAIN_STRUTS,
    Accounts,
    BodyModel,
    BodyState,
    Exponential,
    LegModel,
    LegPlace,
    LegState,
    Planar,
    Solver,
)
from .errors import LandingError
from .parameters import PARAMETER_QUANTITIES, Parameters, azimuth
from .quantities import MODES
from .touchdown import FreeFlight

# Typical size of each state: the absolute part of the error that is allowed is rtol times this.
# Accounts count in no error.
BODY_SCALE = BodyState(x=0.1, y=0.1, pitch=0.1, vx=1.0, vy=1.0, pitch_rate=1.0)
LEG_SCALE = LegState(r=0.1, h=0.1, vr=1.0, vh=1.0, z1=1e5, z2=1e5, q1=1e-3, q2=1e-3)
NO_ENERGY = Accounts(*(0.0 for _ in Accounts._fields))
# the states whose error is relative to their own size as well: the liquid's pressures
BODY_RELATIVE = BodyState(x=0.0, y=0.0, pitch=0.0, vx=0.0, vy=0.0, pitch_rate=0.0)
LEG_RELATIVE = LegState(r=0.0, h=0.0, vr=0.0, vh=0.0, z1=1.0, z2=1.0, q1=0.0, q2=0.0)


def flat_state(body: BodyState, legs: Iterable[LegState], accounts: Accounts) -> array[float]:
    """The numbers of a state: the body's, each leg group's, the accounts."""
    return array("d", [*body, *(number for leg in legs for number in leg), *accounts])


def body_model(parameters: Parameters) -> BodyModel:
    """The body's numbers."""
    at_joint = 1.0 if parameters.vehicle.transverse_load_at == "joint" else 0.0
    return BodyModel(**_by_symbol(parameters, BodyModel._fields, {"at_joint": at_joint}))


def leg_models(parameters: Parameters) -> list[LegModel]:
    """The numbers of each leg group of the parameters' landing mode."""
    own = {
        "main_kind": _place(MAIN_STRUTS, "liquid-spring"),
        "auxiliary_kind": _place(AUXILIARY_STRUTS, "elastic"),
        "friction_kind": _place(FRICTION_LAWS, "paper"),
        "Lb": -parameters.main_strut.joint_depth,
        "Ld": -parameters.auxiliary_strut.joint_depth,
    }
    common = LegModel(**_by_symbol(parameters, LegModel._fields, {**own, "share_1": 0.5}))
    return [
        common._replace(share_1=1.0 if place.sin_g == 0.0 else 0.5)
        for place in leg_places(parameters)
    ]


def leg_places(parameters: Parameters) -> list[LegPlace]:
    """Where each leg group of the parameters' landing mode stands, and how many legs it stands for."""
    return [
        LegPlace(*azimuth(group.azimuth), float(len(group.legs)))
        for group in MODES[parameters.drop.mode]
    ]


def build_system(parameters: Parameters, kind: type[Planar] = Planar) -> Planar:
    """The vehicle on its ground, for the parameters' landing mode; `kind` is the compiled or the
    pure core's class.
    """
    legs = leg_models(parameters)
    scale = flat_state(
        BODY_SCALE, [LEG_SCALE] * len(legs), Accounts(*(1.0 for _ in Accounts._fields))
    )
    relative = flat_state(BODY_RELATIVE, [LEG_RELATIVE] * len(legs), NO_ENERGY)
    return kind(body_model(parameters), legs, leg_places(parameters), scale, relative)


def start_state(parameters: Parameters) -> array[float]:
    """The state at time 0: the state at first contact taken back along the free flight of the rigid
    vehicle.

    The ground's origin lies below the CG at first contact, where the lowest footpad just touches.
    Raises LandingError where the free flight would pass below the ground.
    """
    drop = parameters.drop
    flight = FreeFlight(parameters)
    lowest = flight.lowest(drop.contact_time)
    if lowest < -1e-6:
        raise LandingError(
            f"drop.contact_time = {drop.contact_time:g} s of free flight would pass {-lowest:.3g} m below the ground; "
            "shorten it, or touch down with less pitch rate or a faster descent"
        )
    radius, height = flight.footpad
    charge = parameters.main_strut.charge_pressure
    leg = LegState(r=radius, h=height, vr=0.0, vh=0.0, z1=charge, z2=charge, q1=0.0, q2=0.0)
    return flat_state(
        BodyState(*flight.before_contact(drop.contact_time)),
        [leg] * len(MODES[drop.mode]),
        NO_ENERGY,
    )


def new_solver(
    parameters: Parameters,
    rtol: float,
    method: type[Solver] = Exponential,
    kind: type[Planar] = Planar,
) -> Solver:
    """A solver of relative tolerance `rtol` at the start of the parameters' landing; `method` and
    `kind` are both compiled or both pure.
    """
    solver = method(build_system(parameters, kind), rtol)
    begin(solver, parameters)
    return solver


def begin(solver: Solver, parameters: Parameters) -> None:
    """Take a solver to the start of the parameters' landing: time 0, inputs 0, counts 0.

    Raises LandingError as `start_state`.
    """
    for i, value in enumerate(start_state(parameters)):
        solver.y[i] = value
    for i in range(solver.system.inputs):
        solver.u[i] = solver.u_rate[i] = 0.0
    solver.start(0.0)


def _place(laws: Mapping[str, object], kind: str) -> float:
    """The number that a `LegModel` has for the law `kind`."""
    return float(list(laws).index(kind))


def _by_symbol(
    parameters: Parameters, fields: Iterable[str], own: Mapping[str, float]
) -> dict[str, float]:
    """The `fields` of a model: its `own`, and by their symbols those of the parameters."""
    symbols = {q.symbol: parameters[name] for name, q in PARAMETER_QUANTITIES.items() if q.symbol}
    return {field: float(own[field] if field in own else symbols[field]) for field in fields}
