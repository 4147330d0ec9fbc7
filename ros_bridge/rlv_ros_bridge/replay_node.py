"""Plays a log back: the recorded bytes, in the log's order, with its original timing and quality of service."""

from __future__ import annotations

import gc
import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.serialization import serialize_message

from rlv_landing.errors import LandingError, unknown

from . import topics as landing_topics
from .log_reader import LogMessage, LogReader
from .message_types import message_class
from .messages import set_stamp
from .qos import CLOCK, parse_qos
from .restamp import Restamper
from .ros_setup import StopFlag, ros_context, wait_for_acknowledgement, wait_for_subscribers

# The system wakes a sleeper up to some hundred microseconds late: the rest is waited for awake.
SPIN_SECONDS = 300e-6
LOOK_ROUND_SECONDS = 0.05
# One look at the node's services costs half a millisecond: in a pause, or at the latest after half a second.
PAUSE_SECONDS = 2e-3
LONGEST_DEAF_SECONDS = 0.5


@dataclass(frozen=True)
class ReplayOptions:
    """What to play, and how. Times in s of the log; `clock` is the rate of /clock in Hz of wall time, 0 for none."""

    path: Path
    rate: float = 1.0
    loop: bool = False
    start: float = 0.0
    duration: float = math.inf
    topics: tuple[str, ...] = ()
    clock: float = 0.0
    wait_for_subscribers: int = 0
    wait_timeout: float = 30.0

    def check(self) -> None:
        """Raises LandingError for a value that cannot be."""
        for name, value, unit, lo, hi in (
            ("--rate", self.rate, "", 1e-3, 1e3),
            ("--start", self.start, "s", 0.0, math.inf),
            ("--clock", self.clock, "Hz", 0.0, 1e4),
            ("--wait-for-subscribers", float(self.wait_for_subscribers), "", 0.0, 1e3),
            ("--wait-timeout", self.wait_timeout, "s", 0.0, 86400.0),
        ):
            if not (lo <= value <= hi and math.isfinite(value)):
                raise LandingError(f"{name} = {value:g} {unit}".rstrip() + f" is outside [{lo:g}, {hi:g}] {unit}".rstrip())
        if not self.duration > 0.0:
            raise LandingError(f"--duration = {self.duration:g} s must be above 0 s")


@dataclass(frozen=True)
class ReplaySummary:
    """How a replay went: messages and whole turns played, the signal that ended it (or 0), lateness [s], whether the log was cut."""

    messages: int
    turns: int
    signal: int
    median_lateness: float
    largest_lateness: float
    acknowledged: bool
    cut: bool


class Selection:
    """The part of a log that is to be played, in memory. Raises LandingError where there is nothing to play."""

    def __init__(self, reader: LogReader, options: ReplayOptions) -> None:
        messages = list(reader.messages())
        if not messages:
            raise LandingError(f"{reader.path} holds no message that can be read; there is nothing to play")
        chosen = select_topics(reader, options.topics)
        self.first = min(m.log_time for m in messages) + round(options.start * 1e9)
        last = self.first + round(options.duration * 1e9) if math.isfinite(options.duration) else math.inf
        self.messages: list[LogMessage] = [m for m in messages if m.topic in chosen and self.first <= m.log_time <= last]
        if not self.messages:
            length = (max(m.log_time for m in messages) - min(m.log_time for m in messages)) / 1e9
            raise LandingError(f"nothing to play from --start {options.start:g} s on: the log is {length:g} s long")
        self.channels = [c for c in reader.channels.values() if c.topic in chosen]
        self.length = max(m.log_time for m in self.messages) - self.first
        self.cut = reader.cut


def select_topics(reader: LogReader, names: Sequence[str]) -> set[str]:
    """The full names of the topics to play: all, or `names`, each full or relative to the landing's namespace.

    Raises LandingError, with the nearest name, for one that the log does not hold.
    """
    if not names:
        return set(reader.channels)
    chosen = set()
    for name in names:
        full = name if name in reader.channels else f"{reader.namespace}/{name}"
        if full not in reader.channels:
            known = [*reader.channels, *(t.removeprefix(reader.namespace + "/") for t in reader.channels)]
            raise unknown("topic", name, known)
        chosen.add(full)
    return chosen


