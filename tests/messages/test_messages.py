"""Samples to messages and back: axes, attitude, stamps, and not one digit changed."""

from __future__ import annotations

import struct
from math import cos, sin
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState

from rlv_landing import Landing, load_preset
from rlv_landing.errors import LandingError
from rlv_landing.quantities import OUTPUT_NAMES
from rlv_ros_bridge.messages.axes import from_ros, pitch_quaternion, to_ros, world_to_body
from rlv_ros_bridge.messages.columns import COLUMN_NAMES, sample_columns
from rlv_ros_bridge.messages.fields import FIELDS, Vehicle
from rlv_ros_bridge.messages.markers import Wireframe
from rlv_ros_bridge.messages.samples import SampleMessages
from rlv_ros_bridge.messages.tables import expected_numbers
from rlv_ros_bridge.messages.topics import CLOCK, JOINTS, ODOM, POSE, SAMPLED, STRUTS

FINITE = st.floats(allow_nan=False, allow_infinity=False)
# The paper's x forward, y up, z right, each in ROS's x forward, y left, z up.
PAPER_TO_ROS = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])

VEHICLE = Vehicle.of(load_preset("yue2022-figures"))


def sample(values: dict[str, float]) -> list[float]:
    return [values.get(name, 0.0) for name in OUTPUT_NAMES]


def filled(values: list[float], nanoseconds: int = 0) -> SampleMessages:
    messages = SampleMessages(VEHICLE)
    messages.fill(nanoseconds, values)
    return messages


def bits(value: float) -> bytes:
    return struct.pack("<d", value)


@given(FINITE, FINITE, FINITE)
def test_axes_turn_as_the_rotation_matrix_says(x: float, y: float, z: float) -> None:
    assert np.array_equal(
        to_ros(x, y, z),
        PAPER_TO_ROS @ [x, 0.0, 0.0] + PAPER_TO_ROS @ [0.0, y, 0.0] + PAPER_TO_ROS @ [0.0, 0.0, z],
    )
    assert tuple(map(bits, from_ros(*to_ros(x, y, z)))) == tuple(map(bits, (x, y, z)))


def test_the_turn_of_axes_is_a_rotation_not_a_mirror() -> None:
    forward, up, right = (np.array(to_ros(*axis)) for axis in np.eye(3))
    assert np.array_equal(np.cross(forward, up), right)


@given(st.floats(-3.0, 3.0))
def test_pitch_is_a_turn_about_ros_y_that_takes_the_nose_forward_and_down(pitch: float) -> None:
    # Clockwise positive in the paper's x-y plane: its rotation matrix, told in the paper's axes.
    c, s = np.cos(pitch), np.sin(pitch)
    paper = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    expected = PAPER_TO_ROS @ paper @ PAPER_TO_ROS.T
    assert np.allclose(
        Rotation.from_quat(pitch_quaternion(pitch)).as_matrix(), expected, atol=1e-15
    )


@given(st.floats(-3.0, 3.0), st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))
def test_odometry_has_the_velocity_in_the_body_frame(pitch: float, vx: float, vy: float) -> None:
    messages = filled(sample({"body.pitch": pitch, "body.vx": vx, "body.vy": vy}))
    seen = messages.messages[ODOM].twist.twist.linear
    expected = Rotation.from_quat(pitch_quaternion(pitch)).inv().apply(to_ros(vx, vy, 0.0))
    assert np.allclose([seen.x, seen.y, seen.z], expected, atol=1e-12)
    assert np.allclose(world_to_body(vx, vy, pitch), (expected[0], expected[2]), atol=1e-12)


@given(st.integers(0, 2**31 * 10**9 - 1))
def test_stamps_are_exact_to_the_nanosecond(nanoseconds: int) -> None:
    messages = filled([0.0] * len(OUTPUT_NAMES), nanoseconds)
    for topic, message in messages.messages.items():
        stamp = message.clock if topic is CLOCK else message.header.stamp
        assert stamp.sec * 10**9 + stamp.nanosec == nanoseconds


@settings(max_examples=50)
@given(st.lists(FINITE, min_size=len(COLUMN_NAMES), max_size=len(COLUMN_NAMES)))
def test_columns_from_messages_are_the_sample_bit_for_bit(numbers: list[float]) -> None:
    values = dict(zip(COLUMN_NAMES, numbers))
    messages = filled(sample(values))
    sent: dict[str, Any] = {
        topic.name: deserialize_message(serialize_message(message), type(message))
        for topic, message in messages.messages.items()
    }
    back = sample_columns(sent)
    assert {name: bits(value) for name, value in back.items()} == {
        name: bits(value) for name, value in values.items()
    }


