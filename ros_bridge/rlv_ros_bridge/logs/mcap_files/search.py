"""The search for the next whole chunk in a damaged file, in a time that grows with its size."""

from __future__ import annotations

import re
import struct
from typing import IO

from .chunks import Allowance, open_chunk
from .records import CHUNK_FIELDS, CHUNK_HEAD_BYTES, RECORD_HEAD, DamageError, read_record

# The start of a chunk: opcode, length below 4 GiB, two times, uncompressed size, CRC, name of the
# compression.
CHUNK_START = re.compile(rb"\x06(?=.{4}\0{4}.{28}(?:\0{4}|\x04\0{3}zstd|\x03\0{3}lz4))", re.DOTALL)
SEARCH_WINDOW = 1024 * 1024
# What looks like a chunk and is none may take so many times the bytes that are searched. It is rare
# but where somebody has made it.
MOST_EFFORT = 16
LEAST_EFFORT = 64 * 1024


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
    allowance = Allowance(size)
    effort = LEAST_EFFORT + MOST_EFFORT * max(0, size - position)
    while position < size:
        file.seek(position)
        window = file.read(min(SEARCH_WINDOW, size - position) + CHUNK_HEAD_BYTES)
        for match in CHUNK_START.finditer(window, 0, SEARCH_WINDOW):
            at = position + match.start()
            body = _body_at(file, at, size, window, match.start(), with_checksum=with_checksum)
            if body == 0:
                continue
            effort -= body
            if effort < 0:
                return None
            try:
                _, record = read_record(file, at, size)
                open_chunk(record, allowance, checksum_required=checksum_required)
            except DamageError:
                continue
            return at
        position += SEARCH_WINDOW
    return None


def _body_at(
    file: IO[bytes], at: int, size: int, window: bytes, start: int, *, with_checksum: bool
) -> int:
    """Bytes of what may be a chunk at `at`; 0 where its lengths contradict each other."""
    if len(window) < start + RECORD_HEAD.size + CHUNK_FIELDS.size:
        return 0
    (length,) = struct.unpack_from("<Q", window, start + 1)
    *_, checksum, named = CHUNK_FIELDS.unpack_from(window, start + RECORD_HEAD.size)
    if at + RECORD_HEAD.size + length > size or (with_checksum and checksum == 0):
        return 0
    file.seek(at + RECORD_HEAD.size + CHUNK_FIELDS.size + named)
    (inner,) = struct.unpack("<Q", file.read(8).ljust(8, b"\xff"))
    return length if length == CHUNK_FIELDS.size + named + 8 + inner else 0