class ReplayNode(Node):
    """Publishes a selection of a log's messages. Raises LandingError where a message type is not installed."""

    def __init__(self, selection: Selection, options: ReplayOptions) -> None:
        super().__init__("replay_node")
        self._selection = selection
        self._options = options
        self._spinner = SingleThreadedExecutor(context=self.context)
        self._spinner.add_node(self)
        # `struts` last, as in the landing node: who waits for a match on it finds the others matched.
        channels = sorted(selection.channels, key=lambda c: c.topic.endswith(f"/{landing_topics.STRUTS.name}"))
        self._outlets = {c.topic: self.create_publisher(message_class(c.type_name), c.topic, parse_qos(c.qos).profile()) for c in channels}
        self._types = {c.topic: c.type_name for c in channels}
        self._waited_for = channels[-1].topic
        self._clock_message = message_class(landing_topics.CLOCK.type_name)()
        self._clock_publisher = None
        if options.clock > 0.0:
            self._clock_publisher = self.create_publisher(type(self._clock_message), landing_topics.CLOCK.name, CLOCK.profile())
        self._lateness: list[float] = []
        self._spun = 0.0

    def play(self, stop: StopFlag) -> ReplaySummary:
        """The selection once, or turn after turn with `loop`, until its end or a signal."""
        o, selection = self._options, self._selection
        wait_for_subscribers(self._outlets[self._waited_for], o.wait_for_subscribers, o.wait_timeout, self._spinner, stop)
        played = turns = 0
        # One step of the log lies between the last message of a turn and the first of the next.
        step = _typical_step(selection.messages)
        gc.collect()
        gc.freeze()
        gc.disable()
        try:
            started = time.perf_counter()
            while not stop:
                epoch = turns * (selection.length + step)
                count = self._turn(started + epoch / 1e9 / o.rate, epoch, stop)
                played += count
                if count < len(selection.messages):
                    break
                turns += 1
                if not o.loop:
                    break
        finally:
            gc.enable()
            gc.unfreeze()
        acknowledged = wait_for_acknowledgement(list(self._outlets.values()), interrupted=bool(stop))
        late = sorted(self._lateness)
        return ReplaySummary(
            messages=played,
            turns=turns,
            signal=stop.number,
            median_lateness=late[len(late) // 2] if late else 0.0,
            largest_lateness=late[-1] if late else 0.0,
            acknowledged=acknowledged,
            cut=selection.cut,
        )

    def _turn(self, started: float, epoch: int, stop: StopFlag) -> int:
        """One turn whose time 0 is at `started` of the wall clock; `epoch` [ns] is added to the stamps. How many messages were played."""
        from tqdm import tqdm

        selection, rate = self._selection, self._options.rate
        restamp = Restamper(self._types, epoch) if epoch else None
        tick = 1.0 / self._options.clock if self._clock_publisher is not None else math.inf
        next_tick = started if self._clock_publisher is not None else math.inf
        seconds = selection.length / 1e9
        bar_format = "replay {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s [{elapsed}<{remaining}]"
        with tqdm(total=seconds, disable=not sys.stderr.isatty(), bar_format=bar_format, file=sys.stderr) as bar:
            for i, message in enumerate(selection.messages):
                due = started + (message.log_time - selection.first) / 1e9 / rate
                while next_tick <= due:
                    if not self._wait_until(next_tick, stop):
                        return i
                    self._publish_clock(epoch + selection.first + round((next_tick - started) * rate * 1e9))
                    next_tick += tick
                if not self._wait_until(due, stop):
                    return i
                data = message.data if restamp is None else restamp(message.topic, message.data)
                self._outlets[message.topic].publish(data)
                self._lateness.append(time.perf_counter() - due)
                done = (message.log_time - selection.first) / 1e9
                if done - bar.n > 0.02:
                    bar.update(done - bar.n)
        return len(selection.messages)

    def _wait_until(self, due: float, stop: StopFlag) -> bool:
        """Waits until `due` of the wall clock; False where a signal came."""
        while (left := due - time.perf_counter()) > 0.0:
            if left > SPIN_SECONDS:
                deaf = time.perf_counter() - self._spun
                if (deaf > LOOK_ROUND_SECONDS and left > PAUSE_SECONDS) or deaf > LONGEST_DEAF_SECONDS:
                    self._spinner.spin_once(timeout_sec=0)
                    self._spun = time.perf_counter()
                else:
                    time.sleep(min(left - SPIN_SECONDS, LOOK_ROUND_SECONDS))
            if stop:
                return False
        return not stop

    def _publish_clock(self, nanoseconds: int) -> None:
        if self._clock_publisher is not None:
            set_stamp(self._clock_message.clock, nanoseconds)
            self._clock_publisher.publish(serialize_message(self._clock_message))

    def destroy_node(self) -> None:
        """Also lets go of the executor."""
        self._spinner.shutdown()
        super().destroy_node()


def _typical_step(messages: Sequence[LogMessage]) -> int:
    """The smallest time between two instants of the log [ns]; a millisecond where there is only one."""
    times = sorted({m.log_time for m in messages})
    return min((b - a for a, b in pairwise(times)), default=1_000_000)


def replay(options: ReplayOptions, ros_args: Sequence[str], stop: StopFlag) -> ReplaySummary:
    """Plays a log in a ROS 2 of its own, started with `ros_args`. Raises LandingError: bad options, a log or a topic that is not there."""
    options.check()
    selection = Selection(LogReader(options.path), options)
    with ros_context(ros_args):
        node = ReplayNode(selection, options)
        try:
            return node.play(stop)
        finally:
            node.destroy_node()
