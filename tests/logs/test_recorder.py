"""The recorder: rosbag2's layout, no overwriting, nothing half-written, a full disk."""

from __future__ import annotations

import resource
import shutil
import struct
import subprocess
import sys
import zipfile
from contextlib import suppress
from pathlib import Path

import pytest
import yaml
from bridge_tools import TIMEOUT, Listener, command, environment, new_domain, start
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from rosbags.rosbag2 import Reader
from zstandard import ZstdError

from rlv_landing.errors import LandingError
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.recording.bag_writer import CHUNK_BYTES
from rlv_ros_bridge.messages.qos import CLOCK, TELEMETRY, parse_qos

CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
TOPICS = [RecordedTopic("/a", CLOCK_TYPE, TELEMETRY), RecordedTopic("/b", CLOCK_TYPE, CLOCK)]
CDR = bytes([0, 1, 0, 0]) + bytes(8)


def test_layout_is_that_of_rosbag2(tmp_path: Path) -> None:
    folder = tmp_path / "log"
    recorder = Recorder(folder, TOPICS, {"key": "value"}, {"note.txt": b"hello"})
    for k in range(10):
        recorder.write("/a", 1000 * k, CDR)
    recorder.write("/b", 500, CDR)
    recorder.close()
    assert sorted(p.name for p in folder.iterdir()) == ["log_0.mcap", "metadata.yaml"]
    with (folder / "log_0.mcap").open("rb") as f:
        reader = make_reader(f)
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
        assert summary is not None
        assert {s.encoding for s in summary.schemas.values()} == {"ros2msg"}
        channels = {c.topic: c for c in summary.channels.values()}
        assert channels["/a"].message_encoding == "cdr"
        assert parse_qos(channels["/b"].metadata["offered_qos_profiles"]) == CLOCK
        assert channels["/a"].metadata["topic_type_hash"].startswith("RIHS01_")
        names = [m.name for m in reader.iter_metadata()]
        assert names.count("rlv_landing") == 1
        # as rosbag2's recorder has it, at the start and at the end
        early, serialized = (
            m.metadata["serialized_metadata"] for m in reader.iter_metadata() if m.name == "rosbag2"
        )
    beside = yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert yaml.safe_load(serialized) == beside
    assert yaml.safe_load(early)["message_count"] == 0
    assert beside["version"] == 9
    assert beside["duration"]["nanoseconds"] == 9000
    with Reader(folder) as bag:
        assert {c.topic: c.msgcount for c in bag.connections} == {"/a": 10, "/b": 1}
        assert bag.connections[0].ext.offered_qos_profiles[0].depth == TELEMETRY.depth


def test_no_chunk_is_larger_than_the_limit(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "log", TOPICS)
    for k in range(30_000):
        recorder.write("/a", k, CDR)
    recorder.close()
    with recorder.path.open("rb") as f:
        summary = make_reader(f).get_summary()
    assert summary is not None
    assert max(c.uncompressed_size for c in summary.chunk_indexes) <= CHUNK_BYTES
    assert len(summary.chunk_indexes) > 1


def test_what_is_flushed_can_be_read_before_the_file_is_closed(
    tmp_path: Path,
) -> None:
    recorder = Recorder(tmp_path / "log", TOPICS, {"key": "value"})
    recorder.write("/a", 1, CDR)
    recorder.sync()
    reader = LogReader(tmp_path / "log")
    assert [m.data for m in reader.messages()] == [CDR]
    assert reader.cut
    assert reader.metadata == {"key": "value"}
    recorder.discard()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_exists_is_never_touched(tmp_path: Path) -> None:
    for target in (tmp_path / "folder", tmp_path / "file"):
        target.mkdir() if target.name == "folder" else target.write_text("mine")
        with pytest.raises(LandingError, match="exists; logs are never overwritten"):
            Recorder(target, TOPICS)
    assert list((tmp_path / "folder").iterdir()) == []
    assert (tmp_path / "file").read_text() == "mine"


