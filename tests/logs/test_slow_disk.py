"""A slow disk: the landing continues or waits; lost messages are counted, and noted in the log."""

from __future__ import annotations

import gc
import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest
from bridge_tools import TIMEOUT, environment, run
from log_tools import CDR, CLOCK_TYPE, messages_of
from mcap.reader import make_reader

from rlv_ros_bridge.logs.info import log_info
from rlv_ros_bridge.logs.lost import lost_text
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.recording.log_file import LogFile
from rlv_ros_bridge.logs.recording.writing_thread import WritingThread
from rlv_ros_bridge.messages.qos import TELEMETRY

TOPICS = [
    RecordedTopic("/a", CLOCK_TYPE, TELEMETRY),
    RecordedTopic("/kept", CLOCK_TYPE, TELEMETRY, kept=True),
]
QUEUE = "rlv_ros_bridge.logs.recording.chunk_queue"


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """An event for which every write of a log waits; it is set until a test clears it."""
    free = threading.Event()
    free.set()
    write = LogFile._write

    def wait(self: LogFile, data: memoryview) -> int:
        assert free.wait(TIMEOUT)
        return write(self, data)

    monkeypatch.setattr(LogFile, "_write", wait)
    return free


def write_all(recorder: Recorder, chunks: range, messages: int = 10) -> None:
    """Records chunks of so many messages of each topic."""
    for k in range(chunks.start * messages, chunks.stop * messages):
        for topic in ("/a", "/kept"):
            recorder.write(topic, 1000 * k, CDR + k.to_bytes(8, "little"))
        if k % messages == messages - 1:
            recorder.flush()


def test_messages_that_do_not_fit_are_left_out_and_the_log_says_so(
    tmp_path: Path, disk: threading.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"{QUEUE}.WAITING_BYTES", 3000)
    recorder = Recorder(tmp_path / "log", TOPICS)
    disk.clear()
    write_all(recorder, range(20))
    lost = recorder.lost
    assert lost > 0
    disk.set()
    recorder.sync()
    write_all(recorder, range(20, 22))
    recorder.sync()
    disk.clear()
    write_all(recorder, range(22, 40))
    disk.set()
    recorder.close()
    assert not recorder.error
    assert recorder.lost > lost
    found = messages_of(recorder.path)
    assert len(found) == recorder.count == 800 - recorder.lost
    # What is kept is whole, and sequence numbers tell where the rest is not.
    assert [(time, k) for topic, time, k, _ in found if topic == "/kept"] == [
        (1000 * k, k) for k in range(400)
    ]
    assert all(time == 1000 * k for _, time, k, _ in found)
    reader = LogReader(tmp_path / "log")
    reader.read_summary()
    assert sum(gap.messages for gap in reader.gaps) == recorder.lost
    missing = {1000 * k for k in range(400)} - {t for topic, t, *_ in found if topic == "/a"}
    told = {t for t in range(0, 400_000, 1000) for g in reader.gaps if g.first <= t <= g.last}
    assert told == missing
    assert lost_text(reader.gaps) in log_info(reader).text()
    with recorder.path.open("rb") as f:
        summary = make_reader(f).get_summary()
    assert summary is not None
    spans = [(c.message_start_time, c.message_end_time) for c in summary.chunk_indexes]
    assert all(a[1] < b[0] for a, b in pairwise(spans))


def test_a_recorder_that_waits_for_the_disk_loses_nothing_and_reports_the_wait(
    tmp_path: Path, disk: threading.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"{QUEUE}.WAITING_BYTES", 3000)
    recorder = Recorder(tmp_path / "log", TOPICS)
    recorder.must_wait = True
    disk.clear()
    threading.Timer(0.05, disk.set).start()
    write_all(recorder, range(40))
    recorder.close()
    assert recorder.lost == 0
    assert recorder.waited > 0.0
    assert recorder.count == len(messages_of(recorder.path)) == 800
    assert LogReader(tmp_path / "log").gaps == []


@pytest.mark.parametrize("must_wait", [True, False])
def test_an_error_of_the_writing_thread_ends_recording_and_nothing_waits_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, must_wait: bool
) -> None:
    monkeypatch.setattr(f"{QUEUE}.WAITING_BYTES", 1000)
    recorder = Recorder(tmp_path / "log", TOPICS)
    recorder.must_wait = must_wait
    write_all(recorder, range(1))
    recorder.sync()

    def fail(self: LogFile, data: memoryview) -> int:
        raise MemoryError("no memory")

    monkeypatch.setattr(LogFile, "_write", fail)
    write_all(recorder, range(1, 50))
    recorder.sync()
    assert "stopped after 20 messages: MemoryError: no memory" in recorder.error
    recorder.close()
    assert not recorder._queue._thread._thread.is_alive()
    # The undisturbed start can be read.
    assert sum(1 for _ in LogReader(tmp_path / "log").messages()) == 20


