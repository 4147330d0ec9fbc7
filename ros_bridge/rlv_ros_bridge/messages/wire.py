"""Serialised messages straight from numbers: rclpy's bytes at a fraction of its cost.

The layout of the bytes is rclpy's own. `MessageLayout` learns each field's byte offset by
serialising sentinel values once: it is given messages that rclpy has serialised with a different
sentinel in each field, and looks for the sentinels. From then on all messages of an instant are
packed by one call of `struct`.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from operator import itemgetter
from typing import NamedTuple

from rlv_landing.errors import LandingError

NANOSECONDS = 1_000_000_000
# A stamp that no number of a message looks like.
SENTINEL_STAMP = 305_419_896 * NANOSECONDS + 591_751_049
# CDR: four bytes of encapsulation, which give the byte order, then the fields; a float64 begins at
# a multiple of eight from there.
ENCAPSULATION = 4
# A message's stamp: seconds, nanoseconds. What follows a prefix: sequence number, stamp twice [ns].
STAMP = struct.Struct("<iI")
TIMES = struct.Struct("<IQQ")


def padded(data: bytes) -> bytes:
    """`data` filled up to whole words of four bytes, as DDS delivers payloads to subscribers."""
    rest = len(data) % 4
    return data + bytes(4 - rest) if rest else data


def sentinel_numbers(count: int) -> list[float]:
    """`count` numbers in (1, 2), all different, that stand out among a message's bytes."""
    return [1.0 + (i * 0.6180339887498949 + 0.0123456789) % 1.0 for i in range(1, count + 1)]


class Slots(NamedTuple):
    """Positions in the list that `MessageLayout.pack` picks from, after the caller's numbers.

    `stamp` and `times` are the bytes that `STAMP` and `TIMES` pack; from `constants` on stand the
    constant bytes.
    """

    stamp: int
    times: int
    constants: int


class MessageLayout:
    """Byte offsets of numbers and stamp in the serialised messages of one instant.

    Args:
        serialised: each message as rclpy serialises it, with the stamp `SENTINEL_STAMP` and the
            numbers `sentinels`.
        sentinels: float64 values, all different; 0 for a number that no message carries.
        prefixes: what comes before each message, if anything. After a prefix that is not empty
            follow a sequence number (uint32) and the stamp [ns] (uint64) twice, and then the
            message: a record of MCAP.

    `slices` are where each message is in what `pack` gives, without its prefix.

    Raises:
        LandingError: the messages are not in little-endian plain CDR, which is what Fast DDS and
            Cyclone DDS give on x86-64 and ARM; or a sentinel is not found in them.
    """

    def __init__(
        self,
        serialised: Sequence[bytes],
        sentinels: Sequence[float],
        prefixes: Sequence[bytes] = (),
    ) -> None:
        if any(data[:2] != b"\x00\x01" for data in serialised):
            raise LandingError(
                "messages are not serialised as little-endian CDR here; "
                "choose RMW_IMPLEMENTATION=rmw_fastrtps_cpp"
            )
        self._slots = Slots(*range(len(sentinels), len(sentinels) + 3))
        self._numbers = {struct.pack("<d", s): i for i, s in enumerate(sentinels) if s != 0.0}
        self._format = ["<"]
        self._constants: list[bytes] = []
        self.slices: list[slice] = []
        picked: list[int] = []
        for prefix, data in zip(prefixes or [b""] * len(serialised), map(padded, serialised)):
            if prefix:
                picked += self._prefix(prefix)
            start = struct.calcsize("".join(self._format))
            picked += self._learn(data)
            self.slices.append(slice(start, start + len(data)))
        missing = set(self._numbers.values()).difference(picked)
        if missing:
            raise LandingError(
                f"{len(missing)} of {len(self._numbers)} numbers are not found in the serialised "
                "messages; each needs a float64 field of its own"
            )
        self._pick = itemgetter(*picked)
        self._pack = struct.Struct("".join(self._format)).pack

    def _prefix(self, prefix: bytes) -> list[int]:
        """Adds a prefix and `TIMES`; the positions of what they are packed from."""
        position = self._constant(prefix)
        self._format.append(f"{TIMES.size}s")
        return [position, self._slots.times]

    def _constant(self, data: bytes) -> int:
        """Adds constant bytes; their position in the list to pick from."""
        self._format.append(f"{len(data)}s")
        self._constants.append(data)
        return self._slots.constants + len(self._constants) - 1

    def _learn(self, data: bytes) -> list[int]:
        """Adds a message; the positions of what each part of it is packed from."""
        sentinel_stamp = STAMP.pack(*divmod(SENTINEL_STAMP, NANOSECONDS))
        picked: list[int] = []
        at = constant_from = 0
        while at < len(data):
            word = data[at : at + 8]
            aligned = (at - ENCAPSULATION) % 8 == 0
            if word == sentinel_stamp:
                part, position = f"{STAMP.size}s", self._slots.stamp
            elif aligned and word in self._numbers:
                part, position = "d", self._numbers[word]
            else:
                at += 4
                continue
            if at > constant_from:
                picked.append(self._constant(data[constant_from:at]))
            self._format.append(part)
            picked.append(position)
            at += 8
            constant_from = at
        if constant_from < len(data):
            picked.append(self._constant(data[constant_from:]))
        return picked

    def pack(
        self,
        nanoseconds: int,
        numbers: Sequence[float],
        sequence: int = 0,
        more: Sequence[float] = (),
    ) -> bytes:
        """The messages, one after the other.

        Args:
            nanoseconds: their stamp [ns].
            numbers: in the order of the sentinels.
            sequence: the number that follows each prefix.
            more: the last of the numbers, where the caller has them apart.
        """
        # In the order of `Slots`.
        values = [
            *numbers,
            *more,
            STAMP.pack(nanoseconds // NANOSECONDS, nanoseconds % NANOSECONDS),
            TIMES.pack(sequence, nanoseconds, nanoseconds),
            *self._constants,
        ]
        return self._pack(*self._pick(values))
