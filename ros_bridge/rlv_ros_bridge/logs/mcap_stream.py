"""The records of an MCAP file that may be cut or damaged: whole, checked ones only, and never more
memory than the file gives cause for.
"""

from __future__ import annotations

import io
import os
import re
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

MAGIC = b"\x89MCAP0\r\n"
# What the header of our logs calls their writer. It gives every checksum, and has all messages in
# compressed chunks.
LIBRARY = "rlv-landing"
HEAD = struct.Struct("<BQ")
FOOTER_CRC_FROM = 16
MESSAGE_HEAD = 22
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, ATTACHMENT, STATISTICS, METADATA, DATA_END = (
    1,
    2,
    3,
    4,
    5,
    6,
    9,
    11,
    12,
    15,
)
READ = frozenset(
    (HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, ATTACHMENT, STATISTICS, METADATA, DATA_END)
)
# A damaged size must not ask for the whole memory: no chunk is taken to hold more than this,
# uncompressed.
LARGEST_CHUNK = 256 * 1024 * 1024
# How a chunk begins: opcode, length below 4 GiB, two times, uncompressed size, CRC, name of the
# compression.
CHUNK_START = re.compile(rb"\x06(?=.{4}\0{4}.{28}(?:\0{4}|\x04\0{3}zstd|\x03\0{3}lz4))", re.DOTALL)
CHUNK_FIELDS = struct.Struct("<QQQII")
WINDOW = 1024 * 1024


class DamageError(Exception):
    """A record that is not what it should be."""


class WholeReads(io.BytesIO):
    """Bytes that are read whole or not at all: MCAP's own decoders would take fewer for what they
    asked for.
    """

    def read(self, size: int | None = -1, /) -> bytes:
        """`size` bytes. Raises DamageError where there are fewer, or `size` is below 0."""
        data = super().read(size) if size is not None and size >= 0 else b""
        if size is None or len(data) != size:
            raise DamageError("a length in it is wrong")
        return data


