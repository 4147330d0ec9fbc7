"""The messages of a log's open chunk, gathered as the bytes of their records.

They are handed to MCAP's own writer a chunk at a time: see `internals` for the reason.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import MessageIndex
from numpy.typing import NDArray

from ...messages.wire import TIMES
from .internals import chunk_builder, statistics
from .records import MESSAGE_HEAD_BYTES, RECORD_HEAD, decode_record, split_records

# Before a message's data: opcode, length, channel (MESSAGE_PREFIX), then sequence number, log time
# and publish time (TIMES).
MESSAGE_PREFIX = struct.Struct("<BQH")
RECORD_SIZE = MESSAGE_PREFIX.size + TIMES.size
# The start of a message index: opcode, length, channel, bytes of the entries.
INDEX_HEAD = struct.Struct("<BQHI")


def message_prefix(channel: int, size: int) -> bytes:
    """The record of a message of `size` bytes on `channel`, before its sequence number."""
    return MESSAGE_PREFIX.pack(Opcode.MESSAGE, MESSAGE_HEAD_BYTES + size, channel)


class PackedIndex(MessageIndex):
    """MCAP's message index, written in one piece.

    Args:
        channel: number of the channel.
        entries: (messages, 2), log time [ns] and offset in the chunk [bytes].
    """

    def __init__(self, channel: int, entries: NDArray[np.uint64]) -> None:
        super().__init__(channel, [])
        self.entries = entries

    def write(self, stream: RecordBuilder) -> None:
        """Writes the record to `stream`."""
        size = self.entries.nbytes
        length = INDEX_HEAD.size - RECORD_HEAD.size + size
        head = INDEX_HEAD.pack(Opcode.MESSAGE_INDEX, length, self.channel_id, size)
        stream.write(head + self.entries.tobytes())


class ChunkBuffer:
    """Gathers messages, and has them written as a chunk when it is full.

    `sample_offsets` gives, by channel, the offset of its record among the records of a sample
    [bytes]. `add`, `add_sample` and `write` raise OSError where writing fails.

    Args:
        mcap: MCAP's writer.
        limit: size of a full chunk [bytes], with what `mcap` has gathered before.
    """

    def __init__(self, mcap: Any, limit: int) -> None:
        self.sample_offsets: dict[int, int] = {}
        self._mcap = mcap
        self._limit = limit
        self._builder = chunk_builder(mcap)
        self._statistics = statistics(mcap)
        self._clear()

    def _clear(self) -> None:
        # MCAP's writer may have gathered schemas and channels before.
        self._size = self._builder.count if self._builder is not None else 0
        self._parts: list[bytes] = []
        # Time and offset of samples, and of single messages by channel.
        self._samples: list[tuple[int, int]] = []
        self._singles: dict[int, list[tuple[int, int]]] = {}

    def add(self, channel: int, sequence: int, time: int, data: bytes) -> None:
        """Adds a message of `channel`, logged and published at `time` [ns]."""
        head = message_prefix(channel, len(data)) + TIMES.pack(sequence, time, time)
        offset = self._append(head + data)
        self._singles.setdefault(channel, []).append((time, offset))

    def add_sample(self, time: int, records: bytes) -> None:
        """Adds the records of a sample's messages, logged and published at `time` [ns].

        There is one record for each channel of `sample_offsets`.
        """
        offset = self._append(records)
        self._samples.append((time, offset))

    def _append(self, records: bytes) -> int:
        if self._parts and self._size + len(records) > self._limit:
            self.write()
        offset = self._size
        self._parts.append(records)
        self._size += len(records)
        return offset

    def write(self) -> None:
        """Writes what was gathered as a chunk, and hands it to the operating system."""
        data = b"".join(self._parts)
        if self._builder is not None and self._statistics is not None:
            self._add_messages(data)
        else:
            for record in split_records(data):
                m = decode_record(record[0], record[RECORD_HEAD.size :])
                self._mcap.add_message(m.channel_id, m.log_time, m.data, m.publish_time, m.sequence)
        self._mcap.flush()
        self._clear()

    def _add_messages(self, data: bytes) -> None:
        """Does for all messages at once what `add_message` does for each."""
        if not data:
            return
        indexes = self._indexes()
        groups = (self._samples, *self._singles.values())
        times = [time for messages in groups for time, _ in messages]
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
        for channel, index in indexes.items():
            statistics.channel_message_counts[channel] += len(index)

    def _indexes(self) -> dict[int, NDArray[np.uint64]]:
        """By channel, time and offset of its messages: (messages, 2)."""
        indexes: dict[int, NDArray[np.uint64]] = {}
        if self._samples:
            # All channels at once: the samples' times and offsets, plus the offset in a sample.
            within = np.array([[(0, offset)] for offset in self.sample_offsets.values()], "<u8")
            indexes = dict(zip(self.sample_offsets, np.array(self._samples, "<u8") + within))
        indexes.update(
            (channel, np.array(entries, "<u8")) for channel, entries in self._singles.items()
        )
        return indexes
