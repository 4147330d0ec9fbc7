"""Reads logs, also those that are cut or damaged. Needs no ROS 2."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

from rlv_landing.errors import LandingError, reason_of, unknown
from rlv_landing.parameters import Parameters
from rlv_landing.quantities import Interface

from ..messages.fields import IN_A_PLANE
from ..messages.topics import STRUTS
from .landing_record import RECORD as LANDING_RECORD
from .log_files import check_file, find_files, shown_time
from .lost import RECORD as LOST_RECORD
from .lost import Gap, read_gap
from .mcap_files.stream import RecordStream
from .mcap_files.summary import Summary, read_summary
from .peaks import RECORD as PEAKS_RECORD

Result = TypeVar("Result")
# What a topic of a landing never needs: a longer message, or definition, is a false one [bytes].
LARGEST_MESSAGE = LARGEST_DEFINITION = 256 * 1024


@dataclass(frozen=True)
class Channel:
    """A topic of a log.

    `type_name` is `pkg/msg/Type`. `qos` is the quality of service that its publisher offered, as
    YAML.
    """

    topic: str
    type_name: str
    qos: str


@dataclass(frozen=True)
class LogMessage:
    """A message of a log: topic, log time [ns], and the published bytes (CDR)."""

    topic: str
    log_time: int
    data: bytes

    @property
    def place(self) -> str:
        """Topic and time as text."""
        return f"{self.topic} at {shown_time(self.log_time / 1e9)}"


class LogReader:
    """A log: a folder in rosbag2's layout, or one `.mcap` or `.mcap.part` file.

    After the messages have been read, `cut` says that the log is incomplete or damaged, and
    `damage` what is wrong besides a missing end. `channels`, `metadata` and `attachments` are
    filled while reading; in our logs all stand at the start. So are `peaks` and `landing`, the
    texts of the records of peaks and of the landing, which stand at the end; a cut log lacks them.
    `gaps` are the spans whose messages the recorder left out since its disk took too long.

    Args:
        path: the log.

    Raises:
        LandingError: there is no such log, it is not MCAP, or not even its first record is whole.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.files = find_files(self.path)
        self.channels: dict[str, Channel] = {}
        self.metadata: dict[str, str] = {}
        self.peaks: dict[str, str] = {}
        self.landing: dict[str, str] = {}
        self.attachments: dict[str, bytes] = {}
        self.gaps: list[Gap] = []
        self.cut = False
        self.damage: list[str] = []
        self._schemas: dict[str, Any] = {}
        for file in self.files:
            check_file(file)

    @property
    def size(self) -> int:
        """Size of all files [bytes]."""
        return sum(f.stat().st_size for f in self.files)

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The whole messages of all topics, or of `topics`, in the log's order."""
        from mcap.records import Message

        chosen = None if topics is None else set(topics)
        self.cut, self.damage = False, []
        for file in self.files:
            definitions = Definitions(file)

            def is_wanted(number: int, definitions: Definitions = definitions) -> bool:
                channel, schema = definitions.find(number)
                if channel is not None:
                    self._add_channel(channel, schema)
                return channel is not None and (chosen is None or channel.topic in chosen)

            stream = RecordStream(file, wanted=is_wanted)
            for record in stream:
                if isinstance(record, Message):
                    channel, _ = definitions.find(record.channel_id)
                    yield LogMessage(channel.topic, record.log_time, record.data)
                else:
                    self._keep_record(record, definitions)
            self.cut = self.cut or not stream.finished or bool(stream.damage)
            self.damage += [f"{file.name}, {text}" for text in stream.damage]

    def _keep_record(self, record: Any, definitions: Definitions) -> None:
        """Keeps a record other than a message."""
        from mcap.records import Attachment, Metadata

        if isinstance(record, Attachment):
            self.attachments[record.name] = record.data
        elif isinstance(record, Metadata):
            if record.name == "rlv_landing":
                self.metadata.update(record.metadata)
            elif record.name == PEAKS_RECORD:
                self.peaks.update(record.metadata)
            elif record.name == LANDING_RECORD:
                self.landing.update(record.metadata)
            elif record.name == LOST_RECORD:
                gap = read_gap(record.metadata, str(self.path))
                if gap not in self.gaps:
                    self.gaps.append(gap)
        elif definitions.add(record):
            self._add_channel(*definitions.find(record.id))

    @cached_property
    def summaries(self) -> list[Summary] | None:
        """The summaries of all files; None where one has none that is whole and right."""
        found = [read_summary(file) for file in self.files]
        whole = [s for s in found if s is not None]
        return whole if len(whole) == len(found) else None

    def read_summary(self) -> bool:
        """Fills every attribute from the summaries alone; whether the log has them.

        Damage within the messages is not noticed.
        """
        if self.summaries is None:
            return False
        for summary in self.summaries:
            definitions = Definitions(summary.file)
            for record in (*summary.definitions, *summary.others):
                self._keep_record(record, definitions)
        return True

    def read_through(self) -> None:
        """Reads the log to its end, so that every attribute is filled."""
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
        """The namespace in which the landing was published."""
        if "namespace" in self.metadata:
            return self.metadata["namespace"].rstrip("/")
        struts = [
            c.topic
            for c in self.channels.values()
            if f"/{c.topic}".endswith(f"/{STRUTS.name}") and c.type_name == STRUTS.type_name
        ]
        return struts[0].removesuffix(STRUTS.name).rstrip("/") if struts else ""

    def select(self, names: Sequence[str]) -> list[str]:
        """The full names of topics, after the log has been read.

        Args:
            names: full, or relative to the landing's namespace; none: all topics of the log.

        Raises:
            LandingError: the log has no such topic; the text names the nearest.
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
        """A function from bytes to messages of `topic`, by the definition that the log carries.

        Raises:
            LandingError: the log has no definition, or it cannot be read.
        """
        from mcap_ros2.decoder import DecoderFactory

        schema = self._schemas.get(topic)
        if schema is not None and len(schema.data) > LARGEST_DEFINITION:
            raise LandingError(
                f"{self.path}: the definition of {topic} has {len(schema.data)} bytes, more than "
                f"the {LARGEST_DEFINITION} of one that can be"
            )
        try:
            # A factory for each topic: it identifies schemas by number only, and each file of a log
            # has its own numbers.
            decode = DecoderFactory().decoder_for("cdr", schema)
        except Exception as e:
            raise LandingError(
                f"{self.path}: the definition of {topic} cannot be read: {reason_of(e)}"
            ) from None
        if decode is None:
            raise LandingError(
                f"{self.path}: {topic} has no definition in the log, it cannot be decoded"
            )
        return decode

    def parameters(self) -> Parameters | None:
        """The parameters that the log carries, or None; after its start has been read."""
        from rlv_landing.presets import parse_toml

        data = self.attachments.get("parameters.toml")
        if data is None:
            return None
        name = f"{self.path}: parameters.toml"
        if len(data) > LARGEST_DEFINITION:
            raise LandingError(
                f"{name} has {len(data)} bytes, more than the {LARGEST_DEFINITION} of any vehicle"
            )
        return parse_toml(data.decode("utf-8", "replace"), name)

    @property
    def interface(self) -> Interface:
        """Inputs and outputs of the log's landing; a symmetric one's where it has no parameters."""
        own = self.parameters()
        if own is None:
            return IN_A_PLANE
        return own.interface


class Definitions:
    """The schemas and channels of one file by number; of each number the first counts.

    Those lost with a damaged chunk are looked up in the file's summary.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self._schemas: dict[int, Any] = {}
        self._channels: dict[int, Any] = {}
        self._searched = False

    def add(self, record: Any) -> bool:
        """Adds a schema or a channel; whether it is a channel."""
        from mcap.records import Channel as ChannelRecord
        from mcap.records import Schema as SchemaRecord

        if isinstance(record, SchemaRecord):
            self._schemas.setdefault(record.id, record)
        elif isinstance(record, ChannelRecord):
            self._channels.setdefault(record.id, record)
            return True
        return False

    def find(self, channel: int) -> tuple[Any, Any]:
        """The channel of a number, and its schema; None where they are not found."""
        from mcap.records import Channel as ChannelRecord
        from mcap.records import Schema as SchemaRecord

        if channel not in self._channels and not self._searched:
            self._searched = True
            stream = RecordStream(self._file, summary=True)
            records = [r for r in stream if isinstance(r, (SchemaRecord, ChannelRecord))]
            for record in records if stream.summary_is_valid else ():
                self.add(record)
        found = self._channels.get(channel)
        return found, self._schemas.get(found.schema_id) if found is not None else None


