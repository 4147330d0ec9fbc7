"""The landing against a 3-D Newton-Euler model of the vehicle that shares no code with it.

First without any solver in between: accelerations, pressure rates and friction rates at random
states, to rounding. Then whole landings, each model with a solver of its own.
"""

from array import array
from typing import Any

import numpy as np
import pytest
from pytest import approx
from vehicle_3d import (
    AZIMUTHS,
    LEGS,
    POSITION,
    QUATERNION,
    SPIN,
    VELOCITY,
    Inputs,
    Vehicle3D,
    land,
    rotation,
)

from rlv_landing import Landing, load_preset
from rlv_landing.assembly import planar_system
from rlv_landing.core import LegState, access
from rlv_landing.core.bodies.planar import Planar

FIGURES = "yue2022-figures"
BODY = ("x", "y", "pitch", "vx", "vy", "pitch_rate")
# leg group of legs 1 to 4 in the kernels' state, and the side on which z is turned
GROUPS = {"2-2": ((0, 1), (0, -1), (1, -1), (1, 1)), "1-2-1": ((0, 1), (1, -1), (2, 1), (1, 1))}
# where a leg's state has the friction displacement across the symmetric plane
ACROSS = LegState._fields.index("q2")


def leg_at(group: int) -> int:
    """Where the state of a leg group begins."""
    return access.BODY + access.LEG * group


def chamber_state(power: float) -> float:
    """A chamber's state [Pa]: from 10^3.7 Pa up a pressure, below in a cavity or next to it."""
    return 10.0**power if power > 3.7 else 200.0 * (power - 3.5)


def random_state(
    rng: np.random.Generator, mode: str, model: Vehicle3D, upright: float
) -> tuple[np.ndarray, np.ndarray]:
    """The same violent symmetric state for both models: (the kernels', the 3-D one's).

    The footpads are some millimetres in or above the ground. `upright` is the slope of the ground
    now: the body's height is chosen so that one footpad is near it.
    """
    groups = max(g for g, _ in GROUPS[mode]) + 1
    y = np.zeros(leg_at(groups) + access.ACCOUNTS + groups)
    y[:6] = rng.uniform([-0.5, 0.0, -0.4, -2.0, -2.0, -3.0], [0.5, 0.0, 0.4, 2.0, 2.0, 3.0])
    rest = model.start(np.zeros(6))[LEGS:].reshape(8, 4)
    body = [
        y[0],
        y[1],
        0.0,
        np.cos(-0.5 * y[2]),
        0.0,
        0.0,
        np.sin(-0.5 * y[2]),
        y[3],
        y[4],
        0.0,
        0.0,
        0.0,
        -y[5],
    ]
    legs = np.zeros((8, 4))
    for g in range(groups):
        y[leg_at(g) : leg_at(g + 1)] = [
            *(rest[:2, 0] + rng.uniform(-0.04, 0.04, 2)),
            *rng.uniform(-2.0, 2.0, 2),
            *map(chamber_state, rng.uniform(3.0, 7.5, 2)),
            *rng.uniform(-1.5e-3, 1.5e-3, 2),
        ]
    if mode == "1-2-1":  # a leg in the symmetric plane neither slides nor sticks along z
        y[leg_at(0) + ACROSS] = y[leg_at(2) + ACROSS] = 0.0
    for i, (g, side) in enumerate(GROUPS[mode]):
        legs[:, i] = y[leg_at(g) : leg_at(g + 1)]
        legs[ACROSS, i] *= side
    foot = rotation(np.array(body[3:7])) @ (legs[0] * model.e_r + legs[1] * model.e_y)
    height = (foot[1] + np.tan(upright) * (foot[0] + y[0])).min()
    y[1] = body[1] = rng.uniform(-0.01, 0.005) - height
    return y, np.concatenate((body, legs.ravel()))


def random_play(rng: np.random.Generator) -> dict[str, float]:
    """None, on one side, or on both."""
    tension, compression = rng.choice([0.0, 1.0], 2) * rng.uniform(1e-4, 5e-3, 2)
    return {
        "auxiliary_strut.play_tension": tension,
        "auxiliary_strut.play_compression": compression,
        "auxiliary_strut.play_stiffness": rng.uniform(0.0, 1e6),
        "auxiliary_strut.play_damping": rng.uniform(),
    }


