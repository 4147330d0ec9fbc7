"""The options of a replay, and the part of the log that they select. Needs no ROS 2."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from rlv_landing.errors import LandingError

from ..logs.reader import LogMessage, LogReader
from ..messages.message_types import is_installed
from ..messages.topics import TF, resolve
from .clock import FASTEST, SLOWEST


@dataclass(frozen=True)
class ReplayOptions:
    """The options of a replay.

    Times are in s of the log, `wait_timeout` in s of wall time. `rate` is seconds of the log per
    second. `clock` is the rate of /clock in Hz of wall time; 0: no /clock. `remap` holds texts
    OLD:=NEW.
    """

    path: Path
    rate: float = 1.0
    loop: bool = False
    start: float = 0.0
    duration: float = math.inf
    topics: tuple[str, ...] = ()
    remap: tuple[str, ...] = ()
    start_paused: bool = False
    clock: float = 0.0
    wait_for_subscribers: int = 0
    wait_timeout: float = 30.0

    def check(self) -> None:
        """Checks every value against its bounds.

        Raises:
            LandingError: a value is out of bounds.
        """
        for name, value, unit, lo, hi in (
            ("--rate", self.rate, "", SLOWEST, FASTEST),
            ("--start", self.start, "s", 0.0, math.inf),
            ("--clock", self.clock, "Hz", 0.0, 1e4),
            ("--wait-for-subscribers", float(self.wait_for_subscribers), "", 0.0, 1e3),
            ("--wait-timeout", self.wait_timeout, "s", 0.0, 86400.0),
        ):
            if not (lo <= value <= hi and math.isfinite(value)):
                raise LandingError(
                    f"{name} = {value:g} {unit}".rstrip()
                    + f" is outside [{lo:g}, {hi:g}] {unit}".rstrip()
                )
        if not self.duration > 0.0:
            raise LandingError(f"--duration = {self.duration:g} s must be above 0 s")


class Selection:
    """The part of a log that is to be played, in memory.

    `messages` are in the log's order, from the time `first` on, over `length` [ns]. `names` gives
    for each topic of the log the name under which it is played. `cut` says that the log is
    incomplete.

    Raises:
        LandingError: there is nothing to play, or a remap is not valid.
    """

    def __init__(self, reader: LogReader, options: ReplayOptions) -> None:
        messages = list(reader.messages())
        if not messages:
            raise LandingError(
                f"{reader.path} holds no message that can be read; there is nothing to play"
            )
        chosen = {
            t
            for t in reader.select(options.topics)
            if options.topics or can_be_published(reader.channels[t].type_name)
        }
        self.first = min(m.log_time for m in messages) + round(options.start * 1e9)
        last = (
            self.first + round(options.duration * 1e9)
            if math.isfinite(options.duration)
            else math.inf
        )
        self.messages: list[LogMessage] = [
            m for m in messages if m.topic in chosen and self.first <= m.log_time <= last
        ]
        if not self.messages:
            length = (max(m.log_time for m in messages) - min(m.log_time for m in messages)) / 1e9
            raise LandingError(
                f"nothing to play from --start {options.start:g} s on: the log is {length:g} s long"
            )
        self.channels = [c for c in reader.channels.values() if c.topic in chosen]
        self.names = remapped_names(reader, sorted(chosen), options.remap)
        self.length = max(m.log_time for m in self.messages) - self.first
        self.cut = reader.cut

    @property
    def step(self) -> int:
        """The smallest time between two instants [ns]; 1 ms if there is only one."""
        times = sorted({m.log_time for m in self.messages})
        return min((b - a for a, b in pairwise(times)), default=1_000_000)


def can_be_published(type_name: str) -> bool:
    """Whether messages of the type can be published here.

    Of the types in our logs only that of `/tf` may not be installed.
    """
    return type_name != TF.type_name or is_installed(type_name)


def remapped_names(
    reader: LogReader, topics: Sequence[str], remap: Sequence[str]
) -> dict[str, str]:
    """The names under which topics are played.

    Args:
        reader: the log.
        topics: full names.
        remap: texts OLD:=NEW; both names full or relative to the namespace.

    Raises:
        LandingError: a text that is not OLD:=NEW, a topic that does not exist or gets two names, or
            one name for topics of two types.
    """
    names = {topic: topic for topic in topics}
    given: dict[str, str] = {}
    for text in remap:
        old, found, new = (part.strip() for part in text.partition(":="))
        if not (found and old and new):
            raise LandingError(f"--remap {text!r} is not OLD:=NEW, as in struts:=recorded/struts")
        (topic,) = reader.select([old])
        if topic not in names:
            raise LandingError(
                f"--remap {text!r}: {topic} is not among the topics chosen by --topics; "
                "add it there or leave the remap out"
            )
        if topic in given:
            raise LandingError(
                f"--remap gives {topic} two names, {given[topic]!r} and {new!r}; leave one out"
            )
        given[topic] = new
        names[topic] = resolve(reader.namespace, new)
    types: dict[str, tuple[str, str]] = {}
    for topic, name in names.items():
        kind = reader.channels[topic].type_name
        other, other_kind = types.setdefault(name, (topic, kind))
        if kind != other_kind:
            raise LandingError(
                f"{other} ({other_kind}) and {topic} ({kind}) cannot both be played as {name}; "
                "choose another name"
            )
    return names
