"""Messages recorded a sample at a time are byte for byte what MCAP's own writer writes."""

from __future__ import annotations

import struct
from pathlib import Path
from random import Random

import pytest
from log_tools import CDR, CLOCK_TYPE, messages_of
from mcap.reader import make_reader

from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.recording import bag_writer, chunk_queue
from rlv_ros_bridge.logs.recording.bag_writer import CHUNK_BYTES
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.wire import STAMP, Places

MS = 1_000_000
COUNT = 5
# Messages of 16, 44 and 20 bytes: numbers side by side, apart, twice, and none.
SAMPLED = {
    "/a": Places(CDR + b"-" * 12, [4], []),
    "/b": Places(CDR + b"*" * 40, [12], [(4, 3), (20, 0), (28, 1), (36, 3)]),
    "/c": Places(CDR + b"+" * 16, [], [(12, 4)]),
}
SINGLE = "/single"
MESSAGES = dict[str, list[tuple[int, bytes]]]


def filled(places: Places, time: int, numbers: list[float]) -> bytes:
    """The message with its numbers and its stamp."""
    data = bytearray(places.data)
    for at in places.stamps:
        STAMP.pack_into(data, at, *divmod(time, 10**9))
    for at, i in places.numbers:
        struct.pack_into("<d", data, at, numbers[i])
    return bytes(data)


def record(folder: Path, chunk_messages: int, *, by_the_library: bool) -> tuple[Path, MESSAGES]:
    """A log of 1500 samples and single messages between them, and its expected messages.

    A chunk is written every `chunk_messages` samples.
    """
    random = Random(3)
    recorder = Recorder(
        folder,
        [RecordedTopic(name, CLOCK_TYPE, TELEMETRY) for name in (*SAMPLED, SINGLE)],
        {"key": "value"},
    )
    if by_the_library:
        recorder._queue._writer._builder = None
    expected: MESSAGES = {name: [] for name in (*SAMPLED, SINGLE)}
    recorder.begin_samples(SAMPLED, COUNT)
    for k in range(1500):
        time = MS * k
        numbers = [random.uniform(-1e3, 1e3) for _ in range(COUNT)]
        recorder.write_sample(k, time, numbers)
        for name, places in SAMPLED.items():
            expected[name].append((time, filled(places, time, numbers)))
        for _ in range(random.choice((0, 0, 0, 1, 2))):
            # Times of single messages may go back, as those of inputs do.
            expected[SINGLE].append((max(0, time - MS), CDR + random.randbytes(8)))
            recorder.write(SINGLE, *expected[SINGLE][-1])
        if k % chunk_messages == chunk_messages - 1:
            recorder.sync()
    assert recorder.count == sum(map(len, expected.values()))
    recorder.close()
    assert not recorder.error
    return recorder.path, expected


@pytest.mark.parametrize("chunk_messages", [1, 7, 100])
def test_a_log_is_byte_for_byte_what_mcaps_own_writer_makes_of_its_messages(
    tmp_path: Path, chunk_messages: int
) -> None:
    ours, _ = record(tmp_path / "ours" / "log", chunk_messages, by_the_library=False)
    theirs, _ = record(tmp_path / "theirs" / "log", chunk_messages, by_the_library=True)
    assert ours.read_bytes() == theirs.read_bytes()
    assert (ours.parent / "metadata.yaml").read_bytes() == (
        theirs.parent / "metadata.yaml"
    ).read_bytes()


@pytest.mark.parametrize("by_the_library", [False, True])
def test_every_message_is_in_a_chunk_of_bounded_size_and_found_by_its_index(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, by_the_library: bool
) -> None:
    limit = 64 * 1024
    for module in (bag_writer, chunk_queue):
        monkeypatch.setattr(module, "CHUNK_BYTES", limit)
    path, expected = record(tmp_path / "log", 10**9, by_the_library=by_the_library)
    found = messages_of(path)
    for name, messages in expected.items():
        assert [
            (time, sequence, data) for topic, time, sequence, data in found if topic == name
        ] == [(time, k, data) for k, (time, data) in enumerate(messages)]
    with path.open("rb") as f:
        reader = make_reader(f, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert len(summary.chunk_indexes) > 1
        assert max(c.uncompressed_size for c in summary.chunk_indexes) <= limit
        # By the indexes: a span of one topic.
        part = [
            m.data
            for _, _, m in reader.iter_messages(
                ["/b"], starting_at=400 * MS, ending_before=900 * MS
            )
        ]
    assert part == [data for time, data in expected["/b"] if 400 * MS <= time < 900 * MS]


def test_a_message_larger_than_a_chunk_has_one_of_its_own(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "log", [RecordedTopic("/a", CLOCK_TYPE, TELEMETRY)])
    sent = [CDR + bytes(size) for size in (8, 2 * CHUNK_BYTES, 8)]
    for k, data in enumerate(sent):
        recorder.write("/a", k, data)
    recorder.close()
    assert [data for *_, data in messages_of(recorder.path)] == sent
