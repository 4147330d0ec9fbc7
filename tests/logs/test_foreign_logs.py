"""Recordings of other programs: in sqlite3, split, compressed, of types that are not known here."""

from __future__ import annotations

import sqlite3
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import closing
from pathlib import Path

import pytest
import zstandard
from bridge_tools import one_error_line, run
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from rlv_landing.errors import LandingError
from rlv_landing.history import History
from rlv_ros_bridge.logs.bag_reader import open_log
from rlv_ros_bridge.logs.history import history_of, log_history
from rlv_ros_bridge.logs.info import log_info
from rlv_ros_bridge.logs.reader import LogMessage, LogReader
from rlv_ros_bridge.logs.recover import recover
from rlv_ros_bridge.messages.message_types import is_installed, message_class
from rlv_ros_bridge.replay.selection import ReplayOptions, Selection

# of the landing that is used [ns]
SPAN = 20_000_000
TABLES = """
CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
  timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""


@pytest.fixture(scope="module")
def start(one_log: Path) -> tuple[LogReader, list[LogMessage]]:
    """A landing's first messages, and the reader that knows their topics."""
    reader = LogReader(one_log)
    return reader, [m for m in reader.messages() if m.log_time <= SPAN]


def database(path: Path, reader: LogReader, messages: Iterable[LogMessage]) -> Path:
    """The messages as rosbag2's recorder writes them to sqlite3."""
    numbers = {topic: i for i, topic in enumerate(reader.channels, 1)}
    with closing(sqlite3.connect(path)) as file:
        file.executescript(TABLES)
        file.executemany(
            "INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?)",
            [(numbers[c.topic], c.topic, c.type_name, c.qos) for c in reader.channels.values()],
        )
        file.executemany(
            "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
            [(numbers[m.topic], m.log_time, m.data) for m in messages],
        )
        file.commit()
    return path


def mcap(
    path: Path,
    reader: LogReader,
    messages: Iterable[LogMessage],
    description: str = "",
    compression: CompressionType = CompressionType.ZSTD,
) -> Path:
    """The messages as a MCAP file of another program."""
    with path.open("wb") as file:
        writer = Writer(file, compression=compression)
        writer.start("ros2", "")
        if description:
            writer.add_metadata("rosbag2", {"serialized_metadata": description})
        numbers = {}
        for topic, c in reader.channels.items():
            schema = reader._schemas[topic]
            known = writer.register_schema(c.type_name, "ros2msg", schema.data)
            numbers[topic] = writer.register_channel(topic, "cdr", known)
        for m in messages:
            writer.add_message(numbers[m.topic], m.log_time, m.data, m.log_time)
        writer.finish()
    return path


def packed(path: Path) -> Path:
    """The file compressed as a whole, in its place."""
    target = path.with_name(path.name + ".zstd")
    target.write_bytes(zstandard.compress(path.read_bytes()))
    path.unlink()
    return target


