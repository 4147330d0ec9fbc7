"""Sensitivity: the indices of a closed form, and of landings whose physics determines them."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path

import numpy as np
import pytest
from study_tools import rows, run

from rlv_landing.studies.sweep.sensitivity import indices_of, sobol_design, sobol_indices
from rlv_landing.studies.sweep.study import Study, read_study

STUDY = """
[study]
method = "sobol"
samples = {samples}
seed = 2
until = 0.25
every = 1e-3
responses = [
    "outcome", "legs.main_strut.force.min", "margin.stability_min", "margin.stroke_left",
    "leg[*].main_strut.efficiency",
]
[set]
drop.contact_time = 0.0
drop.pitch_rate = 0.0
drop.horizontal_velocity = 0.0
[[factor]]
name = "drop.tilt"
unit = "deg"
low = -1.0
high = 1.0
[[factor]]
name = "drop.vertical_velocity"
distribution = "normal"
mean = -1.5
deviation = 0.1
[[factor]]
name = "main_strut.stroke_max"
unit = "mm"
low = 60
high = 100
"""


def write(folder: Path, samples: int = 64) -> str:
    (folder / "s.toml").write_text(STUDY.format(samples=samples))
    return str(folder / "s.toml")


@pytest.fixture
def unit_study(tmp_path: Path) -> Study:
    """A study of three uniform factors; the closed forms below take them from -pi to pi."""
    return read_study(Path(write(tmp_path, 4096)))


def points(study: Study) -> np.ndarray:
    """The study's points, each factor stretched to -pi..pi by its own distribution."""
    columns = sobol_design(study).columns
    stretched = []
    for f in study.factors:
        sorted_values = np.sort(columns[f.name])
        places = np.searchsorted(sorted_values, columns[f.name], "left") / len(sorted_values)
        stretched.append(2.0 * pi * places - pi)
    return np.array(stretched)


def test_ishigamis_function_has_its_closed_indices_within_their_intervals(unit_study):
    """The function is sin x1 + a sin^2 x2 + b x3^4 sin x1, Ishigami and Homma (1990)."""
    a, b = 7.0, 0.1
    x1, x2, x3 = points(unit_study)
    values = np.sin(x1) + a * np.sin(x2) ** 2 + b * x3**4 * np.sin(x1)
    first, total = sobol_indices(values.reshape(5, 1, -1), seed=1)
    v1, v2, v13 = 0.5 * (1.0 + b * pi**4 / 5.0) ** 2, a**2 / 8.0, 8.0 * b**2 * pi**8 / 225.0
    variance = v1 + v2 + v13
    for found, exact in ((first[0], (v1, v2, 0.0)), (total[0], (v1 + v13, v2, v13))):
        assert found[:, 0] == pytest.approx(np.array(exact) / variance, abs=0.03)
        assert (found[:, 1] <= np.array(exact) / variance).all()
        assert (np.array(exact) / variance <= found[:, 2]).all()


def test_the_pages_of_the_design_are_two_samples_and_their_exchanges(unit_study):
    n = unit_study.samples
    pages = np.array(list(sobol_design(unit_study).columns.values())).reshape(3, 5, n)
    a, b = pages[:, 0], pages[:, 1]
    assert np.abs(np.corrcoef(np.concatenate([a, b]))[np.triu_indices(6, 1)]).max() < 0.02
    for i in range(3):
        for k in range(3):
            assert (pages[k, 2 + i] == (b if k == i else a)[k]).all()


