"""A vehicle at rest on a deck that moves has settled: rest is judged relative to the deck."""

from __future__ import annotations

from itertools import pairwise
from math import cos, sin
from typing import Any

import numpy as np
import pytest
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, Parameters
from rlv_landing.assembly.sea import waves_of
from rlv_landing.core import Phase
from rlv_landing.core.bodies.sea import FREEDOMS, WAVE
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.whole_landing import whole_landing

UPRIGHT = {"drop.tilt": 0.0, "drop.pitch_rate": 0.0, "drop.contact_time": 0.0}
CALM: dict[str, Any] = {
    "drop.vertical_velocity": -2.0,
    "drop.horizontal_velocity": 0.0,
    "sea.wave_height": 1.0,
    "sea.direction": 0.7,
    "sea.deck_x": -30.0,
    "sea.deck_y": 8.0,
}
# of each freedom: its place at first, its rate, and the rate's rate
DRIVEN = {
    "surge": (0.2, 1.0, 0.7),
    "heave": (0.1, -0.4, 0.5),
    "sway": (0.0, 0.3, -0.6),
    "roll": (0.05, 0.2, -0.3),
    "yaw": (0.3, -0.25, 0.4),
    "tilt": (-0.04, 0.15, 0.35),
}


def phases(landing: Landing, until: float) -> list[int]:
    """The phases one after another, by samples 10 ms apart."""
    told = landing.run(until, 0.01)["status.phase"].astype(int)
    return [int(told[0]), *(int(b) for a, b in pairwise(told) if a != b)]


@pytest.mark.parametrize("mode", ["space", "2-2"])
def test_a_deck_that_moves_on_steadily_changes_no_phase(mode: str) -> None:
    """Galilei: the same landing, all of it carried along."""
    set_up = UPRIGHT | {"drop.mode": mode, "drop.vertical_velocity": -2.0}
    still = Landing(vehicle(set_up))
    if mode == "space":
        way = {"ground.surge_rate": 3.0, "ground.heave_rate": -1.0, "ground.sway_rate": 4.0}
        along = {"drop.horizontal_velocity": 3.4, "drop.lateral_velocity": 4.0}
        one = Landing(vehicle(set_up | {"drop.horizontal_velocity": 0.4}))
    else:
        way, along, one = {"ground.heave_rate": -1.0}, {}, still
    two = Landing(vehicle(set_up | along | {"drop.vertical_velocity": -3.0}), inputs=way)
    told, carried = phases(one, 3.0), phases(two, 3.0)
    assert told[-1] == Phase.SETTLED
    assert carried == told
    assert two.settled_since == pytest.approx(one.settled_since, abs=2e-3)
    # time does not pass without steps there
    assert (one.statistics["asleep"], two.statistics["asleep"]) == (1, 0)


def test_a_vehicle_settles_on_a_gentle_sea_and_stays_so() -> None:
    heavy = {"vehicle.mass": 2.0 * vehicle(SPACE).vehicle.mass}
    landing = Landing(vehicle(SPACE | UPRIGHT | CALM | heavy), rtol=1e-4)
    assert phases(landing, 15.0) == [Phase.FALLING, Phase.CONTACT, Phase.SETTLED]
    assert landing.statistics["asleep"] == 0
    since, state = landing.settled_since, landing.state()
    # what a state does not hold is found again
    again = Landing(landing.parameters, rtol=1e-4)
    again.restore(state)
    for each in (landing, again):
        each.advance_to(16.0)
    assert again.state() == landing.state()
    assert again.settled_since == since


def test_a_landing_at_sea_is_decided_where_it_has_settled_for_a_wave() -> None:
    landing = Landing(vehicle(SPACE | UPRIGHT | CALM), rtol=1e-4)
    history = whole_landing(landing, every=1e-2)
    found = outcome(history)
    assert found.name == "settled"
    assert found.time == landing.settled_since
    stayed = history.time[-1] - found.time
    period = landing.parameters.sea.peak_period
    assert period <= stayed < period + 0.26


def test_a_deck_that_shakes_and_one_that_the_vehicle_slides_on_are_no_rest() -> None:
    base = vehicle(SPACE | UPRIGHT | {"drop.vertical_velocity": -2.0})
    landing = Landing(base)
    landing.advance_to(3.0)
    assert landing.get("status.phase") == Phase.SETTLED
    # the deck starts to move off at once: relative to it, the vehicle does
    landing.set_inputs({"ground.surge_rate": 2.0})
    landing.advance_to(3.05)
    assert landing.get("status.phase") == Phase.CONTACT
    slippery = base.with_values({"ground.friction": 0.0, "drop.horizontal_velocity": 0.5})
    sliding = Landing(slippery, inputs={"ground.surge_rate": 0.4})
    sliding.advance_to(3.0)
    assert sliding.get("status.phase") == Phase.CONTACT


