"""Recovers the whole records of a cut or damaged log into a new log that every reader opens."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from math import isfinite, nan
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError
from rlv_landing.text.durable import unwritable
from rlv_landing.text.files import shown_name
from rlv_landing.text.terminal import legible_lines
from rlv_landing.text.units import UnitError, parse_number

from ..messages.qos import profiles
from .log_files import FINISHED, UNFINISHED, check_file, find_files, log_name, shown_time
from .mcap_files.stream import RecordStream
from .packed import says_packed
from .reader import Definitions
from .recording.bag_writer import BagTopic, BagWriter

# Metadata that the new log's writer makes itself.
WRITERS_METADATA = "rosbag2"


@dataclass
class Recovery:
    """The result of a recovery.

    `messages` were saved, from `start` to `end` [s], to `folder`, which is empty if the log is
    complete. `lost_bytes` could not be read. `unknown_topic` counts messages whose topic is lost.
    `stop_time` [s] is the end of the run by the log's metadata. `damage` holds a sentence for each
    defect.
    """

    path: str
    folder: str = ""
    messages: int = 0
    start: float = 0.0
    end: float = 0.0
    stop_time: float | None = None
    lost_bytes: int = 0
    unknown_topic: int = 0
    finished: bool = True
    damage: list[str] = field(default_factory=list)

    @property
    def complete(self) -> bool:
        """Whether the log had no defect."""
        return self.finished and not self.damage and not self.unknown_topic

    def as_dict(self) -> dict[str, Any]:
        """The fields as plain values, for JSON."""
        return asdict(self)

    def text(self) -> str:
        """The fields as lines of text."""
        span = f"from {shown_time(self.start)} to {shown_time(self.end)}"
        lines = [f"saved    {self.messages} messages {span}, all that is whole: {self.folder}"]
        lines += [f"damage   {text}" for text in self.damage]
        if self.unknown_topic:
            lines.append(
                f"missing  {self.unknown_topic} messages whose topic is not known any more"
            )
        if self.lost_bytes:
            lines.append(f"missing  {self.lost_bytes} bytes that make no whole chunk")
        if not self.finished and self.stop_time is not None and self.end < self.stop_time:
            lines.append(
                f"missing  the span from {shown_time(self.end)} on, "
                f"at most to the stop time of {self.stop_time:g} s"
            )
        elif not self.finished:
            lines.append(f"missing  what was recorded after {shown_time(self.end)}, if anything")
        return legible_lines(lines)


def recovered_folder(path: Path) -> Path:
    """The default folder of a recovered log: the log's name with `-recovered` added, beside it."""
    path = path.absolute()
    return path.with_name((log_name(path) if path.is_file() else path.name) + "-recovered")


def recover(path: Path, folder: Path | None = None) -> Recovery:
    """Copies every whole record of the log at `path` into a new log.

    A log that is complete, `metadata.yaml` included, is not copied.

    Args:
        path: the log.
        folder: the new log's folder, which must not exist; None: `recovered_folder`.

    Raises:
        LandingError: no log, nothing whole in it, the folder exists, or it cannot be written.
            Nothing is left behind.
    """
    _refuse_foreign(path)
    files = find_files(path)
    for file in files:
        check_file(file)
    found = Recovery(str(path))
    if _is_complete(path, files):
        return found
    target = folder if folder is not None else recovered_folder(path)
    try:
        writer = BagWriter(target)
    except OSError as e:
        raise unwritable(target, e, what="log folder ") from None
    try:
        copy = _Copy(writer, found)
        for file in files:
            copy.add_file(file)
        if not found.messages:
            raise LandingError(f"{path} holds no whole chunk; there is nothing to recover")
        copy.finish()
    except BaseException as e:
        writer.discard()
        if isinstance(e, OSError):
            raise unwritable(target, e, what="log folder ") from None
        raise
    found.folder = str(target)
    return found


def _refuse_foreign(path: Path) -> None:
    """Says what to do with a recording that is not plain MCAP.

    Raises:
        LandingError: it is one.
    """
    names = [path.name] if path.is_file() else [f.name for f in path.glob("*")]
    if any(name.endswith((FINISHED, UNFINISHED)) for name in names):
        return
    if any(name.endswith(".zstd") for name in names):
        raise LandingError(
            f"{path} is compressed as a whole; decompress its files by zstd -d first"
        )
    if databases := [name for name in names if name.endswith(".db3")]:
        raise LandingError(
            f"{path} is a recording in sqlite3, of which sqlite3 itself saves what is whole: "
            f"sqlite3 {databases[0]} .recover | sqlite3 whole.db3, then ros2 bag reindex"
        )


