"""Legs that differ: a stone below one foot, ice below another, a damper that lost its oil."""

from __future__ import annotations

from math import pi
from typing import Any

import pytest
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.presets import parse_toml, to_toml

# what legs may have for themselves, of every kind
OWN: dict[str, Any] = {
    "leg[1].ground.step": 0.03,
    "leg[1].main_strut.kind": "spring-damper",
    "leg[2].ground.step": -0.02,
    "leg[2].main_strut.orifice_area_compression": 2e-5,
    "leg[3].ground.friction": 0.05,
    "leg[3].main_strut.charge_pressure": 2e6,
    "leg[4].vehicle.footpad_mass": 9.0,
    "leg[4].main_strut.length": 1.45,
}


def test_values_that_are_those_of_all_legs_change_no_digit() -> None:
    plain = vehicle(TURNING)
    same = {
        f"leg[{leg}].{name}": plain[name]
        for leg in (1, 2, 3)
        for name in ("ground.step", "ground.friction", "main_strut.kind", "vehicle.footpad_mass")
    }
    landings = Landing(plain), Landing(plain.with_values(same))
    for landing in landings:
        landing.advance_to(0.3)
    assert landings[0].values() == landings[1].values()


def test_a_step_below_all_feet_is_a_ground_that_lies_higher() -> None:
    slope = TURNING | {"ground.slope": 0.05, "ground.slope_direction": 0.7}
    raised = Landing(vehicle(slope | {"ground.step": 0.1}), rtol=1e-8)
    flat = Landing(vehicle(slope), rtol=1e-8)
    for landing in (raised, flat):
        landing.advance_to(0.3)
    # along the normal of the slope, which lifts by more
    lift = raised.get("body.y") - flat.get("body.y")
    assert lift == pytest.approx(0.1 / 0.99875026, abs=1e-8)
    for name in ("body.x", "body.pitch", "leg[2].main_strut.stroke"):
        assert raised.get(name) == pytest.approx(flat.get(name), abs=1e-8)


@pytest.mark.parametrize("method", ["exponential", "dormand-prince"])
def test_the_energy_balance_holds_with_legs_that_all_differ(method: str) -> None:
    landing = Landing(vehicle(TURNING | OWN), method=method, rtol=1e-6)
    landing.advance_to(0.6)
    assert landing.get("energy.dissipated") > 100.0
    assert abs(landing.get("energy.balance")) < 1e-5 * landing.get("energy.dissipated")


def test_what_leg_2_has_for_itself_is_leg_1_s_where_legs_are_counted_from_the_next_one() -> None:
    five = vehicle(TURNING | {"vehicle.legs": 5.0})
    spacing = 2.0 * pi / 5.0
    values = [value for name, value in OWN.items() if name.startswith("leg[2]")]
    names = [name[7:] for name in OWN if name.startswith("leg[2]")]
    first, second = ({f"leg[{leg}].{n}": v for n, v in zip(names, values)} for leg in (1, 2))
    start = five.vehicle.leg_azimuth - 2.0 * pi
    one = five.with_values({"vehicle.leg_azimuth": start + spacing, **first})
    two = five.with_values({"vehicle.leg_azimuth": start, **second})
    landings = Landing(one, rtol=1e-8), Landing(two, rtol=1e-8)
    for landing in landings:
        landing.advance_to(0.3)
    for name in ("body.x", "body.z", "body.pitch", "body.roll", "body.heading"):
        assert landings[0].get(name) == pytest.approx(landings[1].get(name), abs=1e-8)
    force = "leg[{}].main_strut.force"
    assert landings[0].get(force.format(1)) == pytest.approx(
        landings[1].get(force.format(2)), rel=1e-5
    )


def test_even_azimuths_are_those_of_legs_evenly_round_the_body() -> None:
    three = vehicle(TURNING | {"vehicle.legs": 3.0, "vehicle.leg_azimuth": 0.5})
    listed = " ".join(repr(0.5 + 2.0 * pi * i / 3.0) for i in range(3))
    # and in another order: leg 1 is the second then
    turned = " ".join(repr(0.5 + 2.0 * pi * i / 3.0) for i in (1, 0, 2))
    landings = [
        Landing(three.with_values(own), rtol=1e-10)
        for own in ({}, {"vehicle.leg_azimuths": listed}, {"vehicle.leg_azimuths": turned})
    ]
    for landing in landings:
        landing.advance_to(0.3)
    for name in ("body.x", "body.pitch", "body.heading", "status.stability_margin"):
        values = [landing.get(name) for landing in landings]
        assert values == pytest.approx([values[0]] * 3, abs=1e-8)
    force = "leg[{}].main_strut.force"
    found = [landings[0].get(force.format(1)), landings[2].get(force.format(2))]
    assert found[1] == pytest.approx(found[0], rel=1e-5)


def test_files_have_azimuths_as_an_array_with_units() -> None:
    text = '[drop]\nmode = "space"\n[vehicle]\nlegs = 3\nleg_azimuths = ["0 deg", 2.0, "-90 deg"]\n'
    found = parse_toml(text, "mine.toml")
    assert found.vehicle.leg_azimuths == f"0.0 2.0 {-0.5 * pi!r}"
    assert parse_toml(to_toml(found), "again").vehicle == found.vehicle


