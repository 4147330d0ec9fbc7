"""The options of a replay, and the part of the log that they select. Needs no ROS 2."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from rlv_landing.errors import LandingError

from ..logs.indexed import last_time, messages_between, span_of
from ..logs.reader import LogMessage, LogReader
from ..messages.message_types import is_installed
from ..messages.topics import TF, resolve
from .clock import FASTEST, SLOWEST

# Messages of a log without a summary are kept up to so many bytes, with those of each in memory.
MOST_KEPT, MESSAGE_BYTES = 32 * 1024 * 1024, 200


@dataclass(frozen=True)
class ReplayOptions:
    """The options of a replay.

    Times are in s of the log, `wait_timeout` and `start_delay` in s of wall time. `rate` is seconds
    of the log per second. `clock` is the rate of /clock in Hz of wall time; 0: no /clock. `remap`
    holds texts OLD:=NEW.
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
    start_delay: float = 0.0

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
            ("--start-delay", self.start_delay, "s", 0.0, 86400.0),
        ):
            if not (lo <= value <= hi and math.isfinite(value)):
                raise LandingError(
                    f"{name} = {value:g} {unit}".rstrip()
                    + f" is outside [{lo:g}, {hi:g}] {unit}".rstrip()
                )
        if not self.duration > 0.0:
            raise LandingError(f"--duration = {self.duration:g} s must be above 0 s")


class Selection:
    """The part of a log that is to be played.

    A log that has its summary is read while it is iterated over, chunk by chunk, from the chunk of
    the first message on. Another is read through once for its span, and again while it is played;
    a small one is kept in memory instead.

    The messages come in the log's order, from the time `first` on, over `length` [ns]. `step` is
    the smallest time between two of them [ns] in a row, as far as they were read; 1 ms where there
    is none. `names` gives for each topic of the log the name under which it is played.

    Raises:
        LandingError: there is nothing to play, or a remap is not valid.
    """

    def __init__(self, reader: LogReader, options: ReplayOptions) -> None:
        self._reader = reader
        self._gap: int | None = None
        self._messages: list[LogMessage] | None = None
        indexed = reader.read_summary()
        self._indexed = indexed
        begin, end = _indexed_span(reader) if indexed else self._read_through()
        named = reader.select(options.topics)
        chosen = {t for t in named if options.topics or is_installed(reader.channels[t].type_name)}
        # Whose types are not installed here; /tf of our own logs is left out without a word.
        self.left_out = {
            t: reader.channels[t].type_name
            for t in named
            if t not in chosen and reader.channels[t].type_name != TF.type_name
        }
        self.first = begin + round(options.start * 1e9)
        self._last = (
            self.first + round(options.duration * 1e9)
            if math.isfinite(options.duration)
            else math.inf
        )
        if not chosen:
            raise LandingError(
                f"{reader.path}: none of its types is installed here "
                f"({', '.join(sorted(set(self.left_out.values())))}); install their packages, or "
                "source your ROS 2"
            )
        self._chosen = chosen
        last = (
            last_time(reader, chosen, self.first, self._last)
            if indexed
            else max((m.log_time for m in self._unindexed()), default=None)
        )
        if last is None:
            raise LandingError(
                f"nothing to play from --start {options.start:g} s on: "
                f"the log is {(end - begin) / 1e9:g} s long"
            )
        self.channels = [c for c in reader.channels.values() if c.topic in chosen]
        self.names = remapped_names(reader, sorted(chosen), options.remap)
        self.length = last - self.first

    def _read_through(self) -> tuple[int, int]:
        """The first and the last time of a log without a summary [ns]; a small one is kept."""
        kept: list[LogMessage] | None = []
        times: tuple[int, int] | None = None
        size = 0
        for m in self._reader.messages():
            times = (
                (m.log_time, m.log_time)
                if times is None
                else (min(times[0], m.log_time), max(times[1], m.log_time))
            )
            size += len(m.data) + MESSAGE_BYTES
            if size > MOST_KEPT:
                kept = None
            if kept is not None:
                kept.append(m)
        self._messages = kept
        if times is None:
            raise _nothing_in(self._reader)
        return times

    def _unindexed(self) -> Iterator[LogMessage]:
        """The chosen messages of a log without a summary."""
        messages = (
            self._messages if self._messages is not None else self._reader.messages(self._chosen)
        )
        for m in messages:
            if m.topic in self._chosen and self.first <= m.log_time <= self._last:
                yield m

    def begin(self) -> Generator[LogMessage, None, None]:
        """An iterator over the messages, the first of which is in memory already."""
        messages = iter(self)
        first = next(messages, None)

        def given() -> Generator[LogMessage, None, None]:
            with closing(messages):
                if first is not None:
                    yield first
                    yield from messages

        return given()

    def __iter__(self) -> Generator[LogMessage, None, None]:
        before = None
        for message in (
            messages_between(self._reader, self._chosen, self.first, self._last)
            if self._indexed
            else self._unindexed()
        ):
            if before is not None and before != message.log_time:
                gap = abs(message.log_time - before)
                self._gap = gap if self._gap is None else min(gap, self._gap)
            before = message.log_time
            yield message

    @property
    def step(self) -> int:
        """The smallest time between two messages in a row [ns]; 1 ms where there is none."""
        return self._gap if self._gap is not None else 1_000_000

    @property
    def cut(self) -> bool:
        """Whether the log is incomplete, or what was read of it is damaged."""
        return self._reader.cut


def _indexed_span(reader: LogReader) -> tuple[int, int]:
    """The first and the last time of a log by its summaries [ns].

    Raises:
        LandingError: it has no message.
    """
    span = span_of(reader)
    if span is None:
        raise _nothing_in(reader)
    return span


def _nothing_in(reader: LogReader) -> LandingError:
    return LandingError(
        f"{reader.path} holds no message that can be read; there is nothing to play"
    )


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
