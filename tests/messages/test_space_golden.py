"""A sample of a landing in space, and its messages, written out by hand.

The model: SI, x forward, y up, z right. ROS, REP-103: x forward, y left, z up. So a vector
(x, y, z) of the model is (x, -z, y) in ROS. The attitude turns the model's body axes x, y, z to
inertial y, z, x: a third of a turn about (1, 1, 1). So a vector (a, b, c) of the body is (c, a, b)
in inertial axes, and a vector (a, b, c) of inertial axes is (b, c, a) in the body's. No number
below is computed by the package.
"""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import pytest
from golden import HEADER, NANOSECONDS, ROUND_NUMBERS
from rclpy.serialization import serialize_message
from test_golden_samples import assert_golden, close_to, decoded, decoded_by_mcap, flat

from rlv_landing import Parameters, load_preset
from rlv_landing.quantities import interface_of
from rlv_ros_bridge.messages.columns import readings_of
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.inputs import READINGS, input_table_of
from rlv_ros_bridge.messages.markers import Wireframe
from rlv_ros_bridge.messages.robot_description import robot_description
from rlv_ros_bridge.messages.samples import SampleBytes, SampleMessages
from rlv_ros_bridge.messages.tables import expected_fields
from rlv_ros_bridge.messages.topics import (
    APPLIED_GROUND,
    APPLIED_WRENCH,
    MARKERS,
    TF,
    Topic,
    topics_of,
)
from rlv_ros_bridge.messages.transforms import Transforms
from rlv_ros_bridge.node.input_queue import InputChange, InputQueue

SPACE = interface_of("space", 3)
SAMPLED = topics_of(SPACE.legs).sampled
# gravity and the top sensor's height of the numbers below
VEHICLE = Vehicle(10.0, 0.5, interface=SPACE)
BODY = {
    "body.x": 2.0,
    "body.y": 3.0,
    "body.z": 4.0,
    "body.q_w": 0.5,
    "body.q_x": 0.5,
    "body.q_y": 0.5,
    "body.q_z": 0.5,
    "body.pitch": 0.2,
    "body.roll": 0.1,
    "body.heading": 0.3,
    "body.vx": 5.0,
    "body.vy": -10.0,
    "body.vz": 6.0,
    "body.spin_x": 0.25,
    "body.spin_y": 0.5,
    "body.spin_z": -0.75,
    "body.ax": 7.0,
    "body.ay": -8.0,
    "body.az": 9.0,
    "body.spin_acceleration_x": 1.0,
    "body.spin_acceleration_y": 2.0,
    "body.spin_acceleration_z": 3.0,
    "body.top_axial_acceleration": -9.75,
}
LEGS = {
    f"leg[{leg}].{name}": leg * value
    for leg in SPACE.legs
    for name, value in {
        "main_strut.stroke": 0.01,
        "auxiliary_strut.stroke": -0.001,
        "main_strut.stroke_rate": 1.0,
        "auxiliary_strut.stroke_rate": -0.25,
        "main_strut.force": -1000.0,
        "auxiliary_strut.force": 100.0,
        "contact.force_x": 8.0,
        "contact.force_y": 64.0,
        "contact.force_z": 2.0,
        "footpad.x": 0.5,
        "footpad.y": 0.125,
        "footpad.z": -0.25,
    }.items()
}
# an output that no message should carry is 777, so that it shows where it does not belong
VALUES = [{**BODY, **LEGS}.get(name, 777.0) for name in SPACE.output_names]
TURNED = {"x": 0.5, "y": -0.5, "z": 0.5, "w": 0.5}


def under(path: str, values: dict[str, float]) -> dict[str, float]:
    return {f"{path}.{name}": value for name, value in values.items()}


def vector(path: str, x: float, y: float, z: float) -> dict[str, float]:
    return under(path, {"x": x, "y": y, "z": z})


