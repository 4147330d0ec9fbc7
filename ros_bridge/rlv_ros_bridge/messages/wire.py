"""Serialised messages straight from numbers: what rclpy's serialisation gives, byte for byte, at a
fraction of its cost.

The layout of the bytes is rclpy's own: messages are filled with numbers that occur nowhere else,
serialised by rclpy, and searched for these numbers. From then on a sample's numbers are packed in
their places, all messages of an instant in one call.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from operator import itemgetter

from rlv_landing.errors import LandingError

NANOSECONDS = 1_000_000_000
# A stamp that no number of a message looks like.
PROBE_STAMP = 305_419_896 * NANOSECONDS + 591_751_049
# CDR: four bytes that tell the byte order, then the fields, numbers of eight bytes on multiples of
# eight.
START = 4


def padded(data: bytes) -> bytes:
    """`data` filled up to whole words of four bytes, in which DDS hands payloads on: so it is what
    subscribers get.
    """
    rest = len(data) % 4
    return data + bytes(4 - rest) if rest else data


def probe_numbers(count: int) -> list[float]:
    """`count` numbers in (1, 2), all different, that stand out among a message's bytes."""
    return [1.0 + (i * 0.6180339887498949 + 0.0123456789) % 1.0 for i in range(1, count + 1)]


class WireFrame:
    """The serialised messages of one instant, made from a list of numbers and a stamp.

    Args:
        serialised: each message as rclpy serialises it, stamped with `PROBE_STAMP`, with the
            `probe` numbers in it.
        probe: the numbers. Those that are 0 are taken for constants, the others must differ from
            each other.
        heads: what comes before each message, if anything; behind a head that is not empty come a
            count (4 bytes) and the stamp in ns (8 bytes), twice, and then the message: a record of
            MCAP.

    `places` is where each message itself stands in what `pack` gives.

    Raises:
        LandingError: the messages are not in little-endian plain CDR, which is what Fast DDS and
            Cyclone DDS give on x86-64 and ARM.
    """

    def __init__(
        self, serialised: Sequence[bytes], probe: Sequence[float], heads: Sequence[bytes] = ()
    ) -> None:
        if any(data[:2] != b"\x00\x01" for data in serialised):
            raise LandingError(
                "messages are not serialised as little-endian CDR here; choose RMW_IMPLEMENTATION=rmw_fastrtps_cpp"
            )
        # A list to pick from: the numbers, the stamp as seconds and nanoseconds and whole, the
        # count, the constants.
        self._stamp_at = len(probe)
        self._places = {
            struct.pack("<d", value): i for i, value in enumerate(probe) if value != 0.0
        }
        self._form = ["<"]
        self._constants: list[bytes] = []
        self.places: list[slice] = []
        picked: list[int] = []
        for head, data in zip(heads or [b""] * len(serialised), map(padded, serialised)):
            if head:
                picked += [
                    self._constant(head),
                    self._stamp_at + 3,
                    self._stamp_at + 2,
                    self._stamp_at + 2,
                ]
                self._form.append("IQQ")
            start = struct.calcsize("".join(self._form))
            picked += self._learn(data)
            self.places.append(slice(start, start + len(data)))
        self._pick = itemgetter(*picked)
        self._pack = struct.Struct("".join(self._form)).pack

    def _constant(self, data: bytes) -> int:
        """Adds constant bytes to the form; where they stand in the list."""
        self._form.append(f"{len(data)}s")
        self._constants.append(data)
        return self._stamp_at + 3 + len(self._constants)

    def _learn(self, data: bytes) -> list[int]:
        """Adds `data` to the form; where each part of it stands in the list."""
        stamp = struct.pack("<iI", *divmod(PROBE_STAMP, NANOSECONDS))
        picked: list[int] = []
        at = plain = 0
        while at <= len(data):
            word = data[at : at + 8]
            number = self._places.get(word) if (at - START) % 8 == 0 else None
            if word == stamp or number is not None or at == len(data):
                if at > plain:
                    picked.append(self._constant(data[plain:at]))
                if at < len(data):
                    self._form.append("d" if number is not None else "iI")
                    picked += (
                        [number] if number is not None else [self._stamp_at, self._stamp_at + 1]
                    )
                at += 8
                plain = at
            else:
                at += 4
        return picked

    def pack(self, nanoseconds: int, numbers: Sequence[float], count: int = 0) -> bytes:
        """The messages, one after the other, of the `numbers` at the stamp `nanoseconds`; `count`
        is what their heads carry.
        """
        return self._pack(
            *self._pick(
                [
                    *numbers,
                    nanoseconds // NANOSECONDS,
                    nanoseconds % NANOSECONDS,
                    nanoseconds,
                    count,
                    *self._constants,
                ]
            )
        )