@pytest.mark.parametrize("law", ["passive", "paper"])
@pytest.mark.parametrize("at", ["footpad", "joint"])
def test_accelerations_and_rates_are_the_same_at_random_states_to_rounding(
    mode: str, at: str, law: str
) -> None:
    """No solver in between.

    Rounding: forces of some 1e6 N on 4.2 kg, and two linear systems solved in different ways, so
    1e-9 of the largest acceleration of its kind; a Coriolis term left out or turned changes it by
    1e-3 and more.
    """
    rng = np.random.default_rng(2022)
    base = load_preset(FIGURES, mode).for_mode(mode)
    touching = 0
    for _ in range(150):
        parameters = base.with_values(
            {
                "vehicle.transverse_load_at": at,
                "ground.slope": rng.uniform(-0.2, 0.2),
                "ground.friction": rng.uniform(0.0, 1.0),
                "ground.friction_law": law,
                "auxiliary_strut.exponent": rng.uniform(1.0, 1.5),
                "main_strut.seal_pressure": rng.uniform(0.0, 1e-4),
                "main_strut.stroke_max": 0.02,
                # so that the piston empties the upper chamber in some states
                "main_strut.volume_upper": 2e-5,
                **random_play(rng),
            }
        )
        loads = Inputs(
            tuple(rng.uniform(-2000.0, 2000.0, 2)),
            rng.uniform(-500.0, 500.0),
            0.0,
            rng.uniform(-0.5, 0.5),
            0.0,
            rng.uniform(-0.3, 0.3),
        )
        model = Vehicle3D(parameters, loads, tuple(rng.uniform(20.0, 400.0, 2)))
        y, state = random_state(rng, mode, model, parameters.ground.slope)
        u = array(
            "d",
            [
                *loads.force,
                loads.moment,
                loads.heave,
                loads.heave_rate,
                loads.tilt,
                loads.tilt_rate,
            ],
        )
        ours = array("d", bytes(8 * len(y)))
        planar_system(parameters, Planar).rhs(array("d", y), u, ours)
        e = model.evaluate(0.0, state)
        touching += int((e["penetration"] > 0.0).sum())

        size = np.abs(e["r_acc"]).max() + np.abs(e["h_acc"]).max()
        assert e["acceleration"][:2] == approx(np.array(ours[3:5]), rel=1e-9, abs=1e-9 * size)
        assert -e["spin_rate"][2] == approx(ours[5], rel=1e-9, abs=1e-9 * size)
        assert np.abs([e["acceleration"][2], *e["spin_rate"][:2]]).max() < 1e-9 * size
        for i, (g, side) in enumerate(GROUPS[mode]):
            leg = access.leg_state(ours, leg_at(g))
            assert (e["r_acc"][i], e["h_acc"][i]) == approx(
                (leg.vr, leg.vh), rel=1e-9, abs=1e-9 * size
            )
            assert (e["upper_rate"][i], e["lower_rate"][i]) == approx((leg.z1, leg.z2), rel=1e-9)
            assert (e["slip_x_rate"][i], side * e["slip_z_rate"][i]) == approx(
                (leg.q1, leg.q2), rel=1e-9, abs=1e-11
            )
    assert 100 < touching < 150 * 4  # some footpads in the ground, some above it


