"""The landing node, seen from other processes."""

from __future__ import annotations

import os
import re
import signal
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from bridge_tools import (
    ROOT,
    TIMEOUT,
    Listener,
    by_topic,
    command,
    complaints,
    environment,
    only_stalls,
    run,
    start,
)
from rclpy.qos import ReliabilityPolicy
from remote import ACTIVATE, CONFIGURE, Remote
from std_msgs.msg import String

from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.messages.qos import parse_qos
from rlv_ros_bridge.messages.rclpy_qos import qos_profile
from rlv_ros_bridge.messages.topics import CLOCK, LATCHED, RECORDED, STRUTS, TF, resolve
from rlv_ros_bridge.node.land import land
from rlv_ros_bridge.ros.setup import StopFlag

# `struts` last: a node that waits for a match on it finds the others matched. What is latched came
# before.
TOPICS = {
    resolve("landing", t.name): t.type_name
    for t in (*(t for t in RECORDED[1:] if t not in (*LATCHED, TF)), STRUTS)
}
SAMPLES = 1001


def test_a_subscriber_in_another_process_gets_every_sample_as_it_is_in_the_log(
    fmu: Path, tmp_path: Path, domain: int
) -> None:
    folder = tmp_path / "log"
    listener = Listener(TOPICS, tmp_path, domain)
    try:
        done = run(
            "node", "--fmu", fmu, "--record", folder, "--wait-for-subscribers", 1, domain=domain
        )
        assert done.returncode == 0, done.stderr
        received = listener.finish()
    finally:
        listener.stop()
    logged: dict[str, list[bytes]] = {}
    for message in LogReader(folder).messages():
        if message.topic in TOPICS:
            logged.setdefault(message.topic, []).append(message.data)
    by_name = by_topic(received)
    assert {name: len(messages) for name, messages in by_name.items()} == {
        name: len(messages) for name, messages in logged.items()
    }
    assert sum(len(messages) == SAMPLES for messages in by_name.values()) == 13
    assert by_name == logged


def test_the_clock_is_published_at_every_step_and_carries_simulation_time(
    fmu: Path, tmp_path: Path, domain: int
) -> None:
    # The clock has a depth of 1. At a tenth of real time every message arrives.
    listener = Listener(
        {CLOCK.name: CLOCK.type_name, "/landing/struts": STRUTS.type_name}, tmp_path, domain
    )
    try:
        more = ("--stop-time", 0.1, "--realtime-factor", 0.1, "--no-record")
        done = run("node", "--fmu", fmu, "--wait-for-subscribers", 1, *more, domain=domain)
        assert done.returncode == 0, done.stderr
        received = by_topic(listener.finish())
    finally:
        listener.stop()
    times = [struct.unpack_from("<iI", data, 4) for data in received["/clock"]]
    # it stands until the landing starts, at a time at which ROS takes it for started
    assert list(dict.fromkeys(times)) == [(0, max(1, k * 1_000_000)) for k in range(101)]
    assert times == sorted(times)
    assert len(received["/landing/struts"]) == 101


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)]
)
def test_a_signal_in_mid_landing_leaves_a_complete_log(
    number: int,
    code: int,
    fmu: Path,
    tmp_path: Path,
    domain: int,
    processes: list[subprocess.Popen[str]],
) -> None:
    folder = tmp_path / "log"
    listener = Listener({"/landing/struts": STRUTS.type_name}, tmp_path, domain, announce=300)
    try:
        node = start(
            "node",
            "--fmu",
            fmu,
            "--record",
            folder,
            "--stop-time",
            20,
            "--wait-for-subscribers",
            1,
            domain=domain,
        )
        processes.append(node)
        listener.wait_for_announcement()
        node.send_signal(number)
        out, err = node.communicate(timeout=TIMEOUT)
        received = by_topic(listener.finish())["/landing/struts"]
    finally:
        listener.stop()
    assert node.returncode == code, err
    # After Ctrl-C the node waits only briefly for slow subscribers, and reports what is missing.
    cut_off = [line for line in complaints(err) if "acknowledged" in line]
    assert only_stalls("\n".join(line for line in err.splitlines() if line not in cut_off)), err
    reader = LogReader(folder)
    logged = [m.data for m in reader.messages(["/landing/struts"])]
    assert not reader.cut
    assert (folder / "metadata.yaml").is_file()
    assert 300 <= len(logged) < 20000
    assert received == logged[: len(received)]
    assert cut_off or len(received) == len(logged)
    assert f"interrupted: {len(logged)} samples" in out


