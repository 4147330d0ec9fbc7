"""The spatial body and its state at the start, from the user's parameters."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from math import cos, sin

from ..core import LegPlace, LegState, Spatial, SpatialInputs, SpatialModel, SpatialState
from ..parameters import Parameters
from ..quantities import TRIPOD
from ..touchdown import each_leg, leg_directions
from .legs import AT_REST, IN_PLANE, NO_ENERGY, flat_state, leg_model, state_sizes
from .sea import waves_of
from .spatial_flight import DeckMotion, SpatialFlight
from .surroundings import body_points, height_field

# see LEG_SCALE; half a quaternion's change is an angle's
BODY_SCALE = SpatialState(*([0.1] * 3 + [0.05] * 4 + [1.0] * 6))


def spatial_model(parameters: Parameters) -> SpatialModel:
    """The body's numbers, and those of the ground at rest.

    An inertia of 0 about x is that about z; about the axis y, that of a thin shell through the main
    struts' joints. [closure]
    """
    v, ground = parameters.vehicle, parameters.ground
    shell = v.mass * parameters.main_strut.joint_radius**2
    s, c = sin(ground.slope), cos(ground.slope)
    aside, ahead = sin(ground.slope_direction), cos(ground.slope_direction)
    return SpatialModel(
        m_u=v.mass,
        I_x=v.inertia_roll or v.inertia,
        I_y=v.inertia_yaw or shell,
        I_z=v.inertia,
        I_xy=v.inertia_xy,
        I_xz=v.inertia_xz,
        I_yz=v.inertia_yz,
        cg_x=v.cg_offset_x,
        cg_z=v.cg_offset_z,
        H=v.top_height,
        tripod=1.0 if parameters.leg.kind == TRIPOD else 0.0,
        at_joint=1.0 if v.transverse_load_at == "joint" else 0.0,
        g=ground.gravity,
        heading=parameters.drop.heading,
        down_x=c * ahead,
        down_y=-s,
        down_z=c * aside,
        along_x=-aside,
        along_z=ahead,
        normal_x=s * ahead,
        normal_y=c,
        normal_z=s * aside,
    )


def spatial_places(parameters: Parameters) -> list[LegPlace]:
    """Place of each leg."""
    return [LegPlace(s, c, 1.0) for s, c in leg_directions(parameters).values()]


def spatial_system(parameters: Parameters, kind: type[Spatial] = Spatial) -> Spatial:
    """The vehicle in space on its ground.

    Args:
        parameters: The parameters of the landing.
        kind: The class of the compiled or of the pure core.
    """
    places = spatial_places(parameters)
    points = body_points(parameters)
    scale, relative = state_sizes(BODY_SCALE, len(places), parameters, len(points))
    body, law = spatial_model(parameters), leg_model(parameters)
    legs = [law] * len(places)
    if parameters.vehicle.leg_overrides:
        legs = [leg_model(parameters, leg) for leg in range(1, len(places) + 1)]
    met = (points, law, *height_field(parameters), waves_of(parameters).kernel())
    return kind(body, legs, places, scale, relative, met)


def spatial_start(
    parameters: Parameters, inputs: Sequence[float], rates: Sequence[float]
) -> array[float]:
    """The state at time 0.

    It is the state at the first contact, taken back along the free flight of the rigid vehicle.

    Args:
        parameters: The parameters of the landing.
        inputs: The inputs at time 0.
        rates: Their rates.

    Raises:
        LandingError: As `SpatialFlight.start`.
    """
    deck = DeckMotion(SpatialInputs(*inputs), SpatialInputs(*rates), waves_of(parameters))
    flight = SpatialFlight(parameters, spatial_model(parameters), spatial_places(parameters), deck)
    legs = [
        LegState(r=radius, h=height, vr=0.0, vh=0.0, z1=charge, z2=charge, q1=0.0, q2=0.0)
        for own, (radius, height) in zip(each_leg(parameters), flight.footpads)
        for charge in [own.main_strut.charge_pressure]
    ]
    points = [AT_REST] * len(body_points(parameters))
    across = [IN_PLANE] * len(legs) if parameters.leg.kind == TRIPOD else []
    return flat_state(flight.start(), legs, NO_ENERGY, points, across)