def test_a_message_field_is_written_once_and_an_output_read_back_once() -> None:
    paths = [(field.topic, path) for field in FIELDS for path in field.paths]
    assert len(set(paths)) == len(paths)
    assert len(set(COLUMN_NAMES)) == len(COLUMN_NAMES)
    assert {field.topic for field in FIELDS} == set(SAMPLED)
    for field in FIELDS:
        written = field.conversion(VEHICLE)(*(0.5 for _ in field.outputs))
        assert len(written) == len(field.paths)
        assert field.read is None or len(field.read(*written)) == len(field.outputs)


def test_inertial_sensors_feel_the_struts_in_flight_and_the_weight_at_rest() -> None:
    parameters = load_preset("yue2022-figures").with_values({"drop.tilt": -0.05})
    landing, vehicle = Landing(parameters), Vehicle.of(parameters)
    pitch, most = 0.0, 0.0
    for k in range(40):
        landing.advance_to(k * 0.05)
        outputs = landing.outputs()
        cg, top = (expected_numbers(name, outputs, vehicle) for name in ("imu", "top/imu"))
        pitch = outputs["body.pitch"]
        axial = outputs["body.top_axial_acceleration"] + vehicle.gravity * cos(pitch)
        assert top["linear_acceleration.z"] == pytest.approx(axial, abs=1e-9)
        most = max(most, abs(axial))
        if k == 0:
            found = [n for m in (cg, top) for p, n in m.items() if p.startswith("linear")]
            # only the struts act on the body, which stretch
            assert found == pytest.approx([0.0] * 4, abs=1.5)
    assert most > 20.0
    # at rest both feel the weight up, in the body's axes
    for felt in (cg, top):
        assert felt["linear_acceleration.x"] == pytest.approx(-9.81 * sin(pitch), abs=0.05)
        assert felt["linear_acceleration.z"] == pytest.approx(9.81 * cos(pitch), abs=0.05)


@pytest.mark.parametrize(
    ("name", "strokes", "reason"),
    [
        (JOINTS[::-1], 8, "the log's struts are called leg_4_auxiliary_strut, "),
        (JOINTS, 7, "has 7 elements of position; a landing's has position\\[7\\]"),
    ],
)
def test_struts_of_another_vehicle_are_not_read(
    name: tuple[str, ...], strokes: int, reason: str
) -> None:
    message = JointState(name=list(name), position=[0.0] * strokes)
    with pytest.raises(LandingError, match=reason):
        sample_columns({STRUTS.name: message})


@pytest.mark.parametrize("where", ["position.y", "orientation.x", "orientation.z"])
def test_a_landing_in_space_is_not_read_as_a_symmetric_one(where: str) -> None:
    message = PoseStamped()
    owner, axis = where.split(".")
    assert sample_columns({POSE.name: message}) == {"body.x": 0.0, "body.y": 0.0}
    setattr(getattr(message.pose, owner), axis, 1e-9)
    with pytest.raises(LandingError, match=r"leaves its plane.*with its parameters only"):
        sample_columns({POSE.name: message})


def test_message_objects_are_filled_again_without_leftovers() -> None:
    first, second = (
        [float(i) for i in range(len(OUTPUT_NAMES))],
        [-float(i) for i in range(len(OUTPUT_NAMES))],
    )
    reused = SampleMessages(VEHICLE)
    reused.fill(5, first)
    reused.fill(7, second)
    fresh = filled(second, 7)
    for a, b in zip(reused.messages.values(), fresh.messages.values()):
        assert serialize_message(a) == serialize_message(b)


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_wireframe_struts_have_their_length_less_the_stroke(mode: str) -> None:
    parameters = load_preset("yue2022-figures", mode)
    landing = Landing(parameters)
    landing.advance_to(0.16)
    wireframe = Wireframe(parameters)
    markers = {
        m.ns: [to_tuple(p) for p in m.points] for m in wireframe.fill(0, landing.values()).markers
    }
    for name, strut, length in (
        ("main_struts", "main_strut", parameters.main_strut.length),
        ("auxiliary_struts", "auxiliary_strut", parameters.auxiliary_strut.length),
    ):
        for leg in (1, 2, 3, 4):
            joint, foot = markers[name][2 * leg - 2], markers[name][2 * leg - 1]
            stroke = landing.get(f"leg[{leg}].{strut}.stroke")
            assert np.linalg.norm(np.subtract(joint, foot)) == pytest.approx(
                length - stroke, abs=1e-9
            )


def to_tuple(point: Any) -> tuple[float, float, float]:
    return point.x, point.y, point.z
