"""Reads logs: complete ones, and those whose writer was killed or ran out of disk, or that were
damaged since. Needs no ROS 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError, unknown
from rlv_landing.parameters import Parameters

from ..messages.topics import STRUTS
from .mcap_stream import HEADER, MAGIC, RecordStream

FINISHED = ".mcap"
# What a file is called until its writer has finished it.
UNFINISHED = ".mcap.part"


@dataclass(frozen=True)
class Channel:
    """A topic of a log: its name, its type `pkg/msg/Type`, and the QoS that its publisher offered,
    as YAML.
    """

    topic: str
    type_name: str
    qos: str


@dataclass(frozen=True)
class LogMessage:
    """A message of a log: its topic, its time [ns], and the serialised bytes (CDR) that were
    published.
    """

    topic: str
    log_time: int
    data: bytes


class LogReader:
    """A log: a folder in rosbag2's layout, or one `.mcap` or `.mcap.part` file.

    Once the messages have been read, `cut` tells that not all of the log is there and `damage` what
    is wrong besides a missing end. `metadata` and `attachments` are known as soon as they have been
    passed; in a log of ours they stand at its start.

    Raises:
        LandingError: there is no such log, it is not MCAP, or not even its first record can be
            read.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.files = find_files(self.path)
        self.channels: dict[str, Channel] = {}
        self.metadata: dict[str, str] = {}
        self.attachments: dict[str, bytes] = {}
        self.cut = False
        self.damage: list[str] = []
        self._schemas: dict[str, Any] = {}
        for file in self.files:
            check_file(file)

    @property
    def size(self) -> int:
        """Bytes of all files."""
        return sum(f.stat().st_size for f in self.files)

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The messages in the log's order, of all topics or of `topics`, up to the end or to where
        the log is cut.
        """
        from mcap.records import Attachment, Message, Metadata

        wanted = None if topics is None else set(topics)
        self.cut, self.damage = False, []
        for file in self.files:
            stream = RecordStream(file)
            definitions = Definitions(file)
            for record in stream:
                if isinstance(record, Message):
                    channel, schema = definitions.of(record.channel_id)
                    if channel is not None:
                        self._add_channel(channel, schema)
                        if wanted is None or channel.topic in wanted:
                            yield LogMessage(channel.topic, record.log_time, record.data)
                elif isinstance(record, Attachment):
                    self.attachments[record.name] = record.data
                elif isinstance(record, Metadata):
                    if record.name == "rlv_landing":
                        self.metadata.update(record.metadata)
                elif definitions.add(record):
                    self._add_channel(*definitions.of(record.id))
            self.cut = self.cut or not stream.finished or bool(stream.damage)
            self.damage += [f"{file.name}, {text}" for text in stream.damage]

    def read_through(self) -> None:
        """Reads the log to its end, so that channels, metadata, attachments, `cut` and `damage` are
        known.
        """
        for _ in self.messages(()):
            pass

    def _add_channel(self, record: Any, schema: Any) -> None:
        if record.topic not in self.channels:
            self._schemas[record.topic] = schema
            name = schema.name if schema is not None else ""
            self.channels[record.topic] = Channel(
                record.topic, name, record.metadata.get("offered_qos_profiles", "")
            )

    @property
    def namespace(self) -> str:
        """The namespace under which the landing was published."""
        if "namespace" in self.metadata:
            return self.metadata["namespace"].rstrip("/")
        struts = [
            c.topic
            for c in self.channels.values()
            if f"/{c.topic}".endswith(f"/{STRUTS.name}") and c.type_name == STRUTS.type_name
        ]
        return struts[0].removesuffix(STRUTS.name).rstrip("/") if struts else ""

    def select(self, names: Sequence[str]) -> list[str]:
        """The full names of topics that are given in full or relative to the landing's namespace;
        all where none is given.

        Raises LandingError, with the nearest name, for one that the log does not hold. The log must
        have been read.
        """
        known = list(self.channels)
        chosen = []
        for name in names:
            full = name if name in self.channels else f"{self.namespace}/{name}"
            if full not in self.channels:
                raise unknown(
                    "topic", name, [*known, *(t.removeprefix(self.namespace + "/") for t in known)]
                )
            chosen.append(full)
        return chosen or known

    def decoder(self, topic: str) -> Any:
        """What makes messages of `topic` from bytes, by the definition that the log carries.

        Raises LandingError where it has none.
        """
        from mcap_ros2.decoder import DecoderFactory

        try:
            # A factory of its own for each: it tells schemas apart by number alone, and another
            # file numbers them anew.
            decode = DecoderFactory().decoder_for("cdr", self._schemas.get(topic))
        except Exception as e:
            raise LandingError(
                f"{self.path}: the definition of {topic} cannot be read: {' '.join(str(e).split())}"
            ) from None
        if decode is None:
            raise LandingError(
                f"{self.path}: {topic} has no definition in the log, it cannot be decoded"
            )
        return decode

    def parameters(self) -> Parameters | None:
        """The parameters that the log carries, once its start has been read."""
        from rlv_landing.presets import parse_toml

        data = self.attachments.get("parameters.toml")
        return (
            None
            if data is None
            else parse_toml(data.decode("utf-8", "replace"), f"{self.path}: parameters.toml")
        )


class Definitions:
    """The schemas and channels of one file, the first of each number; those lost with a damaged
    chunk are looked up in its summary.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self._schemas: dict[int, Any] = {}
        self._channels: dict[int, Any] = {}
        self._searched = False

    def add(self, record: Any) -> bool:
        """Takes in a schema or a channel; whether it is a channel."""
        from mcap.records import Channel as ChannelRecord
        from mcap.records import Schema as SchemaRecord

        if isinstance(record, SchemaRecord):
            self._schemas.setdefault(record.id, record)
        elif isinstance(record, ChannelRecord):
            self._channels.setdefault(record.id, record)
            return True
        return False

    def of(self, channel: int) -> tuple[Any, Any]:
        """The channel of that number, and its schema; None where they are not to be found."""
        from mcap.records import Channel as ChannelRecord
        from mcap.records import Schema as SchemaRecord

        if channel not in self._channels and not self._searched:
            self._searched = True
            stream = RecordStream(self._file, summary=True)
            records = [r for r in stream if isinstance(r, (SchemaRecord, ChannelRecord))]
            for record in records if stream.summary_is_right else ():
                self.add(record)
        found = self._channels.get(channel)
        return found, self._schemas.get(found.schema_id) if found is not None else None


