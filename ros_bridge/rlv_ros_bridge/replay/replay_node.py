"""Plays a log: the recorded bytes, with their original timing and quality of service."""

from __future__ import annotations

import gc
import math
import struct
import sys
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
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

from rlv_landing.errors import LandingError, one_line, reason_of

from ..logs.bag_reader import open_log
from ..logs.reader import LogMessage
from ..messages import topics as landing_topics
from ..messages.message_types import message_class
from ..messages.qos import CLOCK, parse_qos, resending
from ..messages.rclpy_qos import create_publisher
from ..messages.samples import set_stamp
from ..node.pacer import lateness_percentiles
from ..node.parameters import unused_overrides
from ..ros.setup import StopFlag, ros_context, wait_for_acknowledgement, wait_until_matched
from .clock import ReplayClock
from .keyboard import Keyboard
from .restamp import Restamper
from .selection import ReplayOptions, Selection
from .waiting import ReplayWaits

# Period of serving the node while it waits for its start [s].
SERVE_SECONDS = 0.02
BAR = "replay {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s [{elapsed}<{remaining}]{postfix}"


@dataclass(frozen=True)
class ReplaySummary:
    """The figures of a replay.

    `messages` and complete `rounds` were played. `signal` is the number of the signal that ended
    it, or 0; `quit` whether a key did. The lateness of the messages is in s, as is `lost`, the wall
    time that was not made up for after stalls. `cut` says that the log is incomplete.
    """

    messages: int
    rounds: int
    signal: int
    quit: bool
    median_lateness: float
    p99_lateness: float
    largest_lateness: float
    lost: float
    acknowledged: bool
    cut: bool