def deck(parameters: Parameters, t: float) -> tuple[np.ndarray, np.ndarray]:
    """The deck's origin and its axes (3, 3) at time `t`: every harmonic, and the inputs."""
    waves = waves_of(parameters)
    numbers = np.array(waves.numbers).reshape(-1, WAVE)
    parts = numbers[:, 1:].reshape(-1, FREEDOMS, 2)
    angle = numbers[:, 0] * (waves.start + t)
    now = np.cos(angle) @ parts[..., 0] + np.sin(angle) @ parts[..., 1]
    now += [q + v * t + 0.5 * a * t * t for q, v, a in DRIVEN.values()]
    surge, heave, sway, roll, yaw, tilt = now
    about_y = [[cos(yaw), 0.0, sin(yaw)], [0.0, 1.0, 0.0], [-sin(yaw), 0.0, cos(yaw)]]
    about_x = [[1.0, 0.0, 0.0], [0.0, cos(roll), -sin(roll)], [0.0, sin(roll), cos(roll)]]
    clockwise = [[cos(tilt), sin(tilt), 0.0], [-sin(tilt), cos(tilt), 0.0], [0.0, 0.0, 1.0]]
    return np.array([surge, heave, sway]), np.array(clockwise) @ about_x @ about_y


def test_motion_relative_to_the_deck_is_that_against_a_point_and_axes_fixed_to_it() -> None:
    """The deck's velocities and accelerations by differences of its place and its axes."""
    fast = {"drop.contact_time": 0.05, "drop.vertical_velocity": -5.0, "vehicle.inertia_yaw": 30.0}
    parameters = vehicle(SPACE | CALM | TURNING | fast)
    landing = Landing(
        parameters,
        inputs={
            f"ground.{name}{kind}": v
            for name, (place, rate, _) in DRIVEN.items()
            for kind, v in (("", place), ("_rate", rate))
        },
        rates={f"ground.{name}_rate": a for name, (*_, a) in DRIVEN.items()},
    )
    landing.advance_to(0.03)
    solver: Any = landing._solver
    t, h = solver.t, 1e-4
    landing.advance_to(t)
    now = landing.outputs()
    cg = np.array([now[f"body.{a}"] for a in "xyz"])
    (o0, r0), (o1, r1), (o2, r2) = (deck(parameters, t + k * h) for k in (-1, 0, 1))
    fixed = r1.T @ (cg - o1)
    p0, p1, p2 = (o + r @ fixed for o, r in ((o0, r0), (o1, r1), (o2, r2)))
    velocity, acceleration = (p2 - p0) / (2.0 * h), (p2 - 2.0 * p1 + p0) / h**2

    def axial(m: np.ndarray) -> np.ndarray:
        m = 0.5 * (m - m.T)
        return np.array([m[2, 1], m[0, 2], m[1, 0]])

    spin = axial((r2 - r0) / (2.0 * h) @ r1.T)
    # the second difference has the spin's square, which is symmetric
    spin_rate = axial((r2 - 2.0 * r1 + r0) / h**2 @ r1.T)
    w, x, y, z = (now[f"body.q_{a}"] for a in "wxyz")
    body = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    moved = np.array([now[f"body.a{a}"] for a in "xyz"]) - acceleration
    turned = np.array([now[f"body.spin_acceleration_{a}"] for a in "xyz"]) - body.T @ spin_rate
    told = solver.system.relative_acceleration
    assert told == pytest.approx(np.abs(moved).sum() + np.abs(turned).sum(), abs=1e-5)
    v = np.array([now[f"body.v{a}"] for a in "xyz"]) - velocity
    w_body = np.array([now[f"body.spin_{a}"] for a in "xyz"]) - body.T @ spin
    p = parameters.vehicle
    inertia = np.array([p.inertia_roll or p.inertia, p.inertia_yaw, p.inertia])
    twice = p.mass * (v @ v) + inertia @ w_body**2
    for leg in landing.interface.legs:
        foot = np.array([now[f"leg[{leg}].footpad.{a}"] for a in "xyz"]) - cg
        # the legs hang all but still in the body
        speed = v + np.cross(body @ w_body, foot)
        twice += p.footpad_mass * speed @ speed
    assert solver.system.relative_kinetic == pytest.approx(0.5 * twice, rel=1e-4)