class RecordStream:
    """The records of the file `path` in its order, chunks opened; indexes are left out, and what
    the summary repeats unless `summary`.

    Once all have been taken, `finished` tells whether the file has its proper end, `damage` what is
    wrong with it besides (a sentence each), `summary_is_right` whether the summary's checksum
    vouches for it, and `lost` how many bytes could not be read. A damaged record is left out;
    reading goes on with the next record, or with the next chunk that is found behind.
    """

    def __init__(self, path: Path, summary: bool = False) -> None:
        self.path = path
        self.finished = False
        self.damage: list[str] = []
        self.lost = 0
        self.summary_is_right = False
        self._with_summary = summary
        self._in_summary, self._summary = False, 0
        self._crc = self._crc_before = 0
        self._messages = 0
        self._ours = False
        self._checked: bool | None = None

    def __iter__(self) -> Iterator[Any]:
        with self.path.open("rb") as file:
            size = os.fstat(file.fileno()).st_size
            self._crc = zlib.crc32(file.read(len(MAGIC)))
            position = len(MAGIC)
            while True:
                following: int | None = None
                opcode = 0
                try:
                    opcode, body = frame(file, position, size)
                    self._crc_before, self._crc = (
                        self._crc,
                        zlib.crc32(body, zlib.crc32(HEAD.pack(opcode, len(body)), self._crc)),
                    )
                    following = position + HEAD.size + len(body)
                    records = (
                        self._open(opcode, body, file, position, size) if opcode in READ else []
                    )
                except DamageError as e:
                    # The length may be what is damaged: a whole chunk before the next record, as
                    # told by it, counts for more.
                    found = search_chunk(
                        file,
                        position + 1,
                        size if following is None else following,
                        self._is_checked(file, size),
                    )
                    following = found if found is not None else following
                    if following is None:
                        # Nothing can be told from here on: the file is cut.
                        yield from self._count(
                            [] if self._ours else rest_of_chunk(file, position, size)
                        )
                        self.lost += size - position
                        return
                    self.damage.append(f"byte {position}: {e}")
                    self.lost += following - position
                    records = []
                yield from self._count(records)
                position = following
                if opcode == FOOTER:
                    self._end(file, position, size)
                    return

    def _open(
        self, opcode: int, body: bytes, file: IO[bytes], position: int, size: int
    ) -> list[Any]:
        """The records that a record comes to: itself, or what is in the chunk.

        Raises DamageError.
        """
        checked = opcode in (ATTACHMENT, MESSAGE, CHUNK) and self._is_checked(file, size)
        if opcode == ATTACHMENT and is_wrong(
            int.from_bytes(body[-4:], "little"), zlib.crc32(body[:-4]), checked
        ):
            raise DamageError("an attachment's checksum is wrong")
        if opcode == MESSAGE and checked:
            raise DamageError("a message lies outside the chunks, without a checksum")
        record = decode(opcode, body)
        if opcode == HEADER and record.library.startswith(LIBRARY):
            self._ours = self._checked = True
        elif opcode == DATA_END:
            self._in_summary = True
            self._summary = position + HEAD.size + len(body)
            if is_wrong(record.data_section_crc, self._crc_before, self._ours) and not self.damage:
                self.damage.append("its checksum is wrong: bytes were changed")
        elif opcode == FOOTER and (record.summary_crc or self._ours):
            # Bytes that were put in or lost before have moved the summary: it begins where the data
            # end, whatever the footer says.
            file.seek(self._summary)
            self.summary_is_right = (
                zlib.crc32(file.read(position + HEAD.size + FOOTER_CRC_FROM - self._summary))
                == record.summary_crc
            )
            if not self.summary_is_right:
                self.damage.append("its summary's checksum is wrong")
        elif opcode == STATISTICS and record.message_count != self._messages and not self.damage:
            self.damage.append(f"{self._messages} of {record.message_count} messages are there")
        if opcode == CHUNK:
            return open_chunk(record, checked)
        return [] if self._in_summary and not self._with_summary else [record]

    def _is_checked(self, file: IO[bytes], size: int) -> bool:
        """Whether the file's writer gave checksums: it is ours, or at least one chunk's checksum is
        there and right.
        """
        if self._checked is None:
            self._checked = search_chunk(file, len(MAGIC), size, checked=True, unless=0) is not None
        return self._checked

    def _count(self, records: list[Any]) -> Iterator[Any]:
        from mcap.records import Message

        for record in records:
            self._messages += isinstance(record, Message)
            yield record

    def _end(self, file: IO[bytes], position: int, size: int) -> None:
        file.seek(position)
        self.finished = file.read(len(MAGIC)) == MAGIC
        if self.finished and position + len(MAGIC) != size:
            self.damage.append(f"{size - position - len(MAGIC)} bytes follow its end")


def frame(file: IO[bytes], position: int, size: int) -> tuple[int, bytes]:
    """Opcode and body of the record at `position` of a file of `size` bytes.

    Raises DamageError where no record fits there.
    """
    file.seek(position)
    head = file.read(HEAD.size)
    if len(head) < HEAD.size:
        raise DamageError("the file ends")
    opcode, length = HEAD.unpack(head)
    if opcode == 0 or position + HEAD.size + length > size:
        raise DamageError("no record can be told there")
    body = file.read(length)
    if len(body) < length:
        raise DamageError("the file ends")
    return opcode, body


def is_wrong(checksum: int, found: int, checked: bool) -> bool:
    """Whether a stored `checksum` tells of damage.

    0 is none in MCAP; where all have been `checked`, it is that of one chunk in 2**32.
    """
    return checksum != found and (checksum != 0 or checked)


def decode(opcode: int, body: bytes) -> Any:
    """The record that `body` holds, as one of `mcap.records`.

    Raises DamageError, also where it does not fill `body`.
    """
    from mcap.data_stream import RecordBuilder
    from mcap.stream_reader import StreamReader

    builder = RecordBuilder()
    try:
        record = next(
            StreamReader(
                WholeReads(HEAD.pack(opcode, len(body)) + body), skip_magic=True, emit_chunks=True
            ).records
        )
        record.write(builder)
    except Exception as e:
        # Damaged bytes make the decoders raise whatever they like.
        raise DamageError(f"a record (kind {opcode}) cannot be read") from e
    if builder.count != HEAD.size + len(body):
        raise DamageError(f"the length of a record (kind {opcode}) is wrong")
    return record


