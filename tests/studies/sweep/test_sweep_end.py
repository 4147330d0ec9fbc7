"""The end of a swept landing, and the summary's words on what landings do not have."""

from __future__ import annotations

import json

import pytest
from scaled import scaled
from study_tools import rows

from rlv_landing import Landing, load_preset
from rlv_landing.parameters import Parameters
from rlv_landing.presets import to_toml
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.whole_landing import most_samples, whole_landing
from rlv_landing.validation.measures import leg_work


def stage() -> Parameters:
    """A stage of 25 t with little seal friction, which rocks for 12 s."""
    base = scaled(load_preset("yue2022-figures"), 25e3)
    little = dict.fromkeys(("main_strut.seal_stribeck", "main_strut.seal_pressure"), 0.0)
    own = {"vehicle.inertia": 4.0 * base.vehicle.inertia, "main_strut.seal_coulomb": 500.0}
    return base.with_values({**little, **own, "drop.tilt": 0.05, "drop.contact_time": 0.0})


def test_without_until_each_landing_goes_on_until_it_is_decided(tmp_path, command):
    """The end is that of `whole_landing`; the dampers' work is known then, and the same."""
    text = (
        '[study]\nmethod = "grid"\nrtol = 1e-4\n{until}[set]\ndrop.contact_time = 0.0\n'
        'ground.friction = 0.25\n[[factor]]\nname = "drop.tilt"\nvalues = [-0.02, 1.0]\n'
    )
    swept = {}
    for name, until in (("decided", ""), ("short", "until = 0.2\n")):
        (tmp_path / f"{name}.toml").write_text(text.format(until=until))
        done = command("sweep", str(tmp_path / f"{name}.toml"), "--results", str(tmp_path / name))
        assert done.code == 0, done.err
        swept[name] = (rows(tmp_path / name / "results.parquet"), done.out)
    (settled, toppled), out = swept["decided"]
    assert (settled["outcome"], toppled["outcome"]) == ("settled", "toppled")
    assert "1 settled, 1 toppled" in out
    values = {"drop.tilt": -0.02, "drop.contact_time": 0.0, "ground.friction": 0.25}
    landing = Landing(load_preset("yue2022-figures", "2-2").with_values(values), rtol=1e-4)
    history = whole_landing(landing, 10.0)
    assert settled["outcome.time"] == outcome(history).time
    assert settled["leg[3].main_strut.first_stroke"] == "complete"
    assert settled["leg[3].main_strut.dissipated"] == leg_work(history)[3].dissipated
    (short, _), out = swept["short"]
    assert short["outcome"] == "moving"
    assert short["leg[3].main_strut.first_stroke"] == "in rebound"
    assert short["leg[3].main_strut.absorbed"] == pytest.approx(
        settled["leg[3].main_strut.absorbed"], rel=1e-3
    )
    assert short["leg[3].main_strut.dissipated"] is None
    assert short["legs.main_strut.dissipated"] is None
    assert "leg[3].main_strut.first_stroke: 1 in rebound" in out


def test_what_still_rocks_after_10_s_goes_on_until_it_settles_in_few_samples(tmp_path, command):
    """In a sweep whatever the workers, and in an envelope; an end that is given is kept."""
    (tmp_path / "stage.toml").write_text(to_toml(stage()))
    study = '[study]\nmethod = "grid"\nparameters = "stage.toml"\nslide = 20.0\n'
    study += 'responses = ["outcome", "outcome.time"]\n'
    (tmp_path / "s.toml").write_text(
        study + '[[factor]]\nname = "ground.friction"\nvalues = [0.3, 0.6]\n'
    )
    for workers in ("1", "2"):
        folder = ("--results", str(tmp_path / workers), "--workers", workers)
        done = command("sweep", str(tmp_path / "s.toml"), *folder)
        assert done.code == 0, done.err
    results = [tmp_path / workers / "results.parquet" for workers in ("1", "2")]
    assert results[0].read_bytes() == results[1].read_bytes()
    assert all(r["outcome"] == "settled" and r["outcome.time"] > 11.0 for r in rows(results[0]))
    history = whole_landing(Landing(stage(), "2-2", rtol=1e-4))
    assert len(history) < 10_000 + 500 < most_samples(None, 1e-3, decided=True)
    (tmp_path / "e.toml").write_text(
        '[envelope]\nparameters = "stage.toml"\nslide = 20.0\ncells = 2\nlevels = 0\n'
        '[x]\nname = "drop.tilt"\nlow = 0.05\nhigh = 0.06\n'
        '[y]\nname = "drop.horizontal_velocity"\nlow = 0.0\nhigh = 0.1\n'
    )
    for name, until in (("moving", ("--until", "6")), ("settled", ())):
        work = ("--work", str(tmp_path / name), "--json")
        done = command("envelope", str(tmp_path / "e.toml"), *until, *work)
        assert json.loads(done.out)["families"][0]["outcomes"][name] == 9


def test_an_end_between_two_samples_ends_a_landing_that_is_not_decided():
    landing = Landing(load_preset("yue2022-figures", "2-2").with_values({"drop.tilt": 0.1}))
    history = whole_landing(landing, 0.56, 0.1)
    assert history.time.tolist() == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])


def test_responses_that_are_constant_or_that_no_landing_has_are_named(tmp_path, command):
    (tmp_path / "s.toml").write_text(
        '[study]\nmethod = "grid"\nuntil = 0.05\nevery = 2e-3\n'
        'responses = ["outcome", "outcome.first_limit_time", "body.x.final", "rhs_calls", '
        '"leg[1].contact.time"]\n'
        '[set]\ndrop.contact_time = 0.2\n[[factor]]\nname = "ground.friction"\n'
        "values = [0.2, 0.4]\n"
    )
    study = str(tmp_path / "s.toml")
    done = command("sweep", study, "--results", str(tmp_path / "r"))
    assert done.code == 0, done.err
    assert "no landing has: outcome.first_limit_time, leg[1].contact.time" in done.out
    assert "the same in all landings that have it: body.x.final, rhs_calls" in done.out
    record = json.loads(
        command("sweep", study, "--results", str(tmp_path / "r"), "--resume", "--json").out
    )
    assert record["missing"] == ["outcome.first_limit_time", "leg[1].contact.time"]
    assert record["constant"] == ["body.x.final", "rhs_calls"]
