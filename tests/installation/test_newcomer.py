"""A newcomer's way in an empty folder, with the files of a wheel and no checkout."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = """\
new "my hopper" --like hopper
draw "my hopper/vehicle.toml" "my hopper/vehicle.svg"
simulate --parameters "my hopper/vehicle.toml" --output landing.csv
report "my hopper/vehicle.toml" --no-audit -o report.html
examples copy copied
fmu info "{fmu}"
fmu simulate "{fmu}" --until 0.2
"""
# where ROS 2 is
NODE_COMMANDS = """\
node --fmu "{fmu}" --record "my log" --stop-time 0.2 --realtime-factor 0 --ros-args --log-level warn
log info "my log"
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """What a wheel installs, in a folder with blanks and umlauts."""
    from fmu_build.sources import carry, carry_examples

    folder = tmp_path_factory.mktemp("für alle") / "site-packages"
    ignored = shutil.ignore_patterns("__pycache__")
    for package in ("fmu_src/rlv_landing", "fmu_src/fmu_build", "ros_bridge/rlv_ros_bridge"):
        shutil.copytree(ROOT / package, folder / Path(package).name, ignore=ignored)
    carry(folder / "fmu_build")
    carry_examples(folder / "rlv_landing" / "examples")
    return folder


def run(site: Path, *arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-W", "error::RuntimeWarning", *arguments],
        cwd=cwd,
        env={
            **os.environ,
            "PYTHONPATH": str(site),
            "XDG_CACHE_HOME": str(cwd / "cache"),
            "RLV_LANDING_PURE": "",
        },
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_the_commands_run_from_an_empty_folder(site, tmp_path, fmu):
    with_ros = find_spec("rclpy") is not None
    commands = COMMANDS + NODE_COMMANDS if with_ros else COMMANDS
    (tmp_path / "lines").write_text(commands.format(fmu=fmu))
    folder = tmp_path / "leerer Ordner ü"
    folder.mkdir()
    script = Path(__file__).with_name("newcomer.py")
    done = run(site, str(script), str(tmp_path / "lines"), cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (done.stderr, (folder / "landing.csv").is_file()) == ("", True)
    assert not with_ros or "finished: 201 samples" in done.stdout
    assert (folder / "my log" / "metadata.yaml").is_file() == with_ros
    copied = folder / "copied"
    assert {p.name for p in copied.iterdir()} >= {"envelope.toml", "ship_deck", "ros2"}
    assert (copied / "ros2" / "launch" / "landing.launch.py").is_file()
    assert (copied / "ros2" / "config" / "foxglove.json").is_file()
    for page in copied.rglob("*.md"):
        assert not {".venv", "../docs", "examples/"} & set(page.read_text().split("`")), page
        assert ".venv" not in page.read_text()


def test_the_node_of_an_installation_by_pip_has_its_fmu_in_the_users_cache(site, tmp_path):
    code = "from rlv_ros_bridge.fmu.installed import installed_fmu; print(installed_fmu())"
    done = run(site, "-c", code, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    path = Path(done.stdout.strip())
    assert path.is_relative_to(tmp_path / "cache" / "rlv-landing")
    assert path.name == "RlvLanding.fmu"


def test_a_copy_of_a_checkout_has_what_a_wheel_carries(site, tmp_path, command):
    assert command("examples", "copy", str(tmp_path / "copied")).code == 0
    carried = site / "rlv_landing" / "examples"
    names = {p.relative_to(carried) for p in carried.rglob("*") if p.is_file()}
    copied = {p.relative_to(tmp_path / "copied") for p in (tmp_path / "copied").rglob("*")}
    assert names == {p for p in copied if (tmp_path / "copied" / p).is_file()}
    again = command("examples", "copy", str(tmp_path / "copied"))
    assert (again.code, again.err.count("\n")) == (2, 1)
    assert "name a new folder" in again.err


def test_without_the_compiled_core_it_says_what_that_costs(site, tmp_path):
    uncompiled = tmp_path / "site-packages"
    shutil.copytree(site, uncompiled, ignore=shutil.ignore_patterns("compiled.*"))
    done = run(uncompiled, "-m", "rlv_landing.cli", "parameters", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (said,) = done.stderr.splitlines()
    assert "not compiled" in said
    assert "ten times as slow; an installation anew where gcc and Python.h" in said
