"""`log recover` saves all that is whole of a cut or damaged log, and nothing else."""

from __future__ import annotations

import json
import os
import resource
import shutil
import subprocess
import sys
import zlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import zstandard
from bridge_tools import HERE, TIMEOUT, command, environment, one_error_line, run
from log_tools import CDR, messages_of, rewrite, small_log, write_with_chunk
from mcap.reader import make_reader
from mcap.records import Chunk, Message
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, IndexType, Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader

from rlv_landing.errors import LandingError
from rlv_ros_bridge.logs.mcap_files.chunks import LARGEST_CHUNK
from rlv_ros_bridge.logs.mcap_files.stream import RecordStream
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recover import recover

Found = list[tuple[str, int, int, bytes]]


class Whole:
    """The chunks of a complete file by its own index: where they end, and their messages."""

    def __init__(self, file: Path) -> None:
        self.messages = messages_of(file)
        with file.open("rb") as f:
            summary = make_reader(f).get_summary()
        assert summary is not None
        self.chunks = summary.chunk_indexes
        self.ends = [
            (c.chunk_start_offset + c.chunk_length, c.message_end_time) for c in self.chunks
        ]
        assert self.ends == sorted(self.ends)

    def within(self, length: int) -> Found:
        """The messages of the chunks that lie in the first `length` bytes."""
        lasts = [time for end, time in self.ends if end <= length]
        return [m for m in self.messages if lasts and m[1] <= lasts[-1]]


