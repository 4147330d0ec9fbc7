"""The inputs of a log, played into another landing."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

from bridge_tools import TIMEOUT, start
from rclpy.serialization import serialize_message
from remote import ACTIVATE, CLEANUP, CONFIGURE, DEACTIVATE, Remote

from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import Decoder, LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.verification.verify import verify
from rlv_ros_bridge.messages.inputs import HEAVE, READINGS, TILT, WRENCH
from rlv_ros_bridge.messages.message_types import message_class
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.topics import APPLIED, APPLIED_GROUND, APPLIED_WRENCH
from rlv_ros_bridge.node.input_queue import InputChange

Change = tuple[str, dict[str, float]]
# plays the inputs that a node applied to the topics on which a node takes them
REMAP = [
    argument
    for t in APPLIED
    for argument in ("--remap", f"{t.name}:={t.name.removeprefix('applied/')}")
]


def make_inputs(folder: Path) -> list[Change]:
    """A log of ten wrenches and ten movements of the ground within 0.4 s, and its changes."""
    recorder = Recorder(
        folder,
        [RecordedTopic(f"/landing/{t.name}", t.type_name, TELEMETRY) for t in APPLIED],
        {"namespace": "/landing"},
    )
    changes: list[Change] = []
    for k in range(20):
        topic, names = ((APPLIED_WRENCH, WRENCH), (APPLIED_GROUND, (*HEAVE, *TILT)))[k % 2]
        size = 100.0 if topic is APPLIED_WRENCH else 1e-4
        change = InputChange(
            topic, k * 20_000_000, {name: size * (k + 1 + i) for i, name in enumerate(names)}
        )
        recorder.write(
            f"/landing/{topic.name}", change.nanoseconds, serialize_message(change.message())
        )
        changes.append((topic.name, dict(change.values)))
    recorder.close()
    return changes


def recorded_inputs(log: Path) -> list[tuple[int, Change]]:
    """The inputs of a log by time [ns]."""
    reader = LogReader(log)
    reader.read_through()
    decode = Decoder(reader)
    names = {f"/landing/{name}": name for name in READINGS}
    return [
        (m.log_time, (names[m.topic], READINGS[names[m.topic]](decode(m))))
        for m in reader.messages(names)
    ]


def test_the_inputs_of_a_log_act_on_another_landing(
    fmu: Path, one_log: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    changes = make_inputs(tmp_path / "inputs")
    slowly = (
        "--realtime-factor",
        0.25,
        "--stop-time",
        2,
        "--record",
        tmp_path / "landing",
        "--ros-args",
        "-p",
        "input_timeout:=0.0",
    )
    node = start("node", "--managed", "--fmu", fmu, *slowly, domain=domain)
    replay = start(
        "replay",
        tmp_path / "inputs",
        "--rate",
        0.25,
        "--start-paused",
        "--wait-for-subscribers",
        1,
        *REMAP,
        domain=domain,
    )
    processes += [node, replay]
    with Remote(domain) as remote, Remote(domain, "/replay_node") as player:
        assert remote.change(CONFIGURE)
        diagnostics = remote.diagnostics()
        assert player.trigger("pause") == (False, "the replay is paused already")
        assert remote.change(ACTIVATE)
        assert player.trigger("resume")[0]
        out, err = replay.communicate(timeout=TIMEOUT)
        assert (replay.returncode, err) == (0, "")
        assert "played 20 messages" in out
        remote.until(lambda: bool(diagnostics) and diagnostics[-1]["inputs received"] == "20")
        assert remote.change(DEACTIVATE)
        assert remote.change(CLEANUP)
        node.send_signal(signal.SIGINT)
        assert node.wait(TIMEOUT) == 130
    arrived = recorded_inputs(tmp_path / "landing")
    for topic in READINGS:
        # Of two that arrive within one step the last one counts.
        acted, sent = (
            [values for name, values in found if name == topic]
            for found in ([change for _, change in arrived], changes)
        )
        assert acted[-1] == sent[-1]
        assert [values for values in sent if values in acted] == acted
    landing = LogReader(tmp_path / "landing")
    found = verify(landing)
    assert (found.first, found.other_bits, found.inputs) == (None, 0, len(arrived))
    alone = history_of(LogReader(one_log))
    together = history_of(landing)
    last = min(len(together), len(alone)) - 1
    assert abs(together["body.x"][last] - alone["body.x"][last]) > 1e-3


def test_inputs_are_played_one_by_one_in_lock_step_with_a_landing(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    changes = make_inputs(tmp_path / "inputs")
    node = start(
        "node",
        "--managed",
        "--fmu",
        fmu,
        "--record",
        tmp_path / "landing",
        "--ros-args",
        "-p",
        "input_timeout:=0.0",
        domain=domain,
    )
    replay = start(
        "replay",
        tmp_path / "inputs",
        "--start-paused",
        "--wait-for-subscribers",
        1,
        *REMAP,
        domain=domain,
    )
    processes += [node, replay]
    with Remote(domain) as remote, Remote(domain, "/replay_node") as player:
        assert remote.change(CONFIGURE)
        applied: list[int] = []
        for t, kind in zip(APPLIED, applied_types()):
            remote.node.create_subscription(
                kind, f"/landing/{t.name}", lambda m: applied.append(m.header.stamp.nanosec), 100
            )
        remote.until(
            lambda: all(remote.node.count_publishers(f"/landing/{t.name}") for t in APPLIED)
        )
        assert remote.trigger("step")[0]
        for k in range(5):
            assert player.trigger("play_next") == (True, "")
            while len(applied) <= k:
                assert remote.trigger("step")[0]
                remote.executor.spin_once(timeout_sec=0.02)
        assert remote.change(CLEANUP)
        node.send_signal(signal.SIGINT)
        assert node.wait(TIMEOUT) == 130
    arrived = recorded_inputs(tmp_path / "landing")
    assert [change for _, change in arrived] == changes[:5]
    assert len({time for time, _ in arrived}) == 5
    found = verify(LogReader(tmp_path / "landing"))
    assert (found.first, found.other_bits, found.inputs) == (None, 0, 5)


def applied_types() -> list[type]:
    """The message types of `APPLIED`."""
    return [message_class(t.type_name) for t in APPLIED]