def test_a_signal_before_the_landing_begins_leaves_no_landing_and_no_log(
    fmu: Path, tmp_path: Path, domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in environment(domain).items():
        monkeypatch.setenv(name, value)
    folder = tmp_path / "log"
    with StopFlag() as stop:
        signal.raise_signal(signal.SIGINT)
        assert land({"fmu": str(fmu), "record": str(folder)}, [], stop) is None
        assert stop.number == signal.SIGINT
    assert not folder.exists()


def wall(out: str) -> float:
    """The wall time of a landing that the node reports."""
    return float(re.search(r"s in ([0-9.]+) s", out)[1])  # type: ignore[index]


def test_a_frozen_subscriber_neither_slows_the_node_down_nor_makes_the_log_incomplete(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    walls = []
    for frozen in (False, True):
        listener = Listener(TOPICS, tmp_path, domain, announce=100)
        options = (
            "--record",
            tmp_path / f"log-{frozen}",
            "--stop-time",
            5,
            "--wait-for-subscribers",
            1,
        )
        try:
            node = start("node", "--fmu", fmu, *options, domain=domain)
            processes.append(node)
            listener.wait_for_announcement()
            if frozen:
                os.kill(listener.process.pid, signal.SIGSTOP)
            out, err = node.communicate(timeout=TIMEOUT)
        finally:
            os.kill(listener.process.pid, signal.SIGCONT)
            listener.stop()
        assert node.returncode == 0, err
        assert "finished: 5001 samples" in out
        walls.append(wall(out))
    # Plain writes to a frozen subscriber would make each of the last three seconds take four: 9 s
    # more. A busy machine takes some.
    assert walls[1] < walls[0] + 6.0
    assert "not published in time" in err
    assert "not every reliable subscriber has acknowledged" in err
    assert len(list(LogReader(tmp_path / "log-True").messages(["/landing/struts"]))) == 5001


def test_two_nodes_land_at_the_same_time_in_their_namespaces(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    types = {"/first/struts": STRUTS.type_name, "/second/struts": STRUTS.type_name}
    listener = Listener(types, tmp_path, domain, dict.fromkeys(types, 301))
    try:
        nodes = [
            start(
                *(
                    "node",
                    "--fmu",
                    fmu,
                    "--namespace",
                    name,
                    "--mode",
                    mode,
                    "--record",
                    tmp_path / name,
                    "--stop-time",
                    0.3,
                ),
                *(
                    "--wait-for-subscribers",
                    1,
                    "--ros-args",
                    "-p",
                    f"clock:={str(name == 'first').lower()}",
                ),
                domain=domain,
            )
            for name, mode in (("first", "2-2"), ("second", "1-2-1"))
        ]
        processes += nodes
        for node in nodes:
            _, err = node.communicate(timeout=TIMEOUT)
            assert node.returncode == 0, err
        received = by_topic(listener.finish())
    finally:
        listener.stop()
    for name, mode in (("first", "2-2"), ("second", "1-2-1")):
        reader = LogReader(tmp_path / name)
        assert [m.data for m in reader.messages([f"/{name}/struts"])] == received[f"/{name}/struts"]
        assert reader.metadata["mode"] == mode


def test_downsampled_topics_are_complete_in_the_log(fmu: Path, tmp_path: Path, domain: int) -> None:
    listener = Listener(
        {"/landing/pose": "geometry_msgs/msg/PoseStamped", "/landing/struts": STRUTS.type_name},
        tmp_path,
        domain,
    )
    try:
        more = (
            "--stop-time",
            0.1,
            "--wait-for-subscribers",
            1,
            "--ros-args",
            "-p",
            "publish_every.pose:=10",
        )
        done = run("node", "--fmu", fmu, "--record", tmp_path / "log", *more, domain=domain)
        assert done.returncode == 0, done.stderr
        received = by_topic(listener.finish())
    finally:
        listener.stop()
    logged = [m.data for m in LogReader(tmp_path / "log").messages(["/landing/pose"])]
    assert (len(received["/landing/struts"]), len(logged)) == (101, 101)
    assert received["/landing/pose"] == logged[::10]


RELIABILITY = {
    "telemetry": ReliabilityPolicy.RELIABLE,
    "sensor_data": ReliabilityPolicy.BEST_EFFORT,
}


@pytest.mark.parametrize("qos", RELIABILITY)
def test_the_quality_of_service_is_the_requested_one_and_is_in_the_log(
    qos: str, fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    options = (
        "--managed",
        "--realtime-factor",
        0,
        "--stop-time",
        0.01,
        "--record",
        tmp_path / "log",
        "--ros-args",
        "-p",
        f"qos:={qos}",
    )
    node = start("node", "--fmu", fmu, *options, domain=domain)
    processes.append(node)
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        (offered,) = remote.node.get_publishers_info_by_topic("/landing/struts")
        assert offered.qos_profile.reliability == RELIABILITY[qos]
        # A late subscriber still gets the description.
        assert "leg_1_main_strut" in remote.first(String, "/landing/robot_description").data
        assert remote.change(ACTIVATE)
        remote.until((tmp_path / "log" / "metadata.yaml").is_file)
    node.send_signal(signal.SIGINT)
    assert node.wait(TIMEOUT) == 130
    reader = LogReader(tmp_path / "log")
    assert list(reader.messages(["/landing/robot_description"]))
    written = parse_qos(reader.channels["/landing/struts"].qos)
    assert qos_profile(written).reliability == RELIABILITY[qos]


def test_the_node_runs_without_a_home_folder_and_leaves_nothing_behind(
    fmu: Path, tmp_path: Path
) -> None:
    env = environment(TMPDIR=str(tmp_path))
    for name in ("HOME", "ROS_LOG_DIR", "ROS_HOME"):
        env.pop(name, None)
    line = command("node", "--fmu", fmu, "--no-record", "--realtime-factor", 0, "--stop-time", 0.1)
    done = subprocess.run(
        line, env=env, capture_output=True, text=True, timeout=TIMEOUT, check=False
    )
    assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith("rlv-landing-fmu")] == []


def test_settings_come_by_ros_arguments_too(fmu: Path, tmp_path: Path) -> None:
    ros = (
        "--ros-args",
        "-p",
        "mode:=1-2-1",
        "-p",
        "vehicle.mass:=200",
        "-p",
        "stop_time:=0.05",
        "-r",
        "__ns:=/tests",
    )
    done = run("node", "--fmu", fmu, "--realtime-factor", 0, "--log-root", tmp_path / "logs", *ros)
    assert done.returncode == 0, done.stderr
    (folder,) = (tmp_path / "logs").iterdir()
    assert re.fullmatch(r"\d{8}T\d{6}Z-1-2-1", folder.name)
    reader = LogReader(folder)
    assert len(list(reader.messages(["/tests/struts"]))) == 51
    parameters = reader.parameters()
    assert parameters is not None
    assert parameters.vehicle.mass == 200.0
    assert reader.metadata["mode"] == "1-2-1"
    assert reader.namespace == "/tests"


@pytest.mark.parametrize(("at", "count"), [("joint", 1), ("footpad", 0)])
def test_the_node_warns_once_of_a_transverse_load_that_creates_energy(
    fmu: Path, at: str, count: int
) -> None:
    setting = f"vehicle.transverse_load_at={at}"
    done = run("node", "--fmu", fmu, "--no-record", "--realtime-factor", 0, "--set", setting)
    assert done.returncode == 0, done.stderr
    printed = done.stdout + done.stderr
    assert printed.count("J dissipated in a 2-2 landing") == count
    assert printed.count("set vehicle.transverse_load_at = footpad") == count


def test_help_shows_without_loading_ros(tmp_path: Path) -> None:
    code = (
        "import sys; from rlv_ros_bridge.commands.group import main\n"
        "main(['node', '--help'], standalone_mode=False)\n"
        "print(sorted({'rclpy', 'fmpy', 'mcap'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
        cwd=ROOT,
    )
    assert "Examples:" in done.stdout
    assert done.stdout.strip().endswith("[]")