def cut_to(file: Path, folder: Path, length: int) -> Path:
    """The first `length` bytes of `file`, as an unfinished log in `folder`."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    cut = folder / f"{folder.name}_0.mcap.part"
    cut.write_bytes(file.read_bytes()[:length])
    return folder


def test_of_a_file_cut_at_any_byte_exactly_the_whole_chunks_are_read(tmp_path: Path) -> None:
    file = small_log(tmp_path / "log", chunks=3, messages=6)
    whole, size, seen = Whole(file), file.stat().st_size, set()
    for length in range(size, 7, -1):
        os.truncate(file, length)
        stream = RecordStream(file)
        got = [
            (m.channel_id, m.log_time, m.sequence, m.data) for m in stream if isinstance(m, Message)
        ]
        wanted = [(1 if topic == "/a" else 2, *rest) for topic, *rest in whole.within(length)]
        assert got == wanted, length
        assert stream.finished == (length == size)
        assert not stream.damage
        seen.add(len(got))
    assert seen == {0, 6, 12, 18}


def test_recover_saves_exactly_the_whole_chunks_into_a_log_that_every_reader_opens(
    tmp_path: Path,
) -> None:
    file = small_log(tmp_path / "log")
    size, whole = file.stat().st_size, Whole(file)
    refused = 0
    # A step that is prime to the records' lengths cuts at every kind of place.
    for length in range(8, size, 97):
        folder = cut_to(file, tmp_path / "cut", length)
        out = tmp_path / "cut-recovered"
        shutil.rmtree(out, ignore_errors=True)
        wanted = whole.within(length)
        if not wanted:
            with pytest.raises(
                LandingError, match=r"cut within its first record|holds no whole chunk"
            ):
                recover(folder)
            assert not out.exists()
            refused += 1
            continue
        found = recover(folder)
        assert (found.folder, found.messages, found.finished) == (str(out), len(wanted), False)
        assert found.lost_bytes < length
        assert messages_of(out / "cut-recovered_0.mcap") == wanted
        check_with_every_reader(out, wanted)
    assert 0 < refused < size // 97


def check_with_every_reader(folder: Path, wanted: Found) -> None:
    (file,) = folder.glob("*.mcap")
    stamps = [time for _, time, _, _ in wanted]
    with file.open("rb") as f:
        decoded = list(make_reader(f, decoder_factories=[DecoderFactory()]).iter_decoded_messages())
        assert [d.message.log_time for d in decoded] == stamps
    with file.open("rb") as f:
        streamed = [
            r for r in StreamReader(f, validate_crcs=True).records if isinstance(r, Message)
        ]
        assert [m.data for m in streamed] == [data for *_, data in wanted]
    with Reader(folder) as bag:
        assert [(c.topic, time, bytes(data)) for c, time, data in bag.messages()] == [
            (t, time, data) for t, time, _, data in wanted
        ]
        assert bag.message_count == len(wanted)
    ours = LogReader(folder)
    assert [m.data for m in ours.messages()] == [data for *_, data in wanted]
    assert not ours.cut
    assert ours.attachments == {"parameters.toml": b"# none\n"}
    assert ours.metadata["stop_time"] == "1.0"


def test_the_command_says_what_was_saved_and_what_is_missing_and_never_overwrites(
    one_log: Path, tmp_path: Path
) -> None:
    (whole,) = one_log.glob("*.mcap")
    folder = cut_to(whole, tmp_path / "run", whole.stat().st_size // 2)
    done = run("log", "recover", folder)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"all that is whole: {tmp_path / 'run-recovered'}" in done.stdout
    assert "bytes that make no whole chunk" in done.stdout
    assert "at most to the stop time of 1 s" in done.stdout
    info = run("log", "info", tmp_path / "run-recovered")
    assert (info.returncode, info.stderr) == (0, "")
    assert "recovered  from run" in info.stdout
    again = run("log", "recover", folder)
    assert "logs are never overwritten" in one_error_line(again)
    other = run("log", "recover", folder, "--output", tmp_path / "other", "--json")
    report = json.loads(other.stdout)
    assert report["messages"] == sum(1 for _ in LogReader(folder).messages())
    assert (tmp_path / "other" / "metadata.yaml").is_file()


def test_a_complete_log_is_left_as_it_is(one_log: Path) -> None:
    done = run("log", "recover", one_log)
    assert (done.returncode, done.stderr) == (0, "")
    assert "nothing to recover" in done.stdout
    assert not one_log.with_name(one_log.name + "-recovered").exists()


def test_a_full_disk_stops_recovery_and_leaves_nothing(one_log: Path, tmp_path: Path) -> None:
    (whole,) = one_log.glob("*.mcap")
    folder = cut_to(whole, tmp_path / "run", whole.stat().st_size * 9 // 10)
    limit = 100_000
    done = subprocess.run(
        command("log", "recover", folder),
        env=environment(),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )
    assert done.returncode == 2
    assert "cannot be written: File too large" in one_error_line(done)
    assert [p.name for p in tmp_path.iterdir()] == ["run"]


def test_whole_messages_of_an_unfinished_uncompressed_chunk_are_saved(tmp_path: Path) -> None:
    for chunked in (True, False):
        file = tmp_path / f"plain-{chunked}.mcap"
        with file.open("wb") as f:
            writer = Writer(
                f, compression=CompressionType.NONE, index_types=IndexType.ALL, use_chunking=chunked
            )
            writer.start("ros2")
            channel = writer.register_channel(
                "/a", "cdr", writer.register_schema("std_msgs/msg/Empty", "ros2msg", b"")
            )
            for k in range(20):
                writer.add_message(channel, k, CDR + bytes([k]) * 40, k, k)
            writer.finish()
        data = file.read_bytes()
        middle = data.index(CDR + bytes([7]) * 40) + 20
        file.write_bytes(data[:middle])
        found = recover(file, tmp_path / f"out-{chunked}")
        assert found.messages == 7
        assert [
            m[1] for m in messages_of(tmp_path / f"out-{chunked}" / f"out-{chunked}_0.mcap")
        ] == list(range(7))


def test_damage_in_the_middle_costs_only_its_chunk(tmp_path: Path) -> None:
    file = small_log(tmp_path / "log")
    whole, data = Whole(file), file.read_bytes()
    for hit, chunk in enumerate(whole.chunks):
        # Within the compressed bytes, in the length, and by a byte too many: the last two hide
        # where the next record begins.
        for name, changed in (
            ("flip", flipped(data, chunk.chunk_start_offset + chunk.chunk_length - 5)),
            ("length", flipped(data, chunk.chunk_start_offset + 2)),
            (
                "insert",
                data[: chunk.chunk_start_offset + 60]
                + b"x"
                + data[chunk.chunk_start_offset + 60 :],
            ),
        ):
            folder = tmp_path / f"{name}-{hit}"
            folder.mkdir()
            (folder / "log_0.mcap").write_bytes(changed)
            assert recover(folder).damage
            out = tmp_path / f"{name}-{hit}-recovered"
            assert messages_of(out / f"{out.name}_0.mcap") == [
                m for i, m in enumerate(whole.messages) if i // 12 != hit
            ]


def flipped(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1 :]


@pytest.mark.torture
def test_mutated_logs_break_neither_info_nor_recover_and_give_no_wrong_message(
    one_log: Path, tmp_path: Path, many: Callable[[int], int]
) -> None:
    (file,) = one_log.glob("*.mcap")
    short = rewrite(
        file,
        tmp_path / "short",
        lambda r: None if isinstance(r, tuple) and r[1].log_time > 20_000_000 else r,
    )
    worker = HERE / "mutations.py"
    count = many(300)
    line = [sys.executable, str(worker), str(short), str(count), "1", str(tmp_path)]
    done = subprocess.run(
        line, env=environment(OMP_NUM_THREADS="1"), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["cases"] == count
    # There were mutations after which something can be saved, and others.
    assert count // 2 < report["recovered"] < count


@pytest.mark.parametrize("what", ["metadata", "attachment", "end", "summary"])
def test_a_changed_byte_outside_the_chunks_is_noticed(tmp_path: Path, what: str) -> None:
    file = small_log(tmp_path / "log")
    data = file.read_bytes()
    at = {
        "metadata": data.index(b"stop_time") + 14,
        "attachment": data.index(b"# none"),
        "end": -30,
        "summary": data.rindex(b"/a"),
    }[what]
    file.write_bytes(flipped(data, at if at >= 0 else len(data) + at))
    reader = LogReader(file)
    reader.read_through()
    assert reader.cut
    # Once damage has cost the end, as a flip in the footer's head does, the file is cut.
    assert reader.damage or what == "end"


def test_a_chunk_that_claims_gigabytes_does_not_fill_the_memory(tmp_path: Path) -> None:
    bomb = zstandard.compress(bytes(4 * LARGEST_CHUNK))
    chunk = Chunk("zstd", bomb, 1, 0, 0, 4 * LARGEST_CHUNK)
    small = replace(chunk, uncompressed_size=1000)
    for name, record in (("honest", chunk), ("lying", small)):
        write_with_chunk(tmp_path / f"{name}.mcap", record)
    # VmHWM is this process's own; getrusage would also hold its parent's.
    code = (
        "import re, sys; from pathlib import Path\n"
        "from rlv_ros_bridge.logs.mcap_files.stream import RecordStream\n"
        "for name in sys.argv[1:]:\n"
        "    stream = RecordStream(Path(name)); assert len(list(stream)) == 1\n"
        "    assert len(stream.damage) == 1, stream.damage\n"
        "print(re.search('VmHWM:\\\\s+(\\\\d+) kB', Path('/proc/self/status').read_text())[1])"
    )
    files = [str(tmp_path / "honest.mcap"), str(tmp_path / "lying.mcap")]
    done = subprocess.run(
        [sys.executable, "-c", code, *files],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=True,
    )
    assert int(done.stdout) * 1024 < LARGEST_CHUNK


def test_a_chunk_whose_checksum_is_right_is_read(tmp_path: Path) -> None:
    data = b"\x05" + (22 + 4).to_bytes(8, "little") + bytes(22) + b"abcd"
    write_with_chunk(
        tmp_path / "file.mcap",
        Chunk("zstd", zstandard.compress(data), 0, 0, zlib.crc32(data), len(data)),
    )
    stream = RecordStream(tmp_path / "file.mcap")
    assert [m.data for m in stream if isinstance(m, Message)] == [b"abcd"]
    assert stream.finished
    assert not stream.damage