class Decoder:
    """Decodes the messages of a log by the definitions that it carries.

    Raises LandingError for what cannot be decoded.
    """

    def __init__(self, reader: LogReader) -> None:
        self._reader = reader
        self._decoders: dict[str, Any] = {}

    def __call__(self, message: LogMessage) -> Any:
        if message.topic not in self._decoders:
            self._decoders[message.topic] = self._reader.decoder(message.topic)
        try:
            return self._decoders[message.topic](message.data)
        except Exception:
            at = (
                f"{self._reader.path}: a message of {message.topic} at {message.log_time / 1e9:g} s"
            )
            raise LandingError(
                f"{at} is not what its definition says; it cannot be decoded"
            ) from None


def find_files(path: Path) -> list[Path]:
    """The MCAP files of the log at `path`, in their order, unfinished ones too.

    Raises LandingError where there are none.
    """
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise LandingError(f"there is no log {path}; name a log's folder or its .mcap file")
    try:
        files = sorted(
            (f for f in path.iterdir() if f.name.endswith((FINISHED, UNFINISHED)) and f.is_file()),
            key=_number,
        )
    except OSError as e:
        raise LandingError(f"{path} cannot be read: {e.strerror or e}") from None
    if not files:
        raise LandingError(f"{path} holds no .mcap file; name a log's folder or its .mcap file")
    return files


def bare_name(file: Path) -> str:
    """The name of a log's file without its ending."""
    return file.name.removesuffix(UNFINISHED).removesuffix(FINISHED)


def _number(file: Path) -> tuple[str, int]:
    """Split logs are numbered `_0`, `_1`, ..., `_10`: by number, not by letter."""
    name = bare_name(file)
    stem, _, number = name.rpartition("_")
    return (stem, int(number)) if number.isdecimal() else (name, 0)


def check_file(file: Path) -> None:
    """Raises LandingError unless `file` can be opened, starts as MCAP does and has a first record."""
    try:
        with file.open("rb") as stream:
            start = stream.read(len(MAGIC) + 9)
            length = int.from_bytes(start[len(MAGIC) + 1 :], "little")
            whole = file.stat().st_size >= len(MAGIC) + 9 + length
    except OSError as e:
        raise LandingError(f"{file} cannot be read: {e.strerror or e}") from None
    if not start:
        raise LandingError(f"{file} is empty; nothing was recorded")
    if not MAGIC.startswith(start[: len(MAGIC)]):
        raise LandingError(
            f"{file} is not MCAP: it does not start as one; name a log's folder or its .mcap file"
        )
    if len(start) < len(MAGIC) + 9 or start[len(MAGIC)] != HEADER or not whole:
        raise LandingError(f"{file} is cut within its first record; nothing in it can be read")
