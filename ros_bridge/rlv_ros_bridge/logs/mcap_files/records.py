"""The records of MCAP, read from bytes that may be cut or damaged.

Only whole records are returned, checked where a checksum is given. A damaged length never makes
more memory be used than the file's size or `LARGEST_CHUNK`.
"""

from __future__ import annotations

import io
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import IO, Any

MAGIC = b"\x89MCAP0\r\n"
# Before a record's body: opcode, length of the body.
RECORD_HEAD = struct.Struct("<BQ")
# A message's fields before its data: channel, sequence number, log time, publish time.
MESSAGE_FIELDS = struct.Struct("<HIQQ")
MESSAGE_HEAD_BYTES = MESSAGE_FIELDS.size
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE = 1, 2, 3, 4, 5
CHUNK, CHUNK_INDEX, ATTACHMENT, ATTACHMENT_INDEX, STATISTICS = 6, 8, 9, 10, 11
METADATA, METADATA_INDEX, DATA_END = 12, 13, 15
# A chunk that claims to be larger than this, uncompressed, is damaged.
LARGEST_CHUNK = 256 * 1024 * 1024
# The start of a chunk: opcode, length below 4 GiB, two times, uncompressed size, CRC, name of the
# compression.
CHUNK_START = re.compile(rb"\x06(?=.{4}\0{4}.{28}(?:\0{4}|\x04\0{3}zstd|\x03\0{3}lz4))", re.DOTALL)
# A chunk's fields: first and last time, uncompressed size, CRC, length of the compression's name.
CHUNK_FIELDS = struct.Struct("<QQQII")
# The start of a chunk, up to the length of its records.
CHUNK_HEAD_BYTES = RECORD_HEAD.size + CHUNK_FIELDS.size + 8
SEARCH_WINDOW = 1024 * 1024


class DamageError(Exception):
    """A record that is cut or damaged."""


class ExactReader(io.BytesIO):
    """Bytes whose `read` never returns fewer than asked for.

    MCAP's own decoders would go on with fewer.
    """

    def read(self, size: int | None = -1, /) -> bytes:
        """Reads `size` bytes.

        Raises:
            DamageError: there are fewer, or `size` is below 0.
        """
        data = super().read(size) if size is not None and size >= 0 else b""
        if size is None or len(data) != size:
            raise DamageError("a length in it is wrong")
        return data


def read_record(file: IO[bytes], position: int, size: int) -> tuple[int, bytes]:
    """Opcode and body of the record at `position` of a file of `size` bytes.

    Raises:
        DamageError: no record fits there.
    """
    file.seek(position)
    head = file.read(RECORD_HEAD.size)
    if len(head) < RECORD_HEAD.size:
        raise DamageError("the file ends")
    opcode, length = RECORD_HEAD.unpack(head)
    if opcode == 0 or position + RECORD_HEAD.size + length > size:
        raise DamageError("no record can be read there")
    body = file.read(length)
    if len(body) < length:
        raise DamageError("the file ends")
    return opcode, body


def checksum_differs(stored: int, computed: int, *, required: bool) -> bool:
    """Whether a stored checksum shows damage.

    In MCAP a stored 0 means that there is none. If the file's writer gives all checksums, it is
    `required`: a right checksum is 0 for one chunk in 2**32 only.
    """
    return stored != computed and (stored != 0 or required)


def decode_record(opcode: int, body: bytes) -> Any:
    """The record in `body`, as a class of `mcap.records`.

    Raises:
        DamageError: it cannot be decoded, or does not fill `body`.
    """
    from mcap.data_stream import RecordBuilder
    from mcap.stream_reader import StreamReader

    builder = RecordBuilder()
    data = ExactReader(RECORD_HEAD.pack(opcode, len(body)) + body)
    try:
        record = next(StreamReader(data, skip_magic=True, emit_chunks=True).records)
        record.write(builder)
    except Exception as e:
        # MCAP's decoders raise exceptions of any type for damaged bytes.
        raise DamageError(f"a record (kind {opcode}) cannot be read") from e
    if builder.count != RECORD_HEAD.size + len(body):
        raise DamageError(f"the length of a record (kind {opcode}) is wrong")
    return record


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