def halves(messages: list[LogMessage]) -> list[list[LogMessage]]:
    middle = next(i for i, m in enumerate(messages) if m.log_time > SPAN // 2)
    return [messages[:middle], messages[middle:]]


Start = tuple[LogReader, list[LogMessage]]


def in_sqlite(folder: Path, start: Start) -> Path:
    return database(folder / "bag_0.db3", *start)


def in_sqlite_split(folder: Path, start: Start) -> Path:
    for i, half in zip((9, 10), halves(start[1])):
        database(folder / f"bag_{i}.db3", start[0], half)
    return folder


def in_sqlite_packed(folder: Path, start: Start) -> Path:
    packed(database(folder / "bag_0.db3", *start))
    return folder


BY_MESSAGES = "{compression_format: zstd, compression_mode: MESSAGE}"


def small(messages: Iterable[LogMessage]) -> list[LogMessage]:
    return [LogMessage(m.topic, m.log_time, zstandard.compress(m.data)) for m in messages]


def in_sqlite_by_messages(folder: Path, start: Start) -> Path:
    metadata = f"rosbag2_bagfile_information: {BY_MESSAGES}\n"
    (folder / "metadata.yaml").write_text(metadata)
    database(folder / "bag_0.db3", start[0], small(start[1]))
    return folder


def in_mcap_by_messages(folder: Path, start: Start) -> Path:
    metadata = f"rosbag2_bagfile_information: {BY_MESSAGES}\n"
    (folder / "metadata.yaml").write_text(metadata)
    mcap(folder / "bag_0.mcap", start[0], small(start[1]))
    return folder


def in_mcap_by_messages_without_yaml(folder: Path, start: Start) -> Path:
    return mcap(folder / "bag_0.mcap", start[0], small(start[1]), BY_MESSAGES)


def in_mcap_packed(folder: Path, start: Start) -> Path:
    return packed(mcap(folder / "bag_0.mcap", *start))


def in_mcap_split_and_packed(folder: Path, start: Start) -> Path:
    for i, half in zip((9, 10), halves(start[1])):
        packed(mcap(folder / f"bag_{i}.mcap", start[0], half))
    return folder


@pytest.mark.parametrize(
    "form",
    [
        in_sqlite,
        in_sqlite_split,
        in_sqlite_packed,
        in_sqlite_by_messages,
        in_mcap_by_messages,
        in_mcap_by_messages_without_yaml,
        in_mcap_packed,
        in_mcap_split_and_packed,
    ],
)
def test_a_recording_of_any_form_holds_the_same_messages_and_landing(
    start: Start, one_log: Path, tmp_path: Path, form: Callable[[Path, Start], Path]
) -> None:
    log = form(tmp_path, start)
    reader = open_log(log)
    assert sorted(reader.messages(), key=str) == sorted(start[1], key=str)
    assert not reader.cut
    found, whole = history_of(reader), log_history(one_log)
    assert found.names == whole.names
    assert found.data.tobytes() == whole.data[: len(found)].tobytes()
    played = list(Selection(open_log(log), ReplayOptions(log)))
    times = [m.log_time for m in played]
    assert times == sorted(times)
    assert len(played) == sum(is_installed(start[0].channels[m.topic].type_name) for m in start[1])


def test_the_folder_of_a_packed_log_lasts_as_long_as_its_reader(
    start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    room = tmp_path / "room"
    room.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(room))
    reader = open_log(in_mcap_packed(tmp_path, start))
    assert len(list(room.iterdir())) == 1
    del reader
    assert not list(room.iterdir())


@pytest.mark.parametrize(
    "script",
    [
        "CREATE TABLE t (a); CREATE VIEW messages AS SELECT 1 topic_id, 1 timestamp, x'00' data",
        "CREATE TABLE messages (topic_id, timestamp, data AS (zeroblob(1000000000)) VIRTUAL)",
    ],
)
def test_tables_that_are_computed_are_refused(tmp_path: Path, script: str) -> None:
    with closing(sqlite3.connect(tmp_path / "log.db3")) as file:
        file.executescript(TABLES.split(";")[0] + ";" + script)
    with pytest.raises(LandingError, match="its tables are computed, not stored"):
        open_log(tmp_path / "log.db3")


def test_what_sqlite3_has_to_do_is_bounded(tmp_path: Path, start: Start) -> None:
    """A damaged or false tree of pages may have no end; many rows of a small file stand for it."""
    log = database(tmp_path / "log.db3", *start)
    reader = open_log(log)
    with closing(sqlite3.connect(log)) as file:
        file.executescript("UPDATE messages SET data = x'00'; DROP INDEX timestamp_idx;")
        rows = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 300000) "
        file.execute(
            rows + "INSERT INTO messages (topic_id, timestamp, data) SELECT 1, i, '' FROM n"
        )
        file.commit()
    begin = time.process_time()
    count = sum(1 for _ in reader.messages())
    assert time.process_time() - begin < 5.0
    assert reader.cut or count > 300_000


def test_a_damaged_database_gives_what_is_whole_and_says_so(tmp_path: Path, start: Start) -> None:
    log = database(tmp_path / "log.db3", *start)
    data = bytearray(log.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 40_000] = bytes(40_000)
    log.write_bytes(data)
    reader = open_log(log)
    assert len(list(reader.messages())) < len(start[1])
    assert reader.cut
    assert reader.damage


def test_recover_copies_messages_that_are_compressed_by_themselves(
    tmp_path: Path, start: Start
) -> None:
    day = 1_795_707_768 * 10**9
    stamped = [LogMessage(m.topic, m.log_time + day, m.data) for m in start[1]]
    log = in_mcap_by_messages_without_yaml(tmp_path, (start[0], stamped))
    log.write_bytes(log.read_bytes()[:-9])
    saved = recover(log, tmp_path / "saved")
    assert saved.messages == len(start[1])
    assert "compression_mode: MESSAGE" in (tmp_path / "saved" / "metadata.yaml").read_text()
    assert list(open_log(tmp_path / "saved").messages()) == stamped
    assert "from 1795707768.000 s to 1795707768.020 s" in saved.text()


