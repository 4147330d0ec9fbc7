"""Values of landings in space by heading and direction, beside those of the symmetric modes."""

from __future__ import annotations

from functools import lru_cache
from math import cos, radians, sin

from rlv_landing import land_many, load_preset

# what is changed of the figures' preset; four legs are the same after a quarter turn
CASES: dict[str, dict[str, float]] = {
    "level": {},
    "side": {"drop.lateral_velocity": 0.5},
    "roll": {"drop.roll": radians(3.0)},
    "slope": {"ground.slope": radians(5.0), "ground.slope_direction": radians(90.0)},
}
HEADINGS = [5.0 * k for k in range(18)]
DIRECTIONS = [15.0 * k for k in range(24)]
# response and size of the unit of a peak
PEAKS = {
    "force": ("legs.main_strut.force.min", -1e3),
    "stroke": ("legs.main_strut.stroke.max", 1e-3),
}
RESOLUTION = 0.02


@lru_cache
def peaks(case: str, what: str) -> dict[float, float]:
    """The largest main strut force [kN] or stroke [mm] by heading [deg].

    Friction 0.3, 0.4 s of landing.
    """
    parameters = load_preset("yue2022-figures").for_mode("space")
    changed = parameters.with_values(
        {"drop.contact_time": 0.0, "ground.friction": 0.3, **CASES[case]}
    )
    name, size = PEAKS[what]
    found = land_many(changed, {"drop.heading [deg]": HEADINGS}, until=0.4, responses=[name])
    return {heading: float(value) / size for heading, value in zip(HEADINGS, found[name])}


def heading_load(case: str, heading: str, what: str = "force") -> float:
    """The largest main strut force [kN] or stroke [mm] at a heading, or at the worst one."""
    found = peaks(case, what)
    return max(found.values()) if heading == "worst" else found[float(heading)]


def worst_heading(case: str, what: str = "force") -> float:
    """The heading with the largest force or stroke, to 5 deg, 0 to 85 deg."""
    found = peaks(case, what)
    return max(found, key=found.__getitem__)


def beyond_symmetric(case: str, what: str = "force") -> float:
    """By how much the worst heading's force or stroke is above that of both symmetric ones [%]."""
    found = peaks(case, what)
    return 100.0 * (max(found.values()) / max(found[0.0], found[45.0]) - 1.0)


@lru_cache
def topples_from(roll: float, slope: float, directions: tuple[float, ...]) -> dict[float, float]:
    """The speed [m/s] from which on the vehicle topples, by direction [deg], to 0.02 m/s.

    Legs at 45 deg and so on, friction 0.6, no tilt and no rates. All directions are bisected
    together.
    """
    base = load_preset("yue2022-figures").for_mode("space")
    base = base.with_values(
        {
            "drop.contact_time": 0.0,
            "vehicle.leg_azimuth": radians(45.0),
            "ground.friction": 0.6,
            "ground.slope": radians(slope),
            "drop.roll": radians(roll),
            "drop.tilt": 0.0,
            "drop.pitch_rate": 0.0,
        }
    )
    ends = dict.fromkeys(directions, (0.0, 6.0))
    while max(high - low for low, high in ends.values()) > RESOLUTION:
        middles = {d: 0.5 * (low + high) for d, (low, high) in ends.items()}
        velocities = [(v * cos(radians(d)), v * sin(radians(d))) for d, v in middles.items()]
        states = {
            "drop.horizontal_velocity": [x for x, _ in velocities],
            "drop.lateral_velocity": [z for _, z in velocities],
        }
        found = land_many(base, states, responses=["outcome"])["outcome"] == "toppled"
        for (d, middle), toppled in zip(middles.items(), found):
            low, high = ends[d]
            ends[d] = (low, middle) if toppled else (middle, high)
    return {d: 0.5 * (low + high) for d, (low, high) in ends.items()}


def speed_by_direction(roll: str, slope: str, direction: str) -> float:
    """The speed from which on the vehicle topples in a direction [deg], or in the worst [m/s]."""
    if direction != "worst":
        one = float(direction)
        return topples_from(float(roll), float(slope), (one,))[one]
    return min(topples_from(float(roll), float(slope), tuple(DIRECTIONS)).values())


def worst_direction(roll: str, slope: str) -> float:
    """The direction in which the vehicle topples at the lowest speed, to 15 deg."""
    found = topples_from(float(roll), float(slope), tuple(DIRECTIONS))
    return min(found, key=found.__getitem__)
