"""The messages of a log's next chunk, gathered as the bytes of their records."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

from mcap.opcode import Opcode

from ...messages.wire import TIMES
from .records import MESSAGE_HEAD_BYTES, RECORD_HEAD

# Before a message's data: opcode, length, channel (MESSAGE_PREFIX), then sequence number, log time
# and publish time (TIMES).
MESSAGE_PREFIX = struct.Struct("<BQH")
RECORD_SIZE = MESSAGE_PREFIX.size + TIMES.size
# The largest time that a message can have [ns].
LATEST = 2**64 - 1


def message_prefix(channel: int, size: int) -> bytes:
    """The record of a message of `size` bytes on `channel`, before its sequence number."""
    return MESSAGE_PREFIX.pack(Opcode.MESSAGE, MESSAGE_HEAD_BYTES + size, channel)


@dataclass
class Gathered:
    """Messages that make a chunk.

    `parts` are the bytes of their records, `size` in all. `samples` are time [ns] and offset
    [bytes] of each sample's records, one after the other; the record of each channel is at
    `sample_offsets` from there. `singles` are time and offset of other messages by channel. `first`
    and `last` are the smallest and the largest time.
    """

    sample_offsets: Mapping[int, int]
    parts: list[bytes] = field(default_factory=list)
    size: int = 0
    samples: array[int] = field(default_factory=partial(array, "Q"))
    singles: dict[int, list[tuple[int, int]]] = field(default_factory=dict)
    first: int = LATEST
    last: int = -1

    @property
    def sample_count(self) -> int:
        """The number of samples."""
        return len(self.samples) // 2

    @property
    def count(self) -> int:
        """The number of messages."""
        singles = sum(map(len, self.singles.values()))
        return self.sample_count * len(self.sample_offsets) + singles

    def records(self, channel: int) -> list[tuple[int, bytes]]:
        """Time [ns] and record of each single message of `channel`."""
        data = b"".join(self.parts)
        found = []
        for time, offset in self.singles.get(channel, ()):
            _, length = RECORD_HEAD.unpack_from(data, offset)
            found.append((time, data[offset : offset + RECORD_HEAD.size + length]))
        return found


class ChunkBuffer:
    """Gathers messages, and hands them over when they make a chunk.

    A chunk is full when the next message would make it larger than `limit`. It is handed over
    before the first message that is later than all in it, so that no chunk has times of another.

    `sample_offsets` gives, by channel, the offset of its record among the records of a sample
    [bytes].

    Args:
        hand_over: takes a chunk's messages.
        limit: size of a full chunk [bytes].
        begun: size of what the first chunk holds besides [bytes].
    """

    def __init__(self, hand_over: Callable[[Gathered], None], limit: int, begun: int = 0) -> None:
        self.sample_offsets: dict[int, int] = {}
        self._hand_over, self._limit, self._begun = hand_over, limit, begun
        self._open = Gathered(self.sample_offsets)

    def add(self, channel: int, sequence: int, time: int, data: bytes) -> None:
        """Adds a message of `channel`, logged and published at `time` [ns]."""
        head = message_prefix(channel, len(data)) + TIMES.pack(sequence, time, time)
        self.add_record(channel, time, head + data)

    def add_record(self, channel: int, time: int, record: bytes) -> None:
        """Adds the record of a message of `channel`, logged at `time` [ns]."""
        offset = self._append(time, record)
        self._open.singles.setdefault(channel, []).append((time, offset))

    def add_sample(self, time: int, records: bytes) -> None:
        """Adds the records of a sample's messages, logged and published at `time` [ns].

        There is one record for each channel of `sample_offsets`.
        """
        offset = self._append(time, records)
        self._open.samples.extend((time, offset))

    def _append(self, time: int, records: bytes) -> int:
        gathered = self._open
        if self._begun + gathered.size + len(records) > self._limit and time > gathered.last:
            self.hand_over()
            gathered = self._open
        offset = gathered.size
        gathered.parts.append(records)
        gathered.size += len(records)
        if time > gathered.last:
            gathered.last = time
        if time < gathered.first:
            gathered.first = time
        return offset

    def hand_over(self) -> None:
        """Hands over what was gathered, if anything was."""
        gathered = self._open
        if gathered.parts:
            self._begun = 0
            self._open = Gathered(self.sample_offsets)
            self._hand_over(gathered)
