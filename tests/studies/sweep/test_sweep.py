"""Sweeps: every row is the landing that its values say, in order, whoever made it."""

from __future__ import annotations

import json
from math import radians
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from study_tools import rows, write_study

from rlv_landing import Landing, __version__, load_preset
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.sweep.responses import DEFAULT, Measure, expand, known_responses
from rlv_landing.studies.sweep.study import read_study
from rlv_landing.validation.measures import leg_work

FIGURES = "yue2022-figures"
ROOT = Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "examples" / "touchdown_study"
DOCUMENTATION = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
STATES = {
    "drop.tilt [deg]": 2.0,
    "drop.pitch_rate [deg/s]": -3.0,
    "drop.horizontal_velocity": 0.2,
    "drop.vertical_velocity [m/s]": -1.2,
}


def states(values: dict[str, object], count: int = 3) -> str:
    """A CSV table of touchdown states."""
    return "\n".join([",".join(values), *[",".join(map(str, values.values()))] * count]) + "\n"


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study, run by four threads."""
    from click.testing import CliRunner

    from rlv_landing.cli import cli

    folder = tmp_path_factory.mktemp("swept")
    write_study(folder)
    done = CliRunner().invoke(
        cli,
        [
            "sweep",
            str(folder / "study.toml"),
            "--results",
            str(folder / "r"),
            "--workers",
            "4",
            "--json",
        ],
    )
    assert done.exit_code == 0, done.output
    (folder / "summary.json").write_text(done.stdout)
    return folder


def test_one_thread_and_four_write_the_same_file_to_the_byte(swept, tmp_path, command):
    done = command(
        "sweep", str(swept / "study.toml"), "--results", str(tmp_path / "r"), "--workers", "1"
    )
    assert done.code == 0, done.err
    assert (tmp_path / "r" / "results.parquet").read_bytes() == (
        swept / "r" / "results.parquet"
    ).read_bytes()
    assert not (tmp_path / "r" / "parts").exists()


def test_a_row_holds_the_responses_of_the_landing_that_its_values_make(swept):
    found = rows(swept / "r" / "results.parquet")
    assert [row["index"] for row in found] == list(range(40))
    assert [row["sample"] for row in found] == [i // 2 for i in range(40)]
    assert {row["drop.mode"] for row in found} == {"2-2", "1-2-1"}
    for row in found[7:9]:
        assert (row["seed"], row["version"], row["error"]) == (3, __version__, None)
        values = {name: row[name] for name in ("drop.tilt", "drop.vertical_velocity")}
        fixed = {"drop.contact_time": 0.0, "ground.friction": 0.4}
        landing = Landing(
            load_preset(FIGURES, row["drop.mode"]).with_values({**fixed, **values}), rtol=1e-4
        )
        landing.set_inputs({"external.force_x": row["external.force_x"]})
        history = landing.run(0.1, 2e-3)
        assert row["rhs_calls"] == landing.statistics["rhs_calls"]
        assert row["legs.main_strut.force.min"] == min(
            history.extremes[f"leg[{leg}].main_strut.force"].minimum for leg in (1, 2, 3, 4)
        )
        stroke = history.extremes["leg[3].main_strut.stroke"]
        assert row["leg[3].main_strut.stroke.max_time"] == stroke.maximum_time
        assert row["body.pitch.final"] == history["body.pitch"][-1]
        balance = history.extremes["energy.balance"]
        assert row["energy.balance.abs_max"] == max(balance.maximum, -balance.minimum)
        assert row["outcome"] == outcome(history).name
        assert row["margin.slid"] == outcome(history).margins["slid"]


def test_the_files_metadata_repeats_the_study_and_columns_have_units(swept):
    schema = parquet.read_schema(swept / "r" / "results.parquet")
    assert schema.field("drop.tilt").metadata[b"unit"] == b"rad"
    assert schema.field("legs.main_strut.force.min").metadata[b"unit"] == b"N"
    assert schema.metadata[b"study.toml"].decode() == (swept / "study.toml").read_text()
    assert json.loads(schema.metadata[b"versions"])["rlv-landing"] == __version__


def test_the_summary_counts_what_the_rows_hold(swept):
    printed = json.loads((swept / "summary.json").read_text())
    found = rows(swept / "r" / "results.parquet")
    assert (printed["landings"], printed["failed"]) == (40, 0)
    assert sum(printed["outcomes"].values()) == 40
    force = [row["legs.main_strut.force.min"] for row in found]
    assert printed["responses"]["legs.main_strut.force.min"]["median"] == pytest.approx(
        np.median(force)
    )


def test_damper_work_of_a_row_is_that_of_measures(drop_test):
    values = dict(zip(names := expand(None), Measure(names)(drop_test, 1)))
    work = leg_work(drop_test)
    for leg, expected in work.items():
        for what in ("absorbed", "dissipated", "efficiency"):
            assert values[f"leg[{leg}].main_strut.{what}"] == pytest.approx(
                getattr(expected, what), rel=1e-12
            )
    assert values["legs.main_strut.absorbed"] == pytest.approx(
        sum(w.absorbed for w in work.values())
    )


def test_every_response_there_is_can_be_taken_and_has_a_meaning(drop_test):
    names = tuple(known_responses())
    values = Measure(names, {"main_strut.force": 1000.0})(drop_test, 1)
    assert len(values) == len(names) > 600
    assert all(q.meaning for q in known_responses().values())
    assert dict(zip(names, values))["outcome.first_limit"].endswith("main_strut.force")
    assert set(expand(None)) <= set(names)
    assert len(DEFAULT) > 20


def test_what_comes_after_toppling_does_not_count():
    fall = {"drop.tilt": 1.2, "drop.pitch_rate": 3.0, "drop.contact_time": 0.0}
    history = Landing(load_preset(FIGURES, "2-2").with_values(fall), rtol=1e-4).run(1.5, 2e-3)
    assert outcome(history).name == "toppled"
    names = ("outcome.time", "body.pitch.final", "legs.contact.force_y.max")
    values = dict(zip(names, Measure(names)(history, 1)))
    at = int(np.flatnonzero(history.time == values["outcome.time"])[0])
    assert at < len(history.time) - 1
    assert values["body.pitch.final"] == history["body.pitch"][at]


def study_of(folder: Path, text: str):
    (folder / "s.toml").write_text(text)
    return read_study(folder / "s.toml").design


FACTORS = """
[[factor]]
name = "drop.tilt"
unit = "deg"
low = -4.0
high = 4.0
count = 3
[[factor]]
name = "drop.mode"
values = ["2-2", "1-2-1"]
"""


def test_a_grid_has_every_level_with_every_other(tmp_path):
    design = study_of(tmp_path, '[study]\nmethod = "grid"\n' + FACTORS)
    assert [
        (round(v["drop.tilt"] / radians(1.0), 9), v["drop.mode"]) for v in design.rows(0, 6)
    ] == [(tilt, mode) for tilt in (-4.0, 0.0, 4.0) for mode in ("2-2", "1-2-1")]


@pytest.mark.parametrize("method", ["lhs", "sobol"])
def test_drawn_points_fill_their_ranges_evenly_and_repeat_with_their_seed(tmp_path, method):
    text = f'[study]\nmethod = "{method}"\nsamples = 64\nseed = {{}}\n' + FACTORS
    design = study_of(tmp_path, text.format(5))
    strata = np.floor((design.columns["drop.tilt"] / radians(8.0) + 0.5) * 64)
    assert sorted(strata) == list(range(64))
    assert (design.columns["drop.mode"] == "2-2").sum() == 32
    assert study_of(tmp_path, text.format(5)).digest() == design.digest()
    assert study_of(tmp_path, text.format(6)).digest() != design.digest()


def test_a_truncated_normal_stays_within_its_bounds_and_keeps_its_quantiles(tmp_path):
    text = """[study]