def ended_by(end: Callable[[Recorder], object], folder: Path) -> bool:
    """Whether the thread of a recorder to `folder` has ended after `end`."""
    recorder = Recorder(folder, TOPICS)
    thread = recorder._queue._thread._thread
    end(recorder)
    del recorder
    gc.collect()
    thread.join(TIMEOUT)
    return not thread.is_alive()


def test_the_writing_thread_ends_however_recording_ends(tmp_path: Path) -> None:
    for number, end in enumerate((Recorder.close, Recorder.discard, lambda recorder: None)):
        assert ended_by(end, tmp_path / str(number)), end


def test_a_forked_process_adds_nothing_to_the_log(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "log", TOPICS)
    write_all(recorder, range(2))
    recorder.write("/a", 10**6, CDR + bytes(8))
    child = os.fork()
    if child == 0:
        write_all(recorder, range(2, 4))
        recorder.sync()
        recorder.close()
        recorder.discard()
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    recorder.close()
    assert not recorder.error
    assert len(messages_of(recorder.path)) == 41


def test_an_item_larger_than_the_queue_is_queued_alone() -> None:
    written: list[int] = []
    thread = WritingThread(written.append, 10)
    for k in range(3):
        assert thread.hand_over(k, 100, wait=True)
    thread.sync()
    thread.end()
    assert written == [0, 1, 2]
    assert thread.hand_over(4, 1, wait=True)
    assert written == [0, 1, 2]


# The disk takes nothing until there is no room for what comes next.
SLOW_NODE = """
import sys, threading
from rlv_ros_bridge.logs.recording import chunk_queue
from rlv_ros_bridge.logs.recording.log_file import LogFile
from rlv_ros_bridge.logs.recording.writing_thread import WritingThread

full, write, has_room = threading.Event(), LogFile._write, WritingThread._has_room

def slow(self, data):
    if threading.current_thread().name == "log":
        assert full.wait(60.0)
    return write(self, data)

def looked_for(self, size):
    found = has_room(self, size)
    if not found:
        full.set()
    return found

LogFile._write, WritingThread._has_room = slow, looked_for
chunk_queue.WAITING_BYTES = 300_000
from rlv_ros_bridge.commands.group import main
main(sys.argv[1:])
"""


def slow_node(*arguments: object) -> subprocess.CompletedProcess[str]:
    """A node whose log's disk is too slow for a while."""
    return subprocess.run(
        [sys.executable, "-c", SLOW_NODE, "node", *map(str, arguments)],
        env=environment(FASTDDS_BUILTIN_TRANSPORTS="UDPv4"),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )


def test_a_node_tells_what_its_log_lacks_and_verify_compares_the_rest(
    fmu: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "log"
    done = slow_node("--fmu", fmu, "--record", folder, "--stop-time", 1)
    assert done.returncode == 1, done.stderr
    assert "finished: 1001 samples" in done.stdout
    found = re.search(r"^warning: (\d+) messages are missing from the log", done.stderr, re.M)
    assert found is not None, done.stderr
    assert sum("is slower than the landing" in line for line in done.stderr.splitlines()) == 1
    reader = LogReader(folder)
    reader.read_through()
    assert not reader.cut
    assert sum(gap.messages for gap in reader.gaps) == int(found[1])
    verified = run("log", "verify", folder)
    assert verified.returncode == 0, verified.stdout + verified.stderr
    assert "same      bit for bit" in verified.stdout
    lost = sum(gap.samples for gap in reader.gaps)
    assert f"missing   {lost} of these instants" in verified.stdout


@pytest.mark.parametrize("pace", [("--log-must-be-complete",), ("--realtime-factor", 0)])
def test_a_node_that_must_or_can_wait_has_a_whole_log(
    fmu: Path, tmp_path: Path, pace: tuple[object, ...]
) -> None:
    folder = tmp_path / "log"
    arguments = ("--fmu", fmu, "--record", folder, "--stop-time", 0.8, *pace)
    done = slow_node(*arguments)
    assert done.returncode == 0, done.stderr
    assert re.search(r"warning: the landing waited \d+\.\d\d s for the disk", done.stderr)
    reader = LogReader(folder)
    assert sum(1 for _ in reader.messages(["/landing/struts"])) == 801
    assert reader.gaps == []
