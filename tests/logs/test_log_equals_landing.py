"""The log, read by independent readers, is the landing bit for bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from numpy.typing import NDArray
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from rlv_landing import Landing, load_preset
from rlv_landing.history import History
from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import LogReader

LEGS = (1, 2, 3, 4)
# topic -> what its message carries: the output's name and where it stands in the message, axes and
# signs written out
BODY: dict[str, dict[str, Any]] = {
    "/landing/pose": {"body.x": lambda m: m.pose.position.x, "body.y": lambda m: m.pose.position.z},
    "/landing/rpy": {"body.pitch": lambda m: m.vector.y},
    "/landing/twist": {
        "body.vx": lambda m: m.twist.linear.x,
        "body.vy": lambda m: m.twist.linear.z,
        "body.pitch_rate": lambda m: m.twist.angular.y,
    },
    "/landing/accel": {
        "body.ax": lambda m: m.accel.linear.x,
        "body.ay": lambda m: m.accel.linear.z,
        "body.pitch_acceleration": lambda m: m.accel.angular.y,
    },
    "/landing/top/accel": {"body.top_axial_acceleration": lambda m: m.accel.linear.z},
}


def expected_history(mode: str) -> History:
    return Landing(load_preset("yue2022-figures"), mode).run(1.0, 1e-3)


def same_bits(a: Any, b: NDArray[np.float64]) -> bool:
    return bool(
        np.array_equal(
            np.asarray(a, dtype=np.float64).view(np.uint64), np.ascontiguousarray(b).view(np.uint64)
        )
    )


def check(read: dict[str, list[Any]], history: History) -> None:
    for topic, fields in BODY.items():
        for name, field in fields.items():
            assert same_bits([field(m) for m in read[topic]], history[name]), name
    struts = read["/landing/struts"]
    for leg in LEGS:
        for strut in ("main_strut", "auxiliary_strut"):
            i = list(struts[0].name).index(f"leg_{leg}_{strut}")
            assert same_bits([m.position[i] for m in struts], history[f"leg[{leg}].{strut}.stroke"])
            assert same_bits(
                [m.velocity[i] for m in struts], history[f"leg[{leg}].{strut}.stroke_rate"]
            )
            assert same_bits([m.effort[i] for m in struts], history[f"leg[{leg}].{strut}.force"])
        force = [m.wrench.force for m in read[f"/landing/leg_{leg}/contact"]]
        assert same_bits([f.x for f in force], history[f"leg[{leg}].contact.force_x"])
        assert same_bits([f.z for f in force], history[f"leg[{leg}].contact.force_y"])
        assert same_bits([-f.y for f in force], history[f"leg[{leg}].contact.force_z"])


@pytest.mark.parametrize("store", [Stores.ROS2_JAZZY, Stores.ROS2_KILTED])
def test_rosbags_reads_the_landing_bit_for_bit(log: Path, mode: str, store: Stores) -> None:
    types = get_typestore(store)
    read: dict[str, list[Any]] = {}
    with Reader(log) as reader:
        assert reader.message_count == sum(1 for _ in LogReader(log).messages())
        for connection, time, data in reader.messages():
            if connection.topic in BODY or connection.topic.endswith(("struts", "contact")):
                message = types.deserialize_cdr(data, connection.msgtype)
                stamp = message.header.stamp
                assert stamp.sec * 10**9 + stamp.nanosec == time
                read.setdefault(connection.topic, []).append(message)
    check(read, expected_history(mode))


def test_mcap_ros2_support_reads_the_landing_bit_for_bit(log: Path, mode: str) -> None:
    (file,) = log.glob("*.mcap")
    read: dict[str, list[Any]] = {}
    with file.open("rb") as f:
        for _, channel, message, decoded in make_reader(
            f, decoder_factories=[DecoderFactory()]
        ).iter_decoded_messages():
            assert message.log_time == message.publish_time
            read.setdefault(channel.topic, []).append(decoded)
    check(read, expected_history(mode))
    assert len(read["/landing/odom"]) == len(read["/landing/pose"]) == 1001
    assert len(read["/diagnostics"]) == 11


def test_the_diagnostics_hold_phase_energy_balance_pacing_and_the_integrators_counters(
    log: Path, mode: str
) -> None:
    (file,) = log.glob("*.mcap")
    with file.open("rb") as f:
        decoded = make_reader(f, decoder_factories=[DecoderFactory()]).iter_decoded_messages(
            ["/diagnostics"]
        )
        diagnostics = [
            (message.log_time, {v.key: v.value for v in array.status[0].values})
            for _, _, message, array in decoded
        ]
    assert [time for time, _ in diagnostics] == [k * 10**8 for k in range(11)]
    landing = Landing(load_preset("yue2022-figures"), mode)
    for k in range(1001):
        landing.advance_to(k * 1e-3)
        if k % 100 == 0:
            _, values = diagnostics[k // 100]
            assert {name: values[f"solver.{name}"] for name in landing.statistics} == {
                n: str(c) for n, c in landing.statistics.items()
            }
            assert values["energy balance [J]"] == f"{landing.get('energy.balance'):.6g}"
            assert (
                values["phase"]
                == ("falling", "contact", "settled", "toppled")[int(landing.get("status.phase"))]
            )
            assert {"real-time factor", "steps late", "time lost to stalls [s]"} <= values.keys()


def test_our_reader_gives_the_landing_back_with_its_parameters(log: Path, mode: str) -> None:
    expected = expected_history(mode)
    history = history_of(LogReader(log))
    assert same_bits(history.time, expected.time)
    for name in history.names:
        assert same_bits(history[name], expected[name]), name
    assert history.parameters is not None
    assert dict(history.parameters.items()) == dict(load_preset("yue2022-figures", mode).items())


def test_the_log_carries_all_that_repeating_the_run_needs(log: Path, mode: str, fmu: Path) -> None:
    from fmpy import read_model_description

    reader = LogReader(log)
    list(reader.messages())
    assert reader.metadata["mode"] == mode
    assert reader.metadata["fmu_guid"] == read_model_description(str(fmu)).guid
    assert reader.metadata["step_size"] == "0.001"
    for package in ("rlv_landing", "python", "fmpy", "pythonfmu"):
        assert reader.metadata[f"version_{package}"]
    parameters = reader.parameters()
    assert parameters is not None
    again = Landing(parameters).run(1.0, 1e-3)
    assert same_bits(
        again["leg[1].main_strut.force"], history_of(reader)["leg[1].main_strut.force"]
    )
