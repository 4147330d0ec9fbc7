"""Plays a log back: the recorded bytes, in the log's order, with its original timing and quality of
service.
"""

from __future__ import annotations

import gc
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from rclpy.exceptions import InvalidTopicNameException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rclpy.validate_full_topic_name import validate_full_topic_name
from std_srvs.srv import Trigger
from tqdm import tqdm

from rlv_landing.errors import LandingError

from ..logs.reader import LogReader
from ..messages import topics as landing_topics
from ..messages.message_types import message_class
from ..messages.qos import CLOCK, parse_qos
from ..messages.rclpy_qos import qos_profile
from ..messages.restamp import Restamper
from ..messages.samples import set_stamp
from ..node.pacer import lateness_percentiles
from ..ros.setup import StopFlag, ros_context, wait_for_acknowledgement, wait_for_subscribers
from .clock import ReplayClock
from .keyboard import Keyboard
from .selection import ReplayOptions, Selection

# The system wakes a sleeper up to some hundred microseconds late: the rest is waited for awake.
SPIN_SECONDS = 300e-6
LOOK_ROUND_SECONDS = 0.05
# One look at the node's services costs half a millisecond: in a pause, or at the latest after half
# a second.
PAUSE_SECONDS = 2e-3
LONGEST_DEAF_SECONDS = 0.5
# How often the keyboard is asked [s], and what a press of up changes the rate by.
KEY_SECONDS = 0.02
RATE_FACTOR = 1.1
BAR = "replay {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s [{elapsed}<{remaining}]{postfix}"


@dataclass(frozen=True)
class ReplaySummary:
    """How a replay went: messages and whole turns played, the signal that ended it (or 0), whether
    a key did; lateness of messages in median, 99th percentile and at most, and wall time given up
    after stalls [s]; whether the log was cut.
    """

    messages: int
    turns: int
    signal: int
    quit: bool
    median_lateness: float
    p99_lateness: float
    largest_lateness: float
    lost: float
    acknowledged: bool
    cut: bool


