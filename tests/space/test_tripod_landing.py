"""Landings on legs of three struts: what is conserved, mirrored, turned; rest; what is refused."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from space_vehicles import SPACE, TURNING, UNEVEN, vehicle
from test_invariance import SCENE, mirrored, turned, vectors

from rlv_landing import Landing, LandingError
from rlv_landing.audit.spatial_momentum import spatial_impulse, spatial_momentum
from rlv_landing.figures.wireframe import wireframe
from rlv_landing.quantities import interface_of
from rlv_landing.touchdown import footpad_at_rest, tripod_footpad

TRIPOD = {"leg.kind": "tripod"}
UNEVEN_TRIPOD = (
    TRIPOD
    | UNEVEN
    | {
        "leg[2].auxiliary_strut.joint_spread": 0.35,
        "leg[3].vehicle.footpad_mass": 6.0,
    }
)


def test_names_are_those_of_three_struts() -> None:
    landing = Landing(vehicle(TURNING | TRIPOD | {"vehicle.legs": 5.0}))
    names = landing.interface.output_names
    assert names == interface_of("space", 5, "tripod").output_names
    assert "leg[5].auxiliary_strut_2.force" in names
    assert not any("transverse_force" in name for name in names)
    history = landing.run(0.1, 1e-3)
    assert np.isfinite(history.data).all()
    # both sides bear, each for itself
    first, second = (history[f"leg[1].auxiliary_strut{side}.force"] for side in ("", "_2"))
    assert np.abs(first - second).max() > 100.0


def test_the_footpad_is_where_its_struts_meet() -> None:
    parameters = vehicle(TURNING | TRIPOD)
    landing = Landing(parameters)
    struts = ("main_strut", "auxiliary_strut", "auxiliary_strut_2")
    lengths = (1.426, 1.145, 1.145)
    assert tripod_footpad(parameters, *lengths) == pytest.approx(
        (*footpad_at_rest(parameters), 0.0), abs=1e-12
    )
    landing.advance_to(0.1)
    now = landing.outputs()
    turn = Rotation.from_quat([now[f"body.q_{part}"] for part in "xyzw"])
    for leg, (out, across) in {
        1: ([-1, 0, 0], [0, 0, -1]), 2: ([0, 0, -1], [1, 0, 0]),
        3: ([1, 0, 0], [0, 0, 1]), 4: ([0, 0, 1], [-1, 0, 0]),
    }.items():  # fmt: skip
        strokes = [now[f"leg[{leg}].{strut}.stroke"] for strut in struts]
        r, h, t = tripod_footpad(parameters, *(a - s for a, s in zip(lengths, strokes)))
        foot, body = (
            np.array([now[f"{name}{axis}"] for axis in "xyz"])
            for name in (f"leg[{leg}].footpad.", "body.")
        )
        seen = turn.inv().apply(foot - body)
        place = r * np.array(out) + t * np.array(across) + [0.0, h, 0.0]
        assert seen == pytest.approx(place, abs=1e-9)
    assert abs(t) > 1e-4


def test_lines_of_struts_end_at_their_joints_and_at_the_footpads() -> None:
    parameters = vehicle(TURNING | UNEVEN_TRIPOD)
    history = Landing(parameters).run(0.2, 1e-2)
    parts = wireframe(history, parameters, np.arange(len(history)))
    main, both, feet = (parts[name] for name in ("main", "auxiliary", "feet"))
    assert both.shape == (21, 4, 3, 3)
    for i, leg in enumerate(history.legs):
        places = np.column_stack([history[f"leg[{leg}].footpad.{axis}"] for axis in "xyz"])
        for ends in (feet[:, i, 0], main[:, i, 1], both[:, i, 1]):
            assert ends == pytest.approx(places, abs=1e-9)
        for line, strut in (
            (main[:, i], "main_strut"),
            (both[:, i, :2], "auxiliary_strut"),
            (both[:, i, 1:], "auxiliary_strut_2"),
        ):
            whole = 1.426 if strut == "main_strut" else 1.145
            lengths = np.linalg.norm(line[:, 0] - line[:, 1], axis=1)
            stroke = history[f"leg[{leg}].{strut}.stroke"]
            assert lengths == pytest.approx(whole - stroke, abs=1e-9)


@pytest.mark.parametrize("method", ["exponential", "dormand-prince"])
def test_energy_momentum_and_angular_momentum_balance(method: str) -> None:
    parameters = vehicle(SCENE | UNEVEN_TRIPOD)
    landing = Landing(parameters, rtol=1e-7, method=method)
    history = landing.run(0.25, 2.5e-5)
    assert np.abs(history["energy.balance"]).max() < 2e-5 * history["energy.dissipated"][-1]
    assert (np.diff(history["energy.dissipated"]) >= 0.0).all()
    momentum, impulse = spatial_momentum(history, parameters), spatial_impulse(history, parameters)
    for name, scale in (("linear", 150.0), ("about_origin", 30.0)):
        gained = getattr(momentum, name) - getattr(momentum, name)[0]
        size = np.abs(gained).max()
        assert size > scale
        assert np.abs(gained - getattr(impulse, name)).max() < 2e-4 * size


def test_a_tumbling_flight_keeps_angular_momentum() -> None:
    tumbling: dict[str, Any] = TURNING | UNEVEN_TRIPOD | {
        "ground.gravity": 0.0, "drop.contact_time": 2.0, "drop.vertical_velocity": -5.0,
        "drop.pitch_rate": 0.9, "drop.roll_rate": -0.6, "drop.yaw_rate": 0.8,
    }  # fmt: skip
    parameters = vehicle(tumbling)
    landing = Landing(parameters, rtol=1e-9)
    history = landing.run(1.9, 1e-2)
    momentum = spatial_momentum(history, parameters)
    for kept in (momentum.linear, momentum.about_cg):
        assert np.ptp(kept, axis=0).max() < 1e-6 * np.abs(kept).max()
    assert np.abs(history["energy.balance"]).max() < 1e-6


def test_the_mirrored_scene_gives_the_mirrored_landing() -> None:
    """A mirror image exchanges the legs' sides, and so the two auxiliary struts."""
    one = vehicle(SCENE | TRIPOD)
    landings = Landing(one, rtol=1e-9), Landing(mirrored(one), rtol=1e-9)
    for landing in landings:
        landing.advance_to(0.15)
    for leg, image in {1: 1, 2: 4, 3: 3, 4: 2}.items():
        first, second = vectors(landings[0], leg), vectors(landings[1], image)
        for name, vector in first.items():
            other = second[name] * [1.0, 1.0, -1.0]
            assert other == pytest.approx(vector, rel=1e-5, abs=1e-5), name
        for here, there in (("", "_2"), ("_2", "")):
            force = landings[0].get(f"leg[{leg}].auxiliary_strut{here}.force")
            other = landings[1].get(f"leg[{image}].auxiliary_strut{there}.force")
            assert other == pytest.approx(force, rel=1e-5, abs=1e-4)


