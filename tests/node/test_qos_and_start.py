"""Quality of service that others ask for, and what waits for the landing's start."""

from __future__ import annotations

import subprocess
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bridge_tools import TIMEOUT, Listener, by_topic, one_error_line, record, run, start
from geometry_msgs.msg import WrenchStamped
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from remote import ACTIVATE, CONFIGURE, Remote
from sensor_msgs.msg import JointState

from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.messages.qos import Qos, parse_qos
from rlv_ros_bridge.messages.topics import STRUTS
from rlv_ros_bridge.ros import setup

OVERRIDES = (
    ("/landing/struts.publisher.reliability", "best_effort"),
    ("/landing/struts.publisher.depth", "7"),
    ("/landing/struts.publisher.durability", "transient_local"),
    ("/landing/ground.subscription.reliability", "reliable"),
)


def override(name: str, value: str) -> tuple[str, str]:
    return "-p", f"qos_overrides.{name}:={value}"


def test_each_topic_has_the_quality_of_service_that_the_parameters_override(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    given = [text for pair in OVERRIDES for text in override(*pair)]
    fast = ("--realtime-factor", 0, "--stop-time", 0.01, "--record", tmp_path / "log")
    processes.append(
        start("node", "--managed", "--fmu", fmu, *fast, "--ros-args", *given, domain=domain)
    )
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        (offered,) = remote.node.get_publishers_info_by_topic("/landing/struts")
        assert offered.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
        assert offered.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        inputs = {
            name: remote.node.get_subscriptions_info_by_topic(f"/landing/{name}")[0]
            for name in ("ground", "external_wrench")
        }
        assert inputs["ground"].qos_profile.reliability == ReliabilityPolicy.RELIABLE
        assert inputs["external_wrench"].qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
        assert remote.change(ACTIVATE)
        remote.until((tmp_path / "log" / "metadata.yaml").is_file)
    reader = LogReader(tmp_path / "log")
    assert reader.read_summary()
    written = parse_qos(reader.channels["/landing/struts"].qos)
    assert written == Qos("best_effort", "transient_local", 7)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("/landing/pose.publisher.reliability", "certain", "`certain`"),
        ("/landing/pose.publisher.depth", "0", "depth = 0 is outside [1, 100000]"),
        ("/landing/pose.publisher.history", "keep_all", "history must be keep_last"),
        ("/landing/ground.subscription.depth", "many", "expecting type 'INTEGER'"),
    ],
)
def test_an_override_that_cannot_be_is_refused_in_one_line(
    name: str, value: str, reason: str, fmu: Path
) -> None:
    done = run("node", "--fmu", fmu, "--no-record", "--ros-args", *override(name, value))
    assert done.returncode == 2
    assert reason in one_error_line(done)


@pytest.mark.parametrize("reliability", [ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE])
def test_inputs_come_from_publishers_of_either_reliability(
    reliability: ReliabilityPolicy,
    fmu: Path,
    domain: int,
    processes: list[subprocess.Popen[str]],
) -> None:
    processes.append(start("node", "--managed", "--no-record", "--fmu", fmu, domain=domain))
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        seen: list[WrenchStamped] = []
        remote.node.create_subscription(
            WrenchStamped, "/landing/applied/external_wrench", seen.append, 10
        )
        publisher = remote.node.create_publisher(
            WrenchStamped,
            "/landing/external_wrench",
            QoSProfile(depth=10, reliability=reliability),
        )
        message = WrenchStamped()
        message.wrench.force.x = 3.0

        def arrived() -> bool:
            publisher.publish(message)
            if not seen:
                remote.trigger("step")
            return bool(seen)

        remote.until(arrived)
        assert seen[0].wrench.force.x == 3.0


def test_a_recorder_in_simulation_time_that_is_waited_for_hears_the_landing(
    fmu: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    # As `ros2 bag record --use-sim-time`: it subscribes once the clock has started.
    with Remote(domain) as remote:
        remote.node.set_parameters([Parameter("use_sim_time", value=True)])
        clock, seen = remote.node.get_clock(), list[JointState]()
        waiting = ("--wait-for-subscribers", 1, "--no-record", "--stop-time", 0.05)
        processes.append(start("node", "--fmu", fmu, *waiting, domain=domain))
        end = time.monotonic() + TIMEOUT
        while clock.now().nanoseconds == 0 and time.monotonic() < end:
            remote.executor.spin_once(timeout_sec=0.05)
        assert clock.now().nanoseconds == 1
        remote.node.create_subscription(JointState, "/landing/struts", seen.append, 1000)
        while len(seen) < 51 and time.monotonic() < end:
            remote.executor.spin_once(timeout_sec=0.05)
    assert [m.header.stamp.nanosec for m in seen] == [k * 1_000_000 for k in range(51)]


class SlowRecorder:
    """A recorder, in a time of its own, that subscribes to a topic each `pause` [s]."""

    def __init__(self, pause: float, topics: int) -> None:
        self.now, self.pause, self.topics = 0.0, pause, topics

    def publishers(self) -> list[Any]:
        return [
            SimpleNamespace(
                topic_name=str(i), get_subscription_count=lambda i=i: int(self.count() > i)
            )
            for i in range(self.topics)
        ]

    def count(self) -> int:
        return min(int(self.now / self.pause + 1e-9), self.topics)

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize("pause", [0.01, 0.1, 0.25])
def test_who_subscribes_to_one_topic_after_the_other_is_waited_for(
    monkeypatch: pytest.MonkeyPatch, pause: float
) -> None:
    recorder = SlowRecorder(pause, 13)
    monkeypatch.setattr(setup, "time", recorder)
    every = recorder.publishers()
    setup.wait_until_matched(every[0], 1, 30.0, lambda: False, every)
    assert recorder.count() == 13
    begin = recorder.now
    setup.wait_until_matched(every[0], 0, 30.0, lambda: False, every)
    assert recorder.now == begin


def test_subscriptions_without_end_do_not_hold_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    recorder = SlowRecorder(0.1, 1000)
    monkeypatch.setattr(setup, "time", recorder)
    every = recorder.publishers()
    setup.wait_until_matched(every[0], 1, 2.0, lambda: False, every)
    assert 2.0 < recorder.now < 2.0 + 2 * setup.SETTLE_SECONDS


def test_a_replay_waits_with_its_clock_started(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    log = record(fmu, tmp_path / "log", "--stop-time", 0.05)
    clock = Listener({"/clock": "rosgraph_msgs/msg/Clock"}, tmp_path, domain, announce=2)
    try:
        waiting = ("--clock", 50, "--wait-for-subscribers", 1)
        replay = start("replay", log, *waiting, domain=domain)
        processes.append(replay)
        clock.wait_for_announcement()
        listener = Listener(
            {"/landing/struts": STRUTS.type_name}, tmp_path, domain, {"/landing/struts": 51}
        )
        try:
            replay.communicate(timeout=TIMEOUT)
            assert len(by_topic(listener.finish())["/landing/struts"]) == 51
        finally:
            listener.stop()
    finally:
        clock.stop()
    assert replay.returncode == 0


def test_the_landing_waits_for_its_start_delay(fmu: Path) -> None:
    fast = ("--no-record", "--realtime-factor", 0, "--stop-time", 0.01)
    begun = time.monotonic()
    done = run("node", "--fmu", fmu, *fast, "--start-delay", "500 ms")
    assert done.returncode == 0, done.stderr
    assert time.monotonic() - begun > 0.5
