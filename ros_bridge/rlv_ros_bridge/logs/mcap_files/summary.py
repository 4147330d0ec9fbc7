"""The summary at the end of a finished MCAP file, and its chunks, found by their index."""

from __future__ import annotations

import struct
import zlib
from collections import deque
from collections.abc import Generator, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice, pairwise
from pathlib import Path
from typing import IO, Any

from .chunks import Allowance, OpenChunk, open_chunk
from .records import (
    ATTACHMENT,
    ATTACHMENT_INDEX,
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    FOOTER,
    HEADER,
    MAGIC,
    METADATA,
    METADATA_INDEX,
    RECORD_HEAD,
    SCHEMA,
    STATISTICS,
    DamageError,
    checksum_differs,
    decode_record,
    read_record,
    record_places,
)
from .stream import FOOTER_BYTES_IN_CRC, LIBRARY

# The footer's fields: start of the summary, start of its offsets, checksum.
FOOTER_FIELDS = struct.Struct("<QQI")
DATA_END_BYTES = RECORD_HEAD.size + 4
# A chunk index up to its map: first and last time, position, length, bytes of the map. Behind the
# map come the length of the message indexes and more.
CHUNK_INDEX_FIELDS = struct.Struct("<QQQQI")
INDEX_OFFSET = struct.Struct("<HQ")
# Chunks that are read ahead of the one in use.
AHEAD = 2


@dataclass(frozen=True)
class ChunkPlace:
    """A chunk by the file's index.

    `position` and `length` are those of its record [bytes], `first` and `last` the times of its
    messages [ns]. `channels` are the numbers of its messages' channels; empty: not known.
    """

    position: int
    length: int
    first: int
    last: int
    channels: frozenset[int]


@dataclass
class Summary:
    """What is known of a file without reading its messages.

    `definitions` are its schemas and channels, `others` its metadata and attachments, in the file's
    order. `statistics` is MCAP's record. `ours`: it is a log of this program, all of whose parts
    have checksums.
    """

    file: Path
    ours: bool
    statistics: Any
    definitions: list[Any] = field(default_factory=list)
    others: list[Any] = field(default_factory=list)
    chunk_indexes: list[bytes] = field(default_factory=list)

    @cached_property
    def topics(self) -> dict[int, str]:
        """The topics by the numbers of their channels, of each number the first."""
        from mcap.records import Channel

        found: dict[int, str] = {}
        for record in self.definitions:
            if isinstance(record, Channel):
                found.setdefault(record.id, record.topic)
        return found

    @cached_property
    def chunks(self) -> list[ChunkPlace]:
        """The file's chunks, in its order."""
        return sorted(map(_chunk_place, self.chunk_indexes), key=lambda c: c.position)


def read_summary(path: Path) -> Summary | None:
    """The summary of the file at `path`; None where it has none that is whole and right.

    A file that is cut, whose bytes were moved, or whose writer gave no checksum has none. Whether a
    byte of its messages was changed, only reading them shows.
    """
    with path.open("rb") as file:
        size = file.seek(0, 2)
        try:
            return _read(file, path, size)
        except (DamageError, struct.error):
            return None


