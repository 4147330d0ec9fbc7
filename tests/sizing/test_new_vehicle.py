"""`rlv-landing new` and `draw`: files that the other commands take."""

from __future__ import annotations

import json
import os
from pathlib import Path
from xml.etree import ElementTree

import pytest

from rlv_landing.presets import load_preset, read_toml
from rlv_landing.sizing import needs_like, size_vehicle
from rlv_landing.sizing.project import model_name


@pytest.fixture
def vehicle(tmp_path, command):
    """The folder of a new hopper."""
    done = command("new", str(tmp_path / "my hopper"), "--need", "mass=45 kg")
    assert done.code == 0, done.err
    return tmp_path / "my hopper"


def test_the_file_holds_the_sized_vehicle_to_the_digit(vehicle):
    wanted = size_vehicle(needs_like("hopper", {"mass": 45.0}))
    found = read_toml(vehicle / "vehicle.toml")
    assert dict(found.items()) == dict(wanted.items())
    assert {n: found.source(n) for n, _ in found.items()} == {
        n: wanted.source(n) for n, _ in wanted.items()
    }


def test_the_prototypes_file_holds_the_preset(tmp_path, command):
    assert command("new", str(tmp_path / "p"), "--like", "prototype").code == 0
    for mode in ("2-2", "1-2-1"):
        found = read_toml(tmp_path / "p" / "vehicle.toml").for_mode(mode)
        assert dict(found.items()) == dict(load_preset("yue2022-figures", mode).items())


def test_the_commands_of_the_readme_run(vehicle, command, monkeypatch):
    monkeypatch.chdir(vehicle)
    for arguments in (
        ("draw", "vehicle.toml", "vehicle.svg"),
        ("simulate", "--parameters", "vehicle.toml", "--until", "0.05"),
        ("sweep", "study.toml", "--dry-run"),
        ("envelope", "envelope.toml", "--cells", "2", "--levels", "0"),
    ):
        done = command(*arguments)
        assert (done.code, done.err) == (0, ""), arguments
    readme = (vehicle / "README.md").read_text()
    assert "fmu build --parameters vehicle.toml --name my_hopper -o my_hopper.fmu" in readme


@pytest.mark.parametrize("like", ["hopper", "stage", "prototype"])
def test_each_touchdown_of_a_new_study_lands(like, tmp_path, command, monkeypatch):
    assert command("new", str(tmp_path / like), "--like", like).code == 0
    monkeypatch.chdir(tmp_path / like)
    study = Path("study.toml")
    study.write_text(study.read_text().replace("[set]", "until = 0.05\n\n[set]"))
    done = command("sweep", "study.toml", "--workers", "1")
    assert (done.code, done.err) == (0, "")
    assert "failed" not in done.out


@pytest.mark.parametrize(
    ("name", "model"), [("my hopper", "my_hopper"), ("3-körper", "k_rper"), ("!!", "Vehicle")]
)
def test_the_models_name_is_an_identifier(name, model):
    assert model_name(name) == model


def test_a_folder_with_files_a_file_and_needs_of_the_prototype_are_refused(
    vehicle, tmp_path, command
):
    again = command("new", str(vehicle))
    assert again.code == 2
    assert "is not empty" in again.err
    file = command("new", str(vehicle / "README.md"))
    assert file.code == 2
    assert "is a file" in file.err
    fixed = command("new", str(tmp_path / "p"), "--like", "prototype", "--need", "mass=3")
    assert fixed.code == 2
    assert not (tmp_path / "p").exists()


def test_the_needs_are_listed(tmp_path, command):
    done = command("new", str(tmp_path / "v"), "--like", "stage", "--need", "mass=2e4", "--needs")
    assert done.code == 0
    assert "20000 kg" in done.out
    assert not (tmp_path / "v").exists()


def test_a_complete_file_takes_nothing_from_elsewhere(vehicle, command):
    path = vehicle / "vehicle.toml"
    text = path.read_text()
    path.write_text("".join(line for line in text.splitlines(True) if "area_upper" not in line))
    done = command("simulate", "--parameters", str(path))
    assert done.code == 2
    assert "complete = true, but 1 missing: main_strut.area_upper; give a value" in done.err
    path.write_text('preset = "yue2022-tests"\n' + text)
    assert (
        "complete = true leaves nothing to take from a preset"
        in command("parameters", "--parameters", str(path)).err
    )
    path.write_text(text.replace("complete = true", "complete = 1"))
    assert "is neither true nor false" in command("parameters", "--parameters", str(path)).err


def test_the_origin_of_each_value_is_named(tmp_path, command):
    path = tmp_path / "mine.toml"
    path.write_text('preset = "yue2022-tests"\n[mode.1-2-1.drop]\ntilt = "-3 deg"\n')
    options = ("--parameters", str(path), "--mode", "1-2-1", "--set", "ground.friction=0.5")
    done = command("parameters", *options, "--origin", "--json")
    assert done.code == 0, done.err
    found = {record["name"]: record["origin"] for record in json.loads(done.out)}
    assert found["drop.tilt"] == f"{path}, mode 1-2-1"
    assert found["drop.contact_time"] == "preset yue2022-tests, mode 1-2-1"
    assert found["main_strut.length"] == "default, as of yue2022-figures"
    assert found["ground.friction"] == "--set"
    table = command("parameters", "--preset", "yue2022-figures", "--origin")
    assert "preset yue2022-figures, mode 2-2" in table.out


def test_the_origin_of_values_from_a_pipe_is_named(command):
    end, start = os.pipe()
    try:
        os.write(start, b'[vehicle]\nmass = "200 kg"\n')
        os.close(start)
        done = command("parameters", "--parameters", f"/dev/fd/{end}", "--origin", "--json")
    finally:
        os.close(end)
    assert done.code == 0, done.err
    found = {record["name"]: record["origin"] for record in json.loads(done.out)}
    assert found["vehicle.mass"] == f"/dev/fd/{end}"


@pytest.mark.parametrize("ending", ["svg", "png", "pdf"])
def test_the_drawing_is_a_picture_that_repeats(vehicle, command, ending):
    pictures = [vehicle / f"{k}.{ending}" for k in (1, 2)]
    for picture in pictures:
        assert command("draw", str(vehicle / "vehicle.toml"), str(picture)).code == 0
    if ending == "svg":
        text = " ".join(ElementTree.parse(pictures[0]).getroot().itertext())
        for words in ("my hopper", "main_strut.length", "radius of the footpads", "0.7 m"):
            assert words in text
        assert pictures[0].read_bytes() == pictures[1].read_bytes()
    start = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}[ending]
    assert pictures[0].read_bytes().startswith(start)
    refused = command("draw", str(vehicle / "vehicle.toml"), str(pictures[0]))
    assert refused.code == 2
    assert "--force overwrites it" in refused.err


def test_a_drawing_of_another_kind_is_refused(vehicle, command):
    done = command("draw", "yue2022-figures", str(vehicle / "a.bmp"))
    assert done.code == 2
    assert "must end in .png or .svg or .pdf" in done.err
