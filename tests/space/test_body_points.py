"""Points of the body that meet the ground: a nozzle strikes, a vehicle lies on its side."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import pytest
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, LandingError, Parameters
from rlv_landing.core import Phase
from rlv_landing.presets import parse_toml, to_toml
from rlv_landing.summary import summarise


def ring(radius: float, height: float, count: int = 6) -> str:
    """Points on a circle about the legs' axis."""
    angles = (2.0 * pi * k / count for k in range(count))
    return "; ".join(f"{radius * cos(a)!r} {height!r} {radius * sin(a)!r}" for a in angles)


BODY = {"vehicle.body_points": f"{ring(0.45, -1.6)}; {ring(0.45, 1.2)}"}
NOZZLE = {"vehicle.body_points": ring(0.3, -2.08)}


def test_points_that_stay_above_the_ground_change_nothing() -> None:
    plain, other = Landing(vehicle(TURNING)), Landing(vehicle(TURNING | BODY))
    for landing in (plain, other):
        landing.advance_to(0.3)
    one, two = plain.outputs(), other.outputs()
    assert two.pop("body.clearance") > 0.2
    assert one.pop("body.clearance") == 0.0
    assert two == one


@pytest.mark.parametrize("method", ["exponential", "dormand-prince"])
def test_a_vehicle_that_topples_lies_on_its_side_and_not_below_the_ground(method: str) -> None:
    fast = {"drop.horizontal_velocity": 4.5, "ground.friction": 0.9}
    landing = Landing(vehicle(TURNING | BODY | fast), method=method)
    landing.advance_to(4.0)
    now = landing.outputs()
    assert now["status.phase"] == 3.0
    # on its side, 0.45 m of the axis above the ground, and at rest
    assert 0.3 < now["body.y"] < 1.0
    assert now["energy.kinetic"] < 1e-2
    assert now["body.clearance"] > -2e-3
    assert landing.extremes()["body.clearance"].minimum > -0.05
    forces = sum(now[f"leg[{leg}].contact.force_y"] for leg in (1, 2, 3, 4))
    weight = landing.parameters.whole_mass * 9.81
    assert forces + now["body.strike_force_y"] == pytest.approx(weight, rel=1e-2)
    assert abs(now["energy.balance"]) < 1e-5 * now["energy.dissipated"]


def test_a_strike_is_told_as_an_event_and_in_the_summary() -> None:
    landing = Landing(vehicle(TURNING | NOZZLE | {"drop.vertical_velocity": -2.5}))
    times = []
    while landing.time < 0.3:
        found = landing.advance_within_step(0.3, 0.3, to_event=True)
        if found and abs(landing.get("body.clearance")) < 1e-6:
            times.append(landing.time)
    again = Landing(landing.parameters)
    summary = summarise(again.run(0.3, 1e-3))
    assert summary["body_clearance_min"] < 0.0
    assert summary["body_strike_time"] == pytest.approx(times[0], abs=1e-3)
    least = again.extremes()["body.clearance"]
    assert summary["body_clearance_min"] == pytest.approx(least.minimum, rel=1e-9)


def test_a_point_below_the_feet_meets_the_ground_first() -> None:
    low = vehicle(TURNING | {"vehicle.body_points": "0 -2.6 0", "drop.contact_time": 0.05})
    landing = Landing(low)
    landing.advance_to(0.05)
    assert landing.get("body.clearance") == pytest.approx(0.0, abs=2e-5)
    assert all(landing.get(f"leg[{leg}].contact.penetration") < -0.2 for leg in (1, 2, 3, 4))


