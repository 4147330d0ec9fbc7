"""Writes gathered messages as a chunk.

They are handed to MCAP's own writer all at once: see `internals` for the reason.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import MessageIndex
from numpy.typing import NDArray

from .chunk_buffer import Gathered
from .internals import chunk_builder, chunk_indexes, statistics
from .records import RECORD_HEAD, decode_record, split_records

# The start of a message index: opcode, length, channel, bytes of the entries.
INDEX_HEAD = struct.Struct("<BQHI")


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


class PackedRecord:
    """A record of MCAP as its bytes, which take a tenth of the memory that its object takes."""

    def __init__(self, record: Any) -> None:
        builder: Any = RecordBuilder()
        record.write(builder)
        self._data = builder.end()

    def write(self, stream: RecordBuilder) -> None:
        """Writes the record to `stream`."""
        stream.write(self._data)


class JoinedRecords(RecordBuilder):
    """The records of a chunk, which are copied once, when it is written."""

    def __init__(self, parts: list[Any]) -> None:
        super().__init__()
        self._parts = parts

    def end(self) -> bytes:
        """The bytes of all records; from then on it is empty."""
        parts, self._parts = self._parts, []
        return b"".join(parts)


class ChunkWriter:
    """Writes chunks through `mcap`, MCAP's writer. `count` is the number of messages written.

    `write` raises OSError where the disk refuses.
    """

    def __init__(self, mcap: Any) -> None:
        self.count = 0
        self._mcap = mcap
        self._builder, self._statistics = chunk_builder(mcap), statistics(mcap)
        self._indexes = chunk_indexes(mcap)

    @property
    def begun(self) -> int:
        """Size of what the next chunk holds already, such as definitions [bytes]."""
        return self._builder.count if self._builder is not None else 0

    def write(self, gathered: Gathered) -> None:
        """Writes messages as a chunk, and hands it to the operating system."""
        if self._builder is not None and self._statistics is not None:
            self._add_messages(gathered)
        else:
            for record in split_records(b"".join(gathered.parts())):
                m = decode_record(record[0], record[RECORD_HEAD.size :])
                self._mcap.add_message(m.channel_id, m.log_time, m.data, m.publish_time, m.sequence)
        self._mcap.flush()
        self.count += gathered.count
        if self._indexes:
            self._indexes[-1] = PackedRecord(self._indexes[-1])

    def _add_messages(self, gathered: Gathered) -> None:
        """Does for all messages at once what `add_message` does for each."""
        builder, statistics = self._builder, self._statistics
        indexes = _message_indexes(gathered, builder.count)
        first, last, count = gathered.first, gathered.last, gathered.count
        builder.record_writer = JoinedRecords([builder.end(), *gathered.parts()])
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


def _message_indexes(gathered: Gathered, begun: int) -> dict[int, NDArray[np.uint64]]:
    """By channel, time and offset of its messages: (messages, 2).

    Args:
        gathered: the chunk's messages.
        begun: size of what the chunk holds before them [bytes].
    """
    shift = np.array([0, begun], "<u8")
    indexes: dict[int, NDArray[np.uint64]] = {}
    records = gathered.sample_records
    if records is not None and gathered.offsets:
        # All channels at once: the samples' times and offsets, plus the offset in a sample.
        within = np.array([[(0, offset)] for offset in records.offsets.values()], "<u8")
        samples = np.empty((gathered.sample_count, 2), "<u8")
        samples[:, 0], samples[:, 1] = records.read(gathered.rows)["time"], gathered.offsets
        indexes = dict(zip(records.offsets, samples + shift + within))
    singles: dict[int, list[tuple[int, int]]] = {}
    for single in gathered.singles:
        singles.setdefault(single.channel, []).append((single.time, single.offset))
    for channel, entries in singles.items():
        indexes[channel] = np.array(entries, "<u8") + shift
    return indexes
