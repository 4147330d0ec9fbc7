"""Replay on a terminal: keys, the progress line, and the terminal's settings afterwards."""

from __future__ import annotations

import math
import os
import signal
from pathlib import Path

import pytest
from bridge_tools import Listener
from pytest import approx
from terminal import Terminal

from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.replay.clock import STALL_SECONDS, ReplayClock

SPACE, RIGHT, UP, DOWN = " ", "\x1b[C", "\x1b[A", "\x1b[B"
STRUTS = {"/landing/struts": "sensor_msgs/msg/JointState"}
HEARD = ("--topics", "struts", "--wait-for-subscribers", 1)


def test_single_steps_and_then_the_rest_reach_a_waiting_subscriber_complete(
    one_log: Path, tmp_path: Path, domain: int
) -> None:
    original = [m.data for m in LogReader(one_log).messages(STRUTS)]
    listener = Listener(STRUTS, tmp_path, domain, {"/landing/struts": len(original)}, announce=3)
    try:
        with Terminal("replay", one_log, "--start-paused", *HEARD, domain=domain) as terminal:
            terminal.until("paused")
            terminal.press(RIGHT + "x" + RIGHT + "\x1bOC")
            listener.wait_for_announcement()
            terminal.press(SPACE)
            assert terminal.status() == 0
            assert "played 1001 messages; lateness" in terminal.shown
            assert "us in 99 % of messages" in terminal.shown
            assert terminal.is_as_it_was
        assert [m.data for m in listener.finish()] == original
    finally:
        listener.stop()


def test_only_steps_are_played_in_a_pause(one_log: Path, tmp_path: Path, domain: int) -> None:
    listener = Listener(STRUTS, tmp_path, domain, announce=5)
    try:
        with Terminal("replay", one_log, "--start-paused", *HEARD, domain=domain) as terminal:
            terminal.until("paused")
            terminal.press(RIGHT * 5)
            listener.wait_for_announcement()
            terminal.press("q")
            assert terminal.status() == 0
            assert "played 5 messages" in terminal.shown
        assert len(listener.finish()) == 5
    finally:
        listener.stop()


def test_keys_pause_resume_and_change_the_rate(one_log: Path, domain: int) -> None:
    with Terminal("replay", one_log, "--rate", 0.01, domain=domain) as terminal:
        terminal.until("rate 0.01")
        for key, shown in (
            (UP, "rate 0.011"),
            (SPACE, "rate 0.011, paused"),
            (DOWN, "rate 0.01, paused"),
            (SPACE, "rate 0.01"),
        ):
            terminal.press(key)
            terminal.until(shown)
        assert not terminal.line_by_line
        terminal.press("q")
        assert terminal.status() == 0
        assert terminal.is_as_it_was


@pytest.mark.parametrize("end", ["q", "\x03", "\x1c", signal.SIGTERM, signal.SIGHUP])
def test_the_terminals_settings_are_restored(
    one_log: Path, domain: int, end: str | signal.Signals
) -> None:
    with Terminal("replay", one_log, "--rate", 0.01, domain=domain) as terminal:
        terminal.until("rate 0.01")
        assert not terminal.line_by_line
        if isinstance(end, str):
            terminal.press(end)
        else:
            os.kill(terminal.pid, end)
        status = terminal.status()
        code = os.waitstatus_to_exitcode(status)
        assert (
            code
            == {
                "q": 0,
                "\x03": 130,
                "\x1c": -signal.SIGQUIT,
                signal.SIGTERM: 143,
                signal.SIGHUP: 129,
            }[end]
        )
        assert terminal.is_as_it_was


def test_an_error_restores_the_terminals_settings(one_log: Path, domain: int) -> None:
    with Terminal(
        "replay", one_log, "--wait-for-subscribers", 1, "--wait-timeout", 0.5, domain=domain
    ) as terminal:
        assert os.waitstatus_to_exitcode(terminal.status()) == 2
        assert terminal.is_as_it_was


def test_a_stopped_replay_restores_the_terminal_and_reads_keys_again_afterwards(
    one_log: Path, domain: int
) -> None:
    with Terminal("replay", one_log, "--rate", 0.01, domain=domain) as terminal:
        terminal.until("rate 0.01")
        terminal.press("\x1a")
        assert os.WIFSTOPPED(terminal.status())
        assert terminal.is_as_it_was
        os.kill(terminal.pid, signal.SIGCONT)
        terminal.press(SPACE)
        terminal.until("paused")
        assert not terminal.line_by_line
        terminal.press("q")
        assert terminal.status() == 0
        assert terminal.is_as_it_was


def test_time_stops_in_a_pause_and_continues_from_there() -> None:
    clock = ReplayClock(2.0)
    clock.start(100.0)
    assert clock.due(4.0) == 102.0
    assert clock.pause(101.0)
    assert not clock.pause(101.0)
    assert clock.due(4.0) == math.inf
    assert clock.resume(111.0)
    assert not clock.resume(111.0)
    assert clock.due(4.0) == 112.0
    assert clock.due(2.0) == 111.0


def test_a_step_plays_one_message_and_moves_time_to_it() -> None:
    clock = ReplayClock(1.0, paused=True)
    clock.start(50.0)
    assert clock.step()
    assert clock.due(3.0) == -math.inf
    clock.mark_played(3.0)
    assert clock.due(4.0) == math.inf
    clock.resume(60.0)
    assert clock.due(4.0) == 61.0
    assert not clock.step()


def test_another_rate_counts_from_where_it_was_set_on_and_stays_in_bounds() -> None:
    clock = ReplayClock(1.0)
    clock.start(0.0)
    clock.change_rate(2.0, 10.0)
    assert clock.due(14.0) == approx(12.0)
    clock.change_rate(1e9, 10.0)
    assert clock.rate == 1e3
    clock.change_rate(1e-9, 10.0)
    assert clock.rate == 1e-3


def test_only_a_stall_is_skipped() -> None:
    clock = ReplayClock(1.0)
    clock.start(0.0)
    clock.skip_stall(0.5 * STALL_SECONDS)
    clock.skip_stall(math.inf)
    assert (clock.lost, clock.due(1.0)) == (0.0, 1.0)
    clock.skip_stall(5.0)
    assert (clock.lost, clock.due(1.0)) == (5.0, 6.0)