def test_failing_to_open_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(LandingError, match="cannot be made"):
        Recorder(tmp_path / "file" / "below" / "log", TOPICS)
    with pytest.raises(LandingError, match="is not installed"):
        Recorder(
            tmp_path / "new" / "log", [RecordedTopic("/a", "nosuch_msgs/msg/Thing", TELEMETRY)]
        )
    with pytest.raises(LandingError, match="cannot be"):
        Recorder(tmp_path / "new" / ("x" * 254), TOPICS)
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_a_full_disk_does_not_stop_the_landing_and_what_was_written_is_readable(
    fmu: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "log"
    # A file size limit makes write() fail in mid-record, as a full disk does; the files that the
    # FMU unpacks stay below it.
    with zipfile.ZipFile(fmu) as archive:
        limit = max(info.file_size for info in archive.infolist()) + 100_000
    line = command(
        "node", "--fmu", fmu, "--record", folder, "--realtime-factor", 0, "--stop-time", 10
    )
    done = subprocess.run(
        line,
        env=environment(FASTDDS_BUILTIN_TRANSPORTS="UDPv4"),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )
    assert done.returncode == 1, done.stderr
    assert "finished: 10001 samples" in done.stdout
    lines = [line for line in done.stderr.splitlines() if "stopped after" in line]
    assert len(lines) == 2, done.stderr
    assert "the landing continues without recording" in lines[0]
    assert lines[1].startswith("error: recording to")
    assert "File too large" in lines[1]
    (file,) = folder.iterdir()
    reader = LogReader(folder)
    count = sum(1 for _ in reader.messages())
    assert reader.cut
    assert reader.metadata["mode"] == "2-2"
    # All but the chunk that did not fit.
    reported = int(lines[1].split("stopped after ")[1].split()[0])
    # The chunk at whose indexes the disk was full is there all the same.
    assert reported <= count <= reported + CHUNK_BYTES // 200
    seen = 0
    # The file ends in a record; the stream reader's error depends on where.
    with file.open("rb") as f, suppress(EndOfFile, struct.error, ZstdError):
        for record in StreamReader(f).records:
            seen += type(record).__name__ == "Message"
    assert seen == count


@pytest.mark.parametrize("how", ["removed", "moved"])
def test_a_removed_folder_is_noticed_at_the_next_flush_and_at_the_end(
    tmp_path: Path, how: str
) -> None:
    for flushed in (True, False):
        folder, away = tmp_path / f"log-{flushed}", tmp_path / f"away-{flushed}"
        recorder = Recorder(folder, TOPICS)
        recorder.write("/a", 1, CDR)
        recorder.sync()
        assert not recorder.error
        shutil.rmtree(folder) if how == "removed" else folder.rename(away)
        recorder.write("/a", 2, CDR)
        if flushed:
            recorder.sync()
            assert recorder.error.endswith(
                "stopped after 2 messages: the file was removed or moved away"
            )
        recorder.write("/a", 3, CDR)
        recorder.close()
        assert "removed or moved away" in recorder.error
        assert not folder.exists()
        if how == "moved":
            assert [m.log_time for m in LogReader(away).messages()][:2] == [1, 2]


def test_the_landing_continues_when_its_log_is_removed_and_reports_it_at_once_and_at_the_end(
    fmu: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "log"
    domain = new_domain()
    listener = Listener(
        {"/landing/struts": "sensor_msgs/msg/JointState"}, tmp_path, domain, announce=300
    )
    node = start(
        "node",
        "--fmu",
        fmu,
        "--record",
        folder,
        "--stop-time",
        2,
        "--wait-for-subscribers",
        1,
        domain=domain,
    )
    try:
        listener.wait_for_announcement()
        shutil.rmtree(folder)
        out, err = node.communicate(timeout=TIMEOUT)
    finally:
        listener.stop()
        node.kill()
        node.communicate(timeout=TIMEOUT)
    assert node.returncode == 1, err
    assert "finished: 2001 samples" in out
    lines = [line for line in err.splitlines() if "removed or moved away" in line]
    assert len(lines) == 2, err
    assert "the landing continues without recording" in lines[0]
    assert lines[1].startswith("error: recording to")
    assert not folder.exists()


def test_a_file_has_its_temporary_name_until_it_is_finished(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "log", TOPICS)
    recorder.write("/a", 1, CDR)
    assert [p.name for p in (tmp_path / "log").iterdir()] == ["log_0.mcap.part"]
    recorder.close()
    assert sorted(p.name for p in (tmp_path / "log").iterdir()) == ["log_0.mcap", "metadata.yaml"]
    assert not recorder.error


def test_info_on_such_a_log_needs_no_ros(one_log: Path) -> None:
    code = (
        "import sys; from rlv_ros_bridge.commands.group import main\n"
        "main(['log', 'info', sys.argv[1]], standalone_mode=False)\n"
        "print('rclpy' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(one_log)],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )
    assert done.stdout.strip().endswith("False"), done.stderr
