"""Hostile logs: small files that would take much memory or time, and the commands run on them.

As a program it runs commands of the bridge in one process, one after the other, and prints for each
its exit code and processor time, and at the end the most memory that the process has had.
"""

from __future__ import annotations

import json
import os
import struct
import sys
import time
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import lz4.frame
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Message,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)
from mcap.writer import Writer

from rlv_ros_bridge.messages.columns import READINGS
from rlv_ros_bridge.messages.definitions import definition
from rlv_ros_bridge.messages.topics import RECORDED

MAGIC = b"\x89MCAP0\r\n"
MEGABYTE = 1024 * 1024
# Some are larger where time is no matter.
SCALE = 10 if "RLV_TORTURE" in os.environ else 1
# Commands a terminal: colours, its title, a line above, and text that runs backwards.
TERMINAL = "\x1b[31m\x1b]0;owned\x07\x1b[1A\u202e\r\n"


def bytes_of(*records: McapRecord) -> bytes:
    """Records as a file has them."""
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return builder.end()


def file_of(path: Path, *records: McapRecord | bytes) -> Path:
    """A file of records, or bytes of them, with a header and an end."""
    parts = (r if isinstance(r, bytes) else bytes_of(r) for r in records)
    end = bytes_of(DataEnd(0), Footer(0, 0, 0))
    path.write_bytes(MAGIC + bytes_of(Header("ros2", "")) + b"".join(parts) + end + MAGIC)
    return path


def message(size: int, time: int = 0) -> bytes:
    """A message of `size` bytes of zeros."""
    return bytes_of(Message(1, time, bytes(size), time, 0))


CLOCK = bytes_of(
    Schema(1, b"", "ros2msg", "rosgraph_msgs/msg/Clock"), Channel(1, "/clock", "cdr", {}, 1)
)


def zstd(data: bytes, size: int | None = None) -> Chunk:
    """A chunk of `data`, which says that they are `size` bytes."""
    packed = zstandard.ZstdCompressor(write_content_size=size is None).compress(data)
    return Chunk("zstd", packed, 1, 0, 0, len(data) if size is None else size)


def zstd_of_gigabytes(path: Path) -> Path:
    """A chunk that unpacks to hundreds of megabytes, as it states."""
    return file_of(path, CLOCK, zstd(message(260 * MEGABYTE)))


def zstd_that_lies(path: Path) -> Path:
    """A chunk of zstd that unpacks to more than its stated size of 1000 bytes."""
    return file_of(path, CLOCK, zstd(message(260 * MEGABYTE), 1000))


def lz4_that_lies(path: Path) -> Path:
    """A chunk of lz4 that unpacks to more than its stated size of 100 bytes."""
    packed = lz4.frame.compress(bytes(200 * MEGABYTE), store_size=False)
    return file_of(path, CLOCK, Chunk("lz4", packed, 0, 0, 0, 100))


def many_large_chunks(path: Path) -> Path:
    """Each of them is right, and may be that large."""
    return file_of(path, CLOCK, bytes_of(zstd(message(20 * MEGABYTE))) * (15 * SCALE))


def tiny_messages(path: Path) -> Path:
    """More messages than such a file can hold."""
    return file_of(path, CLOCK, zstd(message(0) * 1_000_000))


def most_messages(path: Path) -> Path:
    """As many messages as such a file can just hold."""
    count = 60_000
    chunk = zstd(b"".join(message(0, 1_000_000 * k) for k in range(count)))
    padding = bytes_of(Metadata("other", {"text": "x" * count}))
    return file_of(path, CLOCK, chunk, padding)


def definitions(path: Path) -> Path:
    """More channels than such a file can hold."""
    return file_of(path, CLOCK, zstd(bytes_of(Channel(1, "/clock", "cdr", {}, 1)) * 800_000))


