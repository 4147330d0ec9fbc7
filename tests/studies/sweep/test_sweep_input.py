"""Studies that cannot be are refused before anything runs.

The error is one line with the nearest name or the remedy.
"""

from __future__ import annotations

import builtins

import pytest
from study_tools import write_study

from rlv_landing.tables.rendering import new_table, render

TILT = '[[factor]]\nname = "drop.tilt"\n'
LHS = '[study]\nmethod = "lhs"\nsamples = 8\n'
RANGE = TILT + "low = -0.1\nhigh = 0.1\n"
TABLE = '[study]\ntable = "states.csv"\n'
HEADINGS = "drop.tilt [deg],drop.pitch_rate,drop.horizontal_velocity,drop.vertical_velocity\n"
ROW = "1,0,0,-1\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            LHS + '[[factor]]\nname = "drop.tlit"\nlow = 0\nhigh = 1\n',
            "unknown factor 'drop.tlit'; did you mean drop.tilt?",
        ),
        (
            LHS + '[[factor]]\nname = "external.force_w"\nlow = 0\nhigh = 1\n',
            "did you mean external.force_",
        ),
        (
            LHS + TILT + "low = 0.1\nhigh = 0.1\n",
            "the range from low = 0.1 to high = 0.1 rad is empty",
        ),
        (
            LHS + TILT + "low = nan\nhigh = 0.1\n",
            "the range from low = nan to high = 0.1 rad is empty",
        ),
        (LHS + TILT + "low = -2\nhigh = 0.1\n", "drop.tilt = -2 rad is outside [-1.5, 1.5] rad"),
        (LHS + TILT + 'unit = "m"\nlow = -2\nhigh = 0.1\n', "drop.tilt = '1 m' has the wrong unit"),
        (LHS + TILT + 'low = "-2 m"\nhigh = 0.1\n', "drop.tilt = '-2 m' has the wrong unit"),
        (LHS + TILT + "low = -0.1\n", "factor drop.tilt has no high, which uniform needs"),
        (LHS + TILT + "low = true\nhigh = 1\n", "low = True is not a number"),
        (
            LHS + TILT + "lo = -0.1\nhigh = 0.1\n",
            "unknown key of factor drop.tilt 'lo'; did you mean low?",
        ),
        (LHS + TILT + "values = []\n", "must be a list of one value or more"),
        (LHS + TILT + "values = [0.1, 0.1]\n", "name a value twice"),
        (
            LHS + TILT + 'distribution = "normal"\nmean = 0\ndeviation = 0\n',
            "the deviation above 0",
        ),
        (
            LHS + TILT + 'distribution = "gauss"\n',
            "unknown distribution of factor drop.tilt 'gauss'",
        ),
        (
            LHS + TILT + "values = [0.1]\nlow = 0\n",
            "low does not belong to choice, which takes values",
        ),
        (
            LHS + '[[factor]]\nname = "drop.mode"\nlow = 0\nhigh = 1\n',
            "is one of 2-2, 1-2-1, space; give values",
        ),
        (LHS + "[[factor]]\nlow = 0\n", "a [[factor]] has no name"),
        (LHS + RANGE + RANGE, "drop.tilt is given twice"),
        (LHS + "[set]\ndrop.tilt = 0\n" + RANGE, "drop.tilt is given twice"),
        (LHS + "[set]\nground.fricton = 0.3\n" + RANGE, "did you mean ground.friction?"),
        (LHS + "[set]\nground.friction = -1\n" + RANGE, "ground.friction = -1 is outside [0, 3]"),
        (
            LHS + "[limits]\nmain_strut.forc = 1\n" + RANGE,
            "unknown limit 'main_strut.forc'; did you mean main_strut.force?",
        ),
        (
            LHS + 'responses = ["outcom"]\n' + RANGE,
            "unknown response 'outcom'; did you mean outcome?",
        ),
        (
            LHS + 'responses = ["leg[1].main_strut.force.mean"]\n' + RANGE,
            "did you mean leg[1].main_strut.force.m",
        ),
        (LHS + 'responses = ["nothing.*"]\n' + RANGE, "unknown response 'nothing.*'"),
        (
            LHS + 'responses = ["margin.slid", "margin.*"]\n' + RANGE,
            "response margin.slid is named twice",
        ),
        (LHS + "responses = []\n" + RANGE, "must be a list of texts, not empty"),
        (LHS + "until = 0\n" + RANGE, "until = 0 s is outside"),
        (LHS + "until = 0.1\nevery = 0.2\n" + RANGE, "every = 0.2 s is above until = 0.1 s"),
        (LHS + "rtol = 1\n" + RANGE, "rtol = 1 is outside [1e-12, 0.01]"),
        (LHS + 'modes = ["3-1"]\n' + RANGE, "unknown landing mode '3-1'"),
        (
            LHS + 'modes = ["2-2"]\n[set]\ndrop.mode = "2-2"\n' + RANGE,
            "drop.mode is given as a factor, in [set]",
        ),
        (LHS + 'preset = "mine"\n' + RANGE, "unknown preset 'mine'"),
        (LHS + 'parameters = "mine.toml"\n' + RANGE, "there is no parameter file"),
        (LHS + "seed = -1\n" + RANGE, "seed = -1 must be a whole number from 0"),
        (LHS + 'name = "a/b"\n' + RANGE, "names no folder of its own"),
        (LHS + 'name = ".."\n' + RANGE, "names no folder of its own"),
        (LHS + "sampels = 3\n" + RANGE, "unknown key of [study] 'sampels'; did you mean samples?"),
        (LHS, "the study varies nothing"),
        (LHS + "[[factors]]\n", "unknown table 'factors'; did you mean factor?"),
        (LHS + "[factor]\nname = 3\n", "must be written [[factor]]"),
        ('study = "x"\n', "must be a table"),
        ('[study]\nmethod = "lhs"\n' + RANGE, "lhs needs samples = N"),
        ('[study]\nmethod = "grid"\nsamples = 3\n' + RANGE, 'belongs to "lhs" and "sobol"'),
        (
            '[study]\nmethod = "grid"\n' + RANGE,
            "a grid needs values = [...], or low, high and count",
        ),
        ('[study]\nmethod = "gird"\n' + RANGE, "unknown method 'gird'; did you mean grid?"),
        (
            "[study]\nsamples = 8\n" + RANGE,
            "[study] has no method; write one of grid, lhs, sobol, table",
        ),
        ("[study\n", "TOML syntax"),
        (TABLE, "there is no table"),
        ('[study]\nmethod = "table"\n', 'needs table = "FILE.csv"'),
        (
            '[study]\nmethod = "lhs"\nsamples = 3\ntable = "x.csv"\n' + RANGE,
            'belongs to method = "table"',
        ),
        ('[study]\ntable = "states.txt"\n', "must be a .csv or .parquet file"),
    ],
)
def test_a_bad_study_is_one_clear_line_and_leaves_nothing(tmp_path, command, text, message):
    (tmp_path / "s.toml").write_text(text)
    done = command("sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 2
    assert message in done.err
    assert "s.toml: " in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert [p.name for p in tmp_path.iterdir()] == ["s.toml"]


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            HEADINGS.replace("drop.pitch_rate,", "") + "1,0,-1\n",
            "has no column drop.pitch_rate; a touchdown state needs it",
        ),
        (
            HEADINGS.replace("[deg]", "[mm]") + ROW,
            "column 'drop.tilt [mm]': drop.tilt = '1 mm' has the wrong unit",
        ),
        (HEADINGS.replace("[deg]", "[degg]") + ROW, "is not a number with a unit"),
        (
            HEADINGS.replace("pitch_rate", "pitchrate") + ROW,
            "did you mean drop.pitch_rate?; columns that are not ours go to ignore",
        ),
        (
            HEADINGS.strip() + ",drop.tilt [rad]\n" + ROW.strip() + ",1\n",
            "has two columns of drop.tilt",
        ),
        (
            HEADINGS.strip() + ",ground.friction\n" + ROW.strip() + ",1\n",
            "column of ground.friction, which the study gives, too",
        ),
        (HEADINGS, "has no rows"),
        (HEADINGS + "1,2\n", "line 2: 2 values under 4 headings"),
        ("", "has no column drop.tilt, drop.pitch_rate"),
    ],
)
def test_a_bad_table_is_one_clear_line(tmp_path, command, table, message):
    (tmp_path / "states.csv").write_text(table)
    (tmp_path / "s.toml").write_text(TABLE + "[set]\nground.friction = 0.3\n")
    done = command("sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 2
    assert message in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert not (tmp_path / "r").exists()


def test_a_column_to_ignore_must_be_there(tmp_path, command):
    (tmp_path / "states.csv").write_text(HEADINGS + ROW)
    (tmp_path / "s.toml").write_text(TABLE + 'ignore = ["case"]\n')
    assert "has no column 'case' to ignore" in command("sweep", str(tmp_path / "s.toml")).err


def test_a_missing_study_and_a_folder_that_cannot_be_made_are_refused(tmp_path, command):
    assert "there is no study" in command("sweep", str(tmp_path / "none.toml")).err
    (tmp_path / "file").write_text("")
    done = command("sweep", str(write_study(tmp_path)), "--results", str(tmp_path / "file" / "r"))
    assert done.code == 2
    assert "cannot be written" in done.err


def test_workers_and_a_scheduler_exclude_each_other(tmp_path, command):
    done = command(
        "sweep", str(write_study(tmp_path)), "--workers", "2", "--scheduler", "tcp://127.0.0.1:1"
    )
    assert done.code == 2
    assert "leave --workers or --scheduler out" in done.err


@pytest.mark.parametrize(
    ("module", "options"), [("pyarrow", ()), ("distributed", ("--scheduler", "tcp://127.0.0.1:1"))]
)
def test_what_is_not_installed_is_named_with_its_extra(
    tmp_path, command, monkeypatch, module, options
):
    real = builtins.__import__

    def missing(name: str, *rest: object, **more: object) -> object:
        if name.split(".")[0] == module:
            raise ImportError(f"No module named {name!r}")
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", missing)
    done = command("sweep", str(write_study(tmp_path)), "--results", str(tmp_path / "r"), *options)
    assert done.code == 2
    assert 'pip install "rlv-landing[studies]"' in done.err


def test_a_table_cuts_no_name():
    names = [f"main_strut.orifice_area_compression_{k}" for k in range(8)]
    text = render(new_table("", (), names), 100)
    assert "…" not in text
    assert sum(c.isdigit() for c in text) == len(names)
