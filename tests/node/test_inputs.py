"""Loads and deck motion as topics: applied, ended by a timeout, refused, and recorded."""

from __future__ import annotations

import math
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bridge_tools import TIMEOUT, start
from geometry_msgs.msg import WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
from remote import CLEANUP, CONFIGURE, Remote
from sensor_msgs.msg import JointState

from rlv_landing import Landing, LandingError
from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import Decoder, LogReader
from rlv_ros_bridge.logs.verification.verify import verify
from rlv_ros_bridge.messages.inputs import HEAVE, READINGS, TILT, WRENCH, read_ground, read_wrench
from rlv_ros_bridge.messages.topics import APPLIED_GROUND, APPLIED_WRENCH
from rlv_ros_bridge.node.input_queue import InputChange

FORCE, MOTION = st.floats(-1e7, 1e7), st.floats(-1.0, 1.0)


def wrench(
    x: float = 0.0, y: float = 0.0, z: float = 0.0, torque: float = 0.0, frame: str = "map"
) -> WrenchStamped:
    message = WrenchStamped()
    message.header.frame_id = frame
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = x, y, z
    message.wrench.torque.y = torque
    return message


def ground(heave: float, heave_rate: float, tilt: float, tilt_rate: float) -> JointState:
    return JointState(
        name=["ground_heave", "ground_tilt"],
        position=[heave, tilt],
        velocity=[heave_rate, tilt_rate],
    )


@given(FORCE, FORCE, FORCE)
def test_a_wrench_in_ros_axes_is_the_papers_and_back_digit_for_digit(
    x: float, y: float, moment: float
) -> None:
    # Forward stays forward, the paper's up (y) is ROS's up (z), clockwise (nose down) is positive
    # about +y.
    assert read_wrench(wrench(x=x, z=y, torque=moment)) == dict(zip(WRENCH, (x, y, moment)))
    change = InputChange(APPLIED_WRENCH, 5, dict(zip(WRENCH, (x, y, moment))))
    assert READINGS[APPLIED_WRENCH.name](change.message()) == change.values


@given(MOTION, MOTION, MOTION, MOTION)
def test_a_ground_message_is_the_decks_motion_and_back_digit_for_digit(
    a: float, b: float, c: float, d: float
) -> None:
    values = dict(zip((*HEAVE, *TILT), (a, b, c, d)))
    assert read_ground(ground(a, b, c, d)) == values
    assert READINGS[APPLIED_GROUND.name](InputChange(APPLIED_GROUND, 5, values).message()) == values


@pytest.mark.parametrize(
    ("read", "message", "reason"),
    [
        (read_wrench, wrench(x=math.nan), "external.force_x = nan N"),
        (read_wrench, wrench(z=1e9), "external.force_y = 1e+09 N is outside"),
        (
            read_wrench,
            wrench(frame="base_link"),
            "given in the frame 'base_link'; give it in 'map'",
        ),
        (
            read_ground,
            JointState(name=["ground_yaw"], position=[0.0]),
            "ground has no joint 'ground_yaw'",
        ),
        (
            read_ground,
            JointState(name=["ground_heave"], position=[math.inf]),
            "ground.heave = inf m is outside",
        ),
        (read_ground, JointState(name=["ground_heave"], position=[]), "1 names, 0 positions"),
        (read_ground, JointState(), "0 names"),
        (
            read_ground,
            JointState(name=["ground_heave", "ground_heave"], position=[0.0, 1.0]),
            "names the joint 'ground_heave' twice",
        ),
    ],
)
def test_a_bad_input_is_refused_with_its_reason(
    read: Callable[[Any], dict[str, float]], message: Any, reason: str
) -> None:
    with pytest.raises(LandingError) as refused:
        read(message)
    assert reason in str(refused.value)


