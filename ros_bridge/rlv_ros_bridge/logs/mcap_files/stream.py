"""The records of an MCAP file that may be cut or damaged, in the file's order."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable, Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import IO, Any

from .chunks import Allowance, open_chunk, records_of_cut_chunk
from .records import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    DATA_END,
    FOOTER,
    HEADER,
    MAGIC,
    MESSAGE,
    METADATA,
    RECORD_HEAD,
    SCHEMA,
    STATISTICS,
    DamageError,
    checksum_differs,
    decode_record,
    read_record,
)
from .search import find_chunk

# The library name in the header of our logs. They hold all checksums, and all messages in
# compressed chunks.
LIBRARY = "rlv-landing"
# Defects of a file that are listed one by one.
MOST_TOLD = 100
# Bytes of the footer, head included, that the summary's checksum covers.
FOOTER_BYTES_IN_CRC = 16
DECODED = frozenset(
    (HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, ATTACHMENT, STATISTICS, METADATA, DATA_END)
)


class RecordStream:
    """Iterates over the records of an MCAP file, as classes of `mcap.records`.

    Chunks are opened; indexes are left out. A damaged record is left out, and reading continues
    with the next record or the next chunk that is found.

    After the last record `finished` says whether the file has its proper end. `damage` holds a
    sentence for each other defect. `lost_bytes` counts the bytes that could not be read.
    `summary_is_valid` says whether the summary's checksum is right.

    Args:
        path: the file.
        summary: also give the schemas, channels and metadata that the summary repeats.
        wanted: whether messages of a channel's number are given; None: all are. What is not wanted
            is checked and counted all the same.
    """

    def __init__(
        self, path: Path, *, summary: bool = False, wanted: Callable[[int], bool] | None = None
    ) -> None:
        self.path = path
        self.finished = False
        self.damage: list[str] = []
        self._defects = 0
        self.lost_bytes = 0
        self.summary_is_valid = False
        self._with_summary, self._wanted = summary, wanted
        self._in_summary, self._summary_start = False, 0
        # Checksum of the file so far, and without the last record.
        self._crc = self._crc_before = 0
        self._messages = 0
        self._ours = False
        self._checksums_required: bool | None = None
        self._allowance = Allowance(0)

    def __iter__(self) -> Iterator[Any]:
        with self.path.open("rb") as file:
            size = os.fstat(file.fileno()).st_size
            self._allowance = Allowance(size)
            self._crc = zlib.crc32(file.read(len(MAGIC)))
            position = len(MAGIC)
            while True:
                following: int | None = None
                opcode = 0
                records: Iterable[Any] = ()
                try:
                    opcode, body = read_record(file, position, size)
                    self._add_to_crc(opcode, body)
                    following = position + RECORD_HEAD.size + len(body)
                    if opcode in DECODED:
                        records = self._records(opcode, body, file, position, size)
                except DamageError as e:
                    following = self._resume_position(file, position, size, following)
                    if following is None:
                        # Nothing behind can be read: the file is cut.
                        if not self._ours:
                            rest = records_of_cut_chunk(file, position, size)
                            yield from filter(self._is_wanted, rest)
                        self.lost_bytes += size - position
                        return
                    self._note(f"byte {position}: {e}")
                    self.lost_bytes += following - position
                yield from records
                position = following
                if opcode == FOOTER:
                    self._check_end(file, position, size)
                    return

    def _note(self, damage: str) -> None:
        """Notes a defect; of very many only the first are listed one by one."""
        self._defects += 1
        if self._defects <= MOST_TOLD:
            self.damage.append(damage)
        else:
            self.damage[MOST_TOLD:] = [f"and {self._defects - MOST_TOLD} more such defects"]

    def _add_to_crc(self, opcode: int, body: bytes) -> None:
        head = RECORD_HEAD.pack(opcode, len(body))
        self._crc_before, self._crc = self._crc, zlib.crc32(body, zlib.crc32(head, self._crc))

    def _resume_position(
        self, file: IO[bytes], position: int, size: int, following: int | None
    ) -> int | None:
        """The position to continue at after a damaged record at `position`; None: there is none.

        The record's length may be what is damaged. So a whole chunk before `following`, the next
        record by that length, comes first.
        """
        chunk = find_chunk(
            file,
            position + 1,
            size if following is None else following,
            checksum_required=self._requires_checksums(file, size),
        )
        return chunk if chunk is not None else following

    def _records(
        self, opcode: int, body: bytes, file: IO[bytes], position: int, size: int
    ) -> Iterable[Any]:
        """The record at `position`, or the records in it if it is a chunk.

        Raises:
            DamageError: it is damaged.
        """
        required = opcode in (ATTACHMENT, MESSAGE, CHUNK) and self._requires_checksums(file, size)
        if opcode == ATTACHMENT:
            stored = int.from_bytes(body[-4:], "little")
            if checksum_differs(stored, zlib.crc32(body[:-4]), required=required):
                raise DamageError("an attachment's checksum is wrong")
        if opcode == MESSAGE and required:
            raise DamageError("a message lies outside the chunks, without a checksum")
        if opcode == CHUNK:
            chunk = open_chunk(body, self._allowance, checksum_required=required)
            self._messages += chunk.count
            return chain(chunk.definitions, chunk.messages(self._wanted))
        record = decode_record(opcode, body)
        if opcode == HEADER and record.library.startswith(LIBRARY):
            self._ours = self._checksums_required = True
        elif opcode == DATA_END:
            self._in_summary = True
            self._summary_start = position + RECORD_HEAD.size + len(body)
            differs = checksum_differs(
                record.data_section_crc, self._crc_before, required=self._ours
            )
            if differs and not self.damage:
                self.damage.append("its checksum is wrong: bytes were changed")
        elif opcode == FOOTER and (record.summary_crc or self._ours):
            self._check_summary(record, file, position)
        elif opcode == STATISTICS and record.message_count != self._messages and not self.damage:
            self.damage.append(f"{self._messages} of {record.message_count} messages are there")
        if opcode == MESSAGE:
            self._messages += 1
            if not self._is_wanted(record):
                return ()
        return [] if self._in_summary and not self._with_summary else [record]

    def _is_wanted(self, record: Any) -> bool:
        """Whether a record is given, by its channel where it is a message."""
        number = getattr(record, "channel_id", None)
        return self._wanted is None or number is None or self._wanted(number)

    def _check_summary(self, footer: Any, file: IO[bytes], position: int) -> None:
        # Bytes that were inserted or lost have moved the summary, so its start is the end of the
        # data, whatever the footer says.
        file.seek(self._summary_start)
        end = position + RECORD_HEAD.size + FOOTER_BYTES_IN_CRC
        crc = zlib.crc32(file.read(end - self._summary_start))
        self.summary_is_valid = crc == footer.summary_crc
        if not self.summary_is_valid:
            self.damage.append("its summary's checksum is wrong")

    def _requires_checksums(self, file: IO[bytes], size: int) -> bool:
        """Whether the file's writer gave checksums: it is ours, or a chunk has a right one."""
        if self._checksums_required is None:
            found = find_chunk(file, len(MAGIC), size, checksum_required=True, with_checksum=True)
            self._checksums_required = found is not None
        return self._checksums_required

    def _check_end(self, file: IO[bytes], position: int, size: int) -> None:
        file.seek(position)
        self.finished = file.read(len(MAGIC)) == MAGIC
        if self.finished and position + len(MAGIC) != size:
            self.damage.append(f"{size - position - len(MAGIC)} bytes follow its end")