def open_chunk(chunk: Any, checked: bool) -> list[Any]:
    """The schemas, channels and messages of a chunk; `checked` as in `is_wrong`.

    Raises DamageError: anything in it is wrong.
    """
    import zstandard
    from mcap.records import Chunk
    from mcap.stream_reader import breakup_chunk, get_chunk_data_stream

    try:
        promised = (
            zstandard.frame_content_size(chunk.data)
            if chunk.compression == "zstd"
            else chunk.uncompressed_size
        )
        if not 0 <= chunk.uncompressed_size <= LARGEST_CHUNK or promised not in (
            -1,
            chunk.uncompressed_size,
        ):
            raise DamageError("a chunk's size is wrong")
        stream, length = get_chunk_data_stream(chunk)
        data = stream.read(length)
        if is_wrong(chunk.uncompressed_crc, zlib.crc32(data), checked):
            raise DamageError("a chunk's checksum is wrong")
        whole = data[: sum(len(part) for part in frames(data))]
        if len(whole) != len(data) or len(data) != chunk.uncompressed_size:
            raise DamageError("a chunk's sizes contradict each other")
        return breakup_chunk(
            Chunk("", data, chunk.message_end_time, chunk.message_start_time, 0, len(data))
        )
    except Exception as e:
        raise DamageError("a chunk's bytes were changed") from e


def frames(data: bytes) -> Iterator[bytes]:
    """The whole records in the bytes of a chunk, as far as they can be told."""
    position = 0
    while position + HEAD.size <= len(data):
        opcode, length = HEAD.unpack_from(data, position)
        end = position + HEAD.size + length
        if opcode == 0 or end > len(data) or (opcode == MESSAGE and length < MESSAGE_HEAD):
            return
        yield data[position:end]
        position = end


def rest_of_chunk(file: IO[bytes], position: int, size: int) -> list[Any]:
    """The whole records of an uncompressed chunk at `position` whose end is not there; none where
    there is no such chunk.
    """
    file.seek(position)
    head = file.read(HEAD.size + CHUNK_FIELDS.size + 8)
    if (
        len(head) < HEAD.size + CHUNK_FIELDS.size + 8
        or head[0] != CHUNK
        or head[HEAD.size + CHUNK_FIELDS.size - 4 :][:4] != bytes(4)
    ):
        return []
    found: list[Any] = []
    for part in frames(file.read(size - file.tell())):
        try:
            found += (
                [decode(part[0], part[HEAD.size :])]
                if part[0] in (SCHEMA, CHANNEL, MESSAGE)
                else []
            )
        except DamageError:
            break
    return found


def search_chunk(
    file: IO[bytes], position: int, size: int, checked: bool, unless: int | None = None
) -> int | None:
    """Where the next whole, right chunk begins from `position` on, its checksum not `unless`; None
    where none lies before `size`.
    """
    while position < size:
        file.seek(position)
        window = file.read(WINDOW + HEAD.size + CHUNK_FIELDS.size + 8)
        for match in CHUNK_START.finditer(window):
            at = position + match.start()
            (length,) = struct.unpack_from("<Q", window, match.start() + 1)
            *_, checksum, named = CHUNK_FIELDS.unpack_from(window, match.start() + HEAD.size)
            file.seek(at + HEAD.size + CHUNK_FIELDS.size + named)
            (inner,) = struct.unpack("<Q", file.read(8).ljust(8, b"\xff"))
            if (
                checksum == unless
                or length != CHUNK_FIELDS.size + named + 8 + inner
                or at + HEAD.size + length > size
            ):
                continue
            try:
                opcode, body = frame(file, at, size)
                open_chunk(decode(opcode, body), checked)
            except DamageError:
                continue
            return at
        position += WINDOW
    return None