method = "lhs"
samples = 2000
[[factor]]
name = "drop.vertical_velocity"
distribution = "normal"
mean = -1.0
deviation = 0.5
high = -0.5
"""
    drawn = study_of(tmp_path, text).columns["drop.vertical_velocity"]
    assert drawn.max() <= -0.5
    # of the normal's 84.13 % below one deviation above its mean, half lie below its 42.07 %
    # quantile
    assert np.median(drawn) == pytest.approx(-1.0 + 0.5 * -0.2, abs=2e-3)


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_table_of_touchdown_states_is_landed_row_by_row_in_its_units(tmp_path, command, ending):
    table = tmp_path / f"states.{ending}"
    if ending == "csv":
        table.write_text(states({**STATES, "case": "a"}))
    else:
        fields = [
            pa.field(name, pa.string() if name == "case" else pa.float64())
            for name in (*STATES, "case")
        ]
        parquet.write_table(
            pa.table([[v] * 3 for v in (*STATES.values(), "a")], schema=pa.schema(fields)), table
        )
    (tmp_path / "s.toml").write_text(
        f'[study]\ntable = "states.{ending}"\nignore = ["case"]\nuntil = 0.1\n'
        "[set]\ndrop.contact_time = 0.0\n"
    )
    done = command("sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 0, done.err
    found = rows(tmp_path / "r" / "results.parquet")
    assert len(found) == 3
    assert found[0]["drop.tilt"] == pytest.approx(radians(2.0))
    assert found[0]["drop.pitch_rate"] == pytest.approx(radians(-3.0))
    assert found[0]["drop.vertical_velocity"] == -1.2


def test_a_parquet_column_takes_its_unit_from_its_metadata(tmp_path):
    fields = [
        pa.field(
            name.split(" ")[0], pa.float64(), metadata={"unit": "deg"} if "tilt" in name else {}
        )
        for name in STATES
    ]
    parquet.write_table(
        pa.table([[v] for v in STATES.values()], schema=pa.schema(fields)),
        tmp_path / "states.parquet",
    )
    design = study_of(tmp_path, '[study]\ntable = "states.parquet"\n')
    assert design.columns["drop.tilt"][0] == pytest.approx(radians(2.0))


def test_a_landing_that_takes_too_many_steps_is_its_rows_error(tmp_path, command):
    (tmp_path / "s.toml").write_text(
        '[study]\nmethod = "grid"\nuntil = 0.2\n[set]\nsolver.max_steps_per_second = 2e4\n'
        '[[factor]]\nname = "main_strut.seal_coulomb"\nvalues = [100.0, 1e6]\n'
    )
    done = command("sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 0, done.err
    errors = [row["error"] for row in rows(tmp_path / "r" / "results.parquet")]
    assert errors[0] is None
    assert "takes more than solver.max_steps_per_second = 20000 1/s at t = 0." in errors[1]


def test_rows_that_cannot_be_landed_say_why_and_the_others_are_landed(tmp_path, command):
    lines = states(STATES).splitlines()
    lines[2] = "2.0,nan,0.2,-1.2"
    lines[3] = "2.0,-3.0,fast,-1.2"
    (tmp_path / "states.csv").write_text("\n".join([*lines, "200.0,-3.0,0.2,-1.2"]) + "\n")
    (tmp_path / "s.toml").write_text(
        '[study]\ntable = "states.csv"\nuntil = 0.1\n[set]\ndrop.contact_time = 0.0\n'
    )
    done = command("sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 0, done.err
    assert "3 failed; column `error` says why" in done.out
    errors = [row["error"] for row in rows(tmp_path / "r" / "results.parquet")]
    assert errors[0] is None
    assert "drop.pitch_rate = nan rad/s is outside" in errors[1]
    assert "drop.horizontal_velocity = 'fast' is not a number" in errors[2]
    assert "drop.tilt = 3.49066 rad is outside" in errors[3]
    strict = command(
        "sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "strict"), "--strict"
    )
    assert strict.code == 2
    assert (
        "3 of 4 landings are refused: landing 1 (row 2 of the table): drop.pitch_rate = nan"
        in strict.err
    )
    assert not (tmp_path / "strict").exists()


def test_a_dry_run_prints_number_first_rows_and_time_and_makes_nothing(tmp_path, command):
    study = str(write_study(tmp_path))
    printed = json.loads(command("sweep", study, "--dry-run", "--json").out)
    assert (printed["landings"], printed["samples"], len(printed["first"])) == (40, 20, 5)
    assert printed["seconds_estimated"] == pytest.approx(
        printed["seconds_one"] * 40 / printed["workers"]
    )
    text = command("sweep", study, "--dry-run").out
    assert "40 landings" in text
    assert "drop.vertical_velocity [m/s]" in text
    assert [p.name for p in tmp_path.iterdir()] == ["study.toml"]


@pytest.mark.parametrize("study", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_examples_are_studies_whose_first_landing_works(command, study):
    name = study.stem if study.stem in ("sensitivity", "montecarlo") else "sweep"
    printed = json.loads(command(name, str(study), "--dry-run", "--json").out)
    assert printed["error"] is None
    assert (
        printed["landings"]
        == {"dispersion": 1000, "states": 24, "sensitivity": 1024, "montecarlo": 2000}[study.stem]
    )


def test_the_study_that_the_documentation_shows_is_one(tmp_path):
    shown = DOCUMENTATION.split("```toml\n")[1].split("```")[0]
    (tmp_path / "shown.toml").write_text(shown)
    read = read_study(tmp_path / "shown.toml")
    assert len(read.design) == 500
    assert (read.fixed["external.force_x"], read.limits["main_strut.force"]) == (100.0, 8000.0)
