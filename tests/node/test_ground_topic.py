"""The topic `ground`: the ground at the start, and positions with and without velocities."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path
from random import Random
from typing import Any

import pytest
from bridge_tools import TIMEOUT, start
from hypothesis import given
from hypothesis import strategies as st
from rclpy.duration import Duration
from remote import CLEANUP, CONFIGURE, Remote
from sensor_msgs.msg import JointState

from rlv_landing import Landing, LandingError, Parameters
from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.verification.verify import verify
from rlv_ros_bridge.messages.inputs import merged, read_ground
from rlv_ros_bridge.node.commanded_ground import CommandedGround
from rlv_ros_bridge.node.input_queue import InputQueue

STEP = 1_000_000
HEAVE, HEAVE_RATE, TILT = "ground.heave", "ground.heave_rate", "ground.tilt"


def heave(position: float, velocity: float | None = None) -> JointState:
    message = JointState(name=["ground_heave"], position=[position])
    if velocity is not None:
        message.velocity = [velocity]
    return message


@given(
    spacings=st.lists(st.integers(1, 40), min_size=1, max_size=12),
    places=st.lists(st.floats(-0.5, 0.5), min_size=13, max_size=13),
)
def test_positions_alone_move_the_ground_without_a_jump_to_the_last_one(spacings, places):
    """Its position is the integral of its rate at every step."""
    ground, now, last = CommandedGround(STEP), 0, 0
    ground.command(0, {HEAVE: places[0]})
    before = ground.values(0)
    assert before[HEAVE] == places[0]
    for spacing, place in zip([*spacings, 100], places[1:]):
        for _ in range(spacing):
            now += STEP
            ground.stop_at_goals(now)
            values = ground.values(now)
            assert values[HEAVE] == pytest.approx(
                before[HEAVE] + 1e-3 * before[HEAVE_RATE], abs=1e-12
            )
            before = values
        ground.command(now, {HEAVE: place})
        values = ground.values(now)
        assert values[HEAVE] == before[HEAVE]
        before, last = values, place
    # the way to the last position takes at most 1.5 s; one that is sent again begins no new way
    for _ in range(1600):
        now += STEP
        ground.stop_at_goals(now)
    assert ground.values(now) == {**ground.values(0), HEAVE: last, HEAVE_RATE: 0.0}


def test_positions_of_a_steady_motion_at_uneven_times_give_a_motion_without_stops():
    """The messages come 8 to 12 ms apart; the ground rises at 0.2 m/s."""
    ground, random, now, rates = CommandedGround(STEP), Random(1), 0, []
    ground.command(0, {HEAVE: 0.0})
    due = 0
    for k in range(3000):
        now = (k + 1) * STEP
        ground.stop_at_goals(now)
        if now >= due:
            ground.command(now, {HEAVE: 0.2e-9 * now})
            due = now + random.randint(8, 12) * STEP
        rates.append(ground.values(now)[HEAVE_RATE])
    assert min(rates[200:]) > 0.1
    assert max(rates[200:]) < 0.3
    assert ground.values(now)[HEAVE] == pytest.approx(0.2 * 3.0, abs=0.2 * 0.025)


def test_a_velocity_is_used_as_it_is_and_the_other_joint_goes_on():
    ground = CommandedGround(STEP)
    ground.command(0, read_ground(heave(0.1, 0.5)))
    ground.command(5 * STEP, {TILT: 0.01, "ground.tilt_rate": -0.2})
    values = ground.values(10 * STEP)
    assert values[HEAVE] == pytest.approx(0.1 + 0.5 * 10e-3)
    assert values[TILT] == pytest.approx(0.01 - 0.2 * 5e-3)
    assert ground.stop(10 * STEP)
    assert ground.values(20 * STEP) == {**values, HEAVE_RATE: 0.0, "ground.tilt_rate": 0.0}
    assert not ground.stop(21 * STEP)


def test_a_position_that_is_sent_again_with_its_velocity_does_not_move_the_ground_back():
    ground = CommandedGround(STEP)
    for k in range(5):
        ground.command(10 * k * STEP, read_ground(heave(0.1, 0.5)))
    assert ground.values(60 * STEP)[HEAVE] == pytest.approx(0.1 + 0.5 * 60e-3)
    ground.command(60 * STEP, read_ground(heave(0.1, 0.0)))
    assert ground.values(70 * STEP)[HEAVE] == 0.1


def test_a_position_that_is_sent_again_alone_does_not_hurry_the_ground():
    """Each 5 ms the deck's position comes, which changes once a second."""
    ground, rates = CommandedGround(STEP), []
    ground.command(0, {HEAVE: 0.0})
    for now in range(STEP, 4_000_000_000, STEP):
        ground.stop_at_goals(now)
        if now % (5 * STEP) == 0:
            ground.command(now, {HEAVE: 0.1 * (now // 1_000_000_000)})
        rates.append(ground.values(now)[HEAVE_RATE])
    assert max(rates) == pytest.approx(0.1, rel=0.2)
    assert min(rates[1000:]) > 0.06


def test_a_position_alone_brings_the_ground_back_from_where_a_velocity_led_it():
    ground = CommandedGround(STEP)
    ground.command(0, read_ground(heave(0.1, 0.5)))
    assert ground.stop(20 * STEP)
    ground.command(40 * STEP, read_ground(heave(0.1)))
    assert ground.values(40 * STEP)[HEAVE] == pytest.approx(0.11)
    ground.stop_at_goals(100 * STEP)
    assert ground.values(100 * STEP)[HEAVE] == 0.1


def test_a_stop_lets_the_ground_reach_the_position_that_it_is_on_its_way_to():
    ground = CommandedGround(STEP)
    ground.command(0, {HEAVE: 0.0})
    ground.command(1000 * STEP, {HEAVE: 0.1})
    assert not ground.stop(1500 * STEP)
    ground.stop_at_goals(2500 * STEP)
    assert ground.values(2500 * STEP)[HEAVE] == 0.1


def test_of_two_messages_within_a_step_the_later_counts_joint_by_joint():
    first = {HEAVE: 0.1, HEAVE_RATE: 1.0, TILT: 0.2}
    assert merged(first, {HEAVE: 0.3}) == {HEAVE: 0.3, TILT: 0.2}
    assert merged(first, {TILT: 0.4, "ground.tilt_rate": 0.1}) == {
        HEAVE: 0.1,
        HEAVE_RATE: 1.0,
        TILT: 0.4,
        "ground.tilt_rate": 0.1,
    }


def queue(parameters: Parameters, warnings: list[str]) -> InputQueue:
    made = InputQueue(0.0, warnings.append)
    made.clear(STEP, lambda values: Landing(parameters, inputs=values))
    return made


def test_ground_inputs_that_a_landing_cannot_start_with_are_refused_and_the_next_used():
    warnings: list[str] = []
    inputs = queue(Parameters(), warnings)
    inputs.receive_ground(heave(0.0, -20.0))
    assert inputs.changes_at(0) == []
    assert (inputs.refused, len(warnings)) == (1, 1)
    assert "below the ground" in warnings[0]
    inputs.receive_ground(heave(0.2, 0.1))
    (change,) = inputs.changes_at(0)
    assert (change.values[HEAVE], change.values[HEAVE_RATE]) == (0.2, 0.1)
    inputs.receive_ground(heave(0.2, -20.0))  # after the start no rate is refused
    assert inputs.changes_at(STEP)[0].values[HEAVE_RATE] == -20.0


@pytest.mark.parametrize("spacing", [1, 7, 20])
def test_positions_alone_lift_a_parked_vehicle_without_force_peaks(spacing):
    """`Landing` gets the node's changes for a ground that rises by 0.3 m within 2 s.

    A message comes every `spacing` steps.
    """
    warnings: list[str] = []
    inputs, landing = queue(Parameters(), warnings), Landing()
    landing.advance_to(6.0)
    before = landing.get("energy.work_ground")
    weight, forces = (178.0 + 4 * 4.2) * 9.81, []
    for k in range(6000, 9000):
        if k % spacing == 0:
            grown = min((k - 6000) / 2000, 1.0)
            inputs.receive_ground(heave(0.3 * grown**3 * (10.0 - 15.0 * grown + 6.0 * grown**2)))
        for change in inputs.changes_at(k * STEP):
            landing.set_inputs(change.values)
        landing.advance_to((k + 1) * 1e-3)
        forces.append(sum(landing.get(f"leg[{leg}].contact.force_y") for leg in (1, 2, 3, 4)))
    assert min(forces) / weight > 0.9
    assert max(forces) / weight < 1.1
    work = landing.get("energy.work_ground") - before
    assert work == pytest.approx(weight * 0.3, rel=3e-3)
    assert warnings == []


def deliver(remote: Remote, publisher: Any, message: JointState) -> None:
    """Publish, and return when the node, a reliable subscriber here, has the message.

    Its reader has acknowledged it, and the node has answered a later request.
    """
    publisher.publish(message)
    assert publisher.wait_for_all_acked(Duration(seconds=TIMEOUT))
    assert remote.get("step_count")


def test_ground_inputs_before_the_first_step_place_the_vehicle_and_the_log_repeats(
    fmu: Path, tmp_path: Path, domain: int, processes: list[subprocess.Popen[str]]
) -> None:
    """The node's numbers are `Landing`'s. Later messages give positions alone."""
    node = start(
        "node", "--managed", "--fmu", fmu, "--record", tmp_path / "log",
        "--ros-args", "-p", "input_timeout:=0.0",
        "-p", "qos_overrides./landing/ground.subscription.reliability:=reliable", domain=domain,
    )  # fmt: skip
    processes.append(node)
    with Remote(domain) as remote:
        assert remote.change(CONFIGURE)
        moving = remote.node.create_publisher(JointState, "/landing/ground", 10)
        applied: list[JointState] = []
        remote.node.create_subscription(JointState, "/landing/applied/ground", applied.append, 100)
        remote.until(lambda: moving.get_subscription_count() > 0)
        remote.until(lambda: remote.node.count_publishers("/landing/applied/ground") > 0)
        both = JointState(name=["ground_heave", "ground_tilt"], position=[0.3, 0.05])
        deliver(remote, moving, both)
        assert remote.set(step_count=50)[0].successful
        assert remote.trigger("step")[0]
        assert remote.set(step_count=10)[0].successful
        for k in range(1, 12):
            count = len(applied)
            moving.publish(heave(0.3 + 1e-4 * k * k))
            while len(applied) == count:
                assert remote.trigger("step")[0]
                remote.executor.spin_once(timeout_sec=0.05)
        assert remote.set(step_count=1000)[0].successful
        assert remote.trigger("step") == (True, "at 1 s, finished")
        assert remote.change(CLEANUP)
        node.send_signal(signal.SIGINT)
        assert node.wait(TIMEOUT) == 130
    reader = LogReader(tmp_path / "log")
    reader.read_through()
    found = history_of(reader)
    parameters = reader.parameters()
    assert parameters is not None
    landing = Landing(parameters, inputs={HEAVE: 0.3, TILT: 0.05})
    for k in range(50):
        landing.advance_to(k * 1e-3)
        for column in ("body.y", "body.pitch", "leg[1].main_strut.force", "energy.balance"):
            if column in found:
                assert found[column][k] == landing.get(column), (k, column)
    forces = sum(found[f"leg[{leg}].contact.force_y"] for leg in (1, 2, 3, 4))
    assert forces.max() < 10.0 * (178.0 + 4 * 4.2) * 9.81
    checked = verify(LogReader(tmp_path / "log"))
    assert (checked.first, checked.other_bits) == (None, 0)
    assert checked.inputs >= 12
    by_fmu = verify(LogReader(tmp_path / "log"), fmu)
    assert (by_fmu.first, by_fmu.other_bits) == (None, 0)
    with pytest.raises(LandingError):
        Landing(parameters, inputs={HEAVE_RATE: -20.0})
