"""Records the published bytes to MCAP in rosbag2's layout, so that what was written survives the
writer's death.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rlv_landing.errors import LandingError

from ..messages.definitions import Definition, definition
from ..messages.qos import Qos
from .bag_writer import CHUNK_BYTES, BagTopic, BagWriter, media_type
from .open_chunk import RECORD_SIZE, OpenChunk, message_head

__all__ = ["CHUNK_BYTES", "FLUSH_SECONDS", "RecordedTopic", "Recorder"]

FLUSH_SECONDS = 0.25


@dataclass(frozen=True)
class RecordedTopic:
    """A topic of a log: its full name, its type `pkg/msg/Type`, and what its publisher offers."""

    name: str
    type_name: str
    qos: Qos


class Recorder:
    """One log being written: `<folder>/<folder's name>_0.mcap.part`; once it is closed, that
    without `.part`, and `metadata.yaml`.

    Args:
        folder: made here, with its parents; it must not exist.
        topics: what will be recorded.
        metadata: texts by name, kept in the log's record `rlv_landing`.
        attachments: files by name that the log carries.

    Raises:
        LandingError: the folder exists or cannot be written, or a topic's type is not installed;
            nothing is left behind then.

    A disk that fills up later, or a folder that is removed or moved away, does not raise: `error`
    is set, writing stops, and what was written stays readable. Not for several threads at once.
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
        # Of the messages of a sample: the channels; how many samples were recorded.
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
            self._chunk = OpenChunk(self._bag.mcap, CHUNK_BYTES)
        except BaseException as e:
            self.discard()
            if isinstance(e, OSError):
                raise self._unwritable(e) from None
            raise

    def _unwritable(self, e: OSError) -> LandingError:
        return LandingError(
            f"log folder {self.folder} cannot be written: {e.strerror or e}; name one that can be, or make room"
        )

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
        """From now on samples are recorded as a whole: messages of the topics in `sizes`, of that
        many bytes each. How the record of each begins; a sequence number and the time twice (as in
        `open_chunk.TIMES`), and the message follow.
        """
        self._sampled = tuple(sizes)
        place = 0
        for topic, size in sizes.items():
            self._chunk.sampled[self._channels[topic]] = place
            place += RECORD_SIZE + size
        return [message_head(self._channels[topic], size) for topic, size in sizes.items()]

    def write_sample(self, log_time_ns: int, records: bytes) -> None:
        """Record a sample's messages at the simulation time `log_time_ns`: their records, in the
        order of `begin_samples`, the number of the sample as their sequence number. After an error
        it does nothing.
        """
        if self.error:
            return
        try:
            self._chunk.add_sample(log_time_ns, records)
        except OSError as e:
            self._fail(e.strerror or str(e))
            return
        self._samples += 1
        self._span.add(log_time_ns)

    def write(self, topic: str, log_time_ns: int, data: bytes) -> None:
        """Record the serialised message `data` of `topic` at the simulation time `log_time_ns`.

        After an error it does nothing.
        """
        if self.error:
            return
        entry = self._entries[topic]
        try:
            self._chunk.add(self._channels[topic], entry.count & 0xFFFFFFFF, log_time_ns, data)
        except OSError as e:
            self._fail(e.strerror or str(e))
            return
        entry.count += 1
        self._span.add(log_time_ns)

    def flush(self) -> None:
        """Hand what is recorded to the operating system if the last time is a quarter of a second
        ago. To be called now and then.
        """
        now = time.monotonic()
        if self.error or now - self._flushed < FLUSH_SECONDS:
            return
        self._flushed = now
        try:
            self._chunk.write()
            if not self._bag.is_there():
                self._fail("the file was removed or moved away")
        except OSError as e:
            self._fail(e.strerror or str(e))

    def close(self) -> None:
        """Finish the file and write `metadata.yaml`.

        After an error only closes the file, which `rlv-landing log` still reads.
        """
        if not self._bag.open:
            return
        try:
            if not self.error:
                self._chunk.write()
                for topic in self._sampled:
                    self._entries[topic].count = self._samples
                self._sampled = ()
                self._bag.finish()
        except OSError as e:
            self._fail(e.strerror or str(e))
        finally:
            self._bag.give_up()

    def discard(self) -> None:
        """Close and remove everything that this recorder has made."""
        self._bag.discard()

    def _fail(self, reason: str) -> None:
        self.error = f"recording to {self._bag.part} stopped after {self.count} messages: {reason}"
