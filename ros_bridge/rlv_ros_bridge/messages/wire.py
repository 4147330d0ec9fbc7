"""Serialised messages straight from numbers: rclpy's bytes at a fraction of its cost.

The layout of the bytes is rclpy's own. `MessageLayout` learns each field's byte offset by
serialising sentinel values once: it is given messages that rclpy has serialised with a different
sentinel in each field, and looks for the sentinels. From then on all messages of an instant are
packed by one call of `struct`.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from operator import itemgetter
from typing import NamedTuple

from rlv_landing.errors import LandingError

NANOSECONDS = 1_000_000_000
# A stamp that no number of a message looks like.
SENTINEL_STAMP = 305_419_896 * NANOSECONDS + 591_751_049
# CDR: four bytes of encapsulation, which give the byte order, then the fields; a float64 begins at
# a multiple of eight from there.
ENCAPSULATION = 4
# A message's stamp: seconds, nanoseconds. It has the size of a number.
STAMP = struct.Struct("<iI")
WORD = STAMP.size


def padded(data: bytes) -> bytes:
    """`data` filled up to whole words of four bytes, as DDS delivers payloads to subscribers."""
    rest = len(data) % 4
    return data + bytes(4 - rest) if rest else data


def sentinel_numbers(count: int) -> list[float]:
    """`count` numbers in (1, 2), all different, that stand out among a message's bytes."""
    return [1.0 + (i * 0.6180339887498949 + 0.0123456789) % 1.0 for i in range(1, count + 1)]


class Places(NamedTuple):
    """Where the numbers and stamps of a serialised message are.

    `data` is the message, filled up to whole words. `stamps` are the offsets [bytes] of its stamps;
    `numbers` are the offset of each number [bytes] and its position among the numbers.
    """

    data: bytes
    stamps: list[int]
    numbers: list[tuple[int, int]]


class MessageLayout:
    """Byte offsets of numbers and stamp in the serialised messages of one instant.

    Args:
        serialised: each message as rclpy serialises it, with the stamp `SENTINEL_STAMP` and the
            numbers `sentinels`.
        sentinels: float64 values, all different; 0 for a number that no message carries.

    `slices` are where each message is in what `pack` gives. `places` say it of each one's numbers.

    Raises:
        LandingError: the messages are not in little-endian plain CDR, which is what Fast DDS and
            Cyclone DDS give on x86-64 and ARM; or a sentinel is not found in them.
    """

    def __init__(self, serialised: Sequence[bytes], sentinels: Sequence[float]) -> None:
        if any(data[:2] != b"\x00\x01" for data in serialised):
            raise LandingError(
                "messages are not serialised as little-endian CDR here; "
                "choose RMW_IMPLEMENTATION=rmw_fastrtps_cpp"
            )
        known = {struct.pack("<d", s): i for i, s in enumerate(sentinels) if s != 0.0}
        self.places = [_places(padded(data), known) for data in serialised]
        missing = set(known.values()) - {i for p in self.places for _, i in p.numbers}
        if missing:
            raise LandingError(
                f"{len(missing)} of {len(known)} numbers are not found in the serialised "
                "messages; each needs a float64 field of its own"
            )
        self.slices: list[slice] = []
        self._constants: list[bytes] = []
        # The list to pick from holds the numbers, the stamp and the constants.
        self._stamp = len(sentinels)
        parts, end = ["<"], 0
        picked: list[int] = []
        for places in self.places:
            self.slices.append(slice(end, end + len(places.data)))
            end += len(places.data)
            for part, position in self._parts(places):
                parts.append(part)
                picked.append(position)
        self._pick = itemgetter(*picked)
        self._pack = struct.Struct("".join(parts)).pack

    def _parts(self, places: Places) -> Iterator[tuple[str, int]]:
        """The parts of a message: the format of each, and the position of what is packed there."""
        changing = [(at, "d", position) for at, position in places.numbers]
        changing += [(at, f"{STAMP.size}s", self._stamp) for at in places.stamps]
        end = 0
        for at, part, position in [*sorted(changing), (len(places.data), "", 0)]:
            if at > end:
                self._constants.append(places.data[end:at])
                yield f"{at - end}s", self._stamp + len(self._constants)
            if part:
                yield part, position
            end = at + WORD

    def pack(self, nanoseconds: int, numbers: Sequence[float]) -> bytes:
        """The messages, one after the other.

        Args:
            nanoseconds: their stamp [ns].
            numbers: in the order of the sentinels.
        """
        stamp = STAMP.pack(nanoseconds // NANOSECONDS, nanoseconds % NANOSECONDS)
        return self._pack(*self._pick([*numbers, stamp, *self._constants]))


def _places(data: bytes, known: Mapping[bytes, int]) -> Places:
    """Where numbers and stamps are in a message.

    Args:
        data: the message with sentinels, filled up to whole words.
        known: the position of each sentinel by its bytes.
    """
    sentinel_stamp = STAMP.pack(*divmod(SENTINEL_STAMP, NANOSECONDS))
    found = Places(data, [], [])
    at = 0
    while at < len(data):
        word = data[at : at + WORD]
        if word == sentinel_stamp:
            found.stamps.append(at)
        elif (at - ENCAPSULATION) % WORD == 0 and word in known:
            found.numbers.append((at, known[word]))
        else:
            at += WORD // 2
            continue
        at += WORD
    return found
