"""Reads logs: complete ones, and those whose writer was killed or ran out of disk. Needs no ROS 2."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rlv_landing.errors import LandingError
from rlv_landing.parameters import Parameters

from .columns import READINGS
from .topics import STRUTS

if TYPE_CHECKING:
    from rlv_landing.history import History

MAGIC = b"\x89MCAP0\r\n"


@dataclass(frozen=True)
class Channel:
    """A topic of a log: its name, its type `pkg/msg/Type`, and the QoS that its publisher offered, as YAML."""

    topic: str
    type_name: str
    qos: str


@dataclass(frozen=True)
class LogMessage:
    """A message of a log: its topic, its time [ns], and the serialised bytes (CDR) that were published."""

    topic: str
    log_time: int
    data: bytes


class LogReader:
    """A log: a folder in rosbag2's layout, or one `.mcap` file.

    `cut` tells, once the messages have been read, that the file has no proper end. `metadata` and `attachments` are known as soon as
    they have been passed; in a log of ours they stand at its start.

    Raises:
        LandingError: there is no such log, it is not MCAP, or not even its first record can be read.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.files = find_files(self.path)
        self.channels: dict[str, Channel] = {}
        self.metadata: dict[str, str] = {}
        self.attachments: dict[str, bytes] = {}
        self.cut = False
        self._schemas: dict[str, Any] = {}
        self._topics: dict[int, str] = {}
        for file in self.files:
            check_file(file)

    @property
    def size(self) -> int:
        """Bytes of all files."""
        return sum(f.stat().st_size for f in self.files)

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The messages in the log's order, of all topics or of `topics`, up to the end or to where the log is cut."""
        from mcap.records import Attachment, Message, Metadata
        from mcap.records import Channel as ChannelRecord
        from mcap.records import Schema as SchemaRecord

        wanted = None if topics is None else set(topics)
        self.cut = False
        for file in self.files:
            schemas: dict[int, Any] = {}
            for record in self._records(file):
                if isinstance(record, Message):
                    topic = self._topics.get(record.channel_id, "")
                    if topic and (wanted is None or topic in wanted):
                        yield LogMessage(topic, record.log_time, record.data)
                elif isinstance(record, SchemaRecord):
                    schemas[record.id] = record
                elif isinstance(record, ChannelRecord):
                    self._add_channel(record, schemas.get(record.schema_id))
                elif isinstance(record, Attachment):
                    self.attachments[record.name] = record.data
                elif isinstance(record, Metadata) and record.name == "rlv_landing":
                    self.metadata.update(record.metadata)

    def _records(self, file: Path) -> Iterator[Any]:
        from mcap.stream_reader import StreamReader

        with file.open("rb") as stream:
            # A damaged length must not make the reader ask for more memory than the file is long.
            records = StreamReader(stream, validate_crcs=True, record_size_limit=max(1, file.stat().st_size)).records
            while True:
                try:
                    record = next(records)
                except StopIteration:
                    return
                except Exception:
                    # Cut or damaged bytes make the decoders raise whatever they like.
                    self.cut = True
                    return
                yield record

    def _add_channel(self, record: Any, schema: Any) -> None:
        self._topics[record.id] = record.topic
        self._schemas[record.topic] = schema
        name = schema.name if schema is not None else ""
        self.channels[record.topic] = Channel(record.topic, name, record.metadata.get("offered_qos_profiles", ""))

    @property
    def namespace(self) -> str:
        """The namespace under which the landing was published."""
        if "namespace" in self.metadata:
            return self.metadata["namespace"].rstrip("/")
        struts = next((t for t in self.channels if t.endswith(f"/{STRUTS.name}")), "")
        return struts.removesuffix(f"/{STRUTS.name}")

    def parameters(self) -> Parameters | None:
        """The parameters that the log carries, once its start has been read."""
        from rlv_landing.presets import parse_toml

        data = self.attachments.get("parameters.toml")
        return None if data is None else parse_toml(data.decode("utf-8", "replace"), f"{self.path}: parameters.toml")

    def history(self) -> History:
        """The landing as columns named as the FMU's variables, SI, one row an instant; digit for digit what the FMU gave.

        Instants that lack one of the topics (the last of a cut log) are left out.
        Raises LandingError where the log holds no landing.
        """
        import numpy as np

        from rlv_landing.history import History

        from .columns import COLUMN_NAMES

        rows: dict[int, dict[str, Any]] = {}
        decode = Decoder(self)
        for message in self.messages():
            relative = message.topic.removeprefix(self.namespace + "/")
            if relative in READINGS:
                names, reading = READINGS[relative]
                rows.setdefault(message.log_time, {}).update(zip(names, reading(decode(message))))
        complete = [(t, row) for t, row in sorted(rows.items()) if len(row) == len(COLUMN_NAMES)]
        if not complete:
            raise LandingError(f"{self.path} holds no landing: no instant has all of {', '.join(READINGS)}")
        times = np.array([self._seconds(t) for t, _ in complete])
        data = np.array([[row[name] for name in COLUMN_NAMES] for _, row in complete])
        return History(times, COLUMN_NAMES, data, self.parameters())

    def _seconds(self, nanoseconds: int) -> float:
        # Counted as the landing counts its times, k * step, so that they agree to the bit.
        try:
            step = float(self.metadata["step_size"])
            k, rest = divmod(nanoseconds, round(step * 1e9))
        except (KeyError, ValueError, ZeroDivisionError):
            return nanoseconds / 1e9
        return k * step if rest == 0 else nanoseconds / 1e9


class Decoder:
    """Decodes the messages of a log by the definitions that it carries."""

    def __init__(self, reader: LogReader) -> None:
        from mcap_ros2.decoder import DecoderFactory

        self._reader = reader
        self._factory = DecoderFactory()
        self._decoders: dict[str, Any] = {}

    def __call__(self, message: LogMessage) -> Any:
        if message.topic not in self._decoders:
            decoder = self._factory.decoder_for("cdr", self._reader._schemas[message.topic])
            if decoder is None:
                raise LandingError(f"{self._reader.path}: {message.topic} has no definition in the log, it cannot be decoded")
            self._decoders[message.topic] = decoder
        return self._decoders[message.topic](message.data)


def find_files(path: Path) -> list[Path]:
    """The MCAP files of the log at `path`, in their order. Raises LandingError where there are none."""
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise LandingError(f"there is no log {path}; name a log's folder or its .mcap file")
    files = sorted(path.glob("*.mcap"), key=_number)
    if not files:
        raise LandingError(f"{path} holds no .mcap file; name a log's folder or its .mcap file")
    return files


def _number(file: Path) -> tuple[str, int]:
    """Split logs are numbered `_0`, `_1`, ..., `_10`: by number, not by letter."""
    stem, _, number = file.stem.rpartition("_")
    return (stem, int(number)) if number.isdigit() else (file.stem, 0)


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
        raise LandingError(f"{file} is not MCAP: it does not start as one; name a log's folder or its .mcap file")
    if len(start) < len(MAGIC) + 9 or start[len(MAGIC)] != 1 or not whole:
        raise LandingError(f"{file} is cut within its first record; nothing in it can be read")