@pytest.mark.parametrize(
    ("azimuths", "told"),
    [
        ("0 1 2", "has 3 azimuths for vehicle.legs = 4"),
        ("0 1 2 1.0000001", "legs 2 and 4 stand 1e-07 rad apart, at one azimuth"),
        ("0 1 2 6.2831", "legs 1 and 4 stand"),
        ("0 1 2 north", "leg 4 = 'north' is no angle"),
        ("0 1 2 nan", "leg 4 = 'nan' is no angle"),
    ],
)
def test_legs_at_one_azimuth_are_refused(azimuths: str, told: str) -> None:
    with pytest.raises(LandingError) as e:
        vehicle(SPACE | {"vehicle.leg_azimuths": azimuths})
    assert told in str(e.value)


def test_a_foot_stands_on_its_stone_and_another_in_its_hole() -> None:
    steps = {"leg[1].ground.step": 0.04, "leg[3].ground.step": -0.01}
    landing = Landing(vehicle(SPACE | steps | {"drop.contact_time": 0.0, "drop.tilt": 0.0}))
    landing.advance_to(8.0)
    assert landing.get("status.phase") == 2.0
    heights = {leg: landing.get(f"leg[{leg}].footpad.y") for leg in (1, 2, 3, 4)}
    # a footpad goes into the ground by less than 0.6 mm, or hangs above it
    assert heights[1] == pytest.approx(0.04, abs=6e-4)
    assert heights[3] > -0.0106
    assert landing.statistics["asleep"] == 1


def test_an_event_is_told_at_the_stop_of_the_leg_s_own_damper() -> None:
    parameters = vehicle(TURNING | {"leg[1].main_strut.stroke_max": 0.01})
    landing, strokes = Landing(parameters), []
    while landing.time < 0.3:
        if landing.advance_within_step(0.3, 0.3, to_event=True):
            strokes.append(landing.get("leg[1].main_strut.stroke"))
    assert any(abs(stroke - 0.01) < 1e-8 for stroke in strokes)


def test_files_have_tables_for_single_legs() -> None:
    text = """
        [drop]
        mode = "space"
        [leg.2.ground]
        step = "20 mm"
        friction = { value = 0.1, source = "ice" }
        [leg.4.main_strut]
        orifice_area_compression = "8 mm2"
    """
    found = parse_toml(text, "mine.toml")
    assert found["leg[2].ground.step"] == pytest.approx(0.02)
    assert found["leg[1].ground.step"] == 0.0
    assert found.source("leg[2].ground.friction") == "ice"
    assert found.of_leg(4).main_strut.orifice_area_compression == pytest.approx(8e-6)
    written = to_toml(found)
    assert dict(parse_toml(written, "again").items()) == dict(found.items())
    assert to_toml(parse_toml(written, "again")) == written


def test_the_table_finds_what_a_leg_has_and_lists_what_all_have() -> None:
    assert "leg[8].auxiliary_strut.stiffness" in PARAMETER_QUANTITIES
    assert PARAMETER_QUANTITIES["leg[3].ground.friction"].hi == 3.0
    for name in ("leg[9].ground.step", "leg[0].ground.step", "leg[1].ground.slope", "leg[1].x.y"):
        assert name not in PARAMETER_QUANTITIES
    assert not any(name.startswith("leg[") for name in PARAMETER_QUANTITIES)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"leg[5].ground.step": 0.1}, "leg that is not there: vehicle.legs = 4"),
        ({"leg[9].ground.step": 0.1}, "unknown parameter 'leg[9].ground.step'"),
        ({"leg[2].drop.tilt": 0.1}, "unknown parameter 'leg[2].drop.tilt'"),
        ({"leg[2].ground.friction": -1.0}, "leg[2].ground.friction = -1 is outside [0, 3]"),
        ({"leg[2].main_strut.length": 9.0}, "leg[2]: main_strut.length = 9 m"),
        ({"leg[2].ground.step": float("nan")}, "leg[2].ground.step = nan m is outside"),
        ({"vehicle.leg_overrides": "stones"}, "write name = value"),
        ({"vehicle.leg_overrides": "x = 3"}, "x is nothing that a leg has for itself"),
        ({"vehicle.leg_overrides": "leg[2].ground.step = high"}, "'high' is not a number"),
        ({"vehicle.leg_overrides": 3.0}, "vehicle.leg_overrides = 3.0 is no text"),
        (
            {"vehicle.leg_overrides": "leg[2].ground.step = 0; leg[2].ground.step = 1"},
            "has leg[2].ground.step twice",
        ),
        ({"drop.mode": "2-2", "leg[2].ground.step": 0.1}, "needs drop.mode = space"),
    ],
)
def test_what_no_leg_can_have_is_refused(values: dict[str, Any], told: str) -> None:
    with pytest.raises(LandingError) as e:
        vehicle(SPACE | values)
    assert told in str(e.value)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[leg.x.ground]\nstep = 1", "leg.x has no leg's number"),
        ("[leg.2.drop]\ntilt = 1", "unknown table 'leg[2].drop'"),
        ("[leg.2.ground]\nslope = 0.1", "unknown parameter 'leg[2].ground.slope'"),
        ("[leg.2]\nfriction = 1", "unknown table 'leg[2].friction'"),
        ("leg = 3", "leg = 3 must be a table"),
        ('[leg.2.ground]\nstep = "3 kg"', "wrong unit; give it in m"),
    ],
)
def test_a_bad_table_of_a_leg_is_refused(text: str, told: str) -> None:
    with pytest.raises(LandingError) as e:
        parse_toml(text, "mine.toml")
    assert told in str(e.value)
