"""Parameters at the door: bounds, names, units, TOML in and out."""

from math import inf, nan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import LandingError, Parameters, load_preset
from rlv_landing.choices import choose_parameters, parse_pairs
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.presets import preset_names, read_toml, to_toml
from rlv_landing.quantities import BASE_UNITS, DISPLAY_UNITS, INPUT_QUANTITIES, OUTPUT_QUANTITIES
from rlv_landing.text.values import parse_value
from rlv_landing.touchdown import footpad_at_rest

REALS = [q for q in PARAMETER_QUANTITIES.values() if q.kind == "real"]


def test_every_quantity_has_bounds_a_meaning_a_known_unit_and_a_source():
    for q in PARAMETER_QUANTITIES.values():
        assert q.meaning
        assert q.source in ("paper", "derived", "closure", "identified")
        assert q.kind == "string" or (q.lo <= q.default <= q.hi and abs(q.lo) < inf and q.hi < inf)
    for q in (*PARAMETER_QUANTITIES.values(), *INPUT_QUANTITIES, *OUTPUT_QUANTITIES):
        assert q.unit in BASE_UNITS or q.unit == ""
        assert q.display_unit == "" or DISPLAY_UNITS[q.display_unit][0] == q.unit


def test_table_1_is_the_papers():
    p = Parameters()
    m, a = p.main_strut, p.auxiliary_strut
    assert (p.vehicle.mass, p.vehicle.footpad_mass) == (178.0, 4.2)
    assert (m.joint_radius, m.joint_depth, a.joint_radius, a.joint_depth) == (
        0.445,
        1.103,
        0.463,
        1.513,
    )
    assert (m.length, a.length) == (1.426, 1.145)
    for name in (
        "vehicle.mass",
        "vehicle.footpad_mass",
        "main_strut.length",
        "auxiliary_strut.joint_depth",
    ):
        assert p.source(name) == "paper"


def test_struts_of_table_1_meet_at_radius_1417_mm_2147_mm_below_the_cg():
    assert footpad_at_rest(Parameters()) == (approx(1.417, abs=5e-4), approx(-2.147, abs=5e-4))


@pytest.mark.parametrize("name", preset_names())
@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_presets_load_for_both_modes_with_a_source_for_every_value(name, mode):
    p = load_preset(name, mode)
    assert p.drop.mode == mode
    assert all(p.source(n) in ("paper", "derived", "closure", "identified") for n, _ in p.items())


def test_modes_of_a_preset_have_touchdown_states_of_their_own():
    ours, other = (load_preset("yue2022-figures", mode).drop for mode in ("2-2", "1-2-1"))
    assert ours == Parameters().drop
    assert all(
        getattr(other, name) != getattr(ours, name)
        for name in ("contact_time", "tilt", "pitch_rate")
    )
    assert load_preset("yue2022-figures").for_mode("1-2-1").for_mode("2-2") == load_preset(
        "yue2022-figures", "2-2"
    )


def test_what_the_user_sets_wins_over_what_belongs_to_a_mode():
    p = load_preset("yue2022-figures").with_values({"drop.tilt": 0.05})
    assert p.for_mode("1-2-1").drop.tilt == 0.05
    assert p.source("drop.tilt") == "user"
    values = parse_pairs(
        ["drop.tilt=-2 deg", "ground.friction=0.4"], PARAMETER_QUANTITIES, "parameter"
    )
    chosen = choose_parameters(mode="1-2-1", values=values)
    assert chosen.drop.tilt == approx(-0.0349065850398866)
    assert chosen.ground.friction == 0.4
    assert chosen.drop.mode == "1-2-1"


def test_table2_states_what_the_paper_prints():
    drop = load_preset("yue2022-table2", "1-2-1").drop
    assert (drop.tilt, drop.vertical_velocity, drop.horizontal_velocity) == (
        approx(-0.034906585),
        -1.4,
        0.354,
    )


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_toml_round_trip_keeps_every_digit_and_source(tmp_path_factory, data):
    names = data.draw(st.lists(st.sampled_from([q.name for q in REALS]), max_size=4, unique=True))
    values = {
        n: data.draw(st.floats(PARAMETER_QUANTITIES[n].lo, PARAMETER_QUANTITIES[n].hi), n)
        for n in names
    }
    try:
        parameters = load_preset("yue2022-figures").with_values(values)
    except LandingError:
        return
    file = tmp_path_factory.mktemp("toml") / "p.toml"
    file.write_text(to_toml(parameters))
    back = read_toml(file)
    assert dict(back.items()) == dict(parameters.items())
    assert all(back.source(n) == parameters.source(n) for n, _ in parameters.items())


@pytest.mark.parametrize("q", REALS, ids=lambda q: q.name)
@pytest.mark.parametrize("bad", [nan, inf, -inf, "many", True, None])
def test_no_quantity_takes_what_is_not_a_finite_number(q, bad):
    with pytest.raises(LandingError, match=q.name.replace(".", r"\.")):
        Parameters().with_values({q.name: bad})


