"""Landings in space against the Newton-Euler model: n legs that roll and yaw, with friction.

First without any solver in between, at random states; then a whole landing, each model with a
solver of its own.
"""

from __future__ import annotations

import os
from array import array
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pytest import approx
from scipy.integrate import solve_ivp
from vehicle_3d import (
    LEGS,
    POSITION,
    QUATERNION,
    SPIN,
    VELOCITY,
    Array,
    Inputs,
    Vehicle3D,
    rotation,
    scale_of,
)

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.assembly import spatial_system, waves_of
from rlv_landing.core import access
from rlv_landing.core.bodies.spatial import Spatial

FIRST = access.SPATIAL_STATE
LONG = (
    pytest.mark.torture,
    pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="it is long: make torture"),
)


def random_vehicle(rng: np.random.Generator, legs: int, at: str) -> Parameters:
    """A vehicle without any symmetry, its legs uneven, on a slope and on steps."""
    own = {
        f"leg[{i}].ground.{what}": value
        for i in range(1, legs + 1)
        for what, value in (("friction", rng.uniform(0.0, 1.0)), ("step", rng.uniform(-0.1, 0.1)))
    }
    return load_preset("yue2022-figures").with_values(
        {
            "drop.mode": "space",
            "vehicle.legs": float(legs),
            "vehicle.leg_azimuths": " ".join(
                repr(2.0 * np.pi * i / legs + rng.uniform(-0.3, 0.3)) for i in range(legs)
            ),
            "vehicle.transverse_load_at": at,
            "vehicle.inertia": 120.0,
            "vehicle.inertia_roll": rng.uniform(100.0, 150.0),
            "vehicle.inertia_yaw": rng.uniform(50.0, 90.0),
            "vehicle.inertia_xy": rng.uniform(-10.0, 10.0),
            "vehicle.inertia_xz": rng.uniform(-10.0, 10.0),
            "vehicle.inertia_yz": rng.uniform(-10.0, 10.0),
            "vehicle.cg_offset_x": rng.uniform(-0.2, 0.2),
            "vehicle.cg_offset_z": rng.uniform(-0.2, 0.2),
            "ground.slope": rng.uniform(-0.3, 0.3),
            "ground.slope_direction": rng.uniform(-3.0, 3.0),
            "main_strut.stroke_max": 0.02,
            **own,
        }
    )


def random_state(rng: np.random.Generator, model: Vehicle3D) -> Array:
    """A violent state, the footpads some millimetres in or above the ground."""
    y = model.start([0.0] * 6)
    y[QUATERNION] = [1.0, *rng.uniform(-0.2, 0.2, 3)]
    y[QUATERNION] /= np.linalg.norm(y[QUATERNION])
    y[VELOCITY], y[SPIN] = rng.uniform(-2.0, 2.0, 3), rng.uniform(-2.0, 2.0, 3)
    legs = y[LEGS:].reshape(8, model.n)
    legs[:2] += rng.uniform(-0.04, 0.04, (2, model.n))
    legs[2:4] = rng.uniform(-2.0, 2.0, (2, model.n))
    legs[4:6] = 10.0 ** rng.uniform(4.0, 7.0, (2, model.n))
    legs[6:] = rng.uniform(-1.5e-3, 1.5e-3, (2, model.n))
    # lifted along the vertical so that one footpad is in the ground, and another one near it
    depth = np.sort(model.evaluate(0.0, y)["penetration"])[-2]
    up = np.cos(model.ground.slope)
    y[1] += (depth + rng.uniform(-0.01, 0.005)) / up
    return y


def ours_of(y: Array, legs: int) -> Array:
    """The same state in the kernels' order: leg by leg, then the accounts and each strut's work."""
    own = y[LEGS:].reshape(8, legs).T
    return np.concatenate((y[:LEGS], own.ravel(), np.zeros(access.ACCOUNTS + legs)))


@pytest.mark.parametrize("at", ["footpad", "joint"])
@pytest.mark.parametrize("legs", [3, 4, 5, 8])
def test_rates_are_those_of_newton_and_euler_at_random_states(legs: int, at: str) -> None:
    """To rounding, as in `test_vehicle_3d`."""
    rng = np.random.default_rng(legs)
    touching = 0
    for _ in range(8):
        parameters = random_vehicle(rng, legs, at)
        force, moment = rng.uniform(-2000.0, 2000.0, 2), rng.uniform(-500.0, 500.0)
        model = Vehicle3D(parameters, Inputs(tuple(force), moment))
        y = random_state(rng, model)
        u = [0.0] * access.SPATIAL_INPUTS
        u[0], u[1], u[5] = *force, -moment
        state, ours = array("d", ours_of(y, legs)), array("d", bytes(8 * len(ours_of(y, legs))))
        spatial_system(parameters, Spatial).rhs(state, array("d", u), ours)
        e, theirs = model.evaluate(0.0, y), ours_of(model(0.0, y), legs)
        touching += int((e["penetration"] > 0.0).sum())
        size = np.abs(e["r_acc"]).max() + np.abs(e["h_acc"]).max()
        found = np.array(ours)
        assert found[:FIRST] == approx(theirs[:FIRST], rel=1e-9, abs=1e-9 * size)
        for i in range(legs):
            at_leg = slice(FIRST + access.LEG * i, FIRST + access.LEG * (i + 1))
            pairs = (found[at_leg], theirs[at_leg])
            assert pairs[0][:4] == approx(pairs[1][:4], rel=1e-9, abs=1e-9 * size)
            assert pairs[0][4:] == approx(pairs[1][4:], rel=1e-9, abs=1e-11)
    assert 8 < touching < 8 * legs


