"""`rlv-landing validate`: its JSON, its exit codes, measured curves."""

from __future__ import annotations

import json

import numpy as np
import pytest
from pytest import approx

from rlv_landing import LandingError, load_preset
from rlv_landing.history import History
from rlv_landing.identification.targets import fit_of, targets_of_tests
from rlv_landing.validation.curves import read_curves
from rlv_landing.validation.paper import paper_counts_against_test, printed_scalars
from rlv_landing.validation.required_counts import (
    STATED,
    STATED_OF_TESTS,
    missed_bounds,
    parse_bounds,
    stated_bounds,
)
from rlv_landing.validation.validate import validate

FORCE, STROKE = "leg[1].main_strut.force", "leg[1].main_strut.stroke"
BROKEN = "main_strut.orifice_area_compression=60 mm2"


def test_json_has_every_printed_scalar_with_the_errors_that_follow_from_it(command):
    done = command("validate", "--json")
    assert done.code == 0, done.err
    record = json.loads(done.out)
    scalars = {s["id"]: s for s in record["scalars"]}
    assert list(scalars) == [s.id for s in printed_scalars()]
    for printed in printed_scalars():
        s = scalars[printed.id]
        assert set(s) == {"id", "paper", "test", "ours", "error"}
        assert s["paper"] == printed.simulation
        if not printed.near_zero:
            assert s["error"] == approx((s["ours"] - s["paper"]) / abs(s["paper"]))
    errors = [abs(s["error"]) for s in record["scalars"]]
    assert record["counts"] == {
        **{f"within_{p}": sum(e <= p / 100 for e in errors) for p in (5, 10, 20)},
        "of": 48,
    }
    assert record["paper_counts_against_test"]["of"] == record["counts_against_test"]["of"] == 35
    assert record["missed"] == []
    assert {mode: len(legs) for mode, legs in record["measures"].items()} == {"2-2": 4, "1-2-1": 4}


def test_tables_have_every_scalar_the_measures_and_all_three_counts(command):
    done = command("validate", "--mode", "1-2-1")
    assert done.code == 0, done.err
    for printed in printed_scalars():
        assert (printed.id in done.out) == (printed.mode == "1-2-1")
    assert "efficiency" in done.out
    assert "the paper's own simulation of its tests:" in done.out
    assert "near zero" in done.out


def test_a_broken_preset_fails_with_a_line_and_exit_code_1(command):
    done = command("validate", "--set", BROKEN, "--mode", "2-2", "--json")
    assert done.code == 1
    assert done.err.startswith("missed: within 5 % of the paper's simulation: ")
    assert json.loads(done.out)["missed"]


def test_bounds_can_be_asked_for_and_lifted(command):
    assert command("validate", "--mode", "2-2", "--require", "20/20/20").code == 1
    assert command("validate", "--set", BROKEN, "--mode", "2-2", "--require", "none").code == 0


def test_bounds_are_read_and_missed_as_written():
    assert parse_bounds(" 36/41/45 ") == (36, 41, 45)
    found = {"within_5": 36, "within_10": 40, "within_20": 45, "of": 48}
    (line,) = missed_bounds(found, (36, 41, 45))
    assert line == "within 10 % of the paper's simulation: 40 of 48, at least 41 are required"
    assert stated_bounds(("2-2", "1-2-1")) == tuple(
        a + b for a, b in zip(stated_bounds(("2-2",)), stated_bounds(("1-2-1",)))
    )
    with pytest.raises(LandingError, match="asks for 49 scalars within 20 %, there are 48"):
        missed_bounds(found, (1, 2, 49))


def test_the_preset_of_the_tests_is_stated_above_the_papers_own_simulation_of_them():
    for modes in (("2-2",), ("1-2-1",), ("2-2", "1-2-1")):
        paper = paper_counts_against_test(modes[0] if len(modes) == 1 else None)
        of_paper = tuple(paper[f"within_{p}"] for p in (5, 10, 20))
        stated = stated_bounds(modes, STATED_OF_TESTS)
        assert stated[0] > of_paper[0]
        assert stated[1] > of_paper[1]


@pytest.mark.parametrize(
    ("preset", "counted", "stated"),
    [
        ("yue2022-figures", "counts", STATED),
        ("yue2022-tests", "counts_against_test_sensed", STATED_OF_TESTS),
    ],
)
def test_a_preset_reaches_exactly_what_it_is_stated_to_reach_in_each_mode(
    command, preset, counted, stated
):
    for mode in ("2-2", "1-2-1"):
        done = command("validate", "--preset", preset, "--mode", mode, "--json")
        assert done.code == 0, done.err
        counts = json.loads(done.out)[counted]
        assert tuple(counts[f"within_{p}"] for p in (5, 10, 20)) == stated[mode]


def test_counts_against_the_tests_are_those_of_what_the_sensors_record(validation):
    fits = fit_of(load_preset("yue2022-figures"), targets_of_tests(), sensors=True)
    errors = np.abs([f.error for f in fits])
    assert validation.counts_against_test_sensed == {
        **{f"within_{p}": int((errors <= p / 100).sum()) for p in (5, 10, 20)},
        "of": 35,
    }