def test_the_three_dimensional_model_itself_obeys_newton_and_euler() -> None:
    """The rates of momentum and angular momentum are the forces and moments from outside.

    At random states, rolled and yawed, with rates by differences. This examines the 3-D model by
    sums over its particles and its body, which need no model.
    """
    rng = np.random.default_rng(8)
    parameters = (
        load_preset(FIGURES, "1-2-1")
        .for_mode("1-2-1")
        .with_values({"vehicle.transverse_load_at": "footpad"})
    )
    m, M = parameters.vehicle.footpad_mass, parameters.vehicle.mass
    model = Vehicle3D(parameters, roll_yaw=(160.0, 30.0))

    def momenta(y: np.ndarray) -> np.ndarray:
        legs = y[LEGS:].reshape(8, 4)
        R = rotation(y[QUATERNION])
        rho, rho_rate = (
            legs[0] * model.e_r + legs[1] * model.e_y,
            legs[2] * model.e_r + legs[3] * model.e_y,
        )
        place = y[POSITION][:, None] + R @ rho
        speed = y[VELOCITY][:, None] + R @ (np.cross(y[SPIN], rho, axisb=0, axisc=0) + rho_rate)
        linear = M * y[VELOCITY] + m * speed.sum(axis=1)
        angular = (
            M * np.cross(y[POSITION], y[VELOCITY])
            + R @ (model.inertia * y[SPIN])
            + m * np.cross(place, speed, axis=0).sum(axis=1)
        )
        return np.concatenate((linear, angular))

    for _ in range(20):
        y = model.start([*rng.uniform(-0.3, 0.3, 2), 0.0, 0.0, 0.0, 0.0])
        y[1] = 2.14
        y[QUATERNION] = [1.0, *rng.uniform(-0.05, 0.05, 3)]
        y[QUATERNION] /= np.linalg.norm(y[QUATERNION])
        y[7:13] = rng.uniform(-2.0, 2.0, 6)
        y[LEGS : LEGS + 8] += rng.uniform(-0.01, 0.01, 8)
        y[LEGS + 8 : LEGS + 16] = rng.uniform(-1.0, 1.0, 8)
        e, step = model.evaluate(0.0, y), 1e-7 * model(0.0, y)
        change = (momenta(y + step) - momenta(y - step)) / 2e-7
        weight = np.array([0.0, -9.81, 0.0])
        force = M * weight + (e["ground"] + m * weight[:, None]).sum(axis=1)
        moment = M * np.cross(y[POSITION], weight) + np.cross(
            e["place"], e["ground"] + m * weight[:, None], axis=0
        ).sum(axis=1)
        assert change == approx(
            np.concatenate((force, moment)), rel=1e-6, abs=1e-3
        )  # central differences over 1e-7 s


SLOPE = {"ground.slope": 0.08, "ground.friction": 0.4, "drop.contact_time": 0.0}
LEANING = {
    "ground.slope": -0.06,
    "ground.friction": 0.25,
    "drop.contact_time": 0.0,
    "drop.tilt": 0.1,
    "drop.pitch_rate": -0.2,
}
PLAY = {
    "auxiliary_strut.play_tension": 8e-4,
    "auxiliary_strut.play_compression": 5e-4,
    "auxiliary_strut.play_stiffness": 1e5,
    "auxiliary_strut.play_damping": 0.2,
}
RIGID = {
    "auxiliary_strut.play_tension": 0.0,
    "auxiliary_strut.play_compression": 0.0,
    "auxiliary_strut.damping": 2000.0,
}
PAPER = {"ground.friction_law": "paper"}
JOINT = {"vehicle.transverse_load_at": "joint"}
LOADED = Inputs(force=(400.0, -300.0), moment=150.0)
DECK = Inputs(heave_rate=0.15, tilt_rate=0.05)
BOTH = Inputs(
    force=(-300.0, 200.0), moment=-120.0, heave=-0.02, heave_rate=-0.2, tilt=0.03, tilt_rate=-0.06
)
NEAR = {"drop.contact_time": 0.01}
CAVITIES = "2-2 with cavities down to 4 Pa"
LANDINGS = {
    "2-2 drop test": ("2-2", {}, Inputs(), 0.36),
    "1-2-1 drop test": ("1-2-1", {}, Inputs(), 0.36),
    "2-2 on a slope falling towards +x": ("2-2", SLOPE, Inputs(), 0.27),
    "1-2-1 on a slope falling towards -x, other legs first": ("1-2-1", LEANING, Inputs(), 0.27),
    "2-2 with force and moment": ("2-2", NEAR, LOADED, 0.27),
    CAVITIES: ("2-2", NEAR | {"main_strut.air_fraction": 1e-6}, Inputs(), 0.27),
    "2-2 without play": ("2-2", NEAR | RIGID, Inputs(), 0.27),
    "2-2 with play in the auxiliary struts' joints": ("2-2", NEAR | PLAY, Inputs(), 0.27),
    "1-2-1 on a slope with play in tension only": (
        "1-2-1",
        SLOPE | PLAY | {"auxiliary_strut.play_compression": 0.0},
        Inputs(),
        0.27,
    ),
    "1-2-1 on a slope with the paper's friction": ("1-2-1", SLOPE | PAPER, Inputs(), 0.27),
    "1-2-1 on a deck that rises and tilts, transverse load at the joint": (
        "1-2-1",
        NEAR | JOINT,
        DECK,
        0.27,
    ),
    "2-2 on a deck that falls and tilts, with loads, transverse load at the joint": (
        "2-2",
        NEAR | JOINT,
        BOTH,
        0.27,
    ),
}