def test_a_body_that_slides_on_three_points_has_the_friction_of_its_weight() -> None:
    """A sledge: no leg reaches the ground, and Coulomb friction alone slows the body."""
    sledge = vehicle(
        SPACE
        | {
            "vehicle.body_points": ring(3.0, -3.0, 3),
            "drop.tilt": 0.0,
            "drop.pitch_rate": 0.0,
            "drop.vertical_velocity": -1e-3,
            "drop.horizontal_velocity": 2.0,
            "drop.contact_time": 0.0,
            "ground.stribeck_gain": 0.0,
            "ground.friction": 0.2,
        }
    )
    landing = Landing(sledge, rtol=1e-8)
    landing.advance_to(0.3)
    start = landing.get("body.vx")
    landing.advance_to(0.8)
    # the footpads, on their struts, swing by millimetres
    assert (start - landing.get("body.vx")) / 0.5 == pytest.approx(0.2 * 9.81, rel=1e-2)
    assert abs(landing.get("energy.balance")) < 1e-4


def test_files_have_points_as_arrays_with_units() -> None:
    text = '[vehicle]\nbody_points = [["300 mm", -1.5, 0], [0, "-150 cm", 0.25]]\n'
    found = parse_toml('[drop]\nmode = "space"\n' + text, "mine.toml")
    assert found.vehicle.body_points == "0.3 -1.5 0.0; 0.0 -1.5 0.25"
    assert parse_toml(to_toml(found), "again").vehicle == found.vehicle


@pytest.mark.parametrize(
    ("points", "told"),
    [
        ("0 1", "point 1, '0 1', is not three numbers"),
        ("0 1 2; a b c", "point 2, 'a b c', is not three numbers"),
        ("0 nan 2", "point 1 = 0 nan 2 m is outside [-100, 100] m"),
        ("0 1 200", "outside [-100, 100] m"),
        (ring(1.0, 0.0, 33), "has 33 points, the limit is 32"),
        (3.0, "is no text"),
    ],
)
def test_what_is_no_list_of_points_is_refused(points: Any, told: str) -> None:
    with pytest.raises(LandingError) as e:
        vehicle(SPACE | {"vehicle.body_points": points})
    assert told in str(e.value)


@pytest.mark.parametrize(
    ("points", "told"),
    [
        ("[[0, 1]]", "point 1 = [0, 1] is not three coordinates"),
        ('[[0, 1, "3 kg"]]', "wrong unit"),
        ("[[0, 1, true]]", "True, which is no number"),
        ("[3]", "point 1 = 3 is not three coordinates"),
    ],
)
def test_an_array_that_is_no_list_of_points_is_refused(points: str, told: str) -> None:
    with pytest.raises(LandingError) as e:
        parse_toml(f'[drop]\nmode = "space"\n[vehicle]\nbody_points = {points}\n', "mine.toml")
    assert told in str(e.value)


def test_a_symmetric_landing_has_no_points() -> None:
    with pytest.raises(LandingError, match=r"body_points = .* needs drop.mode = space"):
        vehicle({"vehicle.body_points": "0 -1 0"})


def test_a_vehicle_that_lies_on_its_side_sleeps_and_wakes() -> None:
    """Time passes without steps there, as of one that stands; a load moves it again."""
    rings = f"{ring(0.5, -1.0, 8)}; {ring(0.5, 2.0, 8)}"
    over = {"drop.tilt": 0.3, "drop.pitch_rate": 2.0, "drop.horizontal_velocity": 3.0}
    own = {"drop.contact_time": 0.0, "vehicle.body_points": rings, "ground.friction": 0.9}
    landing = Landing(Parameters().for_mode("space").with_values(own | over), rtol=1e-4)
    landing.advance_to(8.0)
    assert landing.statistics["asleep"] == 1
    assert landing.get("status.phase") == Phase.TOPPLED
    steps, place = landing.statistics["steps"], landing.get("body.x")
    landing.advance_to(1000.0)
    assert landing.statistics["steps"] == steps
    landing.set_inputs({"external.force_x": 1e4})
    landing.advance_to(1000.5)
    assert landing.statistics["asleep"] == 0
    assert landing.get("body.x") > place + 0.1
