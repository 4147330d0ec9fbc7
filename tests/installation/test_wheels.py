"""Wheel and source distribution: made, audited, installed, and a newcomer's way with them.

Part of `make torture`: cores take minutes, and the packages that they need come from the network.
"""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.torture,
    pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="minutes of builds: make torture"),
    pytest.mark.skipif(
        sys.version_info < (3, 11), reason="wheels are made by Python 3.11 or newer"
    ),
]
ROOT = Path(__file__).resolve().parents[2]
COMMANDS = """\
new mine --like hopper
draw mine/vehicle.toml mine/vehicle.svg
simulate --parameters mine/vehicle.toml --plot landing.png --output landing.csv
sweep mine/study.toml
report mine/vehicle.toml -o report.html
report mine/vehicle.toml --no-audit -o report.pdf
envelope mine/envelope.toml --plot envelope.png
fmu build --parameters mine/vehicle.toml --name MyHopper
fmu info MyHopper.fmu
fmu simulate MyHopper.fmu --plot fmu.png
examples copy copied
"""


def run(*command: str | Path, cwd: Path, **environment: str) -> str:
    """What a command prints; it must succeed."""
    done = subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": "", **environment},
        capture_output=True,
        text=True,
        timeout=3600,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> list[Path]:
    """The source distribution, and this machine's wheel."""
    from fmu_build.installing.wheels import make

    return make(tmp_path_factory.mktemp("dist"), "own")


@pytest.fixture
def environment(tmp_path) -> Path:
    """The Python of a new environment, in a path with blanks and umlauts."""
    run(sys.executable, "-m", "venv", "für alle", cwd=tmp_path)
    return tmp_path / "für alle" / "bin" / "python"


def test_the_wheel_runs_on_old_systems(made, tmp_path):
    shown = run(sys.executable, "-m", "auditwheel", "show", made[1], cwd=tmp_path)
    assert '"manylinux_2_17_' in " ".join(shown.split())


def test_a_newcomer_lands_with_the_wheel_without_a_compiler(made, environment, tmp_path):
    run(environment, "-m", "pip", "install", "-q", f"{made[1]}[fmu,studies]", cwd=tmp_path)
    folder = tmp_path / "leerer Ordner ü"
    folder.mkdir()
    (tmp_path / "lines").write_text(COMMANDS)
    script = Path(__file__).with_name("newcomer.py")
    run(environment, script, tmp_path / "lines", cwd=folder, PATH=str(tmp_path), CC="")
    prefix = environment.parents[1]
    assert (prefix / "share" / "rlv_ros_bridge" / "launch" / "landing.launch.py").is_file()
    assert (prefix / "share/ament_index/resource_index/packages/rlv_ros_bridge").is_file()
    assert os.access(prefix / "lib" / "rlv_ros_bridge" / "landing_node", os.X_OK)
    code = "from rlv_ros_bridge.commands.node import _build_first_fmu as b; b()"
    said = run(environment, "-c", code, cwd=folder, XDG_CACHE_HOME=str(tmp_path / "cache"))
    (built,) = (tmp_path / "cache").rglob("*.fmu")
    assert said.splitlines() == [f"building the FMU, once: {built}"]


def test_the_source_distribution_installs_without_a_compiler_and_says_so(
    made, environment, tmp_path
):
    run(environment, "-m", "pip", "install", "-q", made[0], cwd=tmp_path, CC="/missing/cc")
    said = run(environment, "-m", "rlv_landing.cli", "parameters", cwd=tmp_path)
    assert "the core is not compiled" in said


def test_the_record_of_a_wheel_has_each_of_its_files(made):
    with zipfile.ZipFile(made[1]) as wheel:
        (record,) = [n for n in wheel.namelist() if n.endswith(".dist-info/RECORD")]
        names = [line.rsplit(",", 2)[0] for line in wheel.read(record).decode().splitlines()]
        assert sorted(names) == sorted(wheel.namelist())
        assert wheel.testzip() is None
