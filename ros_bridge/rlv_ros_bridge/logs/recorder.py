"""Records published messages to MCAP in rosbag2's layout; a killed writer loses little."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rlv_landing.errors import LandingError, reason_of
from rlv_landing.text.durable import unwritable

from ..messages.definitions import Definition, definition
from ..messages.qos import Qos
from .bag_writer import CHUNK_BYTES, BagTopic, BagWriter, media_type
from .landing_record import RECORD as LANDING_RECORD
from .mcap_files.chunk_buffer import RECORD_SIZE, ChunkBuffer, message_prefix
from .peaks import RECORD as PEAKS_RECORD

__all__ = ["CHUNK_BYTES", "FLUSH_SECONDS", "RecordedTopic", "Recorder"]

FLUSH_SECONDS = 0.25


@dataclass(frozen=True)
class RecordedTopic:
    """A topic of a log: its full name, its type `pkg/msg/Type`, and its publisher's QoS."""

    name: str
    type_name: str
    qos: Qos


class Recorder:
    """A log that is being written: `<folder>/<folder's name>_0.mcap.part`.

    `close` removes the ending `.part` and writes `metadata.yaml`.

    A disk that fills up later, or a folder that is removed or moved, does not raise: `error` is
    set, recording stops, and what was written stays readable. It is not thread-safe.

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
        self.error: str = ""
        self._flushed = time.monotonic()
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
        self._span = self._bag.bag.span
        # The topics of a sample's messages, and the number of samples.
        self._sampled: tuple[str, ...] = ()
        self._samples = 0
        try:
            for name, data in (attachments or {}).items():
                self._bag.mcap.add_attachment(
                    create_time=0, log_time=0, name=name, media_type=media_type(name), data=data
                )
            if metadata:
                self._bag.mcap.add_metadata("rlv_landing", dict(metadata))
            self._channels = self._register(definitions)
            self._bag.mcap.flush()
            self._chunk = ChunkBuffer(self._bag.mcap, CHUNK_BYTES)
        except BaseException as e:
            self.discard()
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
        """Messages recorded so far."""
        return sum(t.count for t in self._entries.values()) + self._samples * len(self._sampled)

    def begin_samples(self, sizes: Mapping[str, int]) -> list[bytes]:
        """Prepares for `write_sample`: from now on the messages of a sample are recorded together.

        Args:
            sizes: by topic, in their order in a sample, the size of its message [bytes].

        Returns:
            For each topic the first bytes of its record. The number of the sample, twice its time
            (as in `chunk_buffer.MESSAGE_TIMES`) and the message follow them.
        """
        self._sampled = tuple(sizes)
        offset = 0
        for topic, size in sizes.items():
            self._chunk.sample_offsets[self._channels[topic]] = offset
            offset += RECORD_SIZE + size
        return [message_prefix(self._channels[topic], size) for topic, size in sizes.items()]

    def write_sample(self, log_time_ns: int, records: bytes) -> None:
        """Records the messages of a sample.

        After an error it does nothing.

        Args:
            log_time_ns: simulation time [ns].
            records: the records of its messages, in the order of `begin_samples`.
        """
        if self.error:
            return
        try:
            self._chunk.add_sample(log_time_ns, records)
        except OSError as e:
            self._fail(reason_of(e))
            return
        self._samples += 1
        self._span.add(log_time_ns)

    def write(self, topic: str, log_time_ns: int, data: bytes) -> None:
        """Records one message.

        After an error it does nothing.

        Args:
            topic: full name.
            log_time_ns: simulation time [ns].
            data: the serialised message.
        """
        if self.error:
            return
        entry = self._entries[topic]
        try:
            self._chunk.add(self._channels[topic], entry.count & 0xFFFFFFFF, log_time_ns, data)
        except OSError as e:
            self._fail(reason_of(e))
            return
        entry.count += 1
        self._span.add(log_time_ns)

    def flush(self) -> None:
        """Hands what was recorded to the operating system, at most every `FLUSH_SECONDS`.

        To be called after each sample.
        """
        now = time.monotonic()
        if self.error or now - self._flushed < FLUSH_SECONDS:
            return
        self._flushed = now
        try:
            self._chunk.write()
            if not self._bag.file_exists():
                self._fail("the file was removed or moved away")
        except OSError as e:
            self._fail(reason_of(e))

    def close(
        self, peaks: Mapping[str, str] | None = None, landing: Mapping[str, str] | None = None
    ) -> None:
        """Finishes the file and writes `metadata.yaml`.

        After an error it only closes the file, which `rlv-landing log` can read.

        Args:
            peaks: the texts of the landing's peaks, see `peaks.peak_texts`; none: no such record.
            landing: the texts of the landing's summary, see `landing_record`; none: no such record.
        """
        if not self._bag.is_open:
            return
        try:
            if not self.error:
                self._chunk.write()
                for topic in self._sampled:
                    self._entries[topic].count = self._samples
                self._sampled = ()
                for name, texts in ((PEAKS_RECORD, peaks), (LANDING_RECORD, landing)):
                    if texts:
                        self._bag.mcap.add_metadata(name, dict(texts))
                self._bag.finish()
        except OSError as e:
            self._fail(reason_of(e))
        finally:
            self._bag.abandon()

    def discard(self) -> None:
        """Closes and removes everything that this recorder has made."""
        self._bag.discard()

    def _fail(self, reason: str) -> None:
        self.error = f"recording to {self._bag.part} stopped after {self.count} messages: {reason}"