def open_chunk(chunk: Any, *, checksum_required: bool) -> OpenChunk:
    """Opens a chunk (`mcap.records.Chunk`).

    Raises:
        DamageError: anything in it is wrong.
    """
    import zstandard
    from mcap.stream_reader import get_chunk_data_stream

    try:
        promised = (
            zstandard.frame_content_size(chunk.data)
            if chunk.compression == "zstd"
            else chunk.uncompressed_size
        )
        size = chunk.uncompressed_size
        if not 0 <= size <= LARGEST_CHUNK or promised not in (-1, size):
            raise DamageError("a chunk's size is wrong")
        stream, length = get_chunk_data_stream(chunk)
        data = stream.read(length)
        if checksum_differs(chunk.uncompressed_crc, zlib.crc32(data), required=checksum_required):
            raise DamageError("a chunk's checksum is wrong")
        definitions, whole, count = [], 0, 0
        for opcode, start, end in record_places(data):
            whole = end
            count += opcode == MESSAGE
            if opcode in (SCHEMA, CHANNEL):
                definitions.append(decode_record(opcode, data[start:end]))
        if whole != len(data) or len(data) != size:
            raise DamageError("a chunk's sizes contradict each other")
        return OpenChunk(data, definitions, count)
    except Exception as e:
        raise DamageError("a chunk's bytes were changed") from e


def record_places(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Opcode, start and end of the body of each whole record in a chunk's uncompressed bytes."""
    position, size = 0, len(data)
    while position + RECORD_HEAD.size <= size:
        opcode, length = RECORD_HEAD.unpack_from(data, position)
        start = position + RECORD_HEAD.size
        position = start + length
        too_short = opcode == MESSAGE and length < MESSAGE_HEAD_BYTES
        if opcode == 0 or position > size or too_short:
            return
        yield opcode, start, position


def split_records(data: bytes) -> Iterator[bytes]:
    """The whole records, heads included, in the uncompressed bytes of a chunk, from its start."""
    for _, start, end in record_places(data):
        yield data[start - RECORD_HEAD.size : end]


def records_of_cut_chunk(file: IO[bytes], position: int, size: int) -> list[Any]:
    """The whole records of an uncompressed chunk at `position` whose end is missing.

    The list is empty where there is no such chunk. `size` is that of the file.
    """
    file.seek(position)
    head = file.read(CHUNK_HEAD_BYTES)
    compression_length = head[RECORD_HEAD.size + CHUNK_FIELDS.size - 4 :][:4]
    if len(head) < CHUNK_HEAD_BYTES or head[0] != CHUNK or compression_length != bytes(4):
        return []
    found: list[Any] = []
    for record in split_records(file.read(size - file.tell())):
        if record[0] not in (SCHEMA, CHANNEL, MESSAGE):
            continue
        try:
            found.append(decode_record(record[0], record[RECORD_HEAD.size :]))
        except DamageError:
            break
    return found


def find_chunk(
    file: IO[bytes],
    position: int,
    size: int,
    *,
    checksum_required: bool,
    with_checksum: bool = False,
) -> int | None:
    """Position of the next whole chunk without damage, from `position` on; None: there is none.

    Args:
        file: the file.
        position: where to begin.
        size: where to end.
        checksum_required: as in `checksum_differs`.
        with_checksum: only a chunk whose stored checksum is not 0.
    """
    while position < size:
        file.seek(position)
        window = file.read(SEARCH_WINDOW + CHUNK_HEAD_BYTES)
        for match in CHUNK_START.finditer(window):
            at = position + match.start()
            (length,) = struct.unpack_from("<Q", window, match.start() + 1)
            *_, checksum, named = CHUNK_FIELDS.unpack_from(window, match.start() + RECORD_HEAD.size)
            file.seek(at + RECORD_HEAD.size + CHUNK_FIELDS.size + named)
            (inner,) = struct.unpack("<Q", file.read(8).ljust(8, b"\xff"))
            if (
                (with_checksum and checksum == 0)
                or length != CHUNK_FIELDS.size + named + 8 + inner
                or at + RECORD_HEAD.size + length > size
            ):
                continue
            try:
                chunk = decode_record(*read_record(file, at, size))
                open_chunk(chunk, checksum_required=checksum_required)
            except DamageError:
                continue
            return at
        position += SEARCH_WINDOW
    return None
