"""Records published messages to MCAP in rosbag2's layout; a killed writer loses little."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from rlv_landing.errors import LandingError, reason_of
from rlv_landing.text.durable import unwritable

from ..messages.definitions import Definition, definition
from ..messages.qos import Qos
from ..messages.wire import Places
from .landing_record import RECORD as LANDING_RECORD
from .lost import RECORD as LOST_RECORD
from .mcap_files.sample_records import SampleRecords
from .peaks import RECORD as PEAKS_RECORD
from .recording.bag_writer import BagTopic, BagWriter, media_type
from .recording.chunk_queue import ChunkQueue


@dataclass(frozen=True)
class RecordedTopic:
    """A topic of a log: its full name, its type `pkg/msg/Type`, and its publisher's QoS.

    Messages of a topic that is `kept` are not left out where the disk takes too long.
    """

    name: str
    type_name: str
    qos: Qos
    kept: bool = False


class Recorder:
    """A log that is being written: `<folder>/<folder's name>_0.mcap.part`.

    `close` removes the ending `.part` and writes `metadata.yaml`.

    A thread compresses and writes. Where too much waits for the disk, what comes next is left out,
    and the log has a record of the gap; with `must_wait`, who records waits instead.

    A disk that fills up later, or a folder that is removed or moved, does not raise: `error` is
    set, recording stops, and what was written stays readable. One thread at a time may use it; in
    a forked process it does nothing.

    Args:
        folder: made here with its parents; it must not exist.
        topics: the topics to record.
        metadata: texts by name, kept in the log's record `rlv_landing`.
        attachments: files by name that the log carries.

    Raises:
        LandingError: the folder exists or cannot be written, or a topic's type is not installed.
            Nothing is left behind.
    """

    def __init__(
        self,
        folder: str | Path,
        topics: Sequence[RecordedTopic],
        metadata: Mapping[str, str] | None = None,
        attachments: Mapping[str, bytes] | None = None,
    ) -> None:
        self.folder = Path(folder)
        self.topics = tuple(topics)
        self._error = ""
        self._process = os.getpid()
        definitions = {t.type_name: definition(t.type_name) for t in self.topics}
        try:
            self._bag = BagWriter(self.folder)
        except OSError as e:
            raise self._unwritable(e) from None
        self.path = self._bag.path
        self._entries = {
            t.name: BagTopic(
                t.name, t.type_name, [t.qos.record()], definitions[t.type_name].type_hash
            )
            for t in self.topics
        }
        self._bag.bag.topics = list(self._entries.values())
        # The topics of a sample's messages.
        self._sampled: tuple[str, ...] = ()
        try:
            for name, data in (attachments or {}).items():
                self._bag.mcap.add_attachment(
                    create_time=0, log_time=0, name=name, media_type=media_type(name), data=data
                )
            if metadata:
                self._bag.mcap.add_metadata("rlv_landing", dict(metadata))
            self._channels = self._register(definitions)
            self._bag.mcap.flush()
            kept = [self._channels[t.name] for t in self.topics if t.kept]
            self._queue = ChunkQueue(self._bag, kept)
        except BaseException as e:
            self._bag.discard()
            if isinstance(e, OSError):
                raise self._unwritable(e) from None
            raise

    def _unwritable(self, e: OSError) -> LandingError:
        return unwritable(self.folder, e, what="log folder ")

    def _register(self, definitions: Mapping[str, Definition]) -> dict[str, int]:
        import yaml

        mcap = self._bag.mcap
        schemas = {
            name: mcap.register_schema(name, "ros2msg", d.text.encode("utf-8"))
            for name, d in definitions.items()
        }
        channels: dict[str, int] = {}
        for t in self.topics:
            qos = yaml.safe_dump([t.qos.record()], sort_keys=False)
            metadata = {
                "offered_qos_profiles": qos,
                "topic_type_hash": definitions[t.type_name].type_hash,
            }
            channels[t.name] = mcap.register_channel(t.name, "cdr", schemas[t.type_name], metadata)
        return channels

    @property
    def count(self) -> int:
        """Messages recorded so far, some of which may still wait for the disk."""
        queue = self._queue
        return queue.samples * len(self._sampled) + queue.singles.total()

    @property
    def must_wait(self) -> bool:
        """Whether who records waits for the disk where it takes too long."""
        return self._queue.must_wait

    @must_wait.setter
    def must_wait(self, must_wait: bool) -> None:
        self._queue.must_wait = must_wait

    @property
    def lost(self) -> int:
        """Messages that were left out."""
        return self._queue.lost

    @property
    def waited(self) -> float:
        """The time for which who records has waited for the disk [s]."""
        return self._queue.waited

    @property
    def error(self) -> str:
        """Why recording has stopped; empty where it has not."""
        if not self._error and (reason := self._queue.error):
            self._fail(reason)
        return self._error

    def begin_samples(
        self,
        messages: Mapping[str, Places],
        count: int,
        take: Callable[[NDArray[Any]], None] = lambda samples: None,
    ) -> None:
        """Prepares for `write_sample`: from now on the messages of a sample are recorded together.

        Args:
            messages: by topic, in their order in a sample, where its message has which numbers.
            count: how many numbers a sample has.
            take: called now and then with the samples since the last call, by fields: `sequence`,
                `time` [ns] and `numbers`.
        """
        self._sampled = tuple(messages)
        records = SampleRecords({self._channels[t]: p for t, p in messages.items()}, count)
        self._queue.begin_samples(records, take)

    def write_sample(self, sequence: int, log_time_ns: int, numbers: Sequence[float]) -> None:
        """Records the messages of a sample.

        After an error it does nothing.

        Args:
            sequence: the number of the sample.
            log_time_ns: simulation time [ns].
            numbers: what its messages hold.
        """
        self._queue.add_sample(sequence, log_time_ns, numbers)

    def write(self, topic: str, log_time_ns: int, data: bytes) -> None:
        """Records one message.

        After an error it does nothing.

        Args:
            topic: full name.
            log_time_ns: simulation time [ns].
            data: the serialised message.
        """
        self._queue.add(self._channels[topic], log_time_ns, data)

    def flush(self) -> None:
        """Hands what was recorded to the thread that writes; after all messages of an instant."""
        self._queue.flush()

    def sync(self) -> None:
        """Waits until the operating system has what was recorded, or recording has failed."""
        self._queue.sync()

    def close(
        self, peaks: Mapping[str, str] | None = None, landing: Mapping[str, str] | None = None
    ) -> None:
        """Waits for the disk, finishes the file and writes `metadata.yaml`.

        After an error it only closes the file, which `rlv-landing log` can read.

        Args:
            peaks: the texts of the landing's peaks, see `peaks.peak_texts`; none: no such record.
            landing: the texts of the landing's summary, see `landing_record`; none: no such record.
        """
        if not self._bag.is_open or os.getpid() != self._process:
            return
        try:
            self._queue.end()
            if not self.error:
                gap = self._queue.gap
                for name, texts in (
                    (LOST_RECORD, gap.texts() if gap is not None else None),
                    (PEAKS_RECORD, peaks),
                    (LANDING_RECORD, landing),
                ):
                    if texts:
                        self._bag.mcap.add_metadata(name, dict(texts))
                self._count_topics()
                self._bag.finish()
        except OSError as e:
            self._fail(reason_of(e))
        finally:
            self._queue.end(discard=True)
            self._bag.abandon()

    def _count_topics(self) -> None:
        """Tells `metadata.yaml` the numbers of messages."""
        for topic, entry in self._entries.items():
            sampled = self._queue.samples if topic in self._sampled else 0
            entry.count = sampled + self._queue.singles[self._channels[topic]]

    def discard(self) -> None:
        """Closes and removes everything that this recorder has made."""
        if os.getpid() == self._process:
            self._queue.end(discard=True)
            self._bag.discard()

    def _fail(self, reason: str) -> None:
        self._error = (
            f"recording to {self._bag.part} stopped after {self._queue.written} messages: {reason}"
        )