class ReplayNode(Node):
    """Publishes a selection of a log's messages.

    Keys and the services `~/pause`, `~/resume` and `~/play_next` change its pace.

    Args:
        selection: the messages to play.
        options: how to play them.
        keyboard: source of keys.
        stop: notes signals, which end the replay.

    Raises:
        LandingError: a message type is not installed, or a topic's new name is not valid.
    """

    def __init__(
        self, selection: Selection, options: ReplayOptions, keyboard: Keyboard, stop: StopFlag
    ) -> None:
        super().__init__("replay_node")
        self._selection = selection
        self._options = options
        self._stop = stop
        self._replay_clock = ReplayClock(options.rate, paused=options.start_paused)
        self._service_executor = SingleThreadedExecutor(context=self.context)
        self._service_executor.add_node(self)
        self._waits = ReplayWaits(
            self._replay_clock, keyboard, stop, self._service_executor.spin_once
        )
        self._create_services()
        # A subscriber that waits for a match on `struts` finds the others matched: it comes last,
        # as in the landing node.
        channels = sorted(
            selection.channels, key=lambda c: c.topic.endswith(f"/{landing_topics.STRUTS.name}")
        )
        publishers: dict[str, Any] = {}
        for c in channels:
            name = selection.names[c.topic]
            if name not in publishers:
                _check_name(name)
                qos = resending(parse_qos(c.qos), options.rate)
                publishers[name], _ = create_publisher(self, message_class(c.type_name), name, qos)
        self._publisher_of = {c.topic: publishers[selection.names[c.topic]] for c in channels}
        self._types = {c.topic: c.type_name for c in channels}
        self._match_topic = channels[-1].topic
        self._clock_message = message_class(landing_topics.CLOCK.type_name)()
        self._clock_publisher = None
        if options.clock > 0.0:
            self._clock_publisher, _ = create_publisher(
                self, type(self._clock_message), landing_topics.CLOCK.name, CLOCK
            )
        self._lateness: list[float] = []

    def _create_services(self) -> None:
        clock = self._replay_clock
        for name, action, refusal in (
            ("pause", clock.pause, "the replay is paused already"),
            ("resume", clock.resume, "the replay is not paused"),
            ("play_next", clock.step, "the replay is not paused; pause it first"),
        ):
            self.create_service(Trigger, f"~/{name}", partial(_answer, action, refusal))

    def play(self) -> ReplaySummary:
        """Plays the selection once, or round after round with the option `loop`.

        It ends at the end of the selection, on a signal, or on the key q.
        """
        o, selection, stop = self._options, self._selection, self._stop
        self._wait_for_start()
        played = rounds = 0
        # tqdm makes its lock on first use, which takes milliseconds.
        tqdm.get_lock()  # type: ignore[no-untyped-call]
        gc.collect()
        gc.freeze()
        gc.disable()
        try:
            messages = selection.begin()
            self._replay_clock.start(time.perf_counter())
            while not self._waits.ended:
                # One step of the log lies between the last message of a round and the first of the
                # next.
                epoch = rounds * (selection.length + selection.step)
                count, whole = self._play_round(messages, epoch)
                played += count
                if not whole:
                    break
                rounds += 1
                if not o.loop:
                    break
                messages = selection.begin()
        finally:
            gc.enable()
            gc.unfreeze()
        acknowledged = wait_for_acknowledgement(
            list(self._publisher_of.values()), interrupted=bool(stop)
        )
        median, p99, largest = lateness_percentiles(self._lateness)
        return ReplaySummary(
            messages=played,
            rounds=rounds,
            signal=stop.number,
            quit=self._waits.quit,
            median_lateness=median,
            p99_lateness=p99,
            largest_lateness=largest,
            lost=self._replay_clock.lost,
            acknowledged=acknowledged,
            cut=selection.cut,
        )

    def _wait_for_start(self) -> None:
        """Waits for subscribers, and then for `start_delay`; meanwhile `/clock` is held.

        Raises:
            LandingError: there are not enough subscribers in time.
        """
        o = self._options

        def interrupted() -> bool:
            self._publish_clock(self._selection.first)
            self._service_executor.spin_once(SERVE_SECONDS)
            return bool(self._stop)

        wait_until_matched(
            self._publisher_of[self._match_topic],
            o.wait_for_subscribers,
            o.wait_timeout,
            interrupted,
            set(self._publisher_of.values()),
        )
        end = time.monotonic() + o.start_delay
        while time.monotonic() < end and not interrupted():
            continue

    def _play_round(
        self, messages: Generator[LogMessage, None, None], epoch: int
    ) -> tuple[int, bool]:
        """Plays `messages`, the selection once, with `epoch` [ns] added to the stamps.

        Returns:
            The messages played, and whether those were all.
        """
        selection, clock = self._selection, self._replay_clock
        restamp = Restamper(self._types, epoch) if epoch else None
        next_tick = epoch / 1e9 if self._clock_publisher is not None else math.inf
        count = 0
        with (
            closing(messages),
            tqdm(
                total=selection.length / 1e9,
                disable=not sys.stderr.isatty(),
                bar_format=BAR,
                file=sys.stderr,
                postfix=self._waits.status,
            ) as bar,
        ):
            for message in messages:
                position = (epoch + message.log_time - selection.first) / 1e9
                while next_tick <= position:
                    if not self._waits.wait_until(next_tick, bar):
                        return count, False
                    self._publish_clock(selection.first + round(next_tick * 1e9))
                    # Messages of /clock are even in wall time, at any rate.
                    next_tick += clock.rate / self._options.clock
                if not self._waits.wait_until(position, bar):
                    return count, False
                late = time.perf_counter() - clock.due(position)
                try:
                    data = message.data if restamp is None else restamp(message.topic, message.data)
                    self._publisher_of[message.topic].publish(data)
                except (RuntimeError, AssertionError, struct.error) as e:
                    raise _not_published(message, e) from None
                count += 1
                if math.isfinite(late):
                    self._lateness.append(late)
                clock.skip_stall(late)
                clock.mark_played(position)
                played = (message.log_time - selection.first) / 1e9
                if played - bar.n > 0.02 or clock.paused:
                    bar.update(played - bar.n)
        return count, True

    def _publish_clock(self, nanoseconds: int) -> None:
        if self._clock_publisher is not None:
            # to ROS a clock at 0 has not started
            set_stamp(self._clock_message.clock, max(1, nanoseconds))
            self._clock_publisher.publish(serialize_message(self._clock_message))

    def destroy_node(self) -> None:
        """Shuts the executor down, and destroys the node."""
        self._service_executor.shutdown()
        super().destroy_node()


def _answer(action: Callable[[float], bool], refusal: str, _request: Any, response: Any) -> Any:
    response.success = action(time.perf_counter())
    response.message = "" if response.success else refusal
    return response


def _not_published(message: LogMessage, error: Exception) -> LandingError:
    """The error where ROS 2 takes no message, as it does of one without its first four bytes."""
    return LandingError(
        f"a message of {message.place}, of {len(message.data)} "
        f"bytes, cannot be published: {' '.join(str(error).split())}; leave it out by --topics"
    )


def _check_name(name: str) -> None:
    try:
        validate_full_topic_name(name)
    except InvalidTopicNameException as e:
        raise LandingError(f"{name!r} cannot be a topic: {reason_of(e)}") from None


def replay(options: ReplayOptions, ros_args: Sequence[str], stop: StopFlag) -> ReplaySummary:
    """Plays a log in a ROS 2 started for it.

    Args:
        options: the log, and how to play it.
        ros_args: ROS arguments, `--ros-args ...`.
        stop: notes signals, which end the replay.

    Raises:
        LandingError: bad options, or a log or topic that does not exist.
    """
    options.check()
    selection = Selection(open_log(options.path), options)
    for topic, kind in selection.left_out.items():
        warning = f"warning: {topic} is left out: its type {kind} is not installed here"
        print(one_line(warning), file=sys.stderr)
    with ros_context(ros_args) as shared, Keyboard() as keyboard:
        node = ReplayNode(selection, options, keyboard, stop)
        try:
            unused_overrides(node, shared)
            return node.play()
        finally:
            node.destroy_node()
