"""One sample of every topic, written out by hand and decoded by a reader that is not ours."""

from __future__ import annotations

import struct
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest
from golden import (
    CARRIED,
    GOLDEN,
    HALF_COS,
    HALF_SIN,
    HEADER,
    NANOSECONDS,
    ROUND_NUMBERS,
    SAMPLE,
    VALUES,
)
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
from rclpy.serialization import serialize_message
from rosbags.typesys import Stores, get_typestore

from rlv_landing import load_preset
from rlv_landing.quantities import OUTPUT_NAMES
from rlv_ros_bridge.messages.columns import READINGS
from rlv_ros_bridge.messages.definitions import definition
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.inputs import READINGS as INPUT_READINGS
from rlv_ros_bridge.messages.markers import Wireframe
from rlv_ros_bridge.messages.samples import SampleBytes, SampleMessages
from rlv_ros_bridge.messages.tables import expected_fields
from rlv_ros_bridge.messages.topics import (
    APPLIED,
    APPLIED_GROUND,
    APPLIED_WRENCH,
    CLOCK,
    MARKERS,
    SAMPLED,
    TF,
    Topic,
)
from rlv_ros_bridge.messages.transforms import Transforms
from rlv_ros_bridge.node.input_queue import InputChange

STORE = get_typestore(Stores.ROS2_KILTED)
TOPICS = pytest.mark.parametrize("topic", [CLOCK, *SAMPLED], ids=lambda topic: topic.name)


def decoded(data: bytes, topic: Topic) -> Any:
    return STORE.deserialize_cdr(data, topic.type_name)


def decoded_by_mcap(data: bytes, topic: Topic) -> Any:
    """Decodes messages that end in an empty array of numbers.

    rclpy adds the gap before the array's first element, which rosbags refuses.
    """
    text = definition(topic.type_name).text.encode()
    decode = DecoderFactory().decoder_for("cdr", Schema(1, text, "ros2msg", topic.type_name))
    assert decode is not None
    return decode(data)


def flat(value: Any, path: str = "") -> dict[str, Any]:
    """Every number and text of a message decoded by rosbags or mcap_ros2, by path."""
    if is_dataclass(value):
        names = [f.name for f in fields(value) if f.name != "__msgtype__"]
        parts = {f"{path}.{name}" if path else name: getattr(value, name) for name in names}
    elif hasattr(value, "__slots__"):
        parts = {f"{path}.{n}" if path else n: getattr(value, n) for n in value.__slots__}
    elif isinstance(value, (list, np.ndarray)):
        parts = {f"{path}[{i}]": element for i, element in enumerate(value)}
    else:
        return {path: value}
    return {p: leaf for name, part in parts.items() for p, leaf in flat(part, name).items()}


def close_to(golden: Any) -> Any:
    return pytest.approx(golden, rel=1e-15, abs=1e-15) if isinstance(golden, float) else golden


def assert_golden(message: Any, golden: dict[str, Any]) -> None:
    found = flat(message)
    assert golden.keys() <= found.keys()
    for path, value in found.items():
        if path not in golden:
            # Not -0.0 either.
            assert str(value) in ("0", "0.0", ""), path
        else:
            assert value == close_to(golden[path]), path


# Gravity and the top sensor's height of `golden.py`.
VEHICLE = Vehicle(10.0, 0.5)


def packed_message(topic: Topic) -> bytes:
    packer = SampleBytes(VEHICLE)
    return packer.pack(NANOSECONDS, VALUES)[packer.slices[packer.topics.index(topic)]]


def test_every_sampled_topic_has_a_golden_message() -> None:
    assert GOLDEN.keys() == {CLOCK.name, *(topic.name for topic in SAMPLED)}


@TOPICS
def test_packed_messages_are_golden(topic: Topic) -> None:
    assert_golden(decoded(packed_message(topic), topic), GOLDEN[topic.name])


@TOPICS
def test_packed_messages_have_their_numbers_where_the_layout_says(topic: Topic) -> None:
    packer = SampleBytes(VEHICLE)
    position = packer.topics.index(topic)
    places, part = packer.places[position], packer.slices[position]
    numbers = packer.numbers(VALUES)
    assert len(numbers) == packer.count
    data = bytearray(places.data)
    for at in places.stamps:
        struct.pack_into("<iI", data, at, *divmod(NANOSECONDS, 10**9))
    for at, i in places.numbers:
        struct.pack_into("<d", data, at, numbers[i])
    assert bytes(data) == packer.pack(NANOSECONDS, VALUES)[part]


@TOPICS
def test_filled_messages_are_golden(topic: Topic) -> None:
    messages = SampleMessages(VEHICLE)
    messages.fill(NANOSECONDS, VALUES)
    data = serialize_message(messages.messages[topic])
    assert_golden(decoded(data, topic), GOLDEN[topic.name])


@pytest.mark.parametrize("topic", SAMPLED, ids=lambda topic: topic.name)
def test_what_verify_expects_is_golden(topic: Topic) -> None:
    expected = expected_fields(topic.name, dict(zip(OUTPUT_NAMES, VALUES)), NANOSECONDS, VEHICLE)
    golden = GOLDEN[topic.name]
    assert golden.keys() <= expected.keys()
    for path, value in expected.items():
        assert value == close_to(golden.get(path, 0.0)), path


@pytest.mark.parametrize("topic", SAMPLED, ids=lambda topic: topic.name)
def test_the_outputs_are_read_back_from_the_independent_readers_message(topic: Topic) -> None:
    carried = CARRIED.get(topic.name, [])
    assert (topic.name in READINGS) == bool(carried)
    if carried:
        names, read = READINGS[topic.name]
        found = dict(zip(names, read(decoded(packed_message(topic), topic))))
        assert found == {name: SAMPLE[name] for name in carried}


