"""Vehicles at random within the bounds of their parameters, and their landings watched."""

from __future__ import annotations

import random
from math import exp, isfinite, log
from typing import NamedTuple

from rlv_landing import Landing, LandingError, Parameters, load_preset
from rlv_landing.assembly import touchdown_energy
from rlv_landing.parameters import PARAMETER_QUANTITIES, parameters_of
from rlv_landing.quantities import LEGS, MODES

# what gives a vehicle its shape, and a landing its touchdown
SHAPE = ("joint_radius", "joint_depth", ".length", "drop.contact_time", "drop.tilt")
# what a liquid spring or a symmetric landing does not have
OTHERS = (
    "main_strut.kind",
    "main_strut.stiffness",
    "main_strut.damping",
    "vehicle.legs",
    "vehicle.leg_azimuth",
)
# the damper's numbers that a random one draws from the whole of its bounds
DAMPER = tuple(
    name
    for name in PARAMETER_QUANTITIES
    if name.startswith("main_strut.") and name not in OTHERS and not name.endswith(SHAPE)
)
CHAMBERS = [
    f"leg[{leg}].main_strut.{what}"
    for leg in LEGS
    for what in ("pressure_upper", "pressure_lower", "liquid_mass")
]

# how often a landing is looked at [s]
SHORTEST_LOOK, LONGEST_LOOK = 1e-6, 5e-4


class Watched(NamedTuple):
    """What a landing kept.

    Its least pressure [Pa], the largest change of a damper's liquid mass in parts of it, the
    largest energy balance in parts of what was turned over, and the time [s] that it reached.
    """

    pressure: float
    mass: float
    energy: float
    time: float


def near(rng: random.Random) -> Parameters:
    """The preset with every positive number up to 3.3 times as large or small."""
    base = load_preset("yue2022-figures", rng.choice(sorted(MODES)))
    values = {}
    for name, q in parameters_of(base.drop.mode).items():
        if (
            q.kind == "string"
            or name in OTHERS
            or name.endswith(SHAPE)
            or not float(base[name]) > 0.0
        ):
            continue
        values[name] = min(max(float(base[name]) * exp(rng.uniform(-1.2, 1.2)), q.lo), q.hi)
    return base.with_values({**values, **fast(base, rng)})


def any_damper(rng: random.Random) -> Parameters:
    """The preset with a damper drawn evenly in logarithms from the whole of its bounds."""
    base = load_preset("yue2022-figures", rng.choice(sorted(MODES)))
    values = {}
    for name in DAMPER:
        q = PARAMETER_QUANTITIES[name]
        low = q.lo if q.lo > 0.0 else 1e-8 * q.hi
        values[name] = min(max(exp(rng.uniform(log(low), log(q.hi))), q.lo), q.hi)
    return base.with_values({**values, **fast(base, rng)})


def fast(base: Parameters, rng: random.Random) -> dict[str, float]:
    """Half to twice the touchdown's speed."""
    return {"drop.vertical_velocity": base.drop.vertical_velocity * rng.uniform(0.5, 2.0)}


def some_vehicle(rng: random.Random) -> Parameters:
    """One that is not refused at the door."""
    while True:
        try:
            parameters = rng.choice((near, any_damper))(rng)
            Landing(parameters)
        except LandingError:
            continue
        return parameters


def watch(landing: Landing, until: float = 0.8, most_steps: int = 10_000) -> Watched:
    """Land until `until` [s], or as far as about `most_steps` of the integrator go.

    The landing is looked at twice a millisecond at least, and more often where steps are short.
    """
    before = [landing.get(name) for name in CHAMBERS]
    pressure, mass, balance, turned = min(before[0::3] + before[1::3]), 0.0, 0.0, 0.0
    every, steps = SHORTEST_LOOK, 0
    while landing.time < until and steps < most_steps:
        landing.advance_to(landing.time + every)
        taken, steps = landing.statistics["steps"] - steps, landing.statistics["steps"]
        every = min(2.0 * every, LONGEST_LOOK) if taken < 100 else 0.5 * every
        out = landing.outputs()
        assert all(map(isfinite, out.values())), landing.time
        now = [out[name] for name in CHAMBERS]
        pressure = min(pressure, *now[0::3], *now[1::3])
        mass = max(mass, *(abs(b / a - 1.0) for a, b in zip(before[2::3], now[2::3])))
        balance = max(balance, abs(out["energy.balance"]))
        turned = out["energy.dissipated"] + abs(out["energy.work_transverse"])
    turned = max(turned, 0.1 * touchdown_energy(landing.parameters))
    return Watched(pressure, mass, balance / turned, landing.time)
