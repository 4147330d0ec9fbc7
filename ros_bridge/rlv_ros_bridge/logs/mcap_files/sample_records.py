"""The records of a landing's samples, made of their numbers: those of a whole chunk at once.

A landing keeps the numbers of each sample only, as a row. What takes time is left to the thread
that writes.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from ...messages.wire import WORD, Places
from .records import MESSAGE_HEAD_BYTES

# Before a message's data: opcode, length, channel (MESSAGE_PREFIX), then sequence number, log time
# and publish time [ns] (TIMES).
MESSAGE_PREFIX = struct.Struct("<BQH")
TIMES = struct.Struct("<IQQ")
RECORD_SIZE = MESSAGE_PREFIX.size + TIMES.size
# What a row begins with: what TIMES packs, and the stamp. The sample's numbers follow.
ROW_HEAD = "<IQQiI"


def message_prefix(channel: int, size: int) -> bytes:
    """The record of a message of `size` bytes on `channel`, before its sequence number."""
    return MESSAGE_PREFIX.pack(Opcode.MESSAGE, MESSAGE_HEAD_BYTES + size, channel)


class SampleRecords:
    """Makes the records of samples: a message on each channel, one behind the other.

    Args:
        messages: each channel's message, and where the numbers are in it.
        count: how many numbers a sample has.

    `size` is that of a sample's records [bytes]. `offsets` are where each channel's record begins.
    `pack` gives a sample's row of its number, its time [ns] twice, its stamp in s and ns, and its
    numbers.
    """

    def __init__(self, messages: Mapping[int, Places], count: int) -> None:
        self.size = 0
        self.offsets: dict[int, int] = {}
        row_format = struct.Struct(f"{ROW_HEAD}{count}d")
        self.pack = row_format.pack
        head = struct.calcsize(ROW_HEAD)
        template = bytearray()
        # what is copied of a row: from, to, size [bytes]
        copied: list[tuple[int, int, int]] = []
        for channel, places in messages.items():
            self.offsets[channel] = len(template)
            template += message_prefix(channel, len(places.data))
            copied.append((0, len(template), TIMES.size))
            template += bytes(TIMES.size)
            stamps = [(at, TIMES.size) for at in places.stamps]
            numbers = [(at, head + WORD * i) for at, i in places.numbers]
            copied += [(row, len(template) + at, WORD) for at, row in sorted(stamps + numbers)]
            template += places.data
        self.size = len(template)
        self._template = np.frombuffer(bytes(template), np.uint8)
        joined = _joined(copied)
        self._from = _record_type([(row, size) for row, _, size in joined], row_format.size)
        self._to = _record_type([(at, size) for _, at, size in joined], self.size)
        self._read = np.dtype(
            {
                "names": ["sequence", "time", "numbers"],
                "formats": ["<u4", "<u8", f"({count},)<f8"],
                "offsets": [0, 4, head],
                "itemsize": row_format.size,
            }
        )

    def read(self, rows: bytes | bytearray) -> NDArray[Any]:
        """The rows as records with `sequence`, `time` [ns] and `numbers`."""
        return np.frombuffer(rows, self._read)

    def of(self, rows: bytes | bytearray) -> NDArray[np.uint8]:
        """The records of samples by their rows, one behind the other: (samples, size)."""
        found = np.frombuffer(rows, self._from)
        records = np.empty((len(found), self.size), np.uint8)
        records[:] = self._template
        # One call copies all parts of all rows. A call for each part would give Python's lock up
        # each time, and wait for it.
        records.view(self._to)[:, 0] = found
        return records


def _record_type(parts: Sequence[tuple[int, int]], size: int) -> np.dtype[Any]:
    """The type of records of `size` bytes with `parts`, given by offset and size [bytes]."""
    return np.dtype(
        {
            "names": [f"part_{i}" for i in range(len(parts))],
            "formats": [f"V{length}" for _, length in parts],
            "offsets": [at for at, _ in parts],
            "itemsize": size,
        }
    )


def _joined(copied: Sequence[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
    """Parts that are copied, those that follow each other as one."""
    found: list[tuple[int, int, int]] = []
    for start, to, size in copied:
        if found:
            start_before, to_before, size_before = found[-1]
            if (start_before + size_before, to_before + size_before) == (start, to):
                found[-1] = start_before, to_before, size_before + size
                continue
        found.append((start, to, size))
    return found
