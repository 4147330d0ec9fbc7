"""What one leg has for itself, and the seed of rough ground, as factors of every study."""

from __future__ import annotations

import json

import numpy as np
import pytest
from study_tools import rows

from rlv_landing import Landing, LandingError, Parameters, land_many

NAMES = ("leg[2].ground.friction", "leg[3].ground.step")
START = '[set]\ndrop.contact_time = 0.0\ndrop.tilt = 0.0\n"leg[1].ground.friction" = 0.5\n'
FACTORS = (
    '[[factor]]\nname = "leg[2].ground.friction"\nvalues = [0.1, 0.6]\n'
    '[[factor]]\nname = "leg[3].ground.step"\nunit = "mm"\nlow = 0\nhigh = 20\ncount = 2\n'
)
SPACE = Parameters().for_mode("space").with_values({"drop.contact_time": 0.0, "drop.tilt": 0.0})


def least_force(values: dict[str, float]) -> float:
    """The least force of leg 2 until 0.05 s."""
    own = {"leg[1].ground.friction": 0.5, **values}
    landing = Landing(SPACE.with_values(own), rtol=1e-4)
    landing.advance_to(0.05)
    return landing.extremes()["leg[2].main_strut.force"].minimum


def test_a_sweep_lands_with_the_values_of_each_leg(tmp_path, command):
    head = '[study]\nmethod = "grid"\nmodes = ["space"]\nuntil = 0.05\nevery = 1e-2\n'
    head += 'responses = ["leg[2].main_strut.force.min"]\n'
    (tmp_path / "s.toml").write_text(head + START + FACTORS)
    done = command("sweep", str(tmp_path / "s.toml"), "--results", str(tmp_path / "r"))
    assert done.code == 0, done.err
    table = rows(tmp_path / "r" / "results.parquet")
    assert [[row[name] for name in NAMES] for row in table] == [
        [0.1, 0.0], [0.1, 0.02], [0.6, 0.0], [0.6, 0.02]
    ]  # fmt: skip
    for row in table:
        exact = least_force({name: row[name] for name in NAMES})
        assert row["leg[2].main_strut.force.min"] == exact
    assert len({row["leg[2].main_strut.force.min"] for row in table}) == 4


def test_a_monte_carlo_draws_them_together_and_seeds_as_whole_numbers(tmp_path, command):
    (tmp_path / "m.toml").write_text(
        '[montecarlo]\nmode = "space"\nsamples = 12\nuntil = 1e-3\nevery = 1e-3\n'
        "[set]\ndrop.contact_time = 0.0\nground.roughness = 0.01\n"
        '[[factor]]\nname = "ground.terrain_seed"\nlow = 0\nhigh = 9\n'
        '[[factor]]\nname = "vehicle.legs"\nlow = 3\nhigh = 5\n'
        '[covariance]\nnames = ["leg[1].ground.friction", "leg[2].ground.friction"]\n'
        "mean = [0.4, 0.4]\ndeviation = [0.05, 0.05]\ncorrelation = [[1.0, 1.0], [1.0, 1.0]]\n"
    )
    study = str(tmp_path / "m.toml")
    done = command("montecarlo", study, "--results", str(tmp_path / "r"), "--no-report")
    assert done.code == 0, done.err
    table = rows(tmp_path / "r" / "results.parquet")
    assert all(row["error"] is None for row in table)
    for row in table:
        both = [row[f"leg[{leg}].ground.friction"] for leg in (1, 2)]
        assert both[0] == pytest.approx(both[1], rel=1e-12)
        assert row["ground.terrain_seed"] in range(10)
        assert row["vehicle.legs"] in (3, 4, 5)
    assert len({row["ground.terrain_seed"] for row in table}) > 4
    assert len({row["vehicle.legs"] for row in table}) > 1
    told = command("montecarlo", study, "--run", "3", "--toml", str(tmp_path / "run.toml"))
    assert told.code == 0, told.err
    assert "[leg.2.ground]" in (tmp_path / "run.toml").read_text()


def test_an_envelope_may_have_one_as_its_axis(tmp_path, command):
    (tmp_path / "e.toml").write_text(
        '[envelope]\nmode = "space"\ncells = 2\nlevels = 0\nuntil = 0.1\nevery = 1e-2\n'
        'slide = "120 mm"\ncriterion = "slid"\n[set]\ndrop.tilt = 0.0\n'
        '[x]\nname = "leg[2].ground.friction"\nlow = 0.1\nhigh = 0.5\n'
        '[y]\nname = "drop.speed"\nlow = 0.0\nhigh = 2.0\n'
    )
    work = ("--work", str(tmp_path / "w"), "--json")
    done = command("envelope", str(tmp_path / "e.toml"), *work)
    assert done.code == 0, done.err
    assert json.loads(done.out)["study"]["x"]["name"] == "leg[2].ground.friction"


def test_many_landings_take_them_too():
    states = {"leg[2].ground.friction": [0.1, 0.6]}
    found = land_many(SPACE, states, until=0.1, every=1e-2, responses=["body.heading.final"])
    assert found.errors == (None, None)
    assert np.diff(found["body.heading.final"]) != 0.0
    with pytest.raises(LandingError, match=r"leg\[7\].ground.friction is of a leg that is not th"):
        land_many(SPACE, {"leg[7].ground.friction": [0.1]})
    with pytest.raises(LandingError, match=r"needs drop.mode = space"):
        land_many(Parameters(), {"leg[2].ground.friction": [0.1]})