def false_chunk_heads(path: Path) -> Path:
    """Each claims the rest of the file, whose checksum would have to be computed."""
    head, count = 60, 16_000
    size = head * count
    parts = []
    for i in range(count):
        inner = size - i * head - 49
        parts.append(struct.pack("<BQQQQIIQ", 6, 40 + inner, 0, 0, inner, 1, 0, inner).ljust(head))
    path.write_bytes(MAGIC + bytes_of(Header("ros2", "")) + b"\x03\xff" + b"".join(parts))
    return path


def damaged_records(path: Path) -> Path:
    """Each of them is a defect."""
    return file_of(path, CLOCK, struct.pack("<BQB", 4, 1, 0) * (5000 * SCALE))


def with_summary(path: Path, data: bytes, summary: Sequence[McapRecord], count: int = 0) -> Path:
    """A file whose summary is right by its checksum."""
    start = MAGIC + bytes_of(Header("ros2", "")) + data + bytes_of(DataEnd(0))
    told = Statistics(
        attachment_count=0,
        channel_count=1,
        channel_message_counts={1: count},
        chunk_count=sum(isinstance(r, ChunkIndex) for r in summary),
        message_count=count,
        message_end_time=0,
        message_start_time=0,
        metadata_count=sum(isinstance(r, MetadataIndex) for r in summary),
        schema_count=1,
    )
    covered = CLOCK + bytes_of(told, *summary)
    footer = bytes_of(Footer(len(start), 0, 0))
    checksum = zlib.crc32(covered + footer[:-4])
    path.write_bytes(start + covered + bytes_of(Footer(len(start), 0, checksum)) + MAGIC)
    return path


def one_metadata_many_times(path: Path) -> Path:
    """Its index names one record of 200 KB again and again."""
    record = bytes_of(Metadata("other", {"text": "x" * 200_000}))
    at = len(MAGIC) + len(bytes_of(Header("ros2", "")))
    return with_summary(
        path, record, [MetadataIndex(length=len(record), name="other", offset=at)] * 10_000
    )


def one_chunk_many_times(path: Path) -> Path:
    """Its index names one chunk again and again."""
    chunk = bytes_of(zstd(CLOCK + message(8) * 5000))
    at = len(MAGIC) + len(bytes_of(Header("ros2", "")))
    index = ChunkIndex(
        chunk_length=len(chunk),
        chunk_start_offset=at,
        compression="zstd",
        compressed_size=1,
        message_end_time=0,
        message_index_length=0,
        message_index_offsets={1: 0},
        message_start_time=0,
        uncompressed_size=1,
    )
    return with_summary(path, chunk, [index] * 5000, 25_000_000)


def landing_log(path: Path, **changes: Any) -> Path:
    """A log of the landing's topics with one message each, and what is false in it.

    `definition` replaces that of each topic, `data` each message, `qos` each profile, `name` each
    name's end. `metadata` are records by name, `toml` the parameters.
    """
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "")
        for name, texts in changes.get("metadata", {}).items():
            writer.add_metadata(name, texts)
        if "toml" in changes:
            writer.add_attachment(0, 0, "parameters.toml", "text", changes["toml"])
        for topic in RECORDED:
            if topic.name not in READINGS:
                continue
            text = changes.get("definition", definition(topic.type_name).text)
            schema = writer.register_schema(topic.type_name, "ros2msg", text.encode())
            qos = {"offered_qos_profiles": changes.get("qos", "")}
            name = f"/landing/{topic.name}{changes.get('name', '')}"
            channel = writer.register_channel(name, "cdr", schema, qos)
            writer.add_message(channel, 0, changes.get("data", b"\0\1\0\0"), 0)
        writer.finish()
    return path


