"""The planar body and its state at the start, from the user's parameters."""

from __future__ import annotations

from array import array

from ..core import BodyModel, BodyState, Inputs, LegModel, LegPlace, LegState, Planar
from ..parameters import Parameters
from ..quantities import azimuth, groups_of
from ..touchdown import AT_REST, FreeFlight, GroundMotion
from .legs import (
    NO_ENERGY,
    by_symbol,
    flat_state,
    leg_model,
    state_sizes,
)

# see LEG_SCALE
BODY_SCALE = BodyState(x=0.1, y=0.1, pitch=0.1, vx=1.0, vy=1.0, pitch_rate=1.0)
NO_INPUTS = Inputs(*(0.0 for _ in Inputs._fields))


def body_model(parameters: Parameters) -> BodyModel:
    """The body's numbers."""
    at_joint = 1.0 if parameters.vehicle.transverse_load_at == "joint" else 0.0
    return BodyModel(**by_symbol(parameters, BodyModel._fields, {"at_joint": at_joint}))


def leg_models(parameters: Parameters) -> list[LegModel]:
    """The numbers of each leg group of the parameters' landing mode."""
    common = leg_model(parameters)
    return [
        common._replace(share_1=1.0 if place.sin_g == 0.0 else 0.5)
        for place in leg_places(parameters)
    ]


def leg_places(parameters: Parameters) -> list[LegPlace]:
    """Place and number of legs of each leg group of the parameters' landing mode."""
    return [
        LegPlace(*azimuth(group.azimuth), float(len(group.legs)))
        for group in groups_of(parameters.drop.mode)
    ]


def planar_system(parameters: Parameters, kind: type[Planar] = Planar) -> Planar:
    """The vehicle on its ground, for the parameters' landing mode.

    Args:
        parameters: The parameters of the landing.
        kind: The class of the compiled or of the pure core.
    """
    legs = leg_models(parameters)
    scale, relative = state_sizes(BODY_SCALE, len(legs), parameters)
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


def planar_start(parameters: Parameters, ground: GroundMotion = AT_REST) -> array[float]:
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
    return flat_state(body, [leg] * len(groups_of(parameters.drop.mode)), NO_ENERGY)
