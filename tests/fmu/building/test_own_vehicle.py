"""The FMU of a user's own vehicle, built from an installed package in an empty folder."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import bridge_tools
import fmpy
import numpy as np
import pytest
from lxml import etree

from rlv_landing import Landing, Parameters
from rlv_landing.cli import run
from rlv_landing.parameters import parameters_of
from rlv_landing.presets import read_toml
from rlv_landing.quantities import OUTPUT_NAMES, flat_name
from rlv_ros_bridge.commands.group import main
from rlv_ros_bridge.fmu.description import own_vehicle
from rlv_ros_bridge.logs.bag_reader import open_log
from rlv_ros_bridge.logs.history import read_history

ROOT = Path(__file__).resolve().parents[3]
# a stage of 25 t, the prototype's lengths times 5.2; stiffness and damping to match
STAGE = """
[vehicle]
mass = "25 t"
inertia = 4.4e5
footpad_mass = { value = 590, source = "weighed <twice> & again" }
[main_strut]
joint_radius = 2.31
joint_depth = 5.74
length = 7.42
area_upper = "250 cm2"
area_lower = "310 cm2"
volume_upper = "26 L"
volume_lower = "23 L"
stroke_max = "260 mm"
orifice_area_compression = "200 mm2"
orifice_area_rebound = "200 mm2"
[auxiliary_strut]
joint_radius = 2.41
joint_depth = 7.87
length = 5.95
stiffness = 1.1e8
damping = 5e5
[ground]
stiffness = 1e9
damping = 2e5
[drop]
contact_time = "600 ms"
vertical_velocity = -4.2
pitch_rate = "2 deg/s"
tilt = "-3 deg"
"""


def installed(folder: Path) -> Path:
    """The packages as an installation has them: no C sources beside, a compiled front in them."""
    build = ["setup.py", "-q", "build_py", "--build-lib", str(folder)]
    done = subprocess.run(
        [sys.executable, *build], cwd=ROOT, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    assert "compiled fronts of the FMU: linux64" in done.stdout
    core = Path("rlv_landing") / "core"
    for file in (ROOT / "fmu_src" / core).glob("compiled.*"):
        (folder / core / file.name).write_bytes(file.read_bytes())
    return folder


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    return installed(tmp_path_factory.mktemp("site"))


@pytest.fixture(scope="module")
def build(site, tmp_path_factory):
    """Runs `fmu build` of the installed package, with no C compiler to be had."""
    folder = tmp_path_factory.mktemp("empty")
    (folder / "stage.toml").write_text(STAGE)

    def built(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "rlv_ros_bridge", "fmu", "build", *arguments],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=300,
            env={**os.environ, "PYTHONPATH": str(site), "CC": "/bin/false", **environment},
        )

    return folder, built


@pytest.fixture(scope="module")
def stage(build) -> Path:
    """The FMU of the stage."""
    folder, built = build
    done = built("--parameters", "stage.toml", "--name", "Stage25", "--mode", "1-2-1")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "valid; trial landing" in done.stdout
    assert sorted(p.name for p in folder.iterdir()) == ["Stage25.fmu", "stage.toml"]
    return folder / "Stage25.fmu"


@pytest.fixture(scope="module")
def parameters(stage) -> Parameters:
    return read_toml(stage.with_name("stage.toml")).for_mode("1-2-1")


@pytest.fixture(scope="module")
def flat(build) -> Path:
    """The FMU of the stage in its other mode, with flat names and no compiled core."""
    folder, built = build
    options = ["--name", "Stage25", "--flat-names", "--pure", "-o", "flat.fmu"]
    done = built("--parameters", "stage.toml", *options)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "flat.fmu"


@pytest.fixture
def command(monkeypatch, capsys):
    """Runs a command of the bridge in this process; exit code, output, errors."""

    def called(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["rlv-landing", *map(str, arguments)])
        code = run(main)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return called


def test_the_fmu_lands_the_vehicle_to_the_same_digits(stage, parameters):
    names = list(OUTPUT_NAMES)
    result = fmpy.simulate_fmu(str(stage), stop_time=1.0, output_interval=1e-3, output=names)
    history = Landing(parameters).run(1.0, 1e-3)
    assert len(result) == len(history)
    assert history["leg[1].main_strut.force"].min() < -1e5
    for name in names:
        assert np.array_equal(result[name], history[name]), name


def test_its_description_is_of_the_vehicle(stage, parameters):
    description = fmpy.read_model_description(str(stage))
    assert (description.modelName, description.coSimulation.modelIdentifier) == ("Stage25",) * 2
    assert "2.736e+04 kg on four legs, 1-2-1 at 4.2 m/s (stage.toml)" in description.description
    assert float(description.defaultExperiment.stopTime) == 2.0
    variables = {v.name: v for v in description.modelVariables}
    for name, q in parameters_of("1-2-1").items():
        start = variables[name].start
        assert (start if q.kind == "string" else float(start)) == parameters[name]
    binaries = [n for n in ZipFile(stage).namelist() if n.startswith("binaries/linux64/")]
    assert binaries == ["binaries/linux64/Stage25.so"]


def test_the_wheels_front_fits_a_landing_in_space_on_any_legs(build):
    folder, built = build
    options = ["--set", "drop.mode=space", "--set", "vehicle.legs=8", "-o", "eight.fmu"]
    done = built(*options)
    assert done.returncode == 0, done.stdout + done.stderr
    names = {v.name for v in fmpy.read_model_description(str(folder / "eight.fmu")).modelVariables}
    assert "peak.leg[8].contact.force.max_time" in names


def test_its_page_and_drawing_are_of_the_vehicle(stage, fmu):
    ours, theirs = ZipFile(stage), ZipFile(fmu)
    assert ours.read("model.png") != theirs.read("model.png")
    text = ours.read("documentation/index.html").replace(b"<!DOCTYPE html>", b"")
    page = etree.fromstring(text)
    cells = {
        row[0].text: [cell.text for cell in row]
        for row in page.xpath("//tbody/tr[td[@class='id']]")
    }
    assert cells["vehicle.mass"][2] == "25000"
    assert "weighed <twice> & again" in cells["vehicle.footpad_mass"]
    assert page.findtext(".//h1") == "Stage25"


def test_every_vehicle_has_a_guid_and_modules_of_its_own_and_the_same_one_the_same_bytes(
    build, stage, flat, fmu
):
    guids = {fmpy.read_model_description(str(f)).guid for f in (stage, flat, fmu)}
    assert len(guids) == 3
    folder, built = build
    options = ("--parameters", "stage.toml", "--name", "Stage25", "--mode", "1-2-1")
    assert built(*options, "-o", "again.fmu", PYTHONHASHSEED="5").returncode == 0
    assert (folder / "again.fmu").read_bytes() == stage.read_bytes()


def test_in_fmi_3_the_front_of_the_package_lands_the_vehicle_too(build, parameters):
    folder, built = build
    options = ("--parameters", "stage.toml", "--mode", "1-2-1", "--fmi", "3", "-o", "three.fmu")
    done = built(*options)
    assert done.returncode == 0, done.stdout + done.stderr
    wanted = ["body.y", "leg.main_strut.force"]
    result = fmpy.simulate_fmu(
        str(folder / "three.fmu"), stop_time=0.7, output_interval=1e-2, output=wanted
    )
    landing = Landing(parameters)
    landing.advance_to(result["time"][-1])
    assert result["body.y"][-1] == landing.get("body.y")
    assert list(result["leg.main_strut.force"][-1]) == [
        landing.get(f"leg[{leg}].main_strut.force") for leg in (1, 2, 3, 4)
    ]


def test_flat_names_have_neither_dots_nor_brackets_and_land_equally(flat, stage):
    description = fmpy.read_model_description(
        str(flat), validate=True, validate_variable_names=True, validate_model_structure=True
    )
    names = [v.name for v in description.modelVariables]
    structured = [v.name for v in fmpy.read_model_description(str(stage)).modelVariables]
    assert names == [flat_name(name) for name in structured]
    assert len(set(names)) == len(names)
    assert not [name for name in names if not name.isidentifier()]
    wanted = ["leg1_main_strut_force", "body_y", "solver_compiled"]
    result = fmpy.simulate_fmu(str(flat), stop_time=0.7, output_interval=1e-2, output=wanted)
    landing = Landing(read_toml(flat.with_name("stage.toml")))
    landing.advance_to(result["time"][-1])
    assert result["body_y"][-1] == landing.get("body.y")
    assert result["leg1_main_strut_force"][-1] == landing.get("leg[1].main_strut.force")
    assert not result["solver_compiled"][-1]


def test_what_cannot_be_built_is_refused_in_one_line(command, stage, monkeypatch):
    folder = stage.parent
    monkeypatch.chdir(folder)
    before = sorted(folder.iterdir())
    for arguments, reason in (
        (["--parameters", "stage.toml", "-o", str(stage)], "exists; --force overwrites it"),
        (["--name", "9x"], "model name '9x' must be letters, digits and underscores"),
        (["--name", "ä"], "must be letters"),
        (["--name", "a" * 65], "65 characters; at most 64"),
        (["--fmi", "4"], "FMI 4 FMUs cannot be built; the versions are 2, 3"),
        (["-o", "x.zip"], "x.zip must end in .fmu"),
        (["-o", "nosuch/x.fmu"], "there is no folder nosuch"),
        (["--set", "vehicle.mass=0"], "vehicle.mass = 0 kg is outside"),
        (["--set", "drop.contact_time=30"], "drop.contact_time = 30 s"),
    ):
        code, out, errors = command("fmu", "build", *arguments)
        assert (code, out) == (2, ""), arguments
        assert reason in errors
        assert errors.count("\n") == 1
    assert sorted(folder.iterdir()) == before


def test_without_a_front_that_fits_a_compiler_is_needed(site, build):
    """A record of other sources is one of a front that does not fit."""
    folder, built = build
    record = site / "fmu_build" / "fronts" / "compiled" / "made.json"
    whole = record.read_text()
    record.write_text(whole.replace('"made_of": "', '"made_of": "0'))
    try:
        done = built("-o", "none.fmu", CC="/nonexistent/cc")
    finally:
        record.write_text(whole)
    assert done.returncode == 1
    assert done.stderr.startswith("error: there is no C compiler /nonexistent/cc")
    assert not (folder / "none.fmu").exists()


def test_missing_packages_are_named_with_the_extra_that_has_them(command, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pythonfmu", None)
    monkeypatch.chdir(tmp_path)
    code, _, errors = command("fmu", "build")
    assert code == 2
    assert 'needs pythonfmu, which is missing; install it with pip install "rlv-landing[fmu]"' in (
        errors
    )


def test_info_shows_vehicle_platforms_core_and_starts(command, stage):
    code, out, _ = command("fmu", "info", stage)
    assert code == 0
    for text in ("Stage25", "linux64", "compiled.abi3.so", "1-2-1", "25000", "leg[1].main_strut"):
        assert text in out, text


def test_simulate_is_simulate_of_the_same_vehicle(command, stage, flat, tmp_path, monkeypatch):
    from rlv_landing.cli import cli

    files = [tmp_path / name for name in ("fmu.csv", "flat.csv", "python.csv", "fmu.png")]
    options = ["--until", "0.68", "--every", "2e-3"]
    assert (
        command("fmu", "simulate", stage, *options, "--output", files[0], "--plot", files[3])[0]
        == 0
    )
    one = ["--set", "drop.mode=1-2-1"]
    assert command("fmu", "simulate", flat, *options, *one, "--output", files[1])[0] == 0
    toml = stage.with_name("stage.toml")
    arguments = ["simulate", "--parameters", toml, *one, *options, "--output", files[2]]
    monkeypatch.setattr(sys, "argv", ["rlv-landing", *map(str, arguments)])
    assert run(cli) == 0
    assert files[0].read_bytes() == files[2].read_bytes()
    assert files[1].read_bytes() == files[2].read_bytes()
    assert files[3].read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_the_node_lands_the_fmus_vehicle_unless_another_is_given(stage, parameters, fmu, tmp_path):
    assert own_vehicle(fmu) is None
    assert own_vehicle(tmp_path / "nosuch.fmu") is None
    own = {name: parameters[name] for name in parameters_of("1-2-1")}
    assert own_vehicle(stage) == Parameters().with_values(own)
    short = ("node", "--fmu", stage, "--realtime-factor", "0", "--stop-time", "0.01")
    for options, mass in (((), 25e3), (("--set", "vehicle.mass=26000"), 26e3)):
        log = tmp_path / f"log{mass:g}"
        done = bridge_tools.run(*short, *options, "--record", log)
        assert done.returncode == 0, done.stderr
        landed = read_history(open_log(log))[0].parameters
        expected = own_vehicle(stage).with_values({"vehicle.mass": mass})
        assert dict(landed.items()) == dict(expected.items())
        names = parameters_of("1-2-1")
        assert [landed.source(n) for n in names] == [expected.source(n) for n in names]


def test_a_front_library_without_a_place_for_its_guid_is_refused(binary):
    from fmu_build.fronts import prebuilt

    with pytest.raises(SystemExit, match="has no place for an identity"):
        prebuilt.identified(b"no mark", b"")