@pytest.mark.parametrize("q", REALS, ids=lambda q: q.name)
def test_bounds_are_named_with_value_and_unit(q):
    beyond = q.hi * 1.5 + 1.0
    with pytest.raises(LandingError) as e:
        Parameters().with_values({q.name: beyond})
    assert f"{q.name} = {beyond:g} {q.unit}".rstrip() in str(e.value)
    assert f"[{q.lo:g}, {q.hi:g}] {q.unit}".rstrip() in str(e.value)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"vehicle.mas": 1.0}, "did you mean vehicle.mass"),
        ({"mass": 1.0}, "did you mean"),
        ({"drop.mode": "2-1-1"}, "not one of 2-2, 1-2-1"),
        ({"vehicle.transverse_load_at": "hip"}, "not one of footpad, joint"),
        ({"main_strut.stroke_max": 0.9}, "sweeps"),
        ({"main_strut.area_upper": 0.01}, "is above main_strut.area_lower"),
        ({"main_strut.length": 5.0}, "do not meet at a footpad"),
    ],
)
def test_names_choices_and_values_that_do_not_fit_together_are_refused(values, message):
    with pytest.raises(LandingError, match=message):
        Parameters().with_values(values)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[vehicle]\nmass = \n", r"TOML syntax: .*line 2"),
        ("[vehicle\nmass = 1\n", r"TOML syntax: .*line 1"),
        ("[vehicel]\nmass = 1.0\n", "did you mean vehicle"),
        ("[vehicle]\nmas = 1.0\n", "did you mean vehicle.mass"),
        ("[vehicle]\nmass = -5.0\n", r"vehicle.mass = -5 kg is outside \[1, 1e\+06\] kg"),
        ("[vehicle]\nmass = nan\n", "vehicle.mass = nan kg"),
        ("[vehicle]\nmass = [1.0]\n", "not a number"),
        ('[vehicle]\nmass = "3 m"\n', "wrong unit"),
        ('[vehicle]\nmass = "3 quid"\n', "not a number with a unit"),
        ("vehicle = 3\n", "must be a table"),
        ("[vehicle]\nmass = { valu = 1.0 }\n", "did you mean value"),
        ("[vehicle]\nmass = { source = 'me' }\n", "has no value"),
        ("[mode.3-3.drop]\ntilt = 0.0\n", "unknown landing mode"),
        ("preset = 'yue2022-figure'\n", "did you mean yue2022-figures"),
    ],
)
def test_a_bad_file_says_where_it_is_bad(tmp_path, text, message):
    file = tmp_path / "bad.toml"
    file.write_text(text)
    with pytest.raises(LandingError, match=message) as e:
        read_toml(file)
    assert str(file) in str(e.value)
    assert "\n" not in str(e.value)


def test_values_of_a_file_are_checked_together_not_one_after_the_other(tmp_path):
    """Joints and lengths that fit each other, but not the defaults."""
    file = tmp_path / "long.toml"
    file.write_text(
        "[auxiliary_strut]\njoint_depth = 4.0\nlength = 3.0\n[main_strut]\nlength = 2.0\n"
    )
    assert read_toml(file).auxiliary_strut.joint_depth == 4.0


def test_missing_file_unreadable_file_and_unknown_preset(tmp_path):
    with pytest.raises(LandingError, match="there is no parameter file"):
        read_toml(tmp_path / "none.toml")
    with pytest.raises(LandingError, match="cannot be read"):
        read_toml(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(LandingError, match="cannot be read"):
        read_toml(tmp_path / "binary.toml")
    with pytest.raises(LandingError, match="yue2022-table2"):
        load_preset("yue2022-tabel2")
    with pytest.raises(LandingError, match="not both"):
        choose_parameters("yue2022-figures", "some.toml")


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("drop.tilt", "-2 deg", -0.03490658503988659),
        ("main_strut.stroke_max", "36 mm", 0.036),
        ("main_strut.orifice_area_compression", "9 mm2", 9e-6),
        ("main_strut.volume_lower", "400 cm3", 4e-4),
        ("main_strut.bulk_modulus", "1 GPa", 1e9),
        ("ground.damping", "5 kN*s/m", 5e3),
        ("ground.friction", "0.3", 0.3),
        ("vehicle.inertia", "190 kg*m**2", 190.0),
    ],
)
def test_values_may_carry_their_unit(name, text, value):
    assert parse_value(PARAMETER_QUANTITIES[name], text) == approx(value, rel=1e-12)


def test_a_liquid_without_stiffness_at_zero_pressure_is_refused():
    soft = {"main_strut.bulk_modulus": 1e7, "main_strut.bulk_modulus_slope": 30.0}
    Parameters().with_values({**soft, "main_strut.ambient_pressure": 2.99e5})
    with pytest.raises(LandingError, match=r"stay below .* = 300000 Pa"):
        Parameters().with_values({**soft, "main_strut.ambient_pressure": 3.01e5})


def test_a_vehicle_of_landings_in_space_keeps_the_values_of_the_symmetric_modes_in_toml(tmp_path):
    values = {"drop.mode": "space", "vehicle.legs": 5.0, "drop.heading": 0.3, "drop.tilt": 0.02}
    parameters = load_preset("yue2022-figures").with_values(values)
    assert parameters.by_mode["1-2-1"]
    file = tmp_path / "space.toml"
    file.write_text(to_toml(parameters))
    found = read_toml(file)
    assert dict(found.items()) == dict(parameters.items())
    assert found.by_mode == parameters.by_mode
    with pytest.raises(LandingError, match=r"vehicle.legs = 5 needs drop.mode = space"):
        found.for_mode("1-2-1")