def yaml_aliases(path: Path) -> Path:
    """Each line of its profiles is nine times the one before."""
    lines = ["- &a0 {depth: 1}"]
    lines += [f"- &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 12)]
    return landing_log(path, qos="\n".join(lines))


def deep_yaml(path: Path) -> Path:
    """Its profiles are nested deeper than Python's stack."""
    return landing_log(path, qos="[" * 20_000 + "]" * 20_000)


def deep_json(path: Path) -> Path:
    """Its records are nested deeper than Python's stack."""
    deep = "[" * 50_000 + "]" * 50_000
    names = {"rlv_landing_peaks": "until", "rlv_landing_summary": "landing"}
    return landing_log(path, metadata={record: {name: deep} for record, name in names.items()})


def deep_toml(path: Path) -> Path:
    """Its parameters are nested deeper than Python's stack, and long."""
    return landing_log(path, toml=b"a = " + b"[" * 100_000 + b"]" * 100_000)


def long_toml(path: Path) -> Path:
    """Its parameters take minutes to parse."""
    return landing_log(path, toml=b"[drop]\n" + b"tilt = 1\n" * 100_000)


def false_definition(path: Path) -> Path:
    """Its messages hold nothing, again and again."""
    rule = "=" * 80
    text = f"Nothing[] many\n{rule}\nMSG: sensor_msgs/Nothing\n"
    data = b"\0\1\0\0" + struct.pack("<I", 250_000) + bytes(250_000)
    metadata = {"rlv_landing": {"step_size": "0.001", "stop_time": "1", "mode": "2-2"}}
    toml = b'preset = "yue2022-figures"\n'
    return landing_log(path, definition=text, data=data, metadata=metadata, toml=toml)


def terminal_texts(path: Path) -> Path:
    """Every text in it holds control sequences for a terminal."""
    metadata = {"rlv_landing": {"mode": TERMINAL, "preset": TERMINAL, f"version_{TERMINAL}": "1"}}
    return landing_log(path, name=TERMINAL, metadata=metadata)


BOMBS: tuple[Callable[[Path], Path], ...] = (
    zstd_of_gigabytes,
    zstd_that_lies,
    lz4_that_lies,
    many_large_chunks,
    tiny_messages,
    most_messages,
    definitions,
    false_chunk_heads,
    damaged_records,
    one_metadata_many_times,
    one_chunk_many_times,
    yaml_aliases,
    deep_yaml,
    deep_json,
    deep_toml,
    long_toml,
    false_definition,
    terminal_texts,
)


def commands(log: Path, out: Path) -> list[list[str]]:
    """Every command that reads a log, with what it writes in the folder `out`."""
    vehicle = ["--preset", "yue2022-figures"]
    return [
        ["log", "info", str(log)],
        ["log", "info", "--check", str(log)],
        ["log", "recover", str(log), "--output", str(out / "recovered")],
        ["log", "verify", str(log)],
        ["log", "export", str(log), str(out / "rows.csv"), "--topics", "struts"],
        ["log", "export", str(log), "--plot", str(out / "plot.png")],
        ["animate", str(log), str(out / "film.gif"), *vehicle],
        ["view", str(log), "--save", str(out / "film.rrd"), *vehicle],
        ["replay", str(log), "--duration", "0.001", "--rate", "100"],
    ]


def most_memory() -> int:
    """The most memory that this process has had, not its parent's [bytes].

    What libraries have mapped of their files is left out: how much of that is in memory, 40 MB more
    or less, is the page cache's choice, and no log fills it.
    """
    lines = Path("/proc/self/status").read_text().splitlines()
    found = {name: 1024 * int(kib.split()[0]) for name, kib in _sizes(lines)}
    return found["VmHWM"] - found["RssFile"]


def _sizes(lines: list[str]) -> list[tuple[str, str]]:
    """Name and size of each line of a process's status that has a size."""
    parts = (line.partition(":") for line in lines)
    return [(name, size) for name, _, size in parts if size.endswith(" kB")]


def main(lines: list[list[str]]) -> None:
    """Run commands, and print their exit codes, processor times and memory."""
    from rlv_landing.cli.group import run
    from rlv_ros_bridge.commands.group import main as group

    for line in lines:
        sys.argv = ["rlv-landing", *line]
        start = time.process_time()
        try:
            code: Any = run(group, "rlv-landing")
        except SystemExit as e:
            code = e.code
        sys.stdout.flush()
        print(json.dumps([line[:2], code, time.process_time() - start]), flush=True)
    print(json.dumps(["memory", 0, most_memory()]), flush=True)


if __name__ == "__main__":
    main(json.load(sys.stdin))