class Decoder:
    """Decodes the messages of a log by the definitions that it carries.

    Args:
        reader: the log.
    """

    def __init__(self, reader: LogReader) -> None:
        self._reader = reader
        self._decoders: dict[str, Any] = {}

    def __call__(self, message: LogMessage) -> Any:
        """The message decoded.

        Raises:
            LandingError: it cannot be decoded.
        """
        if len(message.data) > LARGEST_MESSAGE:
            raise LandingError(
                f"{self._reader.path}: a message of {message.place} has {len(message.data)} bytes, "
                f"more than the {LARGEST_MESSAGE} that are decoded; leave its topic out"
            )
        if message.topic not in self._decoders:
            self._decoders[message.topic] = self._reader.decoder(message.topic)
        try:
            return self._decoders[message.topic](message.data)
        except Exception:
            raise self._unlike(message, "its definition says; it cannot be decoded") from None

    def read(self, message: LogMessage, reading: Callable[[Any], Result]) -> Result:
        """What `reading` makes of the message decoded.

        Raises:
            LandingError: it cannot be decoded, or its definition is not that of its type.
        """
        decoded = self(message)
        try:
            return reading(decoded)
        except LandingError:
            raise
        except (AttributeError, TypeError, ValueError, LookupError, OverflowError):
            kind = self._reader.channels[message.topic].type_name
            raise self._unlike(message, f"{kind} is in ROS 2; its definition is another") from None

    def _unlike(self, message: LogMessage, what: str) -> LandingError:
        at = f"{self._reader.path}: a message of {message.place}"
        return LandingError(f"{at} is not what {what}")