GOLDEN: dict[str, dict[str, Any]] = {
    "struts": {
        "header.frame_id": "base_link",
        **{
            f"name[{i}]": name
            for i, name in enumerate(
                (
                    *("leg_1_main_strut", "leg_1_auxiliary_strut", "leg_2_main_strut"),
                    *("leg_2_auxiliary_strut", "leg_3_main_strut", "leg_3_auxiliary_strut"),
                )
            )
        },
        **{f"position[{i}]": v for i, v in enumerate((0.01, -0.001, 0.02, -0.002, 0.03, -0.003))},
        **{f"velocity[{i}]": v for i, v in enumerate((1.0, -0.25, 2.0, -0.5, 3.0, -0.75))},
        **{f"effort[{i}]": v for i, v in enumerate((-1e3, 100.0, -2e3, 200.0, -3e3, 300.0))},
    },
    "pose": {
        "header.frame_id": "map",
        **vector("pose.position", 2.0, -4.0, 3.0),
        **under("pose.orientation", TURNED),
    },
    "rpy": {"header.frame_id": "map", **vector("vector", 0.1, 0.2, 0.3)},
    "twist": {
        "header.frame_id": "map",
        **vector("twist.linear", 5.0, -6.0, -10.0),
        # (-0.75, 0.25, 0.5) in inertial axes
        **vector("twist.angular", -0.75, -0.5, 0.25),
    },
    "accel": {
        "header.frame_id": "map",
        **vector("accel.linear", 7.0, -9.0, -8.0),
        # (3, 1, 2) in inertial axes
        **vector("accel.angular", 3.0, -2.0, 1.0),
    },
    "top/accel": {"header.frame_id": "top_sensor", "accel.linear.z": -9.75},
    "leg_1/contact": {
        "header.frame_id": "leg_1_footpad",
        **vector("wrench.force", 8.0, -2.0, 64.0),
    },
    "leg_2/contact": {
        "header.frame_id": "leg_2_footpad",
        **vector("wrench.force", 16.0, -4.0, 128.0),
    },
    "leg_3/contact": {
        "header.frame_id": "leg_3_footpad",
        **vector("wrench.force", 24.0, -6.0, 192.0),
    },
    "odom": {
        "header.frame_id": "odom",
        "child_frame_id": "base_link",
        **vector("pose.pose.position", 2.0, -4.0, 3.0),
        **under("pose.pose.orientation", TURNED),
        # (-10, 6, 5) and (0.25, 0.5, -0.75) in the model's body axes
        **vector("twist.twist.linear", -10.0, -5.0, 6.0),
        **vector("twist.twist.angular", 0.25, 0.75, 0.5),
    },
    # by 10 m/s2 of gravity it feels (7, 2, 9) in inertial axes: (2, 9, 7) in the model's body axes
    "imu": {
        "header.frame_id": "base_link",
        **under("orientation", TURNED),
        **vector("angular_velocity", 0.25, 0.75, 0.5),
        **vector("linear_acceleration", 2.0, -7.0, 9.0),
    },
    # 0.5 m above the CG (1, 2, 3) rad/s2 make (-1.5, 0, 0.5) m/s2; the spin, by (0.375, 0, 0.125)
    # m/s, makes (0.0625, -0.3125, -0.1875) m/s2
    "top/imu": {
        "header.frame_id": "top_sensor",
        **under("orientation", TURNED),
        **vector("angular_velocity", 0.25, 0.75, 0.5),
        **vector("linear_acceleration", 0.5625, -7.3125, 8.6875),
    },
}
# topic -> the outputs that are read back from it
CARRIED = {
    "struts": [n for n in LEGS if "_strut." in n],
    "pose": [n for n in BODY if n in ("body.x", "body.y", "body.z") or n.startswith("body.q_")],
    "rpy": ["body.roll", "body.pitch", "body.heading"],
    "twist": ["body.vx", "body.vy", "body.vz"],
    "accel": ["body.ax", "body.ay", "body.az"],
    "top/accel": ["body.top_axial_acceleration"],
    "odom": ["body.spin_x", "body.spin_y", "body.spin_z"],
    **{f"leg_{leg}/contact": [n for n in LEGS if f"[{leg}].contact" in n] for leg in SPACE.legs},
}
TOPICS = pytest.mark.parametrize("topic", SAMPLED, ids=lambda topic: topic.name)


def packed_message(topic: Topic) -> bytes:
    packer = SampleBytes(VEHICLE)
    return packer.pack(NANOSECONDS, VALUES)[packer.slices[packer.topics.index(topic)]]


@TOPICS
def test_packed_filled_and_expected_messages_are_golden(topic: Topic) -> None:
    golden = {**HEADER, **GOLDEN[topic.name]}
    assert_golden(decoded(packed_message(topic), topic), golden)
    messages = SampleMessages(VEHICLE)
    messages.fill(NANOSECONDS, VALUES)
    assert_golden(decoded(serialize_message(messages.messages[topic]), topic), golden)
    expected = expected_fields(
        topic.name, dict(zip(SPACE.output_names, VALUES)), NANOSECONDS, VEHICLE
    )
    assert golden.keys() <= expected.keys()
    for path, value in expected.items():
        assert value == close_to(golden.get(path, 0.0)), path


@TOPICS
def test_the_outputs_are_read_back(topic: Topic) -> None:
    readings = readings_of(SPACE)
    assert (topic.name in readings) == (topic.name in CARRIED)
    if topic.name in CARRIED:
        names, read = readings[topic.name]
        found = dict(zip(names, read(decoded(packed_message(topic), topic))))
        assert found == {name: {**BODY, **LEGS}[name] for name in CARRIED[topic.name]}


WRENCH = {
    f"external.{what}": 10.0 * i
    for i, what in enumerate(
        ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"), 1
    )
}
DECK = {
    f"ground.{what}": 0.01 * i
    for i, what in enumerate(
        (
            *(
                "surge",
                "heave",
                "sway",
                "roll",
                "yaw",
                "tilt",
                "surge_rate",
                "heave_rate",
                "sway_rate",
            ),
            *("roll_rate", "yaw_rate", "tilt_rate"),
        ),
        1,
    )
}