@pytest.mark.parametrize("angle", [-2.3, 0.9])
def test_turning_the_scene_about_the_vertical_turns_the_landing(angle: float) -> None:
    one = vehicle(SCENE | TRIPOD)
    about = Rotation.from_euler("y", angle)
    landings = Landing(one, rtol=1e-9), Landing(turned(one, angle), rtol=1e-9)
    for landing in landings:
        landing.advance_to(0.15)
    for leg in (1, 2, 3, 4):
        first, second = (vectors(landing, leg) for landing in landings)
        for name, vector in first.items():
            assert second[name] == pytest.approx(about.apply(vector), rel=1e-5, abs=1e-5), name


@pytest.mark.parametrize(
    ("values", "method"),
    [
        ({"ground.slope": 0.1, "ground.slope_direction": 1.1}, "exponential"),
        ({"vehicle.legs": 3.0, "vehicle.cg_offset_x": 0.1, "ground.slope": 0.06}, "exponential"),
        ({"main_strut.kind": "spring-damper", "drop.yaw_rate": 0.4}, "dormand-prince"),
    ],
)
def test_a_landing_comes_to_rest_and_stays(values: dict[str, Any], method: str) -> None:
    landing = Landing(vehicle(TURNING | TRIPOD | values), method=method)
    landing.advance_to(25.0)
    now = landing.outputs()
    assert now["status.phase"] == 2.0
    assert landing.statistics["asleep"] == 1
    weight = 9.81 * landing.parameters.whole_mass
    legs = landing.interface.legs
    assert sum(now[f"leg[{i}].contact.force_y"] for i in legs) == pytest.approx(weight, rel=1e-5)
    landing.advance_to(125.0)
    later = landing.outputs()
    # below 1e-6 mm/s
    assert all(abs(later[f"body.{axis}"] - now[f"body.{axis}"]) < 1e-7 for axis in "xyz")


