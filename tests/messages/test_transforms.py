"""`/tf` in a log, by independent readers, against `odom` and against an independent URDF parser."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yourdfpy
from bridge_tools import record
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from rlv_ros_bridge.messages.topics import BODY_FRAME, JOINTS, WORLD_FRAME
from rlv_ros_bridge.messages.transforms import Transform, serialised

STORE = get_typestore(Stores.ROS2_KILTED)
TYPE = "tf2_msgs/msg/TFMessage"


def stamp_of(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def by_rosbags(folder: Path) -> dict[str, list[tuple[int, Any]]]:
    found: dict[str, list[tuple[int, Any]]] = {}
    with Reader(folder) as reader:
        for connection, time, data in reader.messages():
            found.setdefault(connection.topic, []).append(
                (time, STORE.deserialize_cdr(data, connection.msgtype))
            )
    return found


def by_mcap(folder: Path) -> dict[str, list[tuple[int, Any]]]:
    found: dict[str, list[tuple[int, Any]]] = {}
    (file,) = folder.glob("*.mcap")
    with file.open("rb") as f:
        for _, channel, message, decoded in make_reader(
            f, decoder_factories=[DecoderFactory()]
        ).iter_decoded_messages():
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    return found


def test_the_rate_of_tf_can_be_chosen(fmu: Path, tmp_path: Path) -> None:
    folder = record(
        fmu, tmp_path / "log", "--stop-time", "0.1", "--ros-args", "-p", "publish_every.tf:=50"
    )
    assert [time for time, _ in by_mcap(folder)["/tf"]] == [0, 50_000_000, 100_000_000]


def numbers(of: Any, names: str) -> list[float]:
    return [getattr(of, name) for name in names]


@pytest.mark.parametrize("read", [by_rosbags, by_mcap])
def test_the_body_is_where_odom_has_it_a_hundred_times_a_second(log: Path, read: Any) -> None:
    messages = read(log)
    odom = dict(messages["/landing/odom"])
    assert [time for time, _ in messages["/tf"]] == [10_000_000 * k for k in range(101)]
    for time, message in messages["/tf"]:
        odometry, body, *others = message.transforms
        assert (odometry.header.frame_id, odometry.child_frame_id) == ("map", "odom")
        assert matrix(odometry.transform).tolist() == np.eye(4).tolist()
        assert {stamp_of(t.header.stamp) for t in message.transforms} == {time}
        assert (body.header.frame_id, body.child_frame_id) == (
            odom[time].header.frame_id,
            odom[time].child_frame_id,
        )
        pose = odom[time].pose.pose
        assert numbers(body.transform.translation, "xyz") == numbers(pose.position, "xyz")
        assert numbers(body.transform.rotation, "xyzw") == numbers(pose.orientation, "xyzw")
        assert len({t.child_frame_id for t in others}) == len(others) == 21


def matrix(transform: Any) -> Any:
    x, y, z, w = numbers(transform.rotation, "xyzw")
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.vstack(
        [np.column_stack([turn, numbers(transform.translation, "xyz")]), [0.0, 0.0, 0.0, 1.0]]
    )


def test_every_link_is_where_the_urdf_has_it_with_the_strokes_of_that_time(log: Path) -> None:
    messages = by_rosbags(log)
    (description,) = messages["/landing/robot_description"]
    robot = yourdfpy.URDF.load(
        io.StringIO(description[1].data), load_meshes=False, build_scene_graph=True
    )
    struts = dict(messages["/landing/struts"])
    for time, message in messages["/tf"][::10]:
        robot.update_cfg(dict(zip(JOINTS, struts[time].position)))
        frames = {WORLD_FRAME: np.eye(4)}
        for t in message.transforms:
            frames[t.child_frame_id] = frames[t.header.frame_id] @ matrix(t.transform)
        footpads = {f"leg_{leg}_footpad" for leg in range(1, 5)}
        assert set(frames) == {WORLD_FRAME, "odom", *robot.link_map, *footpads}
        to_body = np.linalg.inv(frames[BODY_FRAME])
        for link in robot.link_map:
            assert to_body @ frames[link] == pytest.approx(
                robot.get_transform(link, BODY_FRAME), abs=1e-12
            ), link


def test_the_definition_and_its_hash_are_in_the_log(one_log: Path) -> None:
    with Reader(one_log) as reader:
        (connection,) = [c for c in reader.connections if c.topic == "/tf"]
    assert (connection.msgtype, connection.digest) == (TYPE, STORE.hash_rihs01(TYPE))


@pytest.mark.parametrize(
    "names", [("map", "base_link"), ("a", "bc"), ("abc", "abcdefg"), ("abcdefgh", "")]
)
def test_the_bytes_are_those_of_an_independent_serialisation(names: tuple[str, str]) -> None:
    transforms = [
        Transform(*names, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3, 0.4)),
        Transform("x", "yz", (-1.0, 0.0, 4.0), (0.0, 0.0, 0.0, 1.0)),
    ]
    data = serialised(transforms, 3_000_000_007)
    assert (
        bytes(STORE.serialize_cdr(STORE.deserialize_cdr(data, TYPE), TYPE)).ljust(len(data), b"\0")
        == data
    )
