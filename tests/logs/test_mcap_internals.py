"""The private parts of MCAP's writer have the meaning that the recorder relies on."""

from __future__ import annotations

import io

import pytest
from mcap.writer import Writer

from rlv_ros_bridge.logs.mcap_files.internals import chunk_builder, statistics


@pytest.fixture
def writer() -> Writer:
    """A writer with a channel and three messages in the open chunk."""
    writer = Writer(io.BytesIO())
    writer.start()
    channel = writer.register_channel("/a", "cdr", writer.register_schema("t", "ros2msg", b""))
    for time in (30, 10, 20):
        writer.add_message(channel, time, b"data", time)
    return writer


def test_the_builder_holds_what_the_open_chunk_has(writer: Writer) -> None:
    builder = chunk_builder(writer)
    assert builder.num_messages == 3
    assert (builder.message_start_time, builder.message_end_time) == (10, 30)
    (index,) = builder.message_indices.values()
    assert [time for time, _ in index.records] == [30, 10, 20]
    before = builder.count
    builder.record_writer.write(b"twelve bytes")
    assert builder.count == before + 12


def test_the_statistics_count_all_messages(writer: Writer) -> None:
    found = statistics(writer)
    assert found.message_count == 3
    assert (found.message_start_time, found.message_end_time) == (10, 30)
    assert list(found.channel_message_counts.values()) == [3]


def test_a_writer_without_them_gives_none() -> None:
    assert chunk_builder(object()) is None
    assert statistics(object()) is None