def _read(file: IO[bytes], path: Path, size: int) -> Summary | None:
    from mcap.records import Channel

    opcode, body = read_record(file, len(MAGIC), size)
    if opcode != HEADER:
        return None
    ours = decode_record(opcode, body).library.startswith(LIBRARY)
    footer = size - len(MAGIC) - RECORD_HEAD.size - FOOTER_FIELDS.size
    if footer < len(MAGIC):
        return None
    opcode, body = read_record(file, footer, size)
    if opcode != FOOTER or len(body) != FOOTER_FIELDS.size or file.read() != MAGIC:
        return None
    start, _, checksum = FOOTER_FIELDS.unpack(body)
    if not len(MAGIC) + DATA_END_BYTES <= start < footer:
        return None
    file.seek(start)
    covered = file.read(footer - start + RECORD_HEAD.size + FOOTER_BYTES_IN_CRC)
    if zlib.crc32(covered) != checksum:
        return None
    # Where bytes were inserted or lost, the data do not end where the footer says.
    opcode, body = read_record(file, start - DATA_END_BYTES, size)
    if opcode != DATA_END or file.tell() != start:
        return None
    found = Summary(path, ours, None)
    others: list[int] = []
    for opcode, begin, end in record_places(covered[: footer - start]):
        body = covered[begin:end]
        if opcode in (SCHEMA, CHANNEL):
            found.definitions.append(decode_record(opcode, body))
        elif opcode == STATISTICS:
            found.statistics = decode_record(opcode, body)
        elif opcode == CHUNK_INDEX:
            found.chunk_indexes.append(body)
        elif opcode in (METADATA_INDEX, ATTACHMENT_INDEX):
            others.append(int.from_bytes(body[:8], "little"))
    statistics = found.statistics
    if statistics is None or (statistics.message_count and not found.chunk_indexes):
        return None
    if len(others) != statistics.metadata_count + statistics.attachment_count:
        return None
    # A channel is read beside its schema.
    found.definitions.sort(key=lambda record: isinstance(record, Channel))
    found.others = _others(file, others, size, ours=ours)
    return found if _lie_apart(found.chunks) else None


def _lie_apart(places: Sequence[ChunkPlace]) -> bool:
    """Whether no chunk is in the index twice, or within another."""
    return all(a.position + a.length <= b.position for a, b in pairwise(places))


def _others(file: IO[bytes], positions: Iterable[int], size: int, *, ours: bool) -> list[Any]:
    """The metadata and attachments at `positions`.

    Raises:
        DamageError: one is none, overlaps another, or its bytes were changed.
    """
    found, end = [], 0
    for position in sorted(positions):
        if position < end:
            raise DamageError("two of its metadata overlap")
        found.append(_other(file, position, size, ours=ours))
        end = file.tell()
    return found


def _chunk_place(body: bytes) -> ChunkPlace:
    first, last, position, length, mapped = CHUNK_INDEX_FIELDS.unpack_from(body)
    offsets = body[CHUNK_INDEX_FIELDS.size : CHUNK_INDEX_FIELDS.size + mapped]
    channels = frozenset(channel for channel, _ in INDEX_OFFSET.iter_unpack(offsets))
    return ChunkPlace(position, length, first, last, channels)


def _other(file: IO[bytes], position: int, size: int, *, ours: bool) -> Any:
    """The metadata or the attachment at `position`.

    Raises:
        DamageError: there is none, or its bytes were changed.
    """
    opcode, body = read_record(file, position, size)
    if opcode not in (METADATA, ATTACHMENT):
        raise DamageError("its index names no metadata")
    stored = int.from_bytes(body[-4:], "little")
    if opcode == ATTACHMENT and checksum_differs(stored, zlib.crc32(body[:-4]), required=ours):
        raise DamageError("an attachment's checksum is wrong")
    return decode_record(opcode, body)


def open_chunks(
    summary: Summary, places: Iterable[ChunkPlace]
) -> Generator[tuple[ChunkPlace, OpenChunk | None], None, None]:
    """The chunks at `places`, opened; None for one that is damaged.

    A thread opens them ahead of their use, so that who plays them in time does not wait for the
    disk and for zstd. `places` is asked for no more than these.
    """
    with summary.file.open("rb") as file, ThreadPoolExecutor(1) as reader:
        size = file.seek(0, 2)
        allowance = Allowance(size)

        def read(place: ChunkPlace) -> OpenChunk | None:
            try:
                opcode, body = read_record(file, place.position, size)
                if opcode != CHUNK:
                    return None
                return open_chunk(body, allowance, checksum_required=summary.ours)
            except DamageError:
                return None

        pending: deque[tuple[ChunkPlace, Future[OpenChunk | None]]] = deque()
        following = iter(places)
        try:
            while True:
                for place in islice(following, AHEAD + 1 - len(pending)):
                    pending.append((place, reader.submit(read, place)))
                if not pending:
                    return
                place, opened = pending.popleft()
                yield place, opened.result()
        finally:
            for _, future in pending:
                future.cancel()
