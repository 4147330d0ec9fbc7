"""Replay, seen from another process."""

from __future__ import annotations

import signal
import struct
import subprocess
from collections import Counter
from pathlib import Path

import numpy as np
from bridge_tools import TIMEOUT, Listener, ReceivedMessage, by_topic, run, start

from rlv_ros_bridge.logs.reader import LogMessage, LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.topics import CLOCK, TF


def contents(log: Path) -> tuple[list[LogMessage], dict[str, str]]:
    """The messages of a log that can be published here, and their topics' types, `struts` last.

    All but `/tf` can.
    """
    reader = LogReader(log)
    messages = [message for message in reader.messages() if message.topic != TF.name]
    channels = sorted(reader.channels.values(), key=lambda c: c.topic.endswith("/struts"))
    types = {c.topic: c.type_name for c in channels if c.topic != TF.name}
    return messages, types


def play(
    log: Path,
    types: dict[str, str],
    expected: dict[str, int],
    folder: Path,
    domain: int,
    *options: object,
) -> list[ReceivedMessage]:
    """The messages that another process receives from a replay."""
    listener = Listener(types, folder, domain, expected)
    try:
        done = run("replay", log, "--wait-for-subscribers", 1, *options, domain=domain)
        assert done.returncode == 0, done.stderr
        return listener.finish()
    finally:
        listener.stop()


def test_a_replay_recorded_again_is_the_same_log_with_the_same_timing(
    one_log: Path, tmp_path: Path, domain: int
) -> None:
    original, types = contents(one_log)
    received = play(one_log, types, dict(Counter(m.topic for m in original)), tmp_path, domain)
    recorder = Recorder(
        tmp_path / "again", [RecordedTopic(name, kind, TELEMETRY) for name, kind in types.items()]
    )
    for message in received:
        recorder.write(message.topic, message.receive_time, message.data)
    recorder.close()
    again, _ = contents(tmp_path / "again")
    assert [(m.topic, m.data) for m in again] == [(m.topic, m.data) for m in original]
    for topic in ("/landing/struts", "/landing/leg_4/contact"):
        spacing_then = np.diff([m.log_time for m in original if m.topic == topic])
        spacing_now = np.diff([m.log_time for m in again if m.topic == topic])
        assert np.median(np.abs(spacing_now - spacing_then)) < 1e6


def test_a_part_of_the_log_can_be_played_at_another_rate(
    one_log: Path, tmp_path: Path, domain: int
) -> None:
    original, _ = contents(one_log)
    chosen = [
        m
        for m in original
        if m.topic in ("/landing/pose", "/landing/struts")
        and 200_000_000 <= m.log_time <= 300_000_000
    ]
    types = {
        "/landing/pose": "geometry_msgs/msg/PoseStamped",
        "/landing/struts": "sensor_msgs/msg/JointState",
    }
    options = (
        "--start",
        0.2,
        "--duration",
        0.1,
        "--rate",
        0.25,
        "--topics",
        "struts,/landing/pose",
    )
    received = play(one_log, types, dict.fromkeys(types, 101), tmp_path, domain, *options)
    assert [(m.topic, m.data) for m in received] == [(m.topic, m.data) for m in chosen]
    struts = [m.source_time for m in received if m.topic == "/landing/struts"]
    assert np.median(np.abs(np.diff(struts) - 4e6)) < 1e6


def test_topics_are_played_under_other_names(one_log: Path, tmp_path: Path, domain: int) -> None:
    original, types = contents(one_log)
    kind = types["/landing/struts"]
    remap = ("--remap", "struts:=recorded/struts", "--remap", "/landing/pose:=/elsewhere")
    names = {"/landing/struts": "/landing/recorded/struts", "/landing/pose": "/elsewhere"}
    heard_types = {
        "/elsewhere": types["/landing/pose"],
        "/landing/struts": kind,
        "/landing/recorded/struts": kind,
    }
    expected = {"/elsewhere": 1001, "/landing/recorded/struts": 1001}
    received = play(
        one_log, heard_types, expected, tmp_path, domain, "--topics", "struts,pose", *remap
    )
    assert [(m.topic, m.data) for m in received] == [
        (names[m.topic], m.data) for m in original if m.topic in names
    ]


def test_time_never_runs_backwards_when_a_replay_loops(
    one_log: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    types = {
        "/landing/markers": "visualization_msgs/msg/MarkerArray",
        CLOCK.name: CLOCK.type_name,
        "/landing/struts": "sensor_msgs/msg/JointState",
    }
    listener = Listener(types, tmp_path, domain, announce=350)
    try:
        options = (
            "--loop",
            "--duration",
            0.1,
            "--clock",
            200,
            "--topics",
            "struts,markers",
            "--wait-for-subscribers",
            1,
        )
        node = start("replay", one_log, *options, domain=domain)
        processes.append(node)
        listener.wait_for_announcement()
        node.send_signal(signal.SIGINT)
        _, err = node.communicate(timeout=TIMEOUT)
        received = by_topic(listener.finish())
    finally:
        listener.stop()
    assert (node.returncode, err) == (130, "")
    for topic, offset in ((CLOCK.name, 4), ("/landing/struts", 4), ("/landing/markers", 8)):
        stamps = [struct.unpack_from("<iI", data, offset) for data in received[topic]]
        assert stamps == sorted(stamps), topic
        assert stamps[-1] > (0, 300_000_000)
    stamps = [
        s * 10**9 + ns
        for s, ns in (struct.unpack_from("<iI", data, 4) for data in received["/landing/struts"])
    ]
    assert set(np.diff(stamps)) == {1_000_000}


def test_a_cut_log_is_played_as_far_as_it_goes_and_reported_as_cut(
    one_log: Path, tmp_path: Path, domain: int
) -> None:
    (whole,) = one_log.glob("*.mcap")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    done = run("replay", cut, "--rate", 100, domain=domain)
    assert done.returncode == 3
    assert (
        done.stderr.strip()
        == f"warning: {cut} is cut: its writer did not finish it; all up to there was read"
    )
