"""Studies over a ground that is tilted, lifted or moving give the landings of `Landing`."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from pytest import approx
from study_tools import rows, run

from rlv_landing import Landing, load_preset
from rlv_landing.studies.envelope.search import envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy
from rlv_landing.studies.outcome import outcome

FIGURES = "yue2022-figures"
STUDY = """
[study]
method = "grid"
until = 0.5
every = 1e-3
responses = ["body.y.final", "energy.work_ground.final", "margin.slid"]

[set]
ground.tilt_rate = 0.1
ground.heave = 0.3

[[factor]]
name = "ground.tilt"
unit = "deg"
values = [-4.0, 0.0, 4.0]

[[factor]]
name = "ground.heave_rate"
values = [0.0, 0.2, -20.0]
"""


def test_rows_over_ground_inputs_are_the_same_landings_or_say_why_there_is_none(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    done = run("sweep", "study.toml", "--results", "r", cwd=tmp_path)
    found = rows(tmp_path / "r" / "results.parquet")
    assert len(found) == 9, done.stderr
    for row in found:
        inputs = {"ground.tilt_rate": 0.1, "ground.heave": 0.3}
        inputs |= {name: row[name] for name in ("ground.tilt", "ground.heave_rate")}
        if row["ground.heave_rate"] == -20.0:
            assert "below the ground" in row["error"]
            continue
        history = Landing(load_preset(FIGURES), rtol=1e-4, inputs=inputs).run(0.5, 1e-3)
        assert row["error"] is None
        assert row["body.y.final"] == history["body.y"][-1]
        assert row["energy.work_ground.final"] == history["energy.work_ground"][-1]
        assert row["margin.slid"] == outcome(history).margins["slid"]


def boundary(name: str) -> list[tuple[tuple[float, float], str]]:
    """Points and conditions of all landings of a small envelope over speed and `name`."""
    study = EnvelopeStudy(
        load_preset(FIGURES).with_values({"ground.friction": 0.7, "drop.pitch_rate": 0.0}),
        x=Axis("drop.horizontal_velocity", 0.0, 5.0, 1.25),
        y=Axis(name, radians(-8), radians(8), radians(4)),
        cells=2,
        levels=0,
        until=2.0,
    )
    (family,) = envelope(study).families
    return [((x, y), landed.condition) for x, y, landed in family.landings]


def test_the_envelope_over_the_tilt_of_the_ground_equals_that_over_its_slope():
    tilted = boundary("ground.tilt")
    assert tilted == boundary("ground.slope")
    assert {condition.split(" ")[0] for _, condition in tilted} >= {"topples"}
    assert any(not condition.startswith("topples") for _, condition in tilted)


@pytest.mark.parametrize(
    "inputs", [{"ground.heave_rate": 0.3}, {"ground.heave": 2.0}, {"ground.tilt_rate": 0.02}]
)
def test_a_vehicle_that_moves_with_its_ground_has_not_slid(mode, inputs):
    """Sliding and clearance are relative to the moving ground."""
    values = {"drop.tilt": 0.0, "drop.pitch_rate": 0.0, "drop.horizontal_velocity": 0.0}
    values |= {"ground.friction": 0.8, "drop.contact_time": 0.0}
    parameters = load_preset(FIGURES, mode).with_values(values)
    still = outcome(Landing(parameters).run(2.0)).margins
    history = Landing(parameters, inputs=inputs).run(2.0)
    moved = outcome(history)
    assert moved.name in ("settled", "moving")
    assert moved.margins["slid"] == approx(still["slid"], abs=0.03)
    assert moved.margins["joint_clearance"] == approx(still["joint_clearance"], abs=0.02)
    moved_by = [np.abs(np.ptp(history[f"leg[1].footpad.{axis}"])) for axis in "xy"]
    assert max(moved_by) > 0.3 or inputs != {"ground.heave_rate": 0.3}


def test_the_command_simulate_starts_with_its_ground_inputs(tmp_path):
    arguments = ("--until", 0.4, "--input", "ground.heave=0.3", "--input", "ground.tilt=4 deg")
    done = run("simulate", *arguments, "--output", "h.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    table = np.genfromtxt(
        tmp_path / "h.csv", delimiter=",", names=True, deletechars="", replace_space=" "
    )
    inputs = {"ground.heave": 0.3, "ground.tilt": radians(4)}
    history = Landing(load_preset(FIGURES), inputs=inputs).run(0.4, 1e-3)
    assert np.array_equal(table["body.y"], history["body.y"])
    refused = run("simulate", "--input", "ground.heave_rate=-20", cwd=tmp_path)
    assert refused.returncode == 2
    assert "below the ground" in refused.stderr
    assert len(refused.stderr.splitlines()) == 1
