"""`rlv-landing montecarlo`: rows that do not depend on how they came about, and what they tell."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import numpy as np
import pytest
from montecarlo_studies import write
from study_tools import rows, start, wait_for

from rlv_landing import Landing
from rlv_landing.presets import read_toml
from rlv_landing.studies.montecarlo.difference import Side, difference
from rlv_landing.studies.montecarlo.intervals import wilson
from rlv_landing.studies.montecarlo.run import STEP

BASELINE = Path(__file__).with_name("baseline")
FALLING = "until = 1e-3\nevery = 1e-3"


def made(command, study: Path, name: str, *options: str, report: bool = False):
    folder = study.parent / name
    more = () if report else ("--no-report",)
    done = command("montecarlo", str(study), "--results", str(folder), *options, *more)
    assert done.code == 0, done.err
    return folder, done.out


def test_rows_are_the_same_on_any_threads_grown_or_resumed(tmp_path, command):
    study = write(tmp_path, samples=20)
    one, _ = made(command, study, "one", "--workers", "1")
    grown, _ = made(command, study, "grown", "--samples", "7", "--workers", "3")
    assert len(rows(grown / "results.parquet")) == 7
    made(command, study, "grown", "--samples", "20", "--resume")
    whole = (one / "results.parquet").read_bytes()
    assert (grown / "results.parquet").read_bytes() == whole
    # fewer than there are: all stay
    _, out = made(command, study, "grown", "--samples", "3", "--resume")
    assert (grown / "results.parquet").read_bytes() == whole
    assert "20 runs of seed 5" in out


def test_rows_go_to_a_file_of_ones_own_as_those_of_a_sweep(tmp_path, command):
    study = write(tmp_path, samples=3)
    for name in ("rows.csv", "rows.parquet"):
        folder, _ = made(command, study, f"r-{name}", "--output", str(tmp_path / name))
    table = rows(folder / "results.parquet")
    assert rows(tmp_path / "rows.parquet") == table
    head, *lines = (tmp_path / "rows.csv").read_text().splitlines()
    assert len(lines) == 3
    at = head.replace('"', "").split(",").index("margin.slid")
    assert [float(line.split(",")[at]) for line in lines] == [r["margin.slid"] for r in table]
    again = command("montecarlo", str(study), "--output", str(tmp_path / "rows.csv"))
    assert again.code == 2
    assert "--force" in again.err


def test_a_study_that_changed_is_not_resumed_but_its_end_may_be_another(tmp_path, command):
    study = write(tmp_path, samples=3)
    folder, _ = made(command, study, "r")
    text = study.read_text()
    study.write_text(text.replace("samples = 3", 'samples = 4\ncriterion = "slid"\nworst = 1'))
    made(command, study, "r", "--resume")
    study.write_text(text.replace("deviation = [1.0,", "deviation = [1.1,"))
    done = command("montecarlo", str(study), "--results", str(folder), "--resume")
    assert done.code == 2
    assert "dispersions, points changed since" in done.err


def test_ctrl_c_keeps_rows_and_resume_goes_on(tmp_path, command):
    study = write(tmp_path, samples=4000)
    running = start("montecarlo", study, "--results", tmp_path / "r", cwd=tmp_path)
    with running:
        try:
            parts = tmp_path / "r" / "parts"
            wait_for(running, lambda: parts.is_dir() and any(parts.glob("*.parquet")))
            running.send_signal(signal.SIGINT)
            _, err = running.communicate(timeout=60)
        finally:
            running.kill()
    assert running.returncode == 130
    assert "of 4000 landings are kept in" in err
    kept = [row for part in sorted(parts.glob("*.parquet")) for row in rows(part)]
    assert kept
    last = kept[-1]["index"]
    # an interrupt may lose the rows that are just being kept; they are made again
    folder, _ = made(command, study, "r", "--resume", "--samples", str(last + 3))
    table = rows(folder / "results.parquet")
    assert [row["index"] for row in table] == list(range(last + 3))
    assert [table[row["index"]] for row in kept] == kept


def test_runs_end_where_the_rate_is_known_well_enough(tmp_path, command):
    study = write(tmp_path, samples=5000, more="width = 0.02").read_text()
    path = tmp_path / "study.toml"
    path.write_text(study.replace("until = 0.06", FALLING))
    folder, out = made(command, path, "r")
    low, high = wilson(STEP, STEP, 0.95)
    assert high - low < 0.02
    assert len(rows(folder / "results.parquet")) == STEP
    assert f"{STEP} runs" in out


def test_causes_grades_loads_and_worst_landings_are_those_of_the_rows(tmp_path, command):
    limits = '[limits]\nmain_strut.force = "4 kN"\n'
    grades = (
        '[[grade]]\nname = "soft"\nmost = { legs.contact.force_y.max = "4.5 kN" }\n'
        '[[grade]]\nname = "firm"\nleast = { margin.stroke_left = "20 mm" }\n'
    )
    more = 'criterion = "limit"\npercentiles = [50, 90]\nworst = 2'
    study = write(tmp_path, samples=40, more=more, tables=limits + grades)
    folder, _ = made(command, study, "r", "--workers", "2", report=True)
    found = json.loads((folder / "summary.json").read_text())
    table = rows(folder / "results.parquet")
    lost = [row for row in table if row["outcome.first_limit"] is not None]
    assert 0 < len(lost) < 40
    assert found["successes"] == 40 - len(lost)
    assert found["causes"] == {"passed main_strut.force": len(lost)}
    assert found["grades"]["lost"] == len(lost)
    assert sum(found["grades"].values()) == 40
    soft = [r for r in table if r not in lost and r["legs.contact.force_y.max"] <= 4500.0]
    assert soft
    assert found["grades"]["soft"] == len(soft)
    force = found["loads"]["legs.main_strut.force.min"]
    ranked = sorted((row["legs.main_strut.force.min"], row["index"]) for row in table)
    assert [(w["value"], w["run"]) for w in force["worst"]] == ranked[:2]
    half = next(p for p in force["percentiles"] if p["percent"] == 50.0)
    assert half["value"] == ranked[20][0]
    assert half["low"] < half["value"] < half["high"]
    page = (folder / "report.html").read_text()
    assert f"--run {ranked[0][1]}" in page
    assert "passed main_strut.force" in page
    assert "http" not in page.replace("http://www.w3.org", "")


def test_a_run_lands_again_by_itself_and_as_a_file_of_its_own(tmp_path, command):
    study = write(tmp_path, samples=9)
    folder, _ = made(command, study, "r")
    row = rows(folder / "results.parquet")[8]
    toml = tmp_path / "run8.toml"
    done = command("montecarlo", str(study), "--run", "8", "--toml", str(toml))
    assert done.code == 0, done.err
    assert "run 8 of seed 5" in done.out
    assert done.out.splitlines()[-1].startswith(f"rlv-landing simulate --parameters {toml} --until")
    landing = Landing(read_toml(toml), rtol=1e-3)
    landing.advance_to(0.06)
    least = min(landing.extremes()[f"leg[{n}].main_strut.force"].minimum for n in range(1, 5))
    assert least == pytest.approx(row["legs.main_strut.force.min"], rel=1e-12)
    assert np.isclose(landing.parameters.drop.heading, row["drop.heading"], rtol=0.0, atol=0.0)


def test_a_run_that_cannot_be_made_is_lost_and_says_why(tmp_path, command):
    study = write(tmp_path, samples=6)
    study.write_text(study.read_text().replace("mean = [0.0, 0.0, -1.4]", "mean = [85.9, 0, -1.4]"))
    _, out = made(command, study, "r")
    assert "failed" in out
    assert "could not be made: drop.tilt = 1.5" in out


def test_the_frozen_baseline_is_reached(tmp_path, command):
    """A change of the model, of a response or of the draws shows run by run.

    Where it is meant, `montecarlo` with this study makes the folder anew (results and summary).
    """
    study = write(tmp_path, samples=16)
    made(command, study, "now")
    done = command("montecarlo", "--diff", str(BASELINE), str(tmp_path / "now"), "--json")
    assert done.code == 0, done.out
    found = json.loads(done.out)
    assert found["paired"] == 16
    # parameters that are new do not vary
    assert {setting["name"] for setting in found["settings"]} <= {"parameters"}


def test_a_parameter_that_differs_is_told_with_its_group():
    """It is also where another group has a parameter of that name and value."""
    text = "[main_strut]\nstiffness = {}\n\n[ground]\nstiffness = 5.0\n"
    sides = []
    for value in (4.0, 5.0):
        about = {"responses": [], "points": "", "parameters": text.format(value)}
        sides.append(Side(Path(f"{value}"), about, (), "toppled", 0.95, ()))
    assert difference(*sides, 0.001).settings == (
        ("parameters", "main_strut.stiffness = 4.0", "main_strut.stiffness = 5.0"),
    )


def test_the_difference_of_two_studies_is_told_run_by_run(tmp_path, command):
    study = write(tmp_path, samples=8)
    before, _ = made(command, study, "before")
    study.write_text(study.read_text().replace("[set]", "[set]\nground.friction = 0.8"))
    after, _ = made(command, study, "after")
    done = command("montecarlo", "--diff", str(before), str(after), "--json")
    assert done.code == 1
    found = json.loads(done.out)
    assert found["paired"] == 8
    assert found["settings"][-1]["name"] == "set" or "friction" in str(found["settings"])
    slid = found["loads"]["margin.slid"]
    a, b = (rows(folder / "results.parquet") for folder in (before, after))
    changes = [abs(x["margin.slid"] - y["margin.slid"]) for x, y in zip(a, b)]
    size = max(row["margin.slid"] for row in a + b)
    assert slid["largest_change"] == pytest.approx(max(changes) / size)
    assert slid["run"] == changes.index(max(changes))
    told = command("montecarlo", "--diff", str(before), str(after), "--tolerance", "1.0")
    assert told.code == 0, told.out
    assert "8 runs are the same in both" in told.out
    study.write_text(study.read_text().replace("seed = 5", "seed = 6"))
    other, _ = made(command, study, "other")
    told = command("montecarlo", "--diff", str(before), str(other))
    assert told.code == 1
    assert "no run is the same in both" in told.out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "name a study, STUDY.toml, or two results folders by --diff A B"),
        (["--diff", "a", "b"], "a has no results.parquet"),
        (["study.toml", "--diff", "a", "b"], "leave the study and --run out"),
        (["study.toml", "--toml", "x.toml"], "name it by --run K"),
        (["study.toml", "--run", "0", "--toml", "x.txt"], "must end in .toml"),
        (["study.toml", "--html", "x.txt"], "must end in .html"),
        (["study.toml", "--output", "x.txt"], "must end in .csv or .parquet"),
        (["study.toml", "--run", "0", "--output", "x.csv"], "leave one out"),
        (["nothing.toml"], "nothing.toml"),
        (["study.toml", "--samples", "0"], "--samples"),
    ],
)
def test_bad_options_are_one_clear_line(tmp_path, command, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)
    write(tmp_path)
    done = command("montecarlo", *options)
    assert done.code == 2
    assert message in done.err
    assert done.err.count("\n") == 1
