"""The messages of a log on their way to its file: gathered to chunks, and written by a thread."""

from __future__ import annotations

import weakref
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from typing import Any

from numpy.typing import NDArray

from rlv_landing.errors import reason_of

from ..lost import RECORD as LOST_RECORD
from ..lost import Gap
from ..mcap_files.chunk_buffer import ChunkBuffer, Gathered
from ..mcap_files.chunk_writer import ChunkWriter
from ..mcap_files.sample_records import SampleRecords
from .bag_writer import CHUNK_BYTES, BagWriter
from .writing_thread import WritingThread

# What may wait for the disk, uncompressed [bytes]: half a minute of a landing at 1 kHz.
WAITING_BYTES = 64 * 1024 * 1024
# What may wait of messages that are kept in a gap [bytes].
KEPT_BYTES = 4 * 1024 * 1024
# A chunk's messages, and the gap before them.
_Job = tuple[Gathered, Gap | None]


class ChunkQueue:
    """Gathers messages to chunks, which a thread compresses and writes to the file of `bag`.

    Where more than `WAITING_BYTES` wait, the next chunk's messages are left out. With `must_wait`,
    who adds messages waits instead.

    `samples` counts samples, `singles` other messages by channel, both without what was left out.
    `lost` counts the messages left out, of which `gap` is told with the next chunk.

    Args:
        bag: the log, all of whose topics are registered.
        kept: channels whose single messages are not left out.
    """

    def __init__(self, bag: BagWriter, kept: Collection[int]) -> None:
        self.must_wait = False
        self.samples = 0
        self.singles: Counter[int] = Counter()
        self.lost = 0
        self.gap: Gap | None = None
        self._kept = kept
        self._sequences: Counter[int] = Counter()
        self._writer = ChunkWriter(bag.mcap)
        self._buffer = ChunkBuffer(self._hand_over, CHUNK_BYTES, self._writer.begun)
        self._take: Callable[[NDArray[Any]], None] = lambda samples: None
        self._thread = WritingThread(_write_to(self._writer, bag), WAITING_BYTES)
        # A queue that nobody ends leaves no thread.
        weakref.finalize(self, self._thread.end)

    @property
    def waited(self) -> float:
        """The time for which who adds messages has waited [s]."""
        return self._thread.waited

    @property
    def written(self) -> int:
        """The number of messages that were written."""
        return self._writer.count

    @property
    def error(self) -> str:
        """Why writing has stopped; empty where it has not."""
        error = self._thread.error
        if error is None:
            return ""
        known = "" if isinstance(error, OSError) else f"{type(error).__name__}: "
        return known + reason_of(error)

    def add(self, channel: int, time_ns: int, data: bytes) -> None:
        """Adds a message with its time [ns]; after an error it does nothing."""
        if self._thread.error is None:
            sequence = self._sequences[channel]
            self._buffer.add(channel, sequence & 0xFFFFFFFF, time_ns, data)
            self._sequences[channel] = sequence + 1
            self.singles[channel] += 1

    def begin_samples(self, records: SampleRecords, take: Callable[[NDArray[Any]], None]) -> None:
        """Takes samples from now on; once.

        Args:
            records: makes their records.
            take: called in the thread that adds with the samples of each chunk, as `records.read`
                gives them, also of those that are left out.
        """
        self._take = take
        self._buffer.begin_samples(records)

    def add_sample(self, sequence: int, time_ns: int, numbers: Sequence[float]) -> None:
        """Adds the numbers of a sample, with its time [ns]; after an error it does nothing."""
        if self._thread.error is None:
            self._buffer.add_sample(sequence, time_ns, numbers)
            self.samples += 1

    def flush(self) -> None:
        """Hands what was gathered to the thread; after all messages of an instant."""
        self._buffer.hand_over()

    def sync(self) -> None:
        """Waits until the operating system has what was added, or writing has failed."""
        self._buffer.hand_over()
        self._thread.sync()

    def end(self, *, discard: bool = False) -> None:
        """Ends the thread.

        Args:
            discard: what waits is not written.
        """
        if not discard:
            self.must_wait = True
            self._buffer.hand_over()
        self._thread.end(discard=discard)

    def _hand_over(self, gathered: Gathered) -> None:
        if gathered.sample_records is not None and gathered.offsets:
            self._take(gathered.sample_records.read(gathered.rows))
        if self._thread.hand_over((gathered, self.gap), gathered.size, wait=self.must_wait):
            self.gap = None
        else:
            self._leave_out(gathered)

    def _leave_out(self, gathered: Gathered) -> None:
        """Leaves messages out, but for those of the channels that are kept."""
        kept = [single for single in gathered.singles if single.channel in self._kept]
        if sum(len(single.record) for single in kept) > KEPT_BYTES:
            kept = []
        self.samples -= gathered.sample_count
        self.singles.subtract(single.channel for single in gathered.singles)
        count = gathered.count - len(kept)
        self.lost += count
        if count:
            gap = Gap(count, gathered.sample_count, gathered.first, gathered.last)
            self.gap = gap if self.gap is None else self.gap.and_then(gap)
        for single in kept:
            self._buffer.add_record(single.channel, single.time, single.record)
            self.singles[single.channel] += 1


def _write_to(writer: ChunkWriter, bag: BagWriter) -> Callable[[_Job], None]:
    """Writes the messages of a chunk, in the thread; it does not know the queue."""

    def write(job: _Job) -> None:
        gathered, gap = job
        if gap is not None:
            bag.mcap.add_metadata(LOST_RECORD, gap.texts())
        writer.write(gathered)
        bag.bag.span.add(gathered.first)
        bag.bag.span.add(gathered.last)
        if not bag.file_exists():
            raise FileNotFoundError(0, "the file was removed or moved away")

    return write
