"""Messages packed from numbers are rclpy's own serialisation, byte for byte."""

from __future__ import annotations

import importlib
from typing import Any

import pytest
from geometry_msgs.msg import Vector3Stamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.typesys import Stores, get_typestore

from rlv_landing import load_preset
from rlv_landing.errors import LandingError
from rlv_landing.quantities import OUTPUT_NAMES
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.markers import Wireframe
from rlv_ros_bridge.messages.samples import SampleBytes, SampleMessages
from rlv_ros_bridge.messages.topics import MARKERS
from rlv_ros_bridge.messages.wire import MessageLayout, padded, sentinel_numbers

FINITE = st.floats(allow_nan=False, allow_infinity=False)
SAMPLES = st.lists(FINITE, min_size=len(OUTPUT_NAMES), max_size=len(OUTPUT_NAMES))
STAMPS = st.integers(0, 2**31 * 10**9 - 1)
STORE = get_typestore(Stores.ROS2_KILTED if hasattr(Stores, "ROS2_KILTED") else Stores.ROS2_JAZZY)

VEHICLE = Vehicle.of(load_preset("yue2022-figures"))


def assert_same(ours: bytes, theirs: bytes, type_name: str) -> None:
    """The same bytes but for the gaps between fields, which rclpy leaves as its memory was.

    Where these are, an independent serialisation tells: it leaves zeros there, and changing them
    changes no field.
    """
    assert len(ours) == len(theirs)
    differing = [i for i, (a, b) in enumerate(zip(ours, theirs)) if a != b]
    if not differing:
        return
    kind = message_class(type_name)
    independent = padded(
        bytes(STORE.serialize_cdr(STORE.deserialize_cdr(theirs, type_name), type_name))
    )
    assert len(independent) == len(theirs)
    gaps = bytearray(independent)
    for i in differing:
        assert independent[i] == 0
        gaps[i] = 255
    assert deserialize_message(bytes(gaps), kind) == deserialize_message(independent, kind)
    assert deserialize_message(ours, kind) == deserialize_message(theirs, kind)


def split(packer: SampleBytes, whole: bytes) -> list[bytes]:
    return [whole[part] for part in packer.slices]


def message_class(name: str) -> Any:
    package, middle, short = name.split("/")
    return getattr(importlib.import_module(f"{package}.{middle}"), short)


@settings(max_examples=50, deadline=None)
@given(STAMPS, SAMPLES)
def test_packed_samples_are_rclpys_own_bytes(nanoseconds: int, values: list[float]) -> None:
    packer, messages = SampleBytes(VEHICLE), SampleMessages(VEHICLE)
    messages.fill(nanoseconds, values)
    expected = messages.messages
    packed = dict(zip(packer.topics, split(packer, packer.pack(nanoseconds, values))))
    assert packed.keys() == expected.keys()
    for topic, data in packed.items():
        assert_same(data, padded(serialize_message(expected[topic])), topic.type_name)


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_packed_markers_are_rclpys_own_bytes(mode: str) -> None:
    wireframe = Wireframe(load_preset("yue2022-figures", mode))

    @settings(max_examples=20, deadline=None)
    @given(
        STAMPS,
        st.lists(st.floats(-1e6, 1e6), min_size=len(OUTPUT_NAMES), max_size=len(OUTPUT_NAMES)),
    )
    def holds(nanoseconds: int, values: list[float]) -> None:
        data = padded(wireframe.pack(nanoseconds, values))
        assert_same(
            data, padded(serialize_message(wireframe.fill(nanoseconds, values))), MARKERS.type_name
        )

    holds()


def test_a_number_that_stands_in_no_field_is_refused() -> None:
    sentinels = sentinel_numbers(2)
    stamped = Vector3Stamped()
    stamped.vector.x = sentinels[0]
    MessageLayout([serialize_message(stamped)], [sentinels[0], 0.0])
    with pytest.raises(LandingError, match="1 of 2 numbers are not found"):
        MessageLayout([serialize_message(stamped)], sentinels)


def test_other_byte_orders_are_refused_with_what_helps() -> None:
    big_endian = b"\x00\x00" + serialize_message(Vector3Stamped())[2:]
    with pytest.raises(LandingError, match="choose RMW_IMPLEMENTATION=rmw_fastrtps_cpp"):
        MessageLayout([big_endian], [])


def test_a_packer_keeps_nothing_of_the_sample_before() -> None:
    packer, fresh = SampleBytes(VEHICLE), SampleBytes(VEHICLE)
    first, second = (
        [float(i) for i in range(len(OUTPUT_NAMES))],
        [-float(i) for i in range(len(OUTPUT_NAMES))],
    )
    packer.pack(5, first)
    for topic, used, new in zip(
        packer.topics, split(packer, packer.pack(7, second)), split(fresh, fresh.pack(7, second))
    ):
        assert_same(used, new, topic.type_name)
