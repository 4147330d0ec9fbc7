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
import rclpy
from bridge_tools import ROOT, TIMEOUT, Listener, by_topic, command, environment, only_stalls, run, start
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient

from rlv_ros_bridge.log_reader import LogReader
from rlv_ros_bridge.topics import CLOCK, LATCHED, RECORDED, STRUTS, resolve

# `struts` last: a node that waits for a match on it finds the others matched. What is latched came before.
TOPICS = {resolve("landing", t.name): t.type_name for t in (*(t for t in RECORDED[1:] if t not in LATCHED), STRUTS)}
SAMPLES = 1001


def test_a_subscriber_in_another_process_gets_every_sample_as_it_is_in_the_log(fmu: Path, tmp_path: Path, domain: int) -> None:
    folder = tmp_path / "log"
    listener = Listener(TOPICS, tmp_path, domain)
    try:
        done = run("node", "--fmu", fmu, "--record", folder, "--wait-for-subscribers", 1, domain=domain)
        assert done.returncode == 0, done.stderr
        heard = listener.finish()
    finally:
        listener.stop()
    logged: dict[str, list[bytes]] = {}
    for message in LogReader(folder).messages():
        if message.topic in TOPICS:
            logged.setdefault(message.topic, []).append(message.data)
    received = by_topic(heard)
    assert {name: len(messages) for name, messages in received.items()} == {name: len(messages) for name, messages in logged.items()}
    assert sum(len(messages) == SAMPLES for messages in received.values()) == 11
    assert received == logged


def test_the_clock_goes_out_with_every_step_and_carries_simulation_time(fmu: Path, tmp_path: Path, domain: int) -> None:
    # Best effort by its nature: a depth of 1. At a tenth of real time each one arrives.
    listener = Listener({CLOCK.name: CLOCK.type_name, "/landing/struts": STRUTS.type_name}, tmp_path, domain)
    try:
        more = ("--stop-time", 0.1, "--realtime-factor", 0.1, "--no-record")
        done = run("node", "--fmu", fmu, "--wait-for-subscribers", 1, *more, domain=domain)
        assert done.returncode == 0, done.stderr
        heard = by_topic(listener.finish())
    finally:
        listener.stop()
    assert [struct.unpack_from("<iI", data, 4) for data in heard["/clock"]] == [(0, k * 1_000_000) for k in range(101)]
    assert len(heard["/landing/struts"]) == 101


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_in_mid_landing_leaves_a_complete_log(
    number: int, code: int, fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    folder = tmp_path / "log"
    listener = Listener({"/landing/struts": STRUTS.type_name}, tmp_path, domain, announce=300)
    try:
        node = start("node", "--fmu", fmu, "--record", folder, "--stop-time", 20, "--wait-for-subscribers", 1, domain=domain)
        processes.append(node)
        listener.wait_for_announcement()
        node.send_signal(number)
        out, err = node.communicate(timeout=TIMEOUT)
        heard = by_topic(listener.finish())["/landing/struts"]
    finally:
        listener.stop()
    assert node.returncode == code, err
    assert only_stalls(err), err
    reader = LogReader(folder)
    logged = [m.data for m in reader.messages(["/landing/struts"])]
    assert not reader.cut
    assert (folder / "metadata.yaml").is_file()
    assert 300 <= len(logged) < 20000
    assert [m for m in logged if m not in set(heard)] == []
    assert logged == heard
    assert f"interrupted: {len(logged)} samples" in out


def test_a_subscriber_that_freezes_does_not_keep_the_node_from_its_end(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    listener = Listener(TOPICS, tmp_path, domain, announce=100)
    try:
        node = start("node", "--fmu", fmu, "--no-record", "--wait-for-subscribers", 1, domain=domain)
        processes.append(node)
        listener.wait_for_announcement()
        os.kill(listener.process.pid, signal.SIGSTOP)
        out, err = node.communicate(timeout=TIMEOUT)
    finally:
        os.kill(listener.process.pid, signal.SIGCONT)
        listener.stop()
    assert node.returncode == 0, err
    assert "finished: 1001 samples" in out
    assert "not every reliable subscriber has acknowledged" in err


def test_the_node_runs_without_a_home_folder_and_leaves_nothing_behind(fmu: Path, tmp_path: Path) -> None:
    env = environment(TMPDIR=str(tmp_path))
    for name in ("HOME", "ROS_LOG_DIR", "ROS_HOME"):
        env.pop(name, None)
    line = command("node", "--fmu", fmu, "--no-record", "--realtime-factor", 0, "--stop-time", 0.1)
    done = subprocess.run(line, env=env, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith("rlv-landing-fmu")] == []


def test_settings_come_by_ros_arguments_too(fmu: Path, tmp_path: Path) -> None:
    ros = ("--ros-args", "-p", "mode:=1-2-1", "-p", "vehicle.mass:=200", "-p", "stop_time:=0.05", "-r", "__ns:=/tests")
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


def test_parameters_can_be_read_but_not_changed_while_it_lands(
    fmu: Path, domain: int, processes: list[subprocess.Popen[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    node = start("node", "--fmu", fmu, "--no-record", "--stop-time", 30, "--set", "vehicle.mass=200", domain=domain)
    processes.append(node)
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    try:
        asking = Node("asking", context=context)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(asking)
        client = AsyncParameterClient(asking, "/landing/landing_node")
        assert client.wait_for_services(TIMEOUT)
        read = client.get_parameters(["vehicle.mass", "mode", "main_strut.length"])
        executor.spin_until_future_complete(read, timeout_sec=TIMEOUT)
        mass, mode, length = read.result().values
        assert (mass.double_value, mode.string_value, length.double_value) == (200.0, "2-2", 1.426)
        changed = client.set_parameters([Parameter("vehicle.mass", value=100.0)])
        executor.spin_until_future_complete(changed, timeout_sec=TIMEOUT)
        assert not changed.result().results[0].successful
        executor.shutdown()
        asking.destroy_node()
    finally:
        rclpy.shutdown(context=context)
    node.send_signal(signal.SIGINT)
    _, err = node.communicate(timeout=TIMEOUT)
    assert node.returncode == 130
    assert only_stalls(err), err


def test_help_teaches_without_loading_ros(tmp_path: Path) -> None:
    line = "import sys; from rlv_ros_bridge.__main__ import main; main(['node', '--help'], standalone_mode=False); "
    line += "print(sorted({'rclpy', 'fmpy', 'mcap'} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", line], env=environment(), capture_output=True, text=True, timeout=TIMEOUT, check=False, cwd=ROOT
    )
    assert "Examples:" in done.stdout
    assert done.stdout.strip().endswith("[]")