def test_a_stop_that_is_never_met_has_indices_of_zero_and_adds_to_the_margin_what_it_varies_by(
    tmp_path, command
):
    """The position of the dampers' stop changes no landing that never meets it.

    It changes the stroke left one for one.
    """
    study = write(tmp_path)
    done = command("sensitivity", study, "--results", str(tmp_path / "r"), "--json")
    assert done.code == 0, done.err
    printed = {
        r["response"]: {f["factor"]: f for f in r["indices"]}
        for r in json.loads(done.out)["responses"]
    }
    assert set(printed) == {
        "legs.main_strut.force.min",
        "margin.stability_min",
        "margin.stroke_left",
    }
    for response in ("legs.main_strut.force.min", "margin.stability_min"):
        stop = printed[response]["main_strut.stroke_max"]
        assert stop["first"] == stop["total"] == {"index": 0.0, "low": 0.0, "high": 0.0}
    assert printed["legs.main_strut.force.min"]["drop.vertical_velocity"]["total"]["index"] > 0.3
    found = rows(tmp_path / "r" / "results.parquet")
    variance = np.var([row["margin.stroke_left"] for row in found[:128]])
    exact = 0.04**2 / 12.0 / variance
    for order in ("first", "total"):
        share = printed["margin.stroke_left"]["main_strut.stroke_max"][order]
        assert share["low"] <= exact <= share["high"]
    assert (tmp_path / "r" / "sensitivity.png").read_bytes().startswith(b"\x89PNG")
    again = command(
        "sensitivity", study, "margin.slid", "--results", str(tmp_path / "r"), "--resume"
    )
    assert again.code == 2
    assert "unknown response of this study 'margin.slid'" in again.err
    table = command(
        "sensitivity",
        study,
        "leg[1].main_strut.efficiency",
        "--results",
        str(tmp_path / "r"),
        "--resume",
    )
    assert table.code == 0, table.err
    assert "leg[1].main_strut.efficiency" in table.out
    assert "Sobol indices, 95 % intervals" in table.out
    assert "more (legs.main_strut.force.min, " in table.out
    assert "): name them, and --resume" in table.out


def test_samples_with_a_failed_landing_are_replaced_and_counted_and_too_many_give_no_indices(
    unit_study, tmp_path
):
    import pyarrow as pa
    from pyarrow import parquet

    x1, x2, _ = points(unit_study)
    values = x1 + 2.0 * x2
    count = len(values)
    for lost, used in ((range(100, 200), 3996), (range(0, count, 5), 0)):
        column = [None if i in lost else v for i, v in enumerate(values)]
        parquet.write_table(
            pa.table({"margin.slid": pa.array(column, pa.float64())}), tmp_path / "r.parquet"
        )
        (found,) = indices_of(tmp_path / "r.parquet", unit_study, ["margin.slid"], resamples=99)
        assert (found.used, found.samples) == (used, 4096)
        if used:
            assert found.total[:, 0] == pytest.approx([0.2, 0.8, 0.0], abs=0.03)
        else:
            assert np.isnan(found.total).all()


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        (("samples = 64", "samples = 60"), (), "samples = a power of 2, for example 256 or 1024"),
        (('method = "sobol"\nsamples = 64', 'method = "grid"'), (), "a grid needs values"),
        (
            (STUDY[STUDY.index('[[factor]]\nname = "drop.vert') :], ""),
            (),
            "needs two [[factor]] or more",
        ),
        (("", ""), ("margin.stability",), "did you mean margin.stability_min?"),
        (("", ""), ("outcome",), "outcome is a text"),
        (("", ""), ("--plot", "bars.jpg"), "must end in .png or .svg or .pdf"),
    ],
)
def test_what_has_no_indices_is_refused_before_anything_runs(
    tmp_path, command, change, arguments, message
):
    study = Path(write(tmp_path))
    study.write_text(study.read_text().replace(*change))
    done = command("sensitivity", str(study), *arguments, "--results", str(tmp_path / "r"))
    assert done.code == 2
    assert message in done.err
    assert not (tmp_path / "r").exists()


def test_a_dry_run_counts_the_landings_of_all_pages(tmp_path, command):
    printed = json.loads(command("sensitivity", write(tmp_path), "--dry-run", "--json").out)
    assert (printed["samples"], printed["landings"]) == (64 * 5, 64 * 5)


def test_help_of_both_commands_teaches():
    for name in ("sweep", "sensitivity"):
        done = run(name, "--help", cwd=Path.cwd())
        assert done.returncode == 0
        assert f"rlv-landing {name} study.toml --dry-run" in done.stdout


def test_indices_do_not_depend_on_how_many_resamples_are_drawn_at_once(monkeypatch):
    pages = np.random.default_rng(0).random((5, 2, 64))
    first, total = sobol_indices(pages, 7, 0.95, 99)
    monkeypatch.setattr("rlv_landing.studies.sweep.sensitivity.BATCH", 640)
    again = sobol_indices(pages, 7, 0.95, 99)
    assert np.array_equal(again, (first, total))
