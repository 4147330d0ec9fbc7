"""The records of MCAP, read from bytes that may be cut or damaged.

Only whole records are returned. A damaged length never makes more memory be used than the file's
size.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
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
# A chunk's fields: first and last time, uncompressed size, CRC, length of the compression's name.
CHUNK_FIELDS = struct.Struct("<QQQII")
# The start of a chunk, up to the length of its records.
CHUNK_HEAD_BYTES = RECORD_HEAD.size + CHUNK_FIELDS.size + 8


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
