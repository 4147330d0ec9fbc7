"""A landing in space as users have it: inputs, states, copies, events, and what is refused."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, LandingError
from rlv_landing.hosted import HostedLanding
from rlv_landing.quantities import interface_of


def test_names_are_those_of_the_legs() -> None:
    landing = Landing(vehicle(TURNING | {"vehicle.legs": 5.0}))
    names = landing.interface.output_names
    assert names == interface_of("space", 5).output_names
    assert "leg[5].auxiliary_strut.transverse_force" in names
    assert not any(name.startswith("leg[6]") for name in names)
    assert len(landing.values()) == len(names)
    history = landing.run(0.1, 1e-3)
    assert history.names == names
    assert np.isfinite(history.data).all()


def test_the_lowest_footpad_touches_at_the_contact_time() -> None:
    deck = {"ground.heave": 0.3, "ground.roll": 0.05, "ground.yaw_rate": 0.1, "ground.sway": 0.2}
    fast = {"drop.contact_time": 0.2, "drop.vertical_velocity": -4.0}
    landing = Landing(vehicle(TURNING | fast), inputs=deck)
    landing.advance_to(0.2)
    depths = [landing.get(f"leg[{leg}].contact.penetration") for leg in (1, 2, 3, 4)]
    # the struts' bodies swing free of each other in the flight, by micrometres
    assert max(depths) == pytest.approx(0.0, abs=2e-5)
    assert sum(depth > -1e-3 for depth in depths) == 1
    now = landing.outputs()
    drop = landing.parameters.drop
    assert now["body.x"] == pytest.approx(0.0, abs=1e-5)
    assert now["body.heading"] == pytest.approx(drop.heading, abs=1e-4)
    assert now["body.roll"] == pytest.approx(drop.roll, abs=1e-4)
    assert now["body.vz"] == pytest.approx(drop.lateral_velocity, abs=1e-3)


@pytest.mark.parametrize("kind", ["surge", "heave", "sway", "roll", "yaw", "tilt"])
def test_a_deck_that_moves_does_the_work_that_it_is_told_to_do(kind: str) -> None:
    landing = Landing(vehicle(TURNING | {"drop.contact_time": 0.0}), rtol=1e-7)
    landing.set_inputs({f"ground.{kind}_rate": 0.05}, {f"ground.{kind}_rate": 0.2})
    landing.advance_to(0.6)
    assert abs(landing.get("energy.work_ground")) > 1e-3
    assert abs(landing.get("energy.balance")) < 1e-4
    assert landing.inputs()[f"ground.{kind}"] == pytest.approx(0.05 * 0.6 + 0.1 * 0.36)


def test_a_vehicle_that_rests_rides_on_a_deck_that_yaws() -> None:
    landing = Landing(vehicle(SPACE | {"drop.contact_time": 0.0, "drop.tilt": 0.0}))
    landing.advance_to(8.0)
    assert landing.get("status.phase") == 2.0
    start = landing.get("body.heading")
    landing.set_inputs({"ground.yaw_rate": 0.05})
    landing.advance_to(12.0)
    assert landing.get("body.heading") - start == pytest.approx(0.2, abs=5e-3)


def test_loads_turn_the_body_about_their_axes() -> None:
    flying = vehicle(SPACE | {"drop.contact_time": 1.0, "ground.gravity": 0.0, "drop.tilt": 0.0})
    flying = flying.with_values({"drop.pitch_rate": 0.0, "drop.vertical_velocity": -2.0})
    for axis, other in zip("xyz", "yzx"):
        landing = Landing(flying)
        landing.set_inputs({f"external.moment_{axis}": 50.0, f"external.force_{other}": 80.0})
        landing.advance_to(0.3)
        now = landing.outputs()
        assert now[f"body.spin_{axis}"] > 0.02
        assert abs(now[f"body.a{other}"]) > 0.2
        work = now["energy.work_external"]
        assert abs(now["energy.balance"]) < 1e-6 * max(1.0, abs(work))


def run_on(landing: Landing) -> list[float]:
    landing.set_inputs({"ground.sway": 0.01, "external.force_z": 40.0})
    landing.advance_to(landing.time + 0.15)
    return landing.values()


def test_states_copies_and_pickles_go_on_with_the_same_digits() -> None:
    landing = Landing(vehicle(TURNING), rtol=1e-6, inputs={"ground.roll": 0.02})
    landing.advance_to(0.1)
    landing.set_inputs({"ground.heave": 0.02, "ground.yaw_rate": 0.1})
    landing.advance_to(0.18)
    others = [copy.copy(landing), copy.deepcopy(landing), pickle.loads(pickle.dumps(landing))]
    again = Landing(vehicle(TURNING), rtol=1e-6, inputs={"ground.roll": 0.02})
    again.restore(landing.state())
    expected = run_on(landing)
    for other in (*others, again):
        assert run_on(other) == expected


def test_results_do_not_depend_on_communication_steps() -> None:
    one, many = (Landing(vehicle(TURNING)) for _ in range(2))
    one.advance_to(0.4)
    for k in range(1, 401):
        many.advance_to(k * 1e-3)
    assert many.values() == pytest.approx(one.values(), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("method", ["exponential", "dormand-prince"])
def test_peaks_are_those_of_fine_samples(method: str) -> None:
    landing = Landing(vehicle(TURNING), method=method)
    history = landing.run(0.3, 1e-5)
    for leg in (1, 2, 3, 4):
        for name in ("main_strut.force", "contact.force", "auxiliary_strut.transverse_force"):
            column = history[f"leg[{leg}].{name}"]
            found = landing.extremes()[f"leg[{leg}].{name}"]
            span = column.max() - column.min()
            assert found.maximum == pytest.approx(column.max(), abs=2e-3 * span)
            assert found.minimum == pytest.approx(column.min(), abs=2e-3 * span)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"vehicle.legs": 3.5}, "vehicle.legs = 3.5 is not a whole number"),
        ({"vehicle.legs": 2.0}, r"vehicle.legs = 2 is outside \[3, 8\]"),
        ({"vehicle.inertia_roll": 10.0, "vehicle.inertia_yaw": 20.0}, "are those of no body"),
        (
            {
                "vehicle.inertia_roll": 100.0,
                "vehicle.inertia_yaw": 90.0,
                "vehicle.inertia_xy": 95.0,
            },
            "are those of no body",
        ),
        ({"vehicle.inertia_xy": 3.0}, "needs vehicle.inertia_roll"),
        ({"drop.heading": 4.0}, r"drop.heading = 4 rad is outside"),
        ({"drop.roll": float("nan")}, "drop.roll = nan"),
    ],
)
def test_vehicles_that_cannot_be_are_refused(values: dict[str, Any], told: str) -> None:
    with pytest.raises(LandingError, match=told):
        vehicle(SPACE | values)


@pytest.mark.parametrize(
    "name",
    [
        "drop.heading",
        "drop.roll",
        "drop.roll_rate",
        "drop.yaw_rate",
        "drop.lateral_velocity",
        "ground.slope_direction",
        "vehicle.cg_offset_x",
        "vehicle.cg_offset_z",
        "vehicle.inertia_xy",
    ],
)
def test_a_symmetric_landing_refuses_what_only_space_has(name: str) -> None:
    with pytest.raises(LandingError, match=f"{name} = 0.1 needs drop.mode = space"):
        vehicle({name: 0.1})


def test_a_symmetric_landing_has_four_legs() -> None:
    with pytest.raises(LandingError, match=r"vehicle.legs = 5 needs drop.mode = space"):
        vehicle({"vehicle.legs": 5.0})


def test_a_flight_below_the_ground_is_refused() -> None:
    values = TURNING | {"drop.contact_time": 2.0, "drop.vertical_velocity": 1.0}
    with pytest.raises(LandingError, match="below the ground"):
        Landing(vehicle(values | {"ground.gravity": 0.0}))


def test_a_ground_that_is_too_steep_is_refused() -> None:
    values = TURNING | {"ground.slope": 0.69, "ground.slope_direction": 0.0}
    with pytest.raises(LandingError, match="tilt the ground less"):
        Landing(vehicle(values), inputs={"ground.tilt": 1.0})


def test_an_unknown_input_is_refused() -> None:
    landing = Landing(vehicle(TURNING))
    with pytest.raises(LandingError, match=r"external.moment\b"):
        landing.set_inputs({"external.moment": 1.0})


def test_a_host_refuses_a_landing_in_space() -> None:
    hosted = HostedLanding()
    hosted.set_parameter("drop.mode", "space")
    with pytest.raises(LandingError, match=r"drop.mode = space"):
        hosted.begin()


@pytest.mark.parametrize("method", ["exponential", "dormand-prince"])
def test_a_state_that_is_restored_on_the_way_goes_on_with_the_same_digits(method):
    """Also between two steps: the rates that a step starts with are those of the state kept."""
    parameters = vehicle(TURNING)
    plain, again = (Landing(parameters, rtol=1e-4, method=method) for _ in range(2))
    for k in range(1, 25):
        for landing in (plain, again):
            landing.advance_to(4e-3 * k)
        again.restore(again.state())
    assert again.state() == plain.state()


@pytest.mark.parametrize("factor", [0.0, 0.5, 1.001])
def test_a_state_whose_quaternion_is_no_attitude_is_refused(factor: float) -> None:
    landing = Landing(vehicle(TURNING))
    landing.advance_to(0.1)
    state, before = landing.state(), landing.values()
    quaternion = [landing.get(f"body.q_{part}") for part in "wxyz"]
    at = next(
        i
        for i in range(len(state))
        if state[i : i + 4].tolist() == pytest.approx(quaternion, abs=1e-3)
    )
    for k in range(4):
        state[at + k] *= factor
    with pytest.raises(LandingError, match=r"a quaternion of length .*, which is no attitude"):
        landing.restore(state)
    assert landing.values() == before
