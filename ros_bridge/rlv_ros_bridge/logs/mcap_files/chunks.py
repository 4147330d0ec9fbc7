"""Chunks: opened within what their bytes can justify, so that no file uses more than that.

A few bytes may claim, and decompress to, gigabytes. So a chunk is decompressed into the size that
it says and no further, and what a file's chunks hold together is counted against the file's size.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import IO, Any

from .records import (
    CHANNEL,
    CHUNK,
    CHUNK_FIELDS,
    CHUNK_HEAD_BYTES,
    MESSAGE,
    MESSAGE_FIELDS,
    MESSAGE_HEAD_BYTES,
    RECORD_HEAD,
    SCHEMA,
    DamageError,
    checksum_differs,
    decode_record,
    record_places,
    split_records,
)

# A chunk that claims to be larger than this, uncompressed, is damaged.
LARGEST_CHUNK = 256 * 1024 * 1024
# What a compressed chunk may hold: so many bytes, and so many for each of its own.
CHUNK_BYTES, CHUNK_RATIO = 32 * 1024 * 1024, 20
# What all chunks of a file may hold: bytes, and records, of which a definition counts as many, and
# so many for each byte of the file. Recordings of pictures without contents reach 300 to 1, those
# of a clock a message in 6 bytes.
FILE_BYTES, FILE_RATIO = 512 * 1024 * 1024, 500
FILE_RECORDS, RECORDS_PER_BYTE, RECORDS_PER_DEFINITION = 50_000, 1, 20
LENGTH = struct.Struct("<Q")
CHANGED = "a chunk's bytes were changed"


class Allowance:
    """What the chunks of a file of `size` bytes may hold together."""

    def __init__(self, size: int) -> None:
        self._bytes = FILE_BYTES + FILE_RATIO * size
        self._records = FILE_RECORDS + RECORDS_PER_BYTE * size

    def take(self, count: int = 0, records: int = 0) -> None:
        """Takes `count` bytes and `records` of it.

        Raises:
            DamageError: it is used up.
        """
        self._bytes -= count
        self._records -= records
        if self._bytes < 0 or self._records < 0:
            raise DamageError("its chunks claim more than a file of this size can hold")


@dataclass(frozen=True)
class OpenChunk:
    """The records in a chunk without damage.

    `data` are its uncompressed bytes, `definitions` its schemas and channels, `count` is the number
    of its messages.
    """

    data: bytes
    definitions: list[Any]
    count: int

    def messages(self, wanted: Callable[[int], bool] | None = None) -> Iterator[Any]:
        """The messages, or those of the channels that are `wanted`, asked once for each."""
        from mcap.records import Message

        data, position, known = self.data, 0, {}
        while position < len(data):
            opcode, length = RECORD_HEAD.unpack_from(data, position)
            start = position + RECORD_HEAD.size
            position = start + length
            if opcode != MESSAGE:
                continue
            channel, sequence, log_time, publish_time = MESSAGE_FIELDS.unpack_from(data, start)
            if wanted is not None:
                if channel not in known:
                    known[channel] = wanted(channel)
                if not known[channel]:
                    continue
            body = data[start + MESSAGE_HEAD_BYTES : position]
            yield Message(
                channel_id=channel,
                log_time=log_time,
                data=body,
                publish_time=publish_time,
                sequence=sequence,
            )


def open_chunk(body: bytes, allowance: Allowance, *, checksum_required: bool) -> OpenChunk:
    """Opens a chunk's record.

    Args:
        body: the record without its head.
        allowance: what the file's chunks may hold yet.
        checksum_required: as in `checksum_differs`.

    Raises:
        DamageError: anything in it is wrong, or it holds too much.
    """
    try:
        _, _, size, stored, named = CHUNK_FIELDS.unpack_from(body)
        compression = body[CHUNK_FIELDS.size : CHUNK_FIELDS.size + named].decode()
        (length,) = LENGTH.unpack_from(body, CHUNK_FIELDS.size + named)
        start = CHUNK_FIELDS.size + named + LENGTH.size
    except (struct.error, UnicodeDecodeError):
        raise DamageError(CHANGED) from None
    if start + length != len(body):
        raise DamageError(CHANGED)
    data = _uncompressed(compression, body[start:], size, allowance)
    if len(data) != size:
        raise DamageError(CHANGED)
    if checksum_differs(stored, zlib.crc32(data), required=checksum_required):
        raise DamageError(CHANGED)
    definitions, whole, count = [], 0, 0
    for opcode, start, end in record_places(data):
        whole = end
        count += opcode == MESSAGE
        is_definition = opcode in (SCHEMA, CHANNEL)
        allowance.take(records=RECORDS_PER_DEFINITION if is_definition else 1)
        if is_definition:
            try:
                definitions.append(decode_record(opcode, data[start:end]))
            except DamageError:
                raise DamageError(CHANGED) from None
    if whole != len(data):
        raise DamageError(CHANGED)
    return OpenChunk(data, definitions, count)


def _uncompressed(compression: str, data: bytes, size: int, allowance: Allowance) -> bytes:
    """A chunk's bytes, or none where they do not fill `size`.

    Raises:
        DamageError: it says more than its bytes can hold, or cannot be decompressed.
    """
    if not compression:
        allowance.take(len(data))
        return data
    if size > min(LARGEST_CHUNK, CHUNK_BYTES + CHUNK_RATIO * len(data)):
        raise DamageError(f"a chunk of {len(data)} bytes claims to hold {size}")
    allowance.take(size)
    try:
        if compression == "zstd":
            return _from_zstd(data, size)
        if compression == "lz4":
            return _from_lz4(data, size)
    except Exception as e:
        # Both libraries raise exceptions of their own for damaged bytes.
        raise DamageError(CHANGED) from e
    raise DamageError(f"a chunk's compression {compression[:20]!r} is not known")


def _from_zstd(data: bytes, size: int) -> bytes:
    import zstandard

    if zstandard.frame_content_size(data) not in (-1, size):
        return b""
    return bytes(zstandard.ZstdDecompressor().decompress(data, max_output_size=size))


def _from_lz4(data: bytes, size: int) -> bytes:
    from lz4.frame import LZ4FrameDecompressor

    reader = LZ4FrameDecompressor()
    # One byte more than it claims: so a chunk that claims too little is found.
    found = bytes(reader.decompress(data, max_length=size + 1))
    return found if reader.eof else b""


def records_of_cut_chunk(file: IO[bytes], position: int, size: int) -> Iterator[Any]:
    """The whole records of an uncompressed chunk at `position` whose end is missing.

    There are none where there is no such chunk. `size` is that of the file.
    """
    file.seek(position)
    head = file.read(CHUNK_HEAD_BYTES)
    compression_length = head[RECORD_HEAD.size + CHUNK_FIELDS.size - 4 :][:4]
    if len(head) < CHUNK_HEAD_BYTES or head[0] != CHUNK or compression_length != bytes(4):
        return
    for record in split_records(file.read(size - file.tell())):
        if record[0] not in (SCHEMA, CHANNEL, MESSAGE):
            continue
        try:
            yield decode_record(record[0], record[RECORD_HEAD.size :])
        except DamageError:
            return
