"""Messages found by a log's index are those that reading the whole log finds."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from bridge_tools import record
from log_tools import messages_of, small_log

from rlv_landing.errors import LandingError
from rlv_landing.summary import summarise
from rlv_landing.tables.landing import sampling_note
from rlv_ros_bridge.logs.history import drawn_history, log_history, measured_history
from rlv_ros_bridge.logs.indexed import holds, last_time, messages_between
from rlv_ros_bridge.logs.mcap_files.summary import read_summary
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.rows.instants import RowChoice
from rlv_ros_bridge.logs.rows.parts import HistoryParts, with_parts
from rlv_ros_bridge.replay.selection import ReplayOptions, Selection

CHUNKS, PER_CHUNK = 6, 12
SPANS = [(0, math.inf), (13_000, 29_000), (23_000, 23_000), (24_500, 24_900), (60_000, math.inf)]


@pytest.mark.parametrize("topics", [("/a",), ("/a", "/b"), ()])
@pytest.mark.parametrize("span", SPANS)
def test_a_span_of_topics_is_found_by_the_index(
    tmp_path: Path, topics: tuple[str, ...], span: tuple[int, float]
) -> None:
    reader = LogReader(small_log(tmp_path / "log", CHUNKS, PER_CHUNK))
    first, last = span
    expected = [m for m in reader.messages(topics) if first <= m.log_time <= last]
    assert list(messages_between(reader, topics, first, last)) == expected
    assert not reader.cut
    times = [m.log_time for m in expected]
    assert last_time(reader, topics, first, last) == max(times, default=None)


def test_only_the_chunks_of_the_span_are_read_and_a_damaged_one_is_left_out(
    tmp_path: Path,
) -> None:
    file = small_log(tmp_path / "log", CHUNKS, PER_CHUNK)
    whole = LogReader(file)
    wanted = list(whole.messages())
    summary = read_summary(file)
    assert summary is not None
    data = bytearray(file.read_bytes())
    hit = summary.chunks[2]
    data[hit.position + hit.length - 1] ^= 1
    file.write_bytes(data)
    reader = LogReader(file)
    assert list(messages_between(reader, ["/a", "/b"], 36_000, math.inf)) == wanted[36:]
    assert not reader.cut
    assert list(messages_between(reader, ["/a", "/b"], 0, math.inf)) == wanted[:24] + wanted[36:]
    assert reader.cut
    assert [text.rpartition(": ")[2] for text in reader.damage] == ["a chunk's bytes were changed"]


def test_a_file_whose_end_was_changed_in_any_byte_has_no_summary(tmp_path: Path) -> None:
    file = small_log(tmp_path / "log", 2, PER_CHUNK)
    data = file.read_bytes()
    summary = read_summary(file)
    assert summary is not None
    behind = max(c.position + c.length for c in summary.chunks)
    start = data.index(b"\x0f" + (4).to_bytes(8, "little"), behind)
    # The four bytes of the data's checksum are no part of the summary.
    for at in (*range(start, start + 9), *range(start + 13, len(data))):
        changed = bytearray(data)
        changed[at] ^= 0x10
        file.write_bytes(changed)
        assert read_summary(file) is None
    for length in range(0, len(data), 7):
        file.write_bytes(data[:length])
        assert read_summary(file) is None


@pytest.fixture(scope="module")
def long_log(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log of 200 s in steps of 0.05 s, in many chunks."""
    folder = tmp_path_factory.mktemp("long") / "log"
    return record(fmu, folder, "--step", 0.05, "--stop-time", 200)


def rows_of(log: Path, **choice: float) -> tuple[list[float], bool]:
    """The times [s] of the rows that are chosen, and whether damage was met."""
    reader = LogReader(log)

    def times(parts: HistoryParts) -> list[float]:
        return [time for part in parts for time in part.time.tolist()]

    return with_parts(reader, ["rpy"], RowChoice(**choice), times), reader.cut


