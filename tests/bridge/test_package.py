"""The bridge as an ament_python package: colcon builds it, and what it installs lands."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from bridge_tools import ROOT, TIMEOUT, environment, new_domain

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

import rlv_landing
from rlv_ros_bridge.commands.group import main as group
from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.messages.qos import LATCHED, TELEMETRY
from rlv_ros_bridge.messages.topics import CLOCK, OCCASIONAL, SAMPLED, WORLD_FRAME, resolve
from rlv_ros_bridge.messages.topics import LATCHED as LATCHED_TOPICS
from rlv_ros_bridge.node.settings import SETTINGS

PACKAGE = ROOT / "ros_bridge"
LAUNCH = PACKAGE / "launch" / "landing.launch.py"


def test_colcon_builds_the_package_and_its_node_lands(fmu: Path, tmp_path: Path) -> None:
    ignored = shutil.ignore_patterns("__pycache__", "*.egg-info", "build", "install", "log")
    shutil.copytree(PACKAGE, tmp_path / "src" / "ros_bridge", ignore=ignored)
    build = [
        str(Path(sys.executable).with_name("colcon")),
        "--log-base",
        "log",
        "build",
        "--event-handlers",
        "console_direct+",
    ]
    done = subprocess.run(
        build,
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=4 * TIMEOUT,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    installed = tmp_path / "install" / "rlv_ros_bridge"
    share = installed / "share" / "rlv_ros_bridge"
    for file in (
        "package.xml",
        "launch/landing.launch.py",
        "config/landing.yaml",
        "config/landing.rviz",
        "config/foxglove.json",
        "config/foreign_dds.xml",
        "config/record_qos.yaml",
    ):
        assert (share / file).is_file(), file
    assert (
        installed / "share" / "ament_index" / "resource_index" / "packages" / "rlv_ros_bridge"
    ).is_file()
    (site,) = (installed / "lib").glob("python*/site-packages")
    env = environment(new_domain())
    env["PYTHONPATH"] = os.pathsep.join([str(site), str(ROOT / "fmu_src")])
    # As the launch file starts it.
    line = [
        str(installed / "lib" / "rlv_ros_bridge" / "landing_node"),
        "--ros-args",
        "--params-file",
        str(share / "config" / "landing.yaml"),
    ]
    line += [
        "-p",
        # as launch gives what was written to it
        f"fmu:='{fmu}'",
        "-p",
        "realtime_factor:=0.0",
        "-p",
        "log_root:=logs",
        "-p",
        "mode:=1-2-1",
        "-r",
        "__ns:=/landing",
    ]
    done = subprocess.run(
        line, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=TIMEOUT, check=False
    )
    assert done.returncode == 0, done.stderr
    (log,) = (tmp_path / "logs").iterdir()
    assert "finished: 1001 samples" in done.stdout
    assert f"log: logs/{log.name}" in done.stdout
    assert len(history_of(LogReader(log))) == 1001


def test_the_package_declares_its_version_and_all_that_it_imports() -> None:
    package = ElementTree.parse(PACKAGE / "package.xml")
    assert package.findtext("version") == rlv_landing.__version__
    named = {e.text for e in package.iter("exec_depend")}
    imported = set()
    for file in (*(PACKAGE / "rlv_ros_bridge").rglob("*.py"), LAUNCH):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                imported.add(node.module.split(".")[0])
            elif isinstance(node, ast.Import):
                imported |= {alias.name.split(".")[0] for alias in node.names}
    ros = {
        name
        for name in imported
        if name.endswith(("_msgs", "_srvs", "_interfaces"))
        or name in ("rclpy", "launch", "launch_ros")
    }
    assert ros <= named, ros - named


def test_the_launch_file_and_its_parameter_file_name_parameters_of_the_node() -> None:
    # ROS 2's launch is not on PyPI: what can be seen without running it.
    tree = ast.parse(LAUNCH.read_text())
    tables = {
        node.targets[0].id: node.value
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    given = {name for name, _ in ast.literal_eval(tables["GIVEN"])}
    set_besides = {
        node.slice.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript)
        and isinstance(node.value, ast.Name)
        and node.value.id == "given"
        and isinstance(node.slice, ast.Constant)
    }
    assert given | set_besides == {"fmu", "mode", "frame_prefix", "realtime_factor", "log_root"}
    assert given | set_besides | {"clock", "autostart"} <= set(SETTINGS)
    values = yaml.safe_load((PACKAGE / "config" / "landing.yaml").read_text())["/**"][
        "ros__parameters"
    ]
    assert set(values) <= set(SETTINGS)


def test_rviz_subscribes_to_topics_of_the_node_with_a_quality_of_service_that_matches() -> None:
    offered = {resolve("landing", t.name): TELEMETRY for t in SAMPLED} | {
        resolve("landing", t.name): TELEMETRY for t in OCCASIONAL
    }
    offered |= {resolve("landing", t.name): LATCHED for t in LATCHED_TOPICS}
    config = yaml.safe_load((PACKAGE / "config" / "landing.rviz").read_text())
    manager = config["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == WORLD_FRAME
    shown = [d["Class"].split("/")[1] for d in manager["Displays"]]
    assert {"TF", "RobotModel", "MarkerArray", "Wrench"} <= set(shown)
    topics = [
        d[key] for d in manager["Displays"] for key in ("Topic", "Description Topic") if key in d
    ]
    for wanted in topics:
        qos = offered[wanted["Value"]]
        # a subscription may ask for no more than is offered, and what is latched must be asked for
        if wanted["Reliability Policy"] == "Reliable":
            assert qos.reliability == "reliable"
        latched = wanted["Durability Policy"] == "Transient Local"
        assert latched == (qos.durability == "transient_local")


def test_a_recorder_by_the_shipped_file_lets_as_much_wait_as_the_node() -> None:
    asked = yaml.safe_load((PACKAGE / "config" / "record_qos.yaml").read_text())
    assert set(asked) == {resolve("landing", t.name) for t in (*SAMPLED, *OCCASIONAL, CLOCK)}
    for name, qos in asked.items():
        assert qos.pop("reliability") == ("best_effort" if name == CLOCK.name else "reliable")
        kept = {"history": "keep_last", "depth": TELEMETRY.depth, "durability": "volatile"}
        assert qos == kept


def test_the_bridge_alone_has_the_commands_that_the_package_announces() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    announced = {
        name: EntryPoint(name, target, "").load()
        for name, target in project["entry-points"]["rlv_landing.commands"].items()
    }
    assert announced == group.commands


@pytest.mark.skipif(
    find_spec("launch_ros") is None,
    reason="launch_ros is not installed (there is no wheel of it): the launch file is not run",
)
def test_the_launch_file_lands(fmu: Path, tmp_path: Path) -> None:
    line = "import sys; from launch import LaunchService, LaunchDescription as D\n"
    line += "from launch.actions import IncludeLaunchDescription as I\n"
    line += "from launch.launch_description_sources import AnyLaunchDescriptionSource as S\n"
    line += "s = LaunchService()\n"
    line += "given = [a.split(':=', 1) for a in sys.argv[2:]]\n"
    line += "s.include_launch_description(D([I(S(sys.argv[1]), launch_arguments=given)]))\n"
    line += "sys.exit(s.run())"
    root = tmp_path / "it's"
    arguments = (f"fmu:={fmu}", "realtime_factor:=0", f"log_root:={root}", "mode:=1-2-1")
    done = subprocess.run(
        [sys.executable, "-c", line, str(LAUNCH), *arguments],
        env=environment(new_domain()),
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )
    printed = done.stdout + done.stderr
    assert done.returncode == 0, printed
    (log,) = root.iterdir()
    assert f"log: {log}" in printed
    assert "process has finished cleanly" in printed