@pytest.mark.parametrize(
    ("topic", "values", "golden"),
    [
        (
            APPLIED_WRENCH,
            WRENCH,
            {
                **vector("wrench.force", 10.0, -30.0, 20.0),
                **vector("wrench.torque", 40.0, -60.0, 50.0),
            },
        ),
        (
            APPLIED_GROUND,
            DECK,
            {
                "name[0]": "ground_surge",
                "name[1]": "ground_sway",
                "name[2]": "ground_heave",
                "name[3]": "ground_tilt",
                "name[4]": "ground_roll",
                "name[5]": "ground_yaw",
                **{f"position[{i}]": 0.01 * k for i, k in enumerate((1, -3, 2, 6, 4, 5))},
                **{f"velocity[{i}]": 0.01 * k for i, k in enumerate((7, -9, 8, 12, 10, 11))},
            },
        ),
    ],
    ids=["wrench", "ground"],
)
def test_all_inputs_in_space_are_golden_read_back_and_queued(
    topic: Topic, values: dict[str, float], golden: dict[str, Any]
) -> None:
    table = input_table_of(SPACE)
    message = InputChange(topic, NANOSECONDS, values, table).message()
    read = decoded_by_mcap(serialize_message(message), topic)
    assert_golden(read, {**HEADER, "header.frame_id": "map", **golden})
    assert READINGS[topic.name](read, table) == values
    warnings: list[str] = []
    queue = InputQueue(0.0, warnings.append, table)
    queue.clear(1_000_000, lambda ground: None)
    (queue.receive_wrench if topic is APPLIED_WRENCH else queue.receive_ground)(message)
    (change,) = queue.changes_at(0)
    assert (dict(change.values), warnings) == (values, [])


@pytest.fixture(scope="module")
def vehicle() -> Parameters:
    """Three legs of round numbers, the first ahead, and a CG 0.1 m ahead and 0.2 m to the left."""
    round_numbers = {
        "drop.mode": "space",
        "vehicle.legs": 3.0,
        "vehicle.leg_azimuth": 0.0,
        "vehicle.cg_offset_x": 0.1,
        "vehicle.cg_offset_z": -0.2,
        **ROUND_NUMBERS,
    }
    return load_preset("yue2022-figures").with_values(round_numbers)


def test_markers_are_golden(vehicle: Parameters) -> None:
    message = decoded(Wireframe(vehicle).pack(NANOSECONDS, VALUES), MARKERS)
    points = {m.ns: [(p.x, p.y, p.z) for p in m.points] for m in message.markers}
    feet = [(0.5, 0.25, 0.125), (1.0, 0.5, 0.25), (1.5, 0.75, 0.375)]
    # in the model's body axes, from the CG: (-0.1, -1.5, 0.2) and (-0.1, 0.5, 0.2)
    ends = [(2.2, -2.5, 2.9), (2.2, -4.5, 2.9)]
    assert points["body"] == [pytest.approx(end, abs=1e-12) for end in ends]
    # leg 1: (0.4, -1, 0.2) and (0.4, -1.5, 0.2)
    assert points["main_struts"][0] == pytest.approx((2.2, -3.0, 3.4), abs=1e-12)
    assert points["auxiliary_struts"][0] == pytest.approx((2.2, -2.5, 3.4), abs=1e-12)
    assert points["main_struts"][1::2] == points["auxiliary_struts"][1::2] == feet
    assert points["footpads"] == feet


def test_transforms_and_urdf_are_golden(vehicle: Parameters) -> None:
    message = decoded(Transforms(vehicle).pack(NANOSECONDS, VALUES), TF)
    found = {t.child_frame_id: t for t in message.transforms}
    body = flat(found["base_link"].transform)
    assert body == {**vector("translation", 2.0, -4.0, 3.0), **under("rotation", TURNED)}
    at = found["leg_3_footpad"].transform.translation
    assert (at.x, at.y, at.z) == (1.5, 0.75, 0.375)
    # a rod stands at the strut's length less its stroke
    assert found["leg_3_main_strut_rod"].transform.translation.z == pytest.approx(1.47)
    joints = ElementTree.fromstring(robot_description(vehicle)).iter("joint")
    origins = {j.get("name"): j.find("origin").get("xyz").split() for j in joints}
    mount = [float(number) for number in origins["leg_1_main_strut_mount"]]
    assert mount == pytest.approx([0.4, -0.2, -1.0], abs=1e-12)
    assert {name for name in origins if name.startswith("leg_")} == {
        f"leg_{leg}_{strut}{end}"
        for leg in SPACE.legs
        for strut in ("main_strut", "auxiliary_strut")
        for end in ("", "_mount")
    }