def _is_complete(path: Path, files: list[Path]) -> bool:
    if not (path.is_dir() and (path / "metadata.yaml").is_file()):
        return False
    for file in files:
        stream = RecordStream(file)
        for _ in stream:
            pass
        if not stream.finished or stream.damage:
            return False
    return True


class _Copy:
    """Copies the records of a log's files through one writer, with new numbers."""

    def __init__(self, writer: BagWriter, found: Recovery) -> None:
        self._writer = writer
        self._found = found
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._channels: dict[tuple[str, int], tuple[int, BagTopic]] = {}
        self._our_metadata: dict[str, str] = {}

    def add_file(self, file: Path) -> None:
        """Copies the whole records of `file`."""
        from mcap.records import Attachment, Message, Metadata

        stream = RecordStream(file)
        definitions = Definitions(file)
        known: dict[int, tuple[int, BagTopic]] = {}
        mcap = self._writer.mcap
        for record in stream:
            if isinstance(record, Message):
                if record.channel_id not in known:
                    channel, schema = definitions.find(record.channel_id)
                    if channel is None:
                        self._found.unknown_topic += 1
                        continue
                    known[record.channel_id] = self._channel(channel, schema)
                number, topic = known[record.channel_id]
                mcap.add_message(
                    number, record.log_time, record.data, record.publish_time, record.sequence
                )
                topic.count += 1
                self._writer.bag.span.add(record.log_time)
            elif isinstance(record, Attachment):
                mcap.add_attachment(
                    record.create_time, record.log_time, record.name, record.media_type, record.data
                )
            elif isinstance(record, Metadata):
                if record.name == "rlv_landing":
                    self._our_metadata.update(record.metadata)
                elif record.name != WRITERS_METADATA:
                    mcap.add_metadata(record.name, record.metadata)
                elif says_packed(record.metadata.get("serialized_metadata", "")):
                    # The messages are copied as they are.
                    self._writer.bag.packed = True
            elif definitions.add(record):
                known.setdefault(record.id, self._channel(*definitions.find(record.id)))
        self._found.finished = self._found.finished and stream.finished
        self._found.lost_bytes += stream.lost_bytes
        self._found.damage += [f"{file.name}, {text}" for text in stream.damage]
        self._found.messages = sum(t.count for t in self._writer.bag.topics)

    def finish(self) -> None:
        """Writes the metadata and the end."""
        found, span = self._found, self._writer.bag.span
        found.start, found.end = (span.first or 0) / 1e9, span.last / 1e9
        try:
            stop_time = parse_number(self._our_metadata["stop_time"])
        except (KeyError, UnitError):
            stop_time = nan
        found.stop_time = stop_time if isfinite(stop_time) else None
        missing = "" if found.complete else found.text().split("\n", 1)[-1]
        recovery = {"recovered_from": shown_name(Path(found.path)), "recovery": missing}
        self._writer.mcap.add_metadata("rlv_landing", {**self._our_metadata, **recovery})
        self._writer.finish()

    def _channel(self, channel: Any, schema: Any) -> tuple[int, BagTopic]:
        number = self._schema(schema)
        key = (channel.topic, number)
        if key not in self._channels:
            metadata = channel.metadata
            registered = self._writer.mcap.register_channel(
                channel.topic, channel.message_encoding, number, metadata
            )
            qos = profiles(metadata.get("offered_qos_profiles", ""))
            topic = BagTopic(
                channel.topic,
                schema.name if schema is not None else "",
                qos,
                metadata.get("topic_type_hash", ""),
            )
            self._writer.bag.topics.append(topic)
            self._channels[key] = (registered, topic)
        return self._channels[key]

    def _schema(self, schema: Any) -> int:
        if schema is None:
            return 0
        key = (schema.name, schema.encoding, schema.data)
        if key not in self._schemas:
            self._schemas[key] = self._writer.mcap.register_schema(*key)
        return self._schemas[key]