@pytest.mark.parametrize(
    ("topic", "values", "golden"),
    [
        (
            APPLIED_WRENCH,
            {"external.force_x": 100.0, "external.force_y": 200.0, "external.moment": 30.0},
            {"wrench.force.x": 100.0, "wrench.force.z": 200.0, "wrench.torque.y": 30.0},
        ),
        (
            APPLIED_GROUND,
            {
                "ground.heave": 0.1,
                "ground.heave_rate": -0.2,
                "ground.tilt": 0.03,
                "ground.tilt_rate": -0.04,
            },
            {
                "name[0]": "ground_heave",
                "name[1]": "ground_tilt",
                "position[0]": 0.1,
                "position[1]": 0.03,
                "velocity[0]": -0.2,
                "velocity[1]": -0.04,
            },
        ),
    ],
    ids=[topic.name for topic in APPLIED],
)
def test_applied_inputs_are_golden_and_read_back(
    topic: Topic, values: dict[str, float], golden: dict[str, Any]
) -> None:
    data = serialize_message(InputChange(topic, NANOSECONDS, values).message())
    message = decoded_by_mcap(data, topic)
    assert_golden(message, {**HEADER, "header.frame_id": "map", **golden})
    assert INPUT_READINGS[topic.name](message) == values


@pytest.fixture(scope="module")
def vehicle() -> Any:
    """A vehicle of round numbers, in the mode whose legs lie in the body's plane and beside it."""
    return load_preset("yue2022-figures", "1-2-1").with_values(ROUND_NUMBERS)


def test_markers_are_golden(vehicle: Any) -> None:
    message = decoded(Wireframe(vehicle).pack(NANOSECONDS, VALUES), MARKERS)
    points = {m.ns: [(p.x, p.y, p.z) for p in m.points] for m in message.markers}
    # A point (a, b) of the body, forward and up, is at 2 + 0.6 a + 0.8 b forward and
    # 3 - 0.8 a + 0.6 b up.
    footpads = [(1.25, 0.5, 0.125), (2.25, 1.5, 0.225), (3.25, -0.75, 0.325), (2.75, -1.75, 0.425)]
    # Leg 1 behind the axis, leg 2 to its left, leg 3 before it, leg 4 to its right.
    main = [(0.9, 0.0, 2.8), (1.2, 0.5, 2.4), (1.5, 0.0, 2.0), (1.2, -0.5, 2.4)]
    auxiliary = [(0.5, 0.0, 2.5), (0.8, 0.5, 2.1), (1.1, 0.0, 1.7), (0.8, -0.5, 2.1)]
    expected = {
        "body": [(0.8, 0.0, 2.1), (2.4, 0.0, 3.3)],
        "main_struts": [p for pair in zip(main, footpads) for p in pair],
        "auxiliary_struts": [p for pair in zip(auxiliary, footpads) for p in pair],
        "footpads": footpads,
    }
    assert points.keys() == expected.keys()
    for name, found in points.items():
        assert np.array(found) == pytest.approx(np.array(expected[name]), abs=1e-12), name
    for m in message.markers:
        assert (m.header.frame_id, m.header.stamp.sec, m.header.stamp.nanosec) == (
            "map",
            12,
            345_000_006,
        )


def test_transforms_are_golden(vehicle: Any) -> None:
    message = decoded(Transforms(vehicle).pack(NANOSECONDS, VALUES), TF)
    found = {t.child_frame_id: t for t in message.transforms}
    for t in message.transforms:
        assert (t.header.stamp.sec, t.header.stamp.nanosec) == (12, 345_000_006)
    body = flat(found["base_link"].transform)
    assert found["odom"].header.frame_id == "map"
    assert set(flat(found["odom"].transform).values()) == {0.0, 1.0}
    assert found["base_link"].header.frame_id == "odom"
    feet = [(1.25, 0.5, 0.125), (2.25, 1.5, 0.225), (3.25, -0.75, 0.325), (2.75, -1.75, 0.425)]
    for leg, foot in enumerate(feet, 1):
        footpad = found[f"leg_{leg}_footpad"]
        at, turn = footpad.transform.translation, footpad.transform.rotation
        assert footpad.header.frame_id == "odom"
        assert (at.x, at.y, at.z) == foot
        assert (turn.x, turn.y, turn.z, turn.w) == (0.0, 0.0, 0.0, 1.0)
    assert body == pytest.approx(
        {
            "translation.x": 2.0,
            "translation.y": 0.0,
            "translation.z": 3.0,
            "rotation.x": 0.0,
            "rotation.y": HALF_SIN,
            "rotation.z": 0.0,
            "rotation.w": HALF_COS,
        },
        abs=1e-15,
    )
    top = found["top_sensor"]
    assert (top.header.frame_id, top.transform.translation.z) == ("base_link", 0.5)
    # A rod stands at the strut's length less its stroke, along the cylinder's z.
    rods = {
        "leg_1_main_strut": 1.489,
        "leg_1_auxiliary_strut": 1.262,
        "leg_2_main_strut": 1.479,
        "leg_2_auxiliary_strut": 1.272,
        "leg_3_main_strut": 1.469,
        "leg_3_auxiliary_strut": 1.282,
        "leg_4_main_strut": 1.459,
        "leg_4_auxiliary_strut": 1.292,
    }
    for strut, z in rods.items():
        rod = found[f"{strut}_rod"]
        assert rod.header.frame_id == f"{strut}_cylinder"
        assert flat(rod.transform)["translation.z"] == pytest.approx(z, abs=1e-12)
        assert flat(rod.transform)["rotation.w"] == 1.0