def test_a_copy_and_a_restored_state_go_on_with_the_same_digits() -> None:
    parameters = vehicle(TURNING | UNEVEN_TRIPOD)
    plain, other = Landing(parameters), Landing(parameters)
    plain.advance_to(0.0513)
    other.restore(plain.state())
    twin = pickle.loads(pickle.dumps(plain))
    for landing in (plain, other, twin):
        landing.advance_to(0.2)
    assert plain.values() == other.values() == twin.values()
    with pytest.raises(LandingError, match="it comes from another mode or version"):
        Landing(vehicle(TURNING)).restore(plain.state())


def test_a_wide_stance_holds_the_footpad_across_the_leg() -> None:
    """At rest under a side load the second struts bear it; a wider spread gives less way."""
    ways = []
    for spread in (0.1, 0.3):
        values = TRIPOD | {"auxiliary_strut.joint_spread": spread, "drop.contact_time": 0.0}
        landing = Landing(vehicle(SPACE | values))
        landing.advance_to(6.0)
        landing.set_inputs({"external.moment_y": 150.0})
        before = landing.get("body.heading")
        landing.advance_to(12.0)
        assert landing.get("status.phase") == 2.0
        ways.append(landing.get("body.heading") - before)
        first, second = (landing.get(f"leg[2].auxiliary_strut{k}.force") for k in ("", "_2"))
        assert abs(first - second) > 20.0
    assert ways[0] > 1.5 * ways[1] > 0.0


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"drop.mode": "2-2"}, "leg.kind = tripod needs drop.mode = space.* which has radial"),
        ({"auxiliary_strut.joint_spread": 0.0}, r"joint_spread = 0 m is outside \[0.001, 50\] m"),
        ({"auxiliary_strut.joint_spread": 0.01}, r"joint_spread = 0.01 m .*\[0.0229, 1.145\) m"),
        ({"auxiliary_strut.joint_spread": 1.2}, "joint_spread = 1.2 m is outside"),
        ({"auxiliary_strut.length": 0.0}, r"length = 0 m is outside \[0.05, 100\] m"),
        ({"main_strut.length": 0.69}, r"1.11\d* m in the leg's plane\) do not meet"),
        ({"main_strut.length": 0.70701}, "in one plane at the footpad: the sine .* the least is"),
        ({"vehicle.transverse_load_at": "joint"}, "a tripod has no transverse force"),
        ({"leg[2].auxiliary_strut.joint_spread": 0.01}, r"leg\[2\]: .*joint_spread"),
    ],
)
def test_what_is_no_tripod_is_refused_in_one_line(values: dict[str, Any], told: str) -> None:
    with pytest.raises(LandingError, match=told) as error:
        vehicle(SPACE | TRIPOD | values)
    assert "\n" not in str(error.value)
