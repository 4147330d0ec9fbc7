"""The node as `ros2 run` and `ros2 launch` start it."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from bridge_tools import TIMEOUT, Listener, environment, one_error_line

from rlv_ros_bridge.fmu.installed import installed_fmu
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.messages.topics import STRUTS
from rlv_ros_bridge.ros.parameter_files import shared_names

ENTRY = "import sys; from rlv_ros_bridge.node.start import main; sys.exit(main())"
SHARED = """
/**:
  ros__parameters:
    robot_radius: 0.3
    controller: {gain: 2.0}
    stop_time: 0.02
    qos_overrides: {/elsewhere: {publisher: {depth: 3}}}
/landing/landing_node:
  ros__parameters: {realtime_factor: 0.0}
"""


def line(fmu: Path, *more: object) -> list[str]:
    given = [f"fmu:={fmu}", *map(str, more)]
    ros = [text for pair in given for text in ("-p", pair)]
    return [sys.executable, "-c", ENTRY, "--ros-args", "-r", "__ns:=/landing", *ros]


def run_entry(
    fmu: Path, tmp_path: Path, *more: object, files: tuple[Path, ...] = ()
) -> subprocess.CompletedProcess[str]:
    named = [text for file in files for text in ("--params-file", str(file))]
    return subprocess.run(
        [*line(fmu, *more), *named],
        env=environment(),
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_a_clean_end_with_outcome_and_log(
    number: int,
    fmu: Path,
    tmp_path: Path,
    domain: int,
    processes: list[subprocess.Popen[str]],
) -> None:
    listener = Listener({"/landing/struts": STRUTS.type_name}, tmp_path, domain, announce=20)
    try:
        settings = ("stop_time:=60.0", f"log_root:={tmp_path}/logs", "wait_for_subscribers:=1")
        node = subprocess.Popen(
            line(fmu, *settings),
            env=environment(domain),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        processes.append(node)
        listener.wait_for_announcement()
        node.send_signal(number)
        out, err = node.communicate(timeout=TIMEOUT)
    finally:
        listener.stop()
    assert node.returncode == 0, err
    assert "Traceback" not in err
    (log,) = (tmp_path / "logs").iterdir()
    assert "interrupted: " in out
    assert f"log: {log}" in out
    reader = LogReader(log)
    assert len(list(reader.messages(["/landing/struts"]))) >= 20
    assert not reader.cut


def test_what_a_file_gives_to_every_node_is_ignored_with_a_warning(
    fmu: Path, tmp_path: Path
) -> None:
    file = tmp_path / "shared.yaml"
    file.write_text(SHARED)
    done = run_entry(fmu, tmp_path, files=(file,))
    assert done.returncode == 0, done.stderr
    assert "finished: 21 samples" in done.stdout
    (warning,) = (part for part in done.stderr.splitlines() if "WARN" in part)
    for name in ("robot_radius", "controller.gain", "qos_overrides./elsewhere.publisher.depth"):
        assert name in warning


@pytest.mark.parametrize(
    "name", ["vehicle.mas", "qos_overrides./landing/pos.publisher.depth", "robot_radius"]
)
def test_what_is_given_to_this_node_by_a_wrong_name_is_refused(
    name: str, fmu: Path, tmp_path: Path
) -> None:
    file = tmp_path / "shared.yaml"
    file.write_text(SHARED)
    done = run_entry(fmu, tmp_path, f"{name}:=3", files=(file,))
    assert done.returncode == 2
    refused = one_error_line(done)
    assert name in refused


def test_names_that_files_share_are_told_from_those_for_one_node(tmp_path: Path) -> None:
    one, two = tmp_path / "one.yaml", tmp_path / "two.yaml"
    one.write_text(SHARED)
    two.write_text("/*:\n  landing_node:\n    ros__parameters: {robot_radius: 1.0}\n")
    assert shared_names(["--params-file", str(one), "-p", "n:stop_time:=1.0"]) == {
        "robot_radius",
        "controller.gain",
        "qos_overrides./elsewhere.publisher.depth",
    }
    both = shared_names(["--ros-args", "--params-file", str(one), "--params-file", str(two)])
    assert "robot_radius" not in both


def test_the_fmu_is_that_of_the_installation_wherever_it_is_called_from() -> None:
    checkout = Path("/home/me/project/ros_bridge/rlv_ros_bridge")
    assert installed_fmu(checkout) == Path("/home/me/project/build/RlvLanding.fmu")
    workspace = Path("/ws/install/rlv_ros_bridge/lib/python3.12/site-packages/rlv_ros_bridge")
    share = Path("/ws/install/rlv_ros_bridge/share/rlv_ros_bridge/fmu/RlvLanding.fmu")
    assert installed_fmu(workspace) == share