def test_a_preset_of_the_tests_is_judged_by_the_tests(command):
    broken = ("--set", BROKEN, "--mode", "2-2", "--json")
    done = command("validate", "--preset", "yue2022-tests", *broken)
    required = tuple(json.loads(done.out)["required"].values())
    assert required == stated_bounds(("2-2",), STATED_OF_TESTS)
    counts = json.loads(done.out)["counts_against_test_sensed"]
    missed = missed_bounds(counts, required, "the paper's tests")
    assert done.code == 1
    assert missed
    assert done.err.splitlines() == [f"missed: {line}" for line in missed]


def test_curves_that_are_the_landings_own_times_a_factor_have_that_rrms(validation, tmp_path):
    history = validation.histories["2-2"]
    names = ["body.pitch", FORCE, STROKE]
    data = np.column_stack([history.time, *(1.25 * history[n] for n in names)])
    np.savetxt(
        tmp_path / "t.csv",
        data,
        delimiter=",",
        header=",".join(["time", *names]),
        comments="",
        fmt="%.17g",
    )
    found = validate(
        load_preset("yue2022-figures"), ("2-2",), {"2-2": read_curves(tmp_path / "t.csv")}
    )
    assert {c.column: c.rrms for c in found.curves} == approx(dict.fromkeys(names, 0.2))
    off = found.discrepancies("2-2", 1)
    # the measured energy is 1.25^2 of ours; its start is read off the stroke, not the contact
    assert off[0] == approx(100.0 * (1.0 - 1.25**-2), abs=0.5)
    assert found.discrepancies("2-2", 3) == (None, None)


def test_rrms_and_discrepancies_are_in_json_and_tables(command, validation, tmp_path):
    part = validation.histories["1-2-1"]
    names = [FORCE, STROKE]
    kept = History(part.time, names, np.column_stack([part[n] for n in names]))
    kept.to_csv(tmp_path / "t.csv")
    done = command(
        "validate", "--test-data", f"1-2-1={tmp_path / 't.csv'}", "--require", "none", "--json"
    )
    assert done.code == 0, done.err
    record = json.loads(done.out)
    assert [(c["mode"], c["column"]) for c in record["rrms"]] == [("1-2-1", n) for n in names]
    assert record["rrms"][0]["rrms"] == approx(0.0, abs=1e-12)
    assert "discrepancy_absorbed" in record["measures"]["1-2-1"][0]
    assert (
        "RRMS" in command("validate", "--mode", "1-2-1", "--test-data", str(tmp_path / "t.csv")).out
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "its first column must be time"),
        ("t,body.pitch\n0,1\n1,2\n", "starts with column 't'"),
        ("time\n0\n1\n", "no column beside time"),
        ("time,body.pich\n0,1\n1,2\n", "did you mean body.pitch"),
        ("time,body.pitch,body.pitch\n0,1,1\n1,2,2\n", "'body.pitch' is there 2 times"),
        ("time,body.pitch\n0,1\n", "1 rows of numbers"),
        ("time,body.pitch\n0,1\n1,nan\n", "row 3: body.pitch = 'nan' is not a finite number"),
        ("time,body.pitch\n0,1\n1,\n", "row 3: body.pitch = '' is not a finite number"),
        ("time,body.pitch\n0,1\n1,2,3\n", "row 3: 3 values under 2 headings"),
        ("time,body.pitch\n0,1\n0.2,2\n0.1,3\n", "row 4: time = 0.1 s does not come after 0.2 s"),
        ("time,body.pitch\n0,1\n0.1,2\n0.2,3\n0.5,3\n", "time goes on by 0.3 s at t = 0.2 s"),
        ("time,body.pitch\n5,1\n5.1,2\n5.2,3\n", "do not overlap"),
    ],
)
def test_bad_curves_are_one_clear_line_and_exit_code_2(command, tmp_path, text, message):
    (tmp_path / "t.csv").write_text(text)
    done = command("validate", "--mode", "2-2", "--test-data", str(tmp_path / "t.csv"))
    assert done.code == 2
    assert message in done.err
    assert len(done.err.strip().splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--require", "many"), "is not three counts"),
        (("--require", "45/41/36"), "falls"),
        (("--require", "1/2/99"), "there are 48"),
        (("--html", "report.txt"), "must end in .html"),
        (("--test-data", "none.csv"), "of which drop test?"),
        (("--test-data", "2-2=none.csv"), "there is no file none.csv"),
        (("--test-data", "3-1=none.csv"), "unknown landing mode '3-1'"),
        (("--mode", "2-2", "--test-data", "1-2-1=none.csv"), "mode 1-2-1 is not run"),
        (("--phase", "odd"), "--phase"),
        (("--preset", "yue2022"), "unknown preset"),
    ],
)
def test_bad_input_is_one_clear_line_and_exit_code_2(
    command, tmp_path, monkeypatch, arguments, message
):
    monkeypatch.chdir(tmp_path)
    done = command("validate", *arguments)
    assert done.code == 2
    assert message in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
