"""Tools for tests of logs: small, cut and changed logs, made with MCAP's own writer and readers."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from contextlib import closing
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from mcap.data_stream import RecordBuilder
from mcap.reader import make_reader
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    DataEnd,
    Footer,
    Header,
    Message,
    Metadata,
    Schema,
)
from mcap.stream_reader import StreamReader
from mcap.writer import Writer

from rlv_landing.errors import LandingError
from rlv_ros_bridge.logs.reader import Decoder, LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.verification.known_bytes import LONGEST, KnownBytes
from rlv_ros_bridge.logs.verification.repeat import RepeatedRun
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.tables import table_of
from rlv_ros_bridge.messages.topics import resolve

CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
CDR = bytes([0, 1, 0, 0])
Change = Callable[[Any], Any]


def small_log(folder: Path, chunks: int = 4, messages: int = 12) -> Path:
    """A complete log of two topics in `chunks` chunks of `messages` messages each; its file."""
    topics = [RecordedTopic(name, CLOCK_TYPE, TELEMETRY) for name in ("/a", "/b")]
    recorder = Recorder(
        folder, topics, {"step_size": "0.001", "stop_time": "1.0"}, {"parameters.toml": b"# none\n"}
    )
    for k in range(chunks * messages):
        recorder.write("/b" if k % 3 else "/a", 1000 * k, CDR + k.to_bytes(8, "little"))
        if k % messages == messages - 1:
            recorder.sync()
    recorder.close()
    assert not recorder.error
    return recorder.path


def messages_of(file: Path) -> list[tuple[str, int, int, bytes]]:
    """Topic, time, sequence and bytes of every message, in the file's order.

    MCAP's own seeking reader reads them.
    """
    with file.open("rb") as f:
        found = make_reader(f, validate_crcs=True).iter_messages(log_time_order=False)
        return [(channel.topic, m.log_time, m.sequence, m.data) for _, channel, m in found]


def rewrite(
    source: Path,
    folder: Path,
    change: Change = lambda record: record,
    without: Container[str] = (),
) -> Path:
    """A complete log: `source` with `change` applied to messages, attachments and metadata.

    A record for which `change` returns None is left out, and topics that are to be `without`.
    """
    folder.mkdir()
    target = folder / f"{folder.name}_0.mcap"
    schemas: dict[int, int] = {0: 0}
    channels: dict[int, int] = {}
    topics: dict[int, str] = {}
    skipped: set[int] = set()
    with source.open("rb") as f, target.open("wb") as out:
        writer = Writer(out, chunk_size=50_000, enable_data_crcs=True)
        for record in StreamReader(f).records:
            if isinstance(record, Header):
                writer.start(record.profile, record.library)
            elif isinstance(record, Schema) and record.id not in schemas:
                schemas[record.id] = writer.register_schema(
                    record.name, record.encoding, record.data
                )
            elif isinstance(record, Channel) and record.topic in without:
                skipped.add(record.id)
            elif isinstance(record, Channel) and record.id not in channels:
                topics[record.id] = record.topic
                channels[record.id] = writer.register_channel(
                    record.topic,
                    record.message_encoding,
                    schemas[record.schema_id],
                    record.metadata,
                )
            elif isinstance(record, Message) and record.channel_id not in skipped:
                message = change((topics[record.channel_id], record))
                if message is not None:
                    m = message[1]
                    writer.add_message(
                        channels[m.channel_id], m.log_time, m.data, m.publish_time, m.sequence
                    )
            elif isinstance(record, Attachment):
                a = change(record)
                if a is not None:
                    writer.add_attachment(a.create_time, a.log_time, a.name, a.media_type, a.data)
            elif isinstance(record, Metadata):
                m = change(record)
                if m is not None:
                    writer.add_metadata(m.name, m.metadata)
        writer.finish()
    return target


def write_with_chunk(file: Path, chunk: Chunk, library: str = "") -> None:
    """A file whose only chunk is `chunk`, with an end, as if `library` had written it."""
    builder = RecordBuilder()
    for record in (Header("ros2", library), chunk, DataEnd(0), Footer(0, 0, 0)):
        record.write(builder)
    file.write_bytes(b"\x89MCAP0\r\n" + builder.end() + b"\x89MCAP0\r\n")


def in_message(topic: str, nanoseconds: int, change: Callable[[bytes], bytes | None]) -> Change:
    """For `rewrite`: changes the bytes of one message, or leaves it out."""

    def apply(record: Any) -> Any:
        if isinstance(record, tuple) and record[0] == topic and record[1].log_time == nanoseconds:
            data = change(record[1].data)
            return None if data is None else (topic, replace(record[1], data=data))
        return record

    return apply


def in_metadata(change: Mapping[str, str | None]) -> Change:
    """For `rewrite`: changes our metadata's texts, or leaves them out."""

    def apply(record: Any) -> Any:
        if isinstance(record, Metadata) and record.name == "rlv_landing":
            new = {**record.metadata, **change}
            return Metadata("rlv_landing", {k: v for k, v in new.items() if v is not None})
        return record

    return apply


def in_attachment(change: Callable[[bytes], bytes | None]) -> Change:
    """For `rewrite`: changes the parameters that a log carries, or leaves them out."""

    def apply(record: Any) -> Any:
        if isinstance(record, Attachment):
            data = change(record.data)
            return None if data is None else replace(record, data=data)
        return record

    return apply


def assert_bytes_are_known(reader: LogReader) -> None:
    """The bytes of the tenth message of each sampled topic are known from its first one."""
    reader.read_summary()
    run, decode = RepeatedRun(reader), Decoder(reader)
    with closing(run.samples()) as samples:
        values = list(islice(samples, 10))
    for name, fields in table_of(run.vehicle.interface).fields_of.items():
        topic = resolve(reader.namespace, name)
        messages = list(islice(reader.messages([topic]), 10))
        known = KnownBytes(messages[0], decode, fields, run.vehicle)
        longer = replace(messages[0], data=messages[0].data + bytes(LONGEST))
        with pytest.raises(LandingError, match="is longer than"):
            KnownBytes(longer, decode, fields, run.vehicle)
        assert known.of(messages[9].log_time, values[9]) == messages[9].data, topic
        assert known.of(messages[9].log_time + 1, values[9]) != messages[9].data, topic
        other = {output: value + 0.125 for output, value in values[9].items()}
        assert known.of(messages[9].log_time, other) != messages[9].data, topic