FIVE, THREE = "five legs, rolled, yawing, on steps and a slope", "three legs, the CG off the axis"
AT_SEA = "three legs on a ship in waves"
LANDINGS: dict[str, dict[str, Any]] = {
    FIVE: {
        "vehicle.legs": 5.0,
        "drop.roll": 0.06,
        "drop.heading": 0.4,
        "drop.yaw_rate": 0.4,
        "drop.roll_rate": -0.3,
        "drop.lateral_velocity": 0.3,
        "ground.slope": 0.08,
        "ground.slope_direction": 1.9,
        "leg[2].ground.step": 0.02,
        "leg[3].ground.friction": 0.1,
    },
    THREE: {
        "vehicle.legs": 3.0,
        "vehicle.cg_offset_x": 0.08,
        "vehicle.cg_offset_z": -0.05,
        "drop.roll": -0.04,
        "drop.lateral_velocity": -0.4,
    },
    AT_SEA: {
        "vehicle.legs": 3.0,
        "drop.roll": -0.04,
        "drop.vertical_velocity": -2.0,
        "ground.slope": 0.05,
        "ground.slope_direction": 1.0,
        "sea.wave_height": 6.0,
        "sea.peak_period": 9.0,
        "sea.direction": 0.8,
        "sea.time": 77.0,
        "sea.deck_x": -40.0,
        "sea.deck_y": 10.0,
    },
}


def deck_of(parameters: Parameters) -> Callable[[float], tuple[Array, Array]]:
    """The deck's motion: the sum of all harmonics, each by itself."""
    waves = waves_of(parameters)
    numbers = np.array(waves.numbers).reshape(-1, 13)
    w, a, b = numbers[:, 0], numbers[:, 1::2].T, numbers[:, 2::2].T

    def deck(t: float) -> tuple[Array, Array]:
        c, s = np.cos(w * (waves.start + t)), np.sin(w * (waves.start + t))
        return a @ c + b @ s, (b * w) @ c - (a * w) @ s

    return deck


@pytest.mark.parametrize(
    ("name", "until"),
    [
        (THREE, 0.04),
        (AT_SEA, 0.04),
        pytest.param(THREE, 0.2, marks=LONG),
        pytest.param(FIVE, 0.2, marks=LONG),
        pytest.param(AT_SEA, 0.3, marks=LONG),
    ],
)
def test_a_landing_that_rolls_and_yaws_is_that_of_the_newton_euler_model(
    name: str, until: float
) -> None:
    """The tolerances are those of `test_vehicle_3d`: what contacts and friction carry on."""
    tensor = {"vehicle.inertia_roll": 120.0, "vehicle.inertia_yaw": 60.0, "vehicle.inertia_xy": 5.0}
    values = {"drop.mode": "space", "drop.contact_time": 0.0, **tensor, **LANDINGS[name]}
    parameters = load_preset("yue2022-figures").with_values(values)
    landing = Landing(parameters, rtol=1e-9)
    deck = None if name != AT_SEA else deck_of(parameters)
    model, legs = Vehicle3D(parameters, deck=deck), int(parameters.vehicle.legs)
    y = model.start([0.0] * 6)
    now = landing.outputs()
    y[POSITION] = [now[f"body.{axis}"] for axis in "xyz"]
    y[QUATERNION] = [now[f"body.q_{part}"] for part in "wxyz"]
    y[VELOCITY] = [now[f"body.v{axis}"] for axis in "xyz"]
    y[SPIN] = [now[f"body.spin_{axis}"] for axis in "xyz"]
    times = np.linspace(0.0, until, round(until / 5e-3) + 1)
    tolerances = {"rtol": 3e-8, "atol": 3e-8 * scale_of(legs), "max_step": 2e-3, "first_step": 1e-6}
    done = solve_ivp(model, (0.0, until), y, "DOP853", times, **tolerances)
    assert done.success, done.message
    history = landing.run(until, 5e-3)
    for row, axis in enumerate("xyz"):
        assert np.abs(history[f"body.{axis}"] - done.y[row]).max() < 5e-7
    for row, part in enumerate("wxyz"):
        assert np.abs(history[f"body.q_{part}"] - done.y[3 + row]).max() < 5e-7
    # it rolls and yaws, and one damper at least is pushed in
    assert np.ptp(history["body.roll"]) > 1e-3
    assert np.ptp(history["body.heading"]) > 1e-3
    strokes = np.array([history[f"leg[{i + 1}].main_strut.stroke"] for i in range(legs)])
    assert strokes.max() > 5e-3
    theirs = np.array([model.evaluate(t, s)["stroke"] for t, s in zip(times, done.y.T)]).T
    assert np.abs(strokes - theirs).max() < 2e-7
    # the quaternion has not lost its length
    assert rotation(done.y[QUATERNION, -1]) == approx(rotation(now_attitude(landing)), abs=1e-6)


def now_attitude(landing: Landing) -> Array:
    """The present attitude, w first."""
    return np.array([landing.get(f"body.q_{part}") for part in "wxyz"])
