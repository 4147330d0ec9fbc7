"""What the maker of a vehicle must say before its legs can be sized."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from ..errors import LandingError, unknown
from ..parameters import check_value
from ..quantities import Quantity

# the least footpad_mass over mass: lighter footpads swing faster than the integrator may step
LEAST_FOOTPAD = 1e-5
# unit, meaning, least and largest value by name
NEEDS: dict[str, Quantity] = {
    name: Quantity(unit, meaning, lo, hi, name=name)
    for name, unit, meaning, lo, hi in (
        ("mass", "kg", "mass above the footpads at touchdown", 1.0, 1e6),
        ("footpad_mass", "kg", "mass of one leg that moves with its footpad", 0.01, 1e4),
        ("body_length", "m", "length of the body", 0.05, 200.0),
        ("body_radius", "m", "radius of the body where the legs are", 0.01, 50.0),
        ("cg_height", "m", "height of the CG above level ground, legs extended", 0.05, 100.0),
        ("clearance", "m", "height of the body's lower end above level ground", 0.01, 50.0),
        ("span", "m", "distance of opposite footpads", 0.05, 100.0),
        ("sink_speed", "m/s", "sink speed at touchdown that the legs must take", 0.05, 20.0),
        ("load_factor", "", "most force of all footpads over the weight", 1.2, 50.0),
        ("stroke_reserve", "", "stroke to the stop over that of a level landing", 1.05, 5.0),
        ("gravity", "m/s2", "gravitational acceleration", 0.1, 50.0),
        ("friction", "", "friction coefficient of the ground", 0.0, 3.0),
    )
}


@dataclass(frozen=True)
class Needs:
    """What the maker of a vehicle must say.

    Attributes:
        mass: Mass above the footpads at touchdown [kg].
        footpad_mass: Mass of one leg that moves with its footpad [kg].
        body_length: Length of the body [m].
        body_radius: Radius of the body where the legs are [m].
        cg_height: Height of the CG above level ground, legs extended [m].
        clearance: Height of the body's lower end above level ground, legs extended [m].
        span: Distance of opposite footpads [m].
        sink_speed: Sink speed at touchdown that the legs must take, downward positive [m/s].
        load_factor: Most force of all footpads over the weight.
        stroke_reserve: Stroke to the stop over that of a level landing: for landings on fewer legs.
        gravity: Gravitational acceleration [m/s2].
        friction: Friction coefficient of the ground.

    Raises:
        LandingError: A value is out of bounds, or values contradict each other.
    """

    mass: float
    footpad_mass: float
    body_length: float
    body_radius: float
    cg_height: float
    clearance: float
    span: float
    sink_speed: float
    load_factor: float
    stroke_reserve: float = 1.6
    gravity: float = 9.81
    friction: float = 0.4

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            check_value(NEEDS[name], value)
        if not 0.5 * self.span > 1.1 * self.body_radius:
            raise LandingError(
                f"span = {self.span:g} m is not above 2.2 body_radius = {2.2 * self.body_radius:g} "
                "m; the footpads must stand outside the body"
            )
        if not self.clearance < self.cg_height < self.clearance + self.body_length:
            raise LandingError(
                f"cg_height = {self.cg_height:g} m is not within the body, which reaches from "
                f"clearance = {self.clearance:g} m to {self.clearance + self.body_length:g} m"
            )
        if self.footpad_mass < LEAST_FOOTPAD * self.mass:
            raise LandingError(
                f"footpad_mass = {self.footpad_mass:g} kg is below {LEAST_FOOTPAD:g} mass = "
                f"{LEAST_FOOTPAD * self.mass:g} kg; what moves with a footpad must be heavier"
            )


# vehicles to begin with. The hopper is a round example. The stage has public numbers of a medium
# reusable first stage: 25 t, 3.7 m, 18 m of span over the legs (see docs/own_vehicle.md)
LIKE: dict[str, Needs] = {
    "hopper": Needs(
        mass=60.0,
        footpad_mass=0.8,
        body_length=1.8,
        body_radius=0.2,
        cg_height=1.0,
        clearance=0.35,
        span=1.4,
        sink_speed=1.5,
        load_factor=4.0,
    ),
    "stage": Needs(
        mass=25_000.0,
        footpad_mass=350.0,
        body_length=41.2,
        body_radius=1.83,
        cg_height=14.0,
        clearance=2.5,
        span=18.0,
        sink_speed=2.0,
        load_factor=3.0,
        stroke_reserve=2.5,
    ),
}


def needs_like(like: str, values: Mapping[str, Any]) -> Needs:
    """The needs of a vehicle of `LIKE` with other `values` by name [SI].

    Raises:
        LandingError: An unknown vehicle or name, or a bad value.
    """
    if like not in LIKE:
        raise unknown("vehicle to begin with", like, LIKE)
    for name in values:
        if name not in NEEDS:
            raise unknown("need", name, NEEDS)
    return Needs(**{**asdict(LIKE[like]), **values})
