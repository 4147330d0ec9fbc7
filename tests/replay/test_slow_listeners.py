"""Listeners that take nothing for a while: a replay sends them again what they lack."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import pytest
from bridge_tools import TIMEOUT, Listener, start
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from remote import Remote
from rosgraph_msgs.msg import Clock

from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.messages.qos import (
    CLOCK,
    LATCHED,
    MOST_KEPT,
    SENSOR_DATA,
    TELEMETRY,
    Qos,
    resending,
)
from rlv_ros_bridge.messages.samples import set_stamp

TOPIC, TYPE, COUNT = "/ticks", "rosgraph_msgs/msg/Clock", 1500


def test_a_listener_that_was_stopped_gets_every_message_of_a_replay(
    tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    # As recorded of another publisher, which kept ten.
    recorder = Recorder(tmp_path / "log", [RecordedTopic(TOPIC, TYPE, Qos(depth=10))])
    tick, sent = Clock(), list[bytes]()
    for k in range(COUNT):
        set_stamp(tick.clock, k)
        sent.append(serialize_message(tick))
        recorder.write(TOPIC, k * 500_000, sent[-1])
    recorder.close()
    listener = Listener({TOPIC: TYPE}, tmp_path, domain, {TOPIC: COUNT})
    try:
        with Remote(domain, "/replay_node") as remote:
            seen: list[Clock] = []
            remote.node.create_subscription(Clock, TOPIC, seen.append, QoSProfile(depth=COUNT))
            waiting = ("--start-paused", "--wait-for-subscribers", 2)
            processes.append(start("replay", tmp_path / "log", *waiting, domain=domain))
            # A first message: both are matched.
            assert remote.trigger("play_next")[0]
            remote.until(lambda: len(seen) == 1)
            listener.process.send_signal(signal.SIGSTOP)
            assert remote.trigger("resume")[0]
            remote.until(lambda: len(seen) == COUNT)
            listener.process.send_signal(signal.SIGCONT)
            listener.process.wait(TIMEOUT)
        assert [m.data for m in listener.finish()] == sent
    finally:
        listener.stop()


@pytest.mark.parametrize(
    ("recorded", "rate", "depth"),
    [
        (Qos(depth=10), 1.0, TELEMETRY.depth),
        (Qos(depth=10), 0.1, TELEMETRY.depth),
        (Qos(depth=10), 4.0, 4 * TELEMETRY.depth),
        (Qos(depth=10), 1000.0, MOST_KEPT),
        (Qos(depth=9000), 1.0, 9000),
        (CLOCK, 1.0, TELEMETRY.depth),
        # Who asks later gets as many as were offered.
        (LATCHED, 1.0, LATCHED.depth),
        (SENSOR_DATA, 1.0, SENSOR_DATA.depth),
    ],
)
def test_what_is_kept_follows_the_rate(recorded: Qos, rate: float, depth: int) -> None:
    assert resending(recorded, rate).depth == depth
