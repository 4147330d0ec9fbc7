"""Cases from elsewhere beside our landings, and `rlv-landing validate --case`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rlv_landing import LandingError
from rlv_landing.cases.case_file import case_names, find_case, read_case
from rlv_landing.cases.compare import compare

SHORT = """\
title = "a fall"
source = "a table"
until = "250 ms"
number = [
  { output = "body.vy", at = "0.1 s", value = "VALUE", tolerance = "1 mm/s", page = "7" },
  { contact = 1, value = 0.2, tolerance = 0.01 },
]
[drop]
contact_time = "200 ms"
vertical_velocity = -3.0
pitch_rate = 0.0
"""
FORM = SHORT.split("number", maxsplit=1)[0] + "closed_form = 'tip_over'\ndrop.mode = 'space'\n"


@pytest.mark.parametrize("name", case_names())
def test_we_land_as_others_do(name: str) -> None:
    found = compare(find_case(name))
    assert found.missed == []
    assert found.compared
    assert case_names() == sorted(set(case_names()))


def test_engines_a_published_case_and_closed_forms_are_there_in_space() -> None:
    cases = [find_case(name) for name in case_names()]
    assert {case.parameters.drop.mode for case in cases} == {"space"}
    counted = {case.name: len(case.numbers) for case in cases if not case.closed_form}
    engines = dict.fromkeys(("three-legs-friction", "three-legs-frictionless"), 35 + 18 + 3)
    assert counted == {**engines, "nasa-tumbling-brick": 7 * 3}
    forms = {case.closed_form for case in cases}
    assert forms == {
        *("", "free_fall", "mass_on_springs", "standing_on_slope", "tip_over", "tumbling")
    }


def test_a_closed_form_is_not_met_by_another_vehicle(tmp_path: Path) -> None:
    """What a case tells does not come from what is landed: a softer strut is missed."""
    text = (Path(read_case.__code__.co_filename).parent / "mass-on-springs.toml").read_text()
    softer = tmp_path / "softer.toml"
    # a damper, of which the closed form knows nothing
    assert "damping = 0.0" in text
    softer.write_text(text.replace("damping = 0.0", "damping = 3000.0", 1))
    assert compare(read_case(softer)).missed


def test_an_own_file_is_a_case_with_units_pages_and_an_exit_code(command, tmp_path: Path) -> None:
    file, picture = tmp_path / "mine.toml", tmp_path / "mine.png"
    # it falls, and its legs bear nothing yet
    file.write_text(SHORT.replace("VALUE", f"{-3000.0 + 981.0} mm/s"))
    done = command("validate", "--case", str(file), "--plot", str(picture), "--json")
    assert (done.code, done.err) == (0, "")
    (case,) = json.loads(done.out)["cases"]
    assert (case["name"], case["passed"]) == ("mine", True)
    first, second = case["numbers"]
    assert (first["unit"], first["tolerance"], first["page"]) == ("m/s", 1e-3, "7")
    assert first["ours"] == pytest.approx(-2.019, abs=1e-3)
    assert second["what"] == "first contact of leg 1"
    assert picture.read_bytes()[:4] == b"\x89PNG"
    file.write_text(SHORT.replace("VALUE", "-1.5"))
    missed = command("validate", "--case", str(file))
    assert missed.code == 1
    assert missed.err.startswith("missed: mine: body.vy at 0.1 s: -2.019")
    assert "MISSED" in missed.out
    assert "source: a table" in missed.out


def test_a_case_that_cannot_start_is_named(command, tmp_path: Path) -> None:
    file = tmp_path / "upwards.toml"
    file.write_text(SHORT.replace("VALUE", "1").replace("-3.0", "3.0"))
    done = command("validate", "--case", str(file))
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "upwards: drop.contact_time = 0.2 s of free flight would pass" in done.err


def test_cases_are_listed_and_options_of_the_paper_s_landings_refused(command) -> None:
    listed = command("validate", "--case")
    assert listed.code == 0
    assert all(name in listed.out for name in case_names())
    for options, said in (
        (("--case", "nothing"), "unknown case 'nothing'; `rlv-landing validate --case` lists"),
        (("--case", "tumbling", "--mode", "2-2"), "--mode and --case"),
        (("--case", "tumbling", "--require", "1/2/3"), "--require and --case"),
        (("--plot", "x.png"), "name one by --case"),
        (("--case", "tumbling", "--plot", "x.txt"), "x.txt"),
        (("--case", "none.toml"), "there is no case none.toml"),
    ):
        done = command("validate", *options)
        assert done.code == 2
        assert said in done.err
        assert done.err.count("\n") == 1


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('source = "a table"\n', "", "a case needs source"),
        ('until = "250 ms"', 'until = "50 ms"', "0.1 s is after the end"),
        ("body.vy", "body.v", "unknown output 'body.v'"),
        ('at = "0.1 s", ', "", "give at = a time, or peak = min"),
        ('at = "0.1 s"', 'peak = "most"', "'most' is not one of min, max"),
        ('tolerance = "1 mm/s", ', "", "either tolerance or relative"),
        ('tolerance = "1 mm/s"', 'tolerance = "1 mm"', "wrong unit"),
        ('tolerance = "1 mm/s"', "tolerance = -1.0", "is below 0"),
        ('"VALUE"', "[1]", "is not a number"),
        ("contact = 1", "contact = 9", "9 is no leg's number"),
        ("contact = 1", "contact = 1, output = 'body.x'", "is of 2 things"),
        ("contact = 1", "contact = 1, at = 0.1", "unknown key of number 2 'at'"),
        ("[drop]", "[dorp]", "unknown key 'dorp'"),
        ("number = [", "closed_form = 'none'\nnumber = [", "unknown closed form 'none'"),
        (SHORT, f"{FORM}[leg]\nkind = 'tripod'", r"tip_over: leg\.kind = tripod; it is for radial"),
        (SHORT, f"{FORM}[leg.2.ground]\nstep = 0.1", r"leg\[2\]\.ground\.step is one leg's own"),
        ("number = [", 'number = [{ outcome = "flown" },', "unknown outcome 'flown'"),
        ('"VALUE"', "nan", "body.vy = nan is not finite"),
        ("number = [", "inputs = 3\nnumber = [", "inputs must be a table"),
    ],
)
def test_what_is_no_case_is_refused(before: str, after: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    assert before in SHORT
    file.write_text(SHORT.replace(before, after, 1).replace("VALUE", "1"))
    with pytest.raises(LandingError, match=message) as caught:
        read_case(file)
    assert str(file) in str(caught.value) or "mine.toml" in str(caught.value)


def test_a_case_may_have_tripods_and_inputs_by_dotted_keys(tmp_path: Path) -> None:
    lander = Path(__file__).parents[2] / "examples" / "tripod_lander.toml"
    output = "leg[1].auxiliary_strut_2.force"
    file = tmp_path / "lander.toml"
    for inputs in ("external.force_x = '0.1 kN'", "'external.force_x' = 100.0"):
        file.write_text(
            "title = 'a lander'\nsource = 'a table'\nuntil = 1.0\n"
            f"number = [{{ output = '{output}', peak = 'max', value = 1e3, relative = 1.0 }}]\n"
            f"{lander.read_text()}\n[inputs]\n{inputs}\n"
        )
        case = read_case(file)
        assert case.inputs == {"external.force_x": 100.0}
        assert [number.quantity.name for number in case.numbers] == [output]