@pytest.mark.parametrize(
    "choice",
    [
        {"start": 150.0, "end": 152.0},
        {"start": 199.9},
        {"every": 0.12},
        {"every": 30.0},
        {"start": 10.02, "every": 7.0},
        {"start": 10.0, "end": 100.0, "every": 20.0},
    ],
)
def test_chosen_rows_are_those_that_reading_the_whole_log_finds(
    long_log: Path, choice: dict[str, float]
) -> None:
    whole, _ = rows_of(long_log)
    assert len(whole) == 4001
    wanted = RowChoice(**choice)
    assert rows_of(long_log, **choice) == ([t for t in whole if wanted.takes(t)], False)


def test_only_the_chunks_are_read_that_hold_chosen_rows(long_log: Path, tmp_path: Path) -> None:
    (file,) = long_log.glob("*.mcap")
    summary = read_summary(file)
    assert summary is not None
    hit = next(c for c in summary.chunks if c.first > 60_100_000_000)
    data = bytearray(file.read_bytes())
    data[hit.position + hit.length - 1] ^= 1
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    assert rows_of(damaged)[1]
    span = {"start": hit.first / 1e9, "end": hit.last / 1e9}
    assert rows_of(damaged, **{**span, "end": span["end"] + 10.0})[1]
    for choice in ({"start": span["end"] + 1.0}, {"end": span["start"] - 1.0}, {"every": 150.0}):
        assert rows_of(damaged, **choice) == rows_of(long_log, **choice)
        assert not rows_of(damaged, **choice)[1]


def test_the_summary_of_a_long_landing_needs_few_of_its_rows(long_log: Path) -> None:
    few, whole = measured_history(LogReader(long_log)), log_history(long_log)
    assert 1200 < len(few) < 2400
    until = int(np.flatnonzero(few.time > 60.0)[0])
    assert np.array_equal(few.data[:until], whole.data[:until])
    assert np.array_equal(few.data[-20:], whole.data[-20:])
    assert summarise(few) == summarise(whole)
    assert sampling_note(few) == sampling_note(whole)


def test_what_a_film_shows_is_read_and_little_more(long_log: Path) -> None:
    whole = log_history(long_log)
    few, _ = drawn_history(LogReader(long_log), shown=(100.0, 102.0))
    rows = (whole.time >= 99.0) & (whole.time <= 103.0)
    assert np.array_equal(few.time, whole.time[rows])
    assert np.array_equal(few.data, whole.data[rows])
    # Up to the log's end.
    few, _ = drawn_history(LogReader(long_log), shown=(198.0, math.inf))
    assert np.array_equal(few.time, whole.time[whole.time >= 197.0])
    # A span that the log does not have is refused with all that it has.
    all_rows, _ = drawn_history(LogReader(long_log), shown=(199.0, 201.0))
    assert np.array_equal(all_rows.time, whole.time)


@pytest.mark.parametrize("topic", ["/landing/applied/ground", "/landing/struts", "/landing/none"])
def test_whether_a_topic_has_messages_is_known_from_the_summary(
    long_log: Path, tmp_path: Path, topic: str
) -> None:
    (file,) = long_log.glob("*.mcap")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(file.read_bytes()[:-1])
    assert holds(LogReader(file), topic) == holds(LogReader(cut), topic) == (topic[9:] == "struts")


@pytest.mark.parametrize("cut", [False, True])
def test_a_selection_is_the_same_from_a_log_with_summary_and_from_one_cut_behind_its_messages(
    tmp_path: Path, *, cut: bool
) -> None:
    file = small_log(tmp_path / "log", CHUNKS, PER_CHUNK)
    wanted = messages_of(file)
    if cut:
        file.write_bytes(file.read_bytes()[:-1])
    options = ReplayOptions(file, start=20e-6, duration=30e-6, topics=("/b",))
    selection = Selection(LogReader(file), options)
    played = [(m.topic, m.log_time, m.data) for m in selection]
    assert played == [
        (topic, time, data)
        for topic, time, _, data in wanted
        if topic == "/b" and 20_000 <= time <= 50_000
    ]
    assert (selection.first, selection.length, selection.step) == (20_000, 30_000, 1000)
    assert selection.cut == cut
    with pytest.raises(LandingError, match="nothing to play from --start 1 s on: the log is"):
        Selection(LogReader(file), ReplayOptions(file, start=1.0))