@pytest.mark.parametrize("form", [in_sqlite_by_messages, in_mcap_by_messages])
def test_messages_of_false_sizes_are_damage(
    tmp_path: Path, start: Start, monkeypatch: pytest.MonkeyPatch, form: Callable[..., Path]
) -> None:
    """Each is below what a message may hold; together they are more than a file can."""
    monkeypatch.setattr("rlv_ros_bridge.logs.mcap_files.chunks.FILE_BYTES", 10_000_000)
    monkeypatch.setattr("rlv_ros_bridge.logs.mcap_files.chunks.FILE_RATIO", 0)
    monkeypatch.setattr(sys.modules[__name__], "small", lambda messages: messages)
    bomb = zstandard.compress(bytes(3_000_000))
    topic = start[1][0].topic
    reader = open_log(form(tmp_path, (start[0], [LogMessage(topic, i, bomb) for i in range(9)])))
    assert len(list(reader.messages())) == 3
    assert reader.cut
    assert "more than a file of this size can hold" in reader.damage[0]


def test_of_a_cut_chunk_only_the_topics_that_are_asked_for_are_read(
    tmp_path: Path, start: Start
) -> None:
    """As of `ros2 bag record` that was killed: its chunks are not compressed."""
    log = mcap(tmp_path / "bag_0.mcap", *start, compression=CompressionType.NONE)
    with log.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunk = summary.chunk_indexes[0]
    log.write_bytes(log.read_bytes()[: chunk.chunk_start_offset + chunk.chunk_length // 2])
    reader = open_log(log)
    found = list(reader.messages(["/landing/pose"]))
    assert 0 < len(found) < len(start[1])
    assert {m.topic for m in found} == {"/landing/pose"}
    assert "is cut" in run("log", "info", log).stderr


def test_recover_says_what_to_do_with_other_forms(tmp_path: Path, start: Start) -> None:
    log = database(tmp_path / "bag_0.db3", *start)
    assert "sqlite3 bag_0.db3 .recover | sqlite3 whole.db3" in one_error_line(
        run("log", "recover", log)
    )
    packed(log)
    assert "decompress its files by zstd -d first" in one_error_line(
        run("log", "recover", tmp_path)
    )


def test_a_bomb_of_zstd_is_not_unpacked(tmp_path: Path) -> None:
    bomb = tmp_path / "log.mcap.zstd"
    bomb.write_bytes(zstandard.compress(bytes(300 * 1024 * 1024)) * 2)
    with pytest.raises(LandingError, match="holds more than a file of its size"):
        open_log(bomb)


def test_types_that_are_not_known_here_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "")
        for topic, name in (
            ("/ours", "std_msgs/msg/String"),
            ("/theirs", "their_msgs/msg/Theirs"),
            ("/code", "antigravity/msg/antigravity"),
            ("/no", "no type at all"),
        ):
            schema = writer.register_schema(name, "ros2msg", b"string data")
            channel = writer.register_channel(topic, "cdr", schema)
            writer.add_message(channel, 0, b"\0\1\0\0\x01\0\0\0\0", 0)
        writer.finish()
    done = run("replay", path, "--rate", "100")
    assert done.returncode == 0, done.stderr
    assert "played 1 messages" in done.stdout
    assert [line for line in done.stderr.splitlines() if line.startswith("warning")] == [
        "warning: /theirs is left out: its type their_msgs/msg/Theirs is not installed here",
        "warning: /code is left out: its type antigravity/msg/antigravity is not installed here",
        "warning: /no is left out: its type no type at all is not installed here",
    ]
    with pytest.raises(LandingError, match="message type 'antigravity/msg/antigravity' is not"):
        message_class("antigravity/msg/antigravity")
    assert "antigravity" not in sys.modules


def test_the_time_of_the_day_is_told_as_such_and_csv_has_all_its_digits(
    tmp_path: Path, start: Start
) -> None:
    reader, messages = start
    later = [LogMessage(m.topic, 1_790_000_000_123_456_789 + m.log_time, m.data) for m in messages]
    log = database(tmp_path / "log.db3", reader, later)
    text = log_info(open_log(log)).text()
    assert "start      2026-09-21T14:13:20.123+00:00 (wall time" in text


@pytest.mark.parametrize(
    ("stamp", "text"),
    [
        (0, "0.0"),
        (3_000_000, "0.003"),
        (300_000_000, "0.3"),
        (1_790_000_000_123_456_789, "1790000000.123456789"),
        (-1, "-0.000000001"),
        (5 * 10**9, "5.0"),
    ],
)
def test_times_in_csv_are_the_stamps_exact_decimals(
    tmp_path: Path, one_log: Path, stamp: int, text: str
) -> None:
    whole = log_history(one_log)
    row = History(whole.time[:1], whole.names, whole.data[:1])
    row.stamps = [stamp]
    with (tmp_path / "out.csv").open("w") as file:
        row.write_csv(file)
    assert (tmp_path / "out.csv").read_text().splitlines()[1].split(",")[0] == text
