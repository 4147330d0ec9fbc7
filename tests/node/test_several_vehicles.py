"""Vehicles side by side: each has its own frames, and joint states under ROS's usual name."""

from __future__ import annotations

from pathlib import Path

import pytest
from bridge_tools import Listener, by_topic, one_error_line, record, run
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.verification.verify import verify
from rlv_ros_bridge.messages.topics import STRUTS

STORE = get_typestore(Stores.ROS2_KILTED)


def test_all_frames_but_the_map_have_the_prefix_and_the_log_repeats(
    fmu: Path, tmp_path: Path
) -> None:
    prefix = ("--ros-args", "-p", "frame_prefix:=stage_1/")
    log = record(fmu, tmp_path / "log", "--stop-time", 0.05, *prefix)
    frames, parents = set(), set()
    with AnyReader([log], default_typestore=STORE) as reader:
        for connection, _, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            if connection.topic == "/tf":
                for t in message.transforms:
                    frames.add(t.child_frame_id)
                    parents.add(t.header.frame_id)
            elif hasattr(message, "header"):
                frames.add(message.header.frame_id)
            if hasattr(message, "child_frame_id"):
                frames.add(message.child_frame_id)
    frames -= {""}
    assert {f for f in frames | parents if not f.startswith("stage_1/")} == {"map"}
    own = {"base_link", "odom", "top_sensor", "leg_4_footpad", "leg_1_main_strut_rod"}
    assert {f"stage_1/{name}" for name in own} <= frames
    assert verify(LogReader(log)).first is None


@pytest.mark.parametrize("prefix", ["/stage", "a b/", "x" * 300])
def test_a_prefix_that_no_frame_may_have_is_refused(prefix: str, fmu: Path) -> None:
    done = run("node", "--fmu", fmu, "--no-record", "--ros-args", "-p", f"frame_prefix:='{prefix}'")
    assert done.returncode == 2
    assert "cannot begin the name of a frame" in one_error_line(done)


def test_struts_are_remapped_to_joint_states(fmu: Path, tmp_path: Path, domain: int) -> None:
    listener = Listener({"/landing/joint_states": STRUTS.type_name}, tmp_path, domain)
    try:
        options = ("--no-record", "--stop-time", 0.05, "--wait-for-subscribers", 1)
        remap = ("--ros-args", "-r", "struts:=joint_states")
        done = run("node", "--fmu", fmu, *options, *remap, domain=domain)
        assert done.returncode == 0, done.stderr
        received = by_topic(listener.finish())
    finally:
        listener.stop()
    assert len(received["/landing/joint_states"]) == 51