@pytest.fixture
def stepped(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> Iterator[tuple[subprocess.Popen[str], Remote]]:
    """A configured node that is stepped from outside, and records."""
    node = start("node", "--managed", "--fmu", fmu, "--record", tmp_path / "log", domain=domain)
    processes.append(node)
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        assert remote.trigger("step")[0]
        yield node, remote


def step_until(remote: Remote, publish: Callable[[], None], happened: Callable[[], bool]) -> None:
    """Steps the node 50 times a second, after `publish` each time, until `happened`.

    The landing has 1000 steps. As fast as they can be made, they are over before an input's
    timeout of half a second has passed.
    """
    end = time.monotonic() + TIMEOUT
    while not happened():
        assert time.monotonic() < end, "it did not happen in time"
        publish()
        assert remote.trigger("step")[0]
        next_step = time.monotonic() + 0.02
        while (left := next_step - time.monotonic()) > 0.0:
            remote.executor.spin_once(timeout_sec=left)


def test_inputs_act_until_the_timeout_and_repeat_the_run_from_its_log(
    stepped: tuple[subprocess.Popen[str], Remote], tmp_path: Path
) -> None:
    node, remote = stepped
    applied: dict[str, list[Any]] = {"wrench": [], "ground": []}
    remote.node.create_subscription(
        WrenchStamped, "/landing/applied/external_wrench", applied["wrench"].append, 100
    )
    remote.node.create_subscription(
        JointState, "/landing/applied/ground", applied["ground"].append, 100
    )
    pushing = remote.node.create_publisher(WrenchStamped, "/landing/external_wrench", 10)
    moving = remote.node.create_publisher(JointState, "/landing/ground", 10)
    # steps that are made before all are connected are lost, and the landing has only 1000
    for publisher in (pushing, moving):
        remote.until(lambda publisher=publisher: publisher.get_subscription_count() > 0)
    for topic in (APPLIED_WRENCH, APPLIED_GROUND):
        remote.until(lambda topic=topic: remote.node.count_publishers(f"/landing/{topic.name}") > 0)

    def publish() -> None:
        pushing.publish(wrench(x=800.0, z=-300.0, torque=40.0))
        moving.publish(ground(0.01, 0.2, 0.005, -0.01))

    step_until(remote, publish, lambda: all(applied.values()))
    first = applied["wrench"][0]
    assert (first.wrench.force.x, first.wrench.force.z, first.wrench.torque.y) == (
        800.0,
        -300.0,
        40.0,
    )
    # Without messages, after half a second the load is 0 and the deck stands still.
    silent: Callable[[], None] = lambda: None  # noqa: E731
    step_until(
        remote,
        silent,
        lambda: (
            applied["wrench"][-1].wrench.force.x == 0.0 and applied["ground"][-1].velocity[0] == 0.0
        ),
    )
    assert applied["ground"][-1].position[0] > 0.01
    assert remote.set(step_count=1000)[0].successful
    assert remote.trigger("step") == (True, "at 1 s, finished")
    assert remote.change(CLEANUP)
    node.send_signal(signal.SIGINT)
    assert node.wait(TIMEOUT) == 130
    assert_repeats(tmp_path / "log")


def assert_repeats(log: Path) -> None:
    """The model with the log's parameters and inputs gives the log's landing bit for bit."""
    reader = LogReader(log)
    decode = Decoder(reader)
    names = {f"/landing/{name}": name for name in READINGS}
    changes: dict[int, list[dict[str, float]]] = {}
    for message in reader.messages():
        if message.topic in names:
            changes.setdefault(message.log_time, []).append(
                READINGS[names[message.topic]](decode(message))
            )
    assert len(changes) >= 2
    applied = sum(map(len, changes.values()))
    found = history_of(reader)
    landing = Landing(reader.parameters())
    for values in changes.pop(0, []):
        landing.set_inputs(values)
    for k in range(len(found)):
        for column in (
            "body.x",
            "body.y",
            "body.pitch",
            "leg[1].main_strut.force",
            "leg[3].contact.force_z",
        ):
            assert found[column][k] == landing.get(column), (k, column)
        for values in changes.get(k * 1_000_000, []):
            landing.set_inputs(values)
        landing.advance_to((k + 1) * 1e-3)
    assert (
        np.abs(found["body.x"][-1] - Landing(reader.parameters()).run(1.0, 1e-2)["body.x"][-1])
        > 1e-3
    )
    verified = verify(LogReader(log))
    assert (verified.first, verified.other_bits, verified.inputs) == (None, 0, applied)


def test_bad_inputs_are_counted_in_the_diagnostics_and_change_nothing(
    stepped: tuple[subprocess.Popen[str], Remote],
) -> None:
    node, remote = stepped
    assert remote.set(step_count=100)[0].successful
    diagnostics = remote.diagnostics()
    pushing = remote.node.create_publisher(WrenchStamped, "/landing/external_wrench", 10)
    remote.until(lambda: pushing.get_subscription_count() > 0)
    # inputs are received by best effort: the first may be lost while the node finds the publisher
    step_until(
        remote,
        lambda: pushing.publish(wrench(x=math.nan)),
        lambda: bool(diagnostics) and int(diagnostics[-1]["inputs refused"]) >= 5,
    )
    assert diagnostics[-1]["inputs received"] == "0"
    node.send_signal(signal.SIGINT)
    _, err = node.communicate(timeout=TIMEOUT)
    warnings = [line for line in err.splitlines() if "input refused" in line]
    assert len(warnings) == 1
    assert "external.force_x = nan N" in warnings[0]
