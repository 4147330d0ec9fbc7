"""The open chunk of a log: messages are gathered as the bytes of their records, and handed to
MCAP's own writer a chunk at a time.

MCAP's `add_message` takes some 5 us of processor time a message; a message of a sample that is
packed and recorded with the others takes 1.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import MessageIndex
from numpy.typing import NDArray

from .mcap_stream import HEAD as FRAME
from .mcap_stream import MESSAGE_HEAD, decode, frames

# What comes before a message's data: opcode, length, channel; sequence number, log time, publish
# time.
HEAD = struct.Struct("<BQH")
TIMES = struct.Struct("<IQQ")
RECORD_SIZE = HEAD.size + TIMES.size
# How a message index begins: opcode, length, channel, bytes of the entries.
INDEX = struct.Struct("<BQHI")


def message_head(channel: int, size: int) -> bytes:
    """How the record of a message of `size` bytes on `channel` begins, before its sequence number
    and its two times.
    """
    return HEAD.pack(Opcode.MESSAGE, MESSAGE_HEAD + size, channel)


class PackedIndex(MessageIndex):
    """MCAP's message index of `entries`, rows of time and place, written in one go."""

    def __init__(self, channel: int, entries: NDArray[np.uint64]) -> None:
        super().__init__(channel, [])
        self.entries = entries

    def write(self, stream: RecordBuilder) -> None:
        """Adds the record to `stream`."""
        size = self.entries.nbytes
        stream.write(
            INDEX.pack(Opcode.MESSAGE_INDEX, INDEX.size - FRAME.size + size, self.channel_id, size)
            + self.entries.tobytes()
        )


class OpenChunk:
    """Messages that are not in the file yet, at most `limit` bytes of them with what `mcap`, MCAP's
    writer, holds already.

    `sampled` are the channels of a sample's messages, each with the place of its record among those
    of the sample. All raise OSError where the disk does, when a chunk is written.
    """

    def __init__(self, mcap: Any, limit: int) -> None:
        self.sampled: dict[int, int] = {}
        self._mcap = mcap
        self._limit = limit
        # Where messages are put without `add_message`. Not part of the library's interface: a later
        # one may not have them.
        self._builder: Any = getattr(mcap, "_Writer__chunk_builder", None)
        self._statistics: Any = getattr(mcap, "_Writer__statistics", None)
        self._begin()

    def _begin(self) -> None:
        # The writer may hold schemas and channels already.
        self._size = self._builder.count if self._builder is not None else 0
        self._parts: list[bytes] = []
        # Times and places of samples, and of single messages by channel.
        self._samples: list[tuple[int, int]] = []
        self._singles: dict[int, list[tuple[int, int]]] = {}

    def add(self, channel: int, sequence: int, time: int, data: bytes) -> None:
        """A message of `channel`, logged and published at `time` [ns]."""
        place = self._take(
            message_head(channel, len(data)) + TIMES.pack(sequence, time, time) + data
        )
        self._singles.setdefault(channel, []).append((time, place))

    def add_sample(self, time: int, records: bytes) -> None:
        """The records of a sample's messages, one for each channel of `sampled`, logged and
        published at `time` [ns].
        """
        place = self._take(records)
        self._samples.append((time, place))

    def _take(self, records: bytes) -> int:
        if self._parts and self._size + len(records) > self._limit:
            self.write()
        place = self._size
        self._parts.append(records)
        self._size += len(records)
        return place

    def write(self) -> None:
        """Has what is gathered written as a chunk, and hands it to the operating system."""
        data = b"".join(self._parts)
        if self._builder is not None and self._statistics is not None:
            self._hand_over(data)
        else:
            for record in frames(data):
                m = decode(record[0], record[FRAME.size :])
                self._mcap.add_message(m.channel_id, m.log_time, m.data, m.publish_time, m.sequence)
        self._mcap.flush()
        self._begin()

    def _hand_over(self, data: bytes) -> None:
        """What `add_message` does with each message, once."""
        if not data:
            return
        indexes: dict[int, NDArray[np.uint64]] = {}
        if self._samples:
            # All channels at once: times and places of the samples, and to the places those within
            # a sample added.
            within = np.array([[(0, place)] for place in self.sampled.values()], "<u8")
            indexes = dict(zip(self.sampled, np.array(self._samples, "<u8") + within))
        indexes.update(
            (channel, np.array(entries, "<u8")) for channel, entries in self._singles.items()
        )
        times = [
            time for entries in (self._samples, *self._singles.values()) for time, _ in entries
        ]
        first, last = min(times), max(times)
        count = sum(map(len, indexes.values()))
        builder, statistics = self._builder, self._statistics
        builder.record_writer.write(data)
        builder.message_indices = {
            channel: PackedIndex(channel, entries) for channel, entries in indexes.items()
        }
        builder.num_messages = count
        builder.message_start_time, builder.message_end_time = first, last
        statistics.message_start_time = (
            min(first, statistics.message_start_time) if statistics.message_count else first
        )
        statistics.message_end_time = max(last, statistics.message_end_time)
        statistics.message_count += count
        for channel, entries in indexes.items():
            statistics.channel_message_counts[channel] += len(entries)