def both_ways(
    mode: str, values: dict[str, Any], loads: Inputs, until: float, rtol: float
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The same landing by the kernels and by the 3-D model with scipy's DOP853.

    Both every millisecond, under the same names.
    """
    landing = Landing(load_preset(FIGURES, mode).for_mode(mode).with_values(values), rtol=1e-9)
    landing.set_inputs(
        {
            "external.force_x": loads.force[0], "external.force_y": loads.force[1],
            "external.moment": loads.moment,
            "ground.heave": loads.heave, "ground.heave_rate": loads.heave_rate,
            "ground.tilt": loads.tilt, "ground.tilt_rate": loads.tilt_rate,
        }
    )  # fmt: skip
    body = [landing.get(f"body.{name}") for name in BODY]
    model = Vehicle3D(landing.parameters, loads)
    history = landing.run(until, 1e-3)
    ours = {name: history[f"body.{name}"] for name in ("x", "y", "pitch")}
    columns = {
        "main_force": "main_strut.force",
        "stroke": "main_strut.stroke",
        "aux_force": "auxiliary_strut.force",
    }
    for name, column in columns.items():
        ours[name] = np.array([history[f"leg[{leg}].{column}"] for leg in (1, 2, 3, 4)])
    ours["ground"] = np.array(
        [[history[f"leg[{leg}].contact.force_{axis}"] for leg in (1, 2, 3, 4)] for axis in "xyz"]
    )
    return ours, land(model, body, history.time, "DOP853", rtol)


def worst(ours: dict[str, Any], theirs: dict[str, Any], name: str) -> float:
    return float(np.abs(ours[name] - theirs[name]).max())


@pytest.mark.parametrize("name", LANDINGS)
def test_a_landing_is_that_of_the_three_dimensional_model(name: str) -> None:
    """Tolerances: the two solvers' errors, which contacts and friction carry on.

    The 3-D model's rtol 3e-8 of 0.1 m is 3e-9 m a step; 3e-8 m is seen at the end. Where a strut
    turns round, its seal gives 1.5e4 N s/m and speeds differ by 4e-5 m/s: 0.6 N of 6 kN. A cavity
    that closes carries errors on as well; there the 3-D model lands with 1e-9.
    """
    mode, values, loads, until = LANDINGS[name]
    ours, theirs = both_ways(mode, values, loads, until, 1e-9 if name == CAVITIES else 3e-8)
    assert np.abs(ours["main_force"]).max() > 2000.0  # it did land
    for what in ("x", "y", "pitch"):
        assert worst(ours, theirs, what) < 5e-7
    assert worst(ours, theirs, "stroke") < 1e-7
    assert worst(ours, theirs, "main_force") < 2.0
    # neither out of the symmetric plane nor rolled nor yawed; rounding that four stiff contacts
    # blow up, nothing that grows
    assert np.abs(theirs["z"]).max() < 1e-9
    assert np.abs(theirs["roll_yaw"]).max() < 1e-9


def test_without_friction_a_landing_agrees_to_1e9_m(mode: str) -> None:
    """Without friction only the contacts are not smooth.

    So tight solvers show that the equations are the same, not only similar.
    """
    ours, theirs = both_ways(
        mode,
        {"ground.friction": 0.0, "ground.stick_damping": 0.0, "drop.contact_time": 0.0},
        Inputs(),
        0.22,
        1e-9,
    )
    for what in ("x", "y", "pitch", "stroke"):
        assert worst(ours, theirs, what) < 1e-9
    assert worst(ours, theirs, "main_force") < 0.02


def test_both_models_number_the_legs_alike(mode: str) -> None:
    history = Landing(load_preset(FIGURES, mode)).run(1e-3, 1e-3)
    azimuth = np.radians(AZIMUTHS[mode])
    assert [
        np.sign(np.round(history[f"leg[{leg}].footpad.z"][0], 9)) for leg in (1, 2, 3, 4)
    ] == list(np.sign(np.round(np.sin(azimuth), 9)))