class ReplayNode(Node):
    """Publishes a selection of a log's messages, at a pace that keys of `keyboard` and services
    (`~/pause`, `~/resume`, `~/play_next`) change. Raises LandingError: a message type is not
    installed, a topic's new name cannot be.
    """

    def __init__(
        self, selection: Selection, options: ReplayOptions, keyboard: Keyboard, stop: StopFlag
    ) -> None:
        super().__init__("replay_node")
        self._selection = selection
        self._options = options
        self._keyboard = keyboard
        self._stop = stop
        self._quit = False
        self._clock_of_log = ReplayClock(options.rate, options.start_paused)
        self._spinner = SingleThreadedExecutor(context=self.context)
        self._spinner.add_node(self)
        self._offer_services()
        # `struts` last, as in the landing node: who waits for a match on it finds the others
        # matched.
        channels = sorted(
            selection.channels, key=lambda c: c.topic.endswith(f"/{landing_topics.STRUTS.name}")
        )
        publishers: dict[str, Any] = {}
        for c in channels:
            name = selection.names[c.topic]
            if name not in publishers:
                _check_name(name)
                publishers[name] = self.create_publisher(
                    message_class(c.type_name), name, qos_profile(parse_qos(c.qos))
                )
        self._outlets = {c.topic: publishers[selection.names[c.topic]] for c in channels}
        self._types = {c.topic: c.type_name for c in channels}
        self._waited_for = channels[-1].topic
        self._clock_message = message_class(landing_topics.CLOCK.type_name)()
        self._clock_publisher = None
        if options.clock > 0.0:
            self._clock_publisher = self.create_publisher(
                type(self._clock_message), landing_topics.CLOCK.name, qos_profile(CLOCK)
            )
        self._lateness: list[float] = []
        self._spun = self._asked = 0.0

    def _offer_services(self) -> None:
        clock = self._clock_of_log
        for name, act, otherwise in (
            ("pause", clock.pause, "the replay is paused already"),
            ("resume", clock.resume, "the replay is not paused"),
            ("play_next", clock.step, "the replay is not paused; pause it first"),
        ):
            self.create_service(Trigger, f"~/{name}", partial(_answer, act, otherwise))

    def play(self) -> ReplaySummary:
        """The selection once, or turn after turn with `loop`, until its end, a signal, or the key
        q.
        """
        o, selection, stop = self._options, self._selection, self._stop
        wait_for_subscribers(
            self._outlets[self._waited_for],
            o.wait_for_subscribers,
            o.wait_timeout,
            self._spinner,
            stop,
        )
        played = turns = 0
        # One step of the log lies between the last message of a turn and the first of the next.
        period = selection.length + selection.step
        # The progress bars' lock is made here, for that takes milliseconds.
        tqdm.get_lock()  # type: ignore[no-untyped-call]
        gc.collect()
        gc.freeze()
        gc.disable()
        try:
            self._clock_of_log.start(time.perf_counter())
            while not self._ended:
                count = self._turn(turns * period)
                played += count
                if count < len(selection.messages):
                    break
                turns += 1
                if not o.loop:
                    break
        finally:
            gc.enable()
            gc.unfreeze()
        acknowledged = wait_for_acknowledgement(
            list(self._outlets.values()), interrupted=bool(stop)
        )
        median, p99, largest = lateness_percentiles(self._lateness)
        return ReplaySummary(
            messages=played,
            turns=turns,
            signal=stop.number,
            quit=self._quit,
            median_lateness=median,
            p99_lateness=p99,
            largest_lateness=largest,
            lost=self._clock_of_log.lost,
            acknowledged=acknowledged,
            cut=selection.cut,
        )

    @property
    def _ended(self) -> bool:
        return bool(self._stop) or self._quit

    def _turn(self, epoch: int) -> int:
        """One turn; `epoch` [ns] is added to the stamps. How many messages were played."""
        selection, clock = self._selection, self._clock_of_log
        restamp = Restamper(self._types, epoch) if epoch else None
        next_tick = epoch / 1e9 if self._clock_publisher is not None else math.inf
        with tqdm(
            total=selection.length / 1e9,
            disable=not sys.stderr.isatty(),
            bar_format=BAR,
            file=sys.stderr,
            postfix=self._pace,
        ) as bar:
            for i, message in enumerate(selection.messages):
                position = (epoch + message.log_time - selection.first) / 1e9
                while next_tick <= position:
                    if not self._wait_until(next_tick, bar):
                        return i
                    self._publish_clock(selection.first + round(next_tick * 1e9))
                    # Ticks are even in wall time, whatever the rate is at present.
                    next_tick += clock.rate / self._options.clock
                if not self._wait_until(position, bar):
                    return i
                late = time.perf_counter() - clock.due(position)
                data = message.data if restamp is None else restamp(message.topic, message.data)
                self._outlets[message.topic].publish(data)
                if math.isfinite(late):
                    self._lateness.append(late)
                clock.give_up(late)
                clock.passed(position)
                done = (message.log_time - selection.first) / 1e9
                if done - bar.n > 0.02 or clock.paused:
                    bar.update(done - bar.n)
        return len(selection.messages)

    def _wait_until(self, position: float, bar: Any) -> bool:
        """Waits until the time `position` of the log is due; False where the replay is to end."""
        clock = self._clock_of_log
        while not self._ended:
            now = time.perf_counter()
            if self._keyboard.there and now - self._asked > KEY_SECONDS:
                self._asked = now
                self._obey(self._keyboard.keys(), bar)
                continue
            left = clock.due(position) - now
            if left <= 0.0:
                return True
            if clock.paused:
                self._spinner.spin_once(timeout_sec=KEY_SECONDS)
            elif left > SPIN_SECONDS:
                deaf = now - self._spun
                if (
                    deaf > LOOK_ROUND_SECONDS and left > PAUSE_SECONDS
                ) or deaf > LONGEST_DEAF_SECONDS:
                    self._spinner.spin_once(timeout_sec=0)
                    self._spun = time.perf_counter()
                else:
                    time.sleep(min(left - SPIN_SECONDS, KEY_SECONDS))
        return False

    def _obey(self, keys: Sequence[str], bar: Any) -> None:
        clock = self._clock_of_log
        for key in keys:
            now = time.perf_counter()
            if key == "space":
                (clock.resume if clock.paused else clock.pause)(now)
            elif key == "right":
                clock.step()
            elif key == "q":
                self._quit = True
            else:
                clock.change_rate(RATE_FACTOR if key == "up" else 1.0 / RATE_FACTOR, now)
        if keys:
            bar.set_postfix_str(self._pace)

    @property
    def _pace(self) -> str:
        clock = self._clock_of_log
        return f"rate {clock.rate:.3g}{', paused' if clock.paused else ''}"

    def _publish_clock(self, nanoseconds: int) -> None:
        if self._clock_publisher is not None:
            set_stamp(self._clock_message.clock, nanoseconds)
            self._clock_publisher.publish(serialize_message(self._clock_message))

    def destroy_node(self) -> None:
        """Also lets go of the executor."""
        self._spinner.shutdown()
        super().destroy_node()


def _answer(act: Callable[[float], bool], otherwise: str, _request: Any, response: Any) -> Any:
    response.success = act(time.perf_counter())
    response.message = "" if response.success else otherwise
    return response


def _check_name(name: str) -> None:
    try:
        validate_full_topic_name(name)
    except InvalidTopicNameException as e:
        raise LandingError(f"{name!r} cannot be a topic: {' '.join(str(e).split())}") from None


def replay(options: ReplayOptions, ros_args: Sequence[str], stop: StopFlag) -> ReplaySummary:
    """Plays a log in a ROS 2 of its own, started with `ros_args`.

    Raises LandingError: bad options, a log or a topic that is not there.
    """
    options.check()
    selection = Selection(LogReader(options.path), options)
    with ros_context(ros_args), Keyboard() as keyboard:
        node = ReplayNode(selection, options, keyboard, stop)
        try:
            return node.play()
        finally:
            node.destroy_node()
