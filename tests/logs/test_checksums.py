"""A checksum of 0, which in MCAP means that there is none.

It is damage in a log whose writer gives checksums, and accepted in another.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import pytest
import zstandard
from log_tools import CDR, messages_of, small_log, write_with_chunk
from mcap.reader import make_reader
from mcap.records import Chunk, ChunkIndex, Message
from mcap.writer import CompressionType, IndexType, Writer

from rlv_landing.errors import LandingError
from rlv_ros_bridge.logs.mcap_files.stream import RecordStream
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recover import recover

HEAD = 9
# Where a chunk's record has its checksum, and where its compressed bytes begin.
CHECKSUM, DATA = HEAD + 24, HEAD + 24 + 4 + 4 + len("zstd") + 8
PER_CHUNK = 12


def foreign_log(
    file: Path,
    *,
    checksums: bool,
    chunked: bool = True,
    compression: CompressionType = CompressionType.ZSTD,
) -> Path:
    """A log of three chunks that another program wrote, with checksums or without."""
    with file.open("wb") as f:
        writer = Writer(
            f,
            compression=compression,
            index_types=IndexType.ALL,
            use_chunking=chunked,
            enable_crcs=checksums,
        )
        writer.start("ros2")
        channel = writer.register_channel(
            "/a", "cdr", writer.register_schema("std_msgs/msg/Empty", "ros2msg", b"")
        )
        for k in range(3 * PER_CHUNK):
            writer.add_message(channel, k, CDR + k.to_bytes(8, "little"), k, k)
            if k % PER_CHUNK == PER_CHUNK - 1:
                writer.flush()
        writer.finish()
    return file


def chunks_of(file: Path) -> list[ChunkIndex]:
    with file.open("rb") as f:
        summary = make_reader(f).get_summary()
    assert summary is not None
    return summary.chunk_indexes


def without_checksum(data: bytes, chunk: ChunkIndex, flip: int | None) -> bytes:
    """`data` with the chunk's checksum set to 0.

    Also one bit at the byte `flip` of the chunk's record is changed; None: no other change.
    """
    changed = bytearray(data)
    at = chunk.chunk_start_offset
    changed[at + CHECKSUM : at + CHECKSUM + 4] = bytes(4)
    if flip is not None:
        changed[at + flip] ^= 1 << (flip % 8)
    return bytes(changed)


def recovered(file: Path, folder: Path) -> list[tuple[str, int, int, bytes]]:
    recover(file, folder)
    return messages_of(folder / f"{folder.name}_0.mcap")


def decompresses(data: bytes, chunk: ChunkIndex) -> bool:
    """Whether the damaged chunk still gives as many bytes as it should.

    Then only the checksum shows the damage.
    """
    start = chunk.chunk_start_offset
    try:
        return (
            len(zstandard.decompress(data[start + DATA : start + chunk.chunk_length]))
            == chunk.uncompressed_size
        )
    except zstandard.ZstdError:
        return False


@pytest.mark.parametrize("ours", [True, False])
def test_no_wrong_message_is_read_where_a_checksum_was_zeroed_and_a_bit_of_the_chunk_changed(
    tmp_path: Path, *, ours: bool
) -> None:
    file = (
        small_log(tmp_path / "log", chunks=3, messages=PER_CHUNK)
        if ours
        else foreign_log(tmp_path / "log.mcap", checksums=True)
    )
    data, wanted, changed_file = file.read_bytes(), messages_of(file), tmp_path / "changed.mcap"
    tried = 0
    for hit, chunk in enumerate(chunks_of(file)):
        assert data[chunk.chunk_start_offset + CHECKSUM :][:4] != bytes(4)
        # A checksum set to 0 alone may also cost the chunk, for nothing shows that it is right.
        places = [None, *range(DATA, chunk.chunk_length)]
        changed = [without_checksum(data, chunk, place) for place in places]
        plausible = [
            s for s, place in zip(changed, places) if place is None or decompresses(s, chunk)
        ]
        tried += len(plausible)
        for number, bytes_now in enumerate(plausible):
            changed_file.write_bytes(bytes_now)
            stream = RecordStream(changed_file)
            found = [m.sequence for m in stream if isinstance(m, Message)]
            assert found == [
                sequence for i, (*_, sequence, _) in enumerate(wanted) if i // PER_CHUNK != hit
            ]
            assert any("chunk" in text for text in stream.damage)
            if number in (0, len(plausible) // 2, len(plausible) - 1):
                kept = [m for i, m in enumerate(wanted) if i // PER_CHUNK != hit]
                assert recovered(changed_file, tmp_path / f"out-{hit}-{number}") == kept
    # zstd itself detects many flips; it did not detect these.
    assert tried > 50


def test_nothing_is_left_of_our_log_whose_only_chunk_lost_its_checksum(tmp_path: Path) -> None:
    file = small_log(tmp_path / "log", chunks=1)
    (chunk,) = chunks_of(file)
    file.write_bytes(without_checksum(file.read_bytes(), chunk, None))
    with pytest.raises(LandingError, match="holds no whole chunk"):
        recover(file)


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.NONE])
@pytest.mark.parametrize("chunked", [True, False])
def test_foreign_logs_without_checksums_are_read_and_recovered(
    tmp_path: Path, compression: CompressionType, *, chunked: bool
) -> None:
    file = foreign_log(
        tmp_path / "log.mcap", checksums=False, chunked=chunked, compression=compression
    )
    wanted = messages_of(file)
    reader = LogReader(file)
    assert [m.data for m in reader.messages()] == [data for *_, data in wanted]
    assert not reader.cut
    file.write_bytes(file.read_bytes()[:-50])
    assert recovered(file, tmp_path / "out") == wanted
    assert len(wanted) == 3 * PER_CHUNK


def test_in_a_foreign_log_without_checksums_damage_costs_only_its_chunk(
    tmp_path: Path,
) -> None:
    file = foreign_log(tmp_path / "log.mcap", checksums=False)
    wanted, data = messages_of(file), bytearray(file.read_bytes())
    # The missing checksum becomes a wrong one.
    data[chunks_of(file)[1].chunk_start_offset + CHECKSUM] = 1
    file.write_bytes(data)
    assert recovered(file, tmp_path / "out") == wanted[:PER_CHUNK] + wanted[2 * PER_CHUNK :]


def test_an_index_of_our_log_that_turned_into_a_message_is_not_read_as_one(tmp_path: Path) -> None:
    file = small_log(tmp_path / "log")
    wanted, data = messages_of(file), file.read_bytes()
    for number, chunk in enumerate(chunks_of(file)):
        for channel, at in chunk.message_index_offsets.items():
            changed = bytearray(data)
            # One bit makes a message index, opcode 7, a message, opcode 5.
            changed[at] ^= 2
            file.write_bytes(changed)
            assert recovered(file, tmp_path / f"out-{number}-{channel}") == wanted
    assert number == 3


@pytest.mark.parametrize("what", ["attachment", "data", "summary"])
def test_a_zeroed_checksum_outside_the_chunks_of_our_log_is_damage(
    tmp_path: Path, what: str
) -> None:
    file = small_log(tmp_path / "log")
    data = bytearray(file.read_bytes())
    end = len(data) - len(b"\x89MCAP0\r\n") - 4
    start = struct.unpack_from("<Q", data, end - 16)[0]
    at = {
        "attachment": data.index(b"# none\n") + len(b"# none\n"),
        "data": start - 4,
        "summary": end,
    }[what]
    assert data[at : at + 4] != bytes(4)
    data[at : at + 4] = bytes(4)
    file.write_bytes(data)
    reader = LogReader(file)
    reader.read_through()
    assert reader.damage
    assert bool(reader.attachments) == (what != "attachment")


def test_a_chunk_of_our_log_whose_checksum_is_really_0_is_read(tmp_path: Path) -> None:
    data = b"\x05" + (22 + 4).to_bytes(8, "little") + bytes(22)
    # The CRC of these four bytes by themselves is 0; so is that of `data` and these, with the CRC
    # of `data` added.
    data += (zlib.crc32(data) ^ int.from_bytes(b"\x9d\x0a\xd9\x6d", "little")).to_bytes(4, "little")
    assert zlib.crc32(data) == 0
    file = tmp_path / "file.mcap"
    write_with_chunk(
        file, Chunk("zstd", zstandard.compress(data), 0, 0, 0, len(data)), "rlv-landing"
    )
    assert [m.data for m in RecordStream(file) if isinstance(m, Message)] == [data[-4:]]
