"""Legs on three struts against a Newton-Euler model in which each footpad is a free point mass.

First without any solver in between, at random states; then a whole landing, each model with a
solver of its own.
"""

from __future__ import annotations

from array import array

import numpy as np
import pytest
from pytest import approx
from scipy.integrate import solve_ivp
from test_vehicle_in_space import FIRST, FIVE, LANDINGS, LONG, THREE, random_vehicle
from tripod_3d import OF_A_LEG, Tripod3D
from vehicle_3d import LEGS, QUATERNION, SPIN, VELOCITY, Array, cross, rotation

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.assembly import spatial_system
from rlv_landing.core import access
from rlv_landing.core.bodies.spatial import Spatial

TRIPOD = {"leg.kind": "tripod"}


def random_state(rng: np.random.Generator, model: Tripod3D, start: dict[str, float]) -> Array:
    """A violent state, the footpads some millimetres in or above the ground."""
    y = model.start_at(start)
    y[VELOCITY], y[SPIN] = rng.uniform(-2.0, 2.0, 3), rng.uniform(-2.0, 2.0, 3)
    legs = y[LEGS:].reshape(OF_A_LEG, model.n)
    legs[:3] += rng.uniform(-0.04, 0.04, (3, model.n))
    legs[3:6] = rng.uniform(-2.0, 2.0, (3, model.n))
    legs[6:8] = 10.0 ** rng.uniform(4.0, 7.0, (2, model.n))
    legs[8:] = rng.uniform(-1.5e-3, 1.5e-3, (2, model.n))
    # body and footpads are lifted so that two footpads are in the ground or near it
    lift = np.sort(model.loads(0.0, y)["depth"])[-2] / np.cos(model.ground.slope)
    lift += rng.uniform(-0.01, 0.005)
    y[1] += lift
    legs[1] += lift
    return y


def ours_of(model: Tripod3D, y: Array, rates: Array | None = None) -> Array:
    """A state, or with `rates` its rate, in the kernels' order."""
    n = model.n
    of = y if rates is None else rates
    legs = of[LEGS:].reshape(OF_A_LEG, n)
    rho, rho_rate = model.relative(y)
    if rates is not None:
        R, spin = rotation(y[QUATERNION]), y[SPIN][:, None]
        seen = R.T @ (legs[3:6] - rates[VELOCITY][:, None])
        seen = seen - cross(rates[SPIN][:, None], rho) - 2.0 * cross(spin, rho_rate)
        rho, rho_rate = rho_rate, seen - cross(spin, cross(spin, rho))
    else:
        rho = rho + model.cg
    along = [
        [(e * v).sum(axis=0) for e in (model.e_r, model.e_y, model.e_t)] for v in (rho, rho_rate)
    ]
    in_plane = np.array([*along[0][:2], *along[1][:2], *legs[6:]])
    across = np.array([along[0][2], along[1][2]])
    rest = np.zeros(access.ACCOUNTS + n)
    return np.concatenate((of[:LEGS], in_plane.T.ravel(), across.T.ravel(), rest))


@pytest.mark.parametrize("legs", [3, 4, 8])
def test_rates_are_those_of_free_point_masses_at_random_states(legs: int) -> None:
    """To rounding, as in `test_vehicle_in_space`."""
    rng = np.random.default_rng(legs)
    touching = 0
    for _ in range(6):
        parameters = random_vehicle(rng, legs, "footpad").with_values(
            {**TRIPOD, "auxiliary_strut.joint_spread": rng.uniform(0.1, 0.5),
             "drop.heading": rng.uniform(-0.2, 0.2), "drop.roll": rng.uniform(-0.2, 0.2),
             "drop.contact_time": 0.0}
        )  # fmt: skip
        model = Tripod3D(parameters)
        y = random_state(rng, model, Landing(parameters).outputs())
        state = array("d", ours_of(model, y))
        ours = array("d", bytes(8 * len(state)))
        u = array("d", bytes(8 * access.SPATIAL_INPUTS))
        system = spatial_system(parameters, Spatial)
        assert system.n == len(state)
        system.rhs(state, u, ours)
        theirs, found = ours_of(model, y, model(0.0, y)), np.array(ours)
        touching += int((model.loads(0.0, y)["depth"] > 0.0).sum())
        size = np.abs(theirs[FIRST:]).max()
        laws = np.arange(FIRST, FIRST + access.LEG * legs).reshape(legs, access.LEG)[:, 4:].ravel()
        moving = np.setdiff1d(np.arange(FIRST + (access.LEG + access.ACROSS) * legs), laws)
        speed = np.abs(theirs[moving]).max()
        assert found[moving] == approx(theirs[moving], rel=1e-9, abs=1e-9 * speed)
        assert found[laws] == approx(theirs[laws], rel=1e-9, abs=1e-11)
        assert size > speed > 10.0
    assert 6 < touching < 6 * legs


@pytest.mark.parametrize(
    ("name", "until"),
    [(THREE, 0.02), pytest.param(THREE, 0.2, marks=LONG), pytest.param(FIVE, 0.2, marks=LONG)],
)
def test_a_landing_is_that_of_free_point_masses(name: str, until: float) -> None:
    """The tolerances are those of `test_vehicle_in_space`."""
    parameters = tripod(name)
    landing = Landing(parameters, rtol=1e-9)
    model, legs = Tripod3D(parameters), int(parameters.vehicle.legs)
    times = np.linspace(0.0, until, round(until / 5e-3) + 1)
    tolerances = {"rtol": 3e-8, "atol": 3e-8 * model.scale(), "max_step": 2e-3, "first_step": 1e-6}
    y = model.start_at(landing.outputs())
    done = solve_ivp(model, (0.0, until), y, "DOP853", times, **tolerances)
    assert done.success, done.message
    history = landing.run(until, 5e-3)
    for row, axis in enumerate("xyz"):
        assert np.abs(history[f"body.{axis}"] - done.y[row]).max() < 5e-7
        feet = np.array([history[f"leg[{i + 1}].footpad.{axis}"] for i in range(legs)])
        theirs = done.y[LEGS + row * legs : LEGS + (row + 1) * legs]
        assert np.abs(feet - theirs).max() < 5e-7
    for row, part in enumerate("wxyz"):
        assert np.abs(history[f"body.q_{part}"] - done.y[3 + row]).max() < 5e-7
    found = [model.loads(t, s) for t, s in zip(times, done.y.T)]
    for k, strut in enumerate(("main_strut", "auxiliary_strut", "auxiliary_strut_2")):
        strokes, forces = (
            np.array([history[f"leg[{i + 1}].{strut}.{what}"] for i in range(legs)])
            for what in ("stroke", "force")
        )
        theirs = np.array([e["strokes"][k] for e in found]).T
        assert np.abs(strokes - theirs).max() < 2e-7
        theirs = -np.array([e["forces"][k] for e in found]).T
        assert np.abs(forces - theirs).max() < 2.0
        assert np.ptp(forces) > 500.0


def tripod(name: str) -> Parameters:
    """The vehicle of a landing of `test_vehicle_in_space`, on three struts a leg."""
    tensor = {"vehicle.inertia_roll": 120.0, "vehicle.inertia_yaw": 60.0, "vehicle.inertia_xy": 5.0}
    values = {"drop.mode": "space", "drop.contact_time": 0.0, **tensor, **LANDINGS[name], **TRIPOD}
    return load_preset("yue2022-figures").with_values(values)
