"""Identification: it finds known parameters again, repeats itself, and resumes after an interrupt.

Input that makes no sense is refused.
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.history import History
from rlv_landing.identification.conditions import CONDITIONS
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.measured.series import Series
from rlv_landing.identification.measured.target_file import read_targets
from rlv_landing.identification.objective import Objective
from rlv_landing.identification.priors import BORE, PRIORS, ROD_AREA
from rlv_landing.identification.targets import paper_targets
from rlv_landing.presets import read_toml

FIGURES = "yue2022-figures"
TRUTH = {"main_strut.orifice_area_compression": 1.1e-5, "ground.friction": 0.25}
COLUMNS = ("leg[1].main_strut.stroke", "leg[3].main_strut.force", "leg[1].auxiliary_strut.force")


def command(*arguments: object) -> list[str]:
    return [
        sys.executable,
        "-c",
        "from rlv_landing.cli import main; main()",
        "identify",
        *map(str, arguments),
    ]


def run(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(*arguments), capture_output=True, text=True, cwd=cwd, timeout=300)


@pytest.fixture
def measured(tmp_path: Path) -> Path:
    """Curves of a 2-2 landing whose orifice and friction are known."""
    history = Landing(load_preset(FIGURES, "2-2").with_values(TRUTH)).run(0.6, 2e-3)
    path = tmp_path / "measured.csv"
    rows = [",".join(["time", *COLUMNS])]
    rows += [
        ",".join(repr(float(v)) for v in (t, *(history[c][i] for c in COLUMNS)))
        for i, t in enumerate(history.time)
    ]
    path.write_text("\n".join(rows) + "\n")
    return path


def test_known_parameters_are_found_again_from_measured_curves(measured, tmp_path):
    free = ("--series", f"2-2={measured}", "--free", ",".join(TRUTH))
    search = ("--population", 8, "--evaluations", 150, "--polish", 60, "--sigma", 0.2)
    done = run(*free, *search, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    found = read_toml(tmp_path / "identification" / "identified.toml")
    for name, value in TRUTH.items():
        assert found[name] == pytest.approx(value, rel=0.02)
        assert found.source(name) == "identified"
    report = (tmp_path / "identification" / "report.md").read_text()
    assert len(re.findall(r"\| (well )?determined \|", report)) == 2


def test_the_same_seed_gives_the_same_search_and_resuming_goes_on_with_it(measured, tmp_path):
    free = (
        "--series",
        f"2-2={measured}",
        "--free",
        ",".join(TRUTH),
        "--population",
        6,
        "--polish",
        0,
        "--seed",
        5,
    )
    for work, limits in (("whole", [37]), ("again", [37]), ("parts", [19, 37])):
        for i, limit in enumerate(limits):
            done = run(
                *free,
                "--work",
                work,
                "--evaluations",
                limit,
                *(["--resume"] if i else []),
                cwd=tmp_path,
            )
            assert done.returncode in (0, 1), done.stderr
    best = [
        json.loads((tmp_path / work / "best.json").read_text())
        for work in ("whole", "again", "parts")
    ]
    assert best[0] == best[1] == best[2]


@contextmanager
def searching(folder: Path, *arguments: object) -> Iterator[subprocess.Popen[str]]:
    """A long search in `folder` that has found a best point; it is killed at the end."""
    process = subprocess.Popen(
        command("--evaluations", 100000, *arguments),
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        while not (folder / "identification" / "best.json").exists():
            assert process.poll() is None, process.communicate()[1]
            os.sched_yield()
        yield process
    finally:
        process.kill()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupted_identification_keeps_its_best_and_can_go_on(tmp_path, number):
    with searching(tmp_path) as process:
        process.send_signal(number)
        _, err = process.communicate(timeout=120)
    assert process.returncode == 130, err
    assert "interrupted; --resume goes on" in err
    assert "Traceback" not in err
    kept = json.loads((tmp_path / "identification" / "best.json").read_text())
    parameters = read_toml(tmp_path / "identification" / "identified.toml")
    numbers = FreeNumbers(load_preset(FIGURES))
    assert Objective(numbers, paper_targets()).loss(kept["z"]) == pytest.approx(kept["loss"])
    assert parameters["vehicle.inertia"] == pytest.approx(
        numbers.parameters(kept["z"])["vehicle.inertia"]
    )


def test_a_killed_identification_leaves_no_process_and_no_lock(tmp_path):
    with searching(tmp_path, "--workers", 2) as process:
        pass
    # the ends of both pipes are the processes' ends
    process.communicate(timeout=120)
    done = run("--resume", "--evaluations", 1, "--polish", 0, cwd=tmp_path)
    assert done.returncode in (0, 1), done.stderr


def test_nothing_better_than_the_start_is_said_so(tmp_path):
    """The compression stop is never met in these landings, so where it is makes no difference."""
    bound = ("--free", "main_strut.stroke_max", "--bound", "main_strut.stroke_max=0.05..0.06")
    done = run(*bound, "--evaluations", 5, "--population", 4, "--polish", 0, cwd=tmp_path)
    assert done.returncode == 1
    assert "nothing better than the start was found" in done.stderr


def test_numbers_and_the_unit_cube_belong_together():
    numbers = FreeNumbers(load_preset(FIGURES))
    z = numbers.start()
    assert all(0.0 <= x <= 1.0 for x in z)
    inside = [min(max(x, 0.1), 0.9) for x in z]
    values = numbers.numbers(inside)
    assert [p.place(v) for (p, _), v in zip(numbers.columns, values)] == pytest.approx(inside)
    assert numbers.numbers([2.0 - x for x in inside]) == pytest.approx(values)
    assert numbers.numbers([-x for x in inside]) == pytest.approx(values)
    parameters = numbers.parameters(inside)
    labels = dict(zip(numbers.labels, values))
    assert float(parameters[BORE]) - parameters.main_strut.area_upper == pytest.approx(
        labels[ROD_AREA]
    )
    assert parameters.for_mode("1-2-1").drop.tilt == labels["1-2-1: drop.tilt"]
    assert parameters.for_mode("2-2").drop.tilt == labels["2-2: drop.tilt"]


def test_every_prior_has_bounds_and_a_reason_and_table_1_is_never_free():
    parameters = load_preset(FIGURES)
    for p in PRIORS:
        assert p.lo < p.hi
        assert p.reason
        if p.name != ROD_AREA:
            assert parameters.source(p.name) in ("identified", "closure")


def test_conditions_cost_nothing_on_a_plausible_landing_and_something_on_a_hard_one():
    sensible = Landing(load_preset(FIGURES, "2-2")).run(0.6)
    hard = Landing(
        load_preset(FIGURES, "2-2").with_values(
            {"drop.vertical_velocity": -6.0, "drop.contact_time": 0.0}
        )
    ).run(0.6)
    penetration = next(c for c in CONDITIONS if c.name == "penetration")
    assert penetration.measure(sensible) < penetration.limit < penetration.measure(hard)


def test_a_curve_of_the_landing_itself_is_no_misfit(tmp_path):
    base = load_preset(FIGURES, "2-2")
    history = Landing(base, rtol=1e-5).run(0.5)
    curves = np.stack([history[name] for name in COLUMNS], axis=1)
    series = Series("2-2", History(history.time, COLUMNS, curves))
    objective = Objective(FreeNumbers(base, ["ground.friction"]), [], [series])
    with pytest.raises(LandingError, match="unknown landing mode '3-3'"):
        Series("3-3", series.curves)
    of_curves = [i for i, label in enumerate(objective.labels) if " at " in label]
    assert len(of_curves) == 100 * len(COLUMNS)
    assert np.abs(objective.misfits(objective.free.start())[of_curves]).max() < 1e-9


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (b"id,value,unit\n22-fm1-td,-2710,N\n", -2710.0),
        (b"id,value,unit\n22-fm1-td,-2.71,kN\n", -2710.0),
        (b"\xef\xbb\xbfid,value,unit\r\n22-s3-max,24.17,mm\r\n", 24.17),
        (b"id,value,unit\n22-s3-max,2.417,cm\n", 24.17),
    ],
)
def test_targets_may_have_any_unit_of_their_dimension(tmp_path, text, value):
    (tmp_path / "t.csv").write_bytes(text)
    assert [t.value for t in read_targets(tmp_path / "t.csv")] == [value]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("id,value,unit\n22-fm1-tdd,-2000,N\n", "did you mean 22-fm1-td"),
        ("id,value,unit\n22-fm1-td,-2,m\n", "has the wrong unit; give it in N"),
        ('id,value,unit\n22-fm1-td,"-2,5",kN\n', "write a point instead of the comma"),
        ("id;value;unit\n22-fm1-td;-2,5;kN\n", "is separated by semicolons"),
        ("id,value,unit\n22-fm1-td,nan,N\n", "must be finite"),
        ("id,value,unit\n22-fm1-td,much,N\n", "not a number"),
        ("id,value\n22-fm1-td,-2000\n", "no unit"),
        ("id,value,unit\n", "holds no targets"),
    ],
)
def test_bad_targets_are_refused_by_line(tmp_path, text, message):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(LandingError, match=message):
        read_targets(tmp_path / "t.csv")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("--free", "vehicle.mass"),
            "has no bounds to be identified between; give them: --bound vehicle.mass=LO..HI",
        ),
        (("--free", "ground.frictoin"), "did you mean ground.friction?"),
        (("--bound", "ground.friction=0.5..0.1"), "bounds of ground.friction are empty"),
        (("--bound", "ground.friction=-1..0.1"), "are outside [0, 3]"),
        (("--bound", "ground.friction=0.1"), "write NAME=LO..HI"),
        (("--bound", "drop.mode=1..2"), "only numbers can be identified"),
        (("--targets", "none.csv"), "cannot be read"),
        (("--series", "2-2=none.csv"), "there is no file none.csv of measured curves"),
        (("--resume",), "there is nothing to resume"),
    ],
)
def test_bad_input_is_one_clear_line(tmp_path, arguments, message):
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_holds_a_search_is_not_overwritten(tmp_path):
    (tmp_path / "identification").mkdir()
    (tmp_path / "identification" / "best.json").write_text("{}")
    done = run(cwd=tmp_path)
    assert done.returncode == 2
    assert "--resume goes on with it" in done.stderr
    assert (tmp_path / "identification" / "best.json").read_text() == "{}"
