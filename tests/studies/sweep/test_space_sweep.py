"""Sweeps in space: every parameter and input of it varies, by the same files as symmetric ones."""

from __future__ import annotations

from pathlib import Path

import pytest
from study_tools import rows

STUDY = """
[study]
method = "lhs"
samples = 6
until = 0.08
modes = ["space"]
[set]
drop.contact_time = 0.0
vehicle.inertia_yaw = 40.0
{more}
"""
VARIED = {
    "drop.heading": ("deg", -40.0, 40.0),
    "drop.roll": ("deg", -2.0, 2.0),
    "drop.speed": ("m/s", 0.0, 0.5),
    "drop.direction": ("deg", 0.0, 360.0),
    "drop.roll_rate": ("deg/s", -5.0, 5.0),
    "drop.yaw_rate": ("deg/s", -5.0, 5.0),
    "ground.slope": ("deg", 0.0, 3.0),
    "ground.slope_direction": ("deg", -90.0, 90.0),
    "vehicle.inertia_roll": ("kg.m2", 90.0, 110.0),
    "vehicle.cg_offset_x": ("mm", -20.0, 20.0),
    "vehicle.inertia_xz": ("kg.m2", -3.0, 3.0),
    "external.moment_y": ("N.m", -50.0, 50.0),
    "ground.sway_rate": ("m/s", -0.2, 0.2),
}
FACTOR = '[[factor]]\nname = "{}"\nunit = "{}"\nlow = {}\nhigh = {}\n'
FACTORS = "".join(FACTOR.format(name, *given) for name, given in VARIED.items())


def swept(command, folder: Path, name: str, text: str, *options: str):
    study = folder / f"{name}.toml"
    study.write_text(text)
    return command("sweep", str(study), "--results", str(folder / name), *options)


def test_everything_of_a_landing_in_space_varies_on_any_threads(tmp_path, command):
    found = []
    for workers in ("1", "3"):
        text = STUDY.format(more="") + FACTORS
        done = swept(command, tmp_path, f"on{workers}", text, "--workers", workers)
        assert done.code == 0, done.err
        found.append((tmp_path / f"on{workers}" / "results.parquet").read_bytes())
    assert found[0] == found[1]
    table = rows(tmp_path / "on1" / "results.parquet")
    assert [row["error"] for row in table] == [None] * 6
    assert {row["drop.mode"] for row in table} == {"space"}
    assert all(len({row[name] for row in table}) == 6 for name in VARIED)
    assert len({row["body.roll.final"] for row in table}) == 6
    # the speed is the landing's: it has moved so far
    for row in table:
        assert abs(row["body.x.final"]) + abs(row["body.z.final"]) < 0.1 * row["drop.speed"] + 0.02
    assert all(row["leg[4].auxiliary_strut.transverse_force.abs_max"] >= 0.0 for row in table)


def test_legs_vary_and_what_a_vehicle_lacks_is_empty(tmp_path, command):
    more = '[[factor]]\nname = "vehicle.legs"\nvalues = [3, 5]\n'
    text = STUDY.format(more="").replace("until", 'responses = ["leg[*].contact.force_y.max", '
        '"legs.contact.force_y.max", "leg[*].main_strut.first_stroke"]\nuntil') + more  # fmt: skip
    done = swept(command, tmp_path, "legs", text)
    assert done.code == 0, done.err
    for row in rows(tmp_path / "legs" / "results.parquet"):
        assert row["error"] is None
        forces = [row[f"leg[{leg}].contact.force_y.max"] for leg in range(1, 6)]
        assert (forces[4] is None) == (row["vehicle.legs"] == 3.0)
        assert (row["leg[5].main_strut.first_stroke"] is None) == (row["vehicle.legs"] == 3.0)
        assert row["legs.contact.force_y.max"] == max(f for f in forces if f is not None)


def test_speed_and_direction_are_the_velocity_s_components(tmp_path, command):
    polar = '[[factor]]\nname = "drop.direction"\nunit = "deg"\nvalues = [90.0]\n'
    plain = '[[factor]]\nname = "drop.lateral_velocity"\nvalues = [0.4]\n'
    found = []
    for name, set_too, factor in (
        ("polar", "drop.speed = 0.4", polar),
        ("plain", "drop.horizontal_velocity = 0.0", plain),
    ):
        done = swept(command, tmp_path, name, STUDY.format(more=set_too) + factor)
        assert done.code == 0, done.err
        found.append(rows(tmp_path / name / "results.parquet")[0]["body.z.final"])
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    assert found[0] > 0.02


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            STUDY.format(more="").replace('["space"]', '["2-2", "space"]') + FACTORS,
            "have other responses than symmetric ones; make a study of each",
        ),
        (
            STUDY.format(more="").replace('["space"]', '["2-2"]') + FACTORS,
            "needs drop.mode = space, and the study lands with 2-2",
        ),
        (
            STUDY.format(more="external.moment = 3.0") + FACTORS,
            "external.moment needs drop.mode = 2-2 or 1-2-1, and the study lands with space",
        ),
        (
            STUDY.format(more="drop.lateral_velocity = 0.1") + FACTORS,
            "both give the horizontal velocity",
        ),
        (
            STUDY.format(more="").replace("until", 'responses = ["leg[5].contact.time"]\nuntil')
            + FACTORS,
            "unknown response 'leg[5].contact.time'",
        ),
        (
            '[study]\nmethod = "table"\ntable = "states.csv"\nmodes = ["space"]\n',
            "no column drop.heading, drop.roll, drop.roll_rate, drop.yaw_rate",
        ),
    ],
)
def test_what_is_not_of_the_mode_is_refused_at_the_door(tmp_path, command, text, message):
    (tmp_path / "states.csv").write_text(
        "drop.tilt [deg],drop.pitch_rate,drop.speed,drop.direction [deg],drop.vertical_velocity\n"
        "1,0,0.2,30,-1.3\n"
    )
    done = swept(command, tmp_path, "bad", text)
    assert done.code == 2, done.err
    assert message in done.err
    assert done.err.count("\n") == 1
    assert not (tmp_path / "bad").exists()
