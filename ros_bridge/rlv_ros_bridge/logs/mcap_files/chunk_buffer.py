"""The messages of a log's next chunk: samples as rows, others as the bytes of their records."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ...messages.wire import NANOSECONDS
from .sample_records import TIMES, SampleRecords, message_prefix

# The largest time that a message can have [ns].
LATEST = 2**64 - 1


class Single(NamedTuple):
    """A message that is not a sample's: its record, and the record's `offset` in the chunk [bytes].

    `time` is in ns. `samples` of the chunk are before it.
    """

    channel: int
    time: int
    offset: int
    samples: int
    record: bytes


@dataclass
class Gathered:
    """Messages that make a chunk.

    `rows` are those of its samples, one behind the other, and `offsets` where the records of each
    begin in the chunk [bytes]; `sample_records` makes the records of these. `size` is that of all
    records. `first` and `last` are the smallest and the largest time [ns].
    """

    sample_records: SampleRecords | None
    rows: bytearray = field(default_factory=bytearray)
    offsets: list[int] = field(default_factory=list)
    singles: list[Single] = field(default_factory=list)
    size: int = 0
    first: int = LATEST
    last: int = -1

    @property
    def sample_count(self) -> int:
        """The number of samples."""
        return len(self.offsets)

    @property
    def count(self) -> int:
        """The number of messages."""
        channels = len(self.sample_records.offsets) if self.sample_records else 0
        return self.sample_count * channels + len(self.singles)

    def parts(self) -> list[Any]:
        """The bytes of all records in their order, in pieces."""
        if self.sample_records is None or not self.offsets:
            return [single.record for single in self.singles]
        records = self.sample_records.of(self.rows)
        found: list[Any] = []
        before = 0
        for single in self.singles:
            found += [records[before : single.samples], single.record]
            before = single.samples
        return [*found, records[before:]]


class ChunkBuffer:
    """Gathers messages, and hands them over when they make a chunk.

    A chunk is full when the next message would make it larger than `limit`. It is handed over
    before the first message that is later than all in it, so that no chunk has times of another.

    Args:
        hand_over: takes a chunk's messages.
        limit: size of a full chunk [bytes].
        begun: size of what the first chunk holds besides [bytes].
    """

    def __init__(self, hand_over: Callable[[Gathered], None], limit: int, begun: int = 0) -> None:
        self._hand_over, self._limit, self._begun = hand_over, limit, begun
        self._sample_records: SampleRecords | None = None
        self._open = Gathered(None)

    def begin_samples(self, sample_records: SampleRecords) -> None:
        """Takes samples from now on, whose records `sample_records` makes; once."""
        self._sample_records = self._open.sample_records = sample_records

    def add(self, channel: int, sequence: int, time: int, data: bytes) -> None:
        """Adds a message of `channel`, logged and published at `time` [ns]."""
        head = message_prefix(channel, len(data)) + TIMES.pack(sequence, time, time)
        self.add_record(channel, time, head + data)

    def add_record(self, channel: int, time: int, record: bytes) -> None:
        """Adds the record of a message of `channel`, logged at `time` [ns]."""
        offset = self._reserve(time, len(record))
        gathered = self._open
        single = Single(channel, time, offset, len(gathered.offsets), record)
        gathered.singles.append(single)

    def add_sample(self, sequence: int, time: int, numbers: Sequence[float]) -> None:
        """Adds the numbers of a sample, logged and published at `time` [ns]."""
        records = self._sample_records
        assert records is not None
        offset = self._reserve(time, records.size)
        gathered = self._open
        gathered.offsets.append(offset)
        seconds, rest = divmod(time, NANOSECONDS)
        gathered.rows += records.pack(sequence, time, time, seconds, rest, *numbers)

    def _reserve(self, time: int, size: int) -> int:
        """The offset of what is added next, of `size` bytes and with `time` [ns]."""
        gathered = self._open
        if self._begun + gathered.size + size > self._limit and time > gathered.last:
            self.hand_over()
            gathered = self._open
        offset = gathered.size
        gathered.size += size
        if time > gathered.last:
            gathered.last = time
        if time < gathered.first:
            gathered.first = time
        return offset

    def hand_over(self) -> None:
        """Hands over what was gathered, if anything was."""
        gathered = self._open
        if gathered.size:
            self._begun = 0
            self._open = Gathered(self._sample_records)
            self._hand_over(gathered)
