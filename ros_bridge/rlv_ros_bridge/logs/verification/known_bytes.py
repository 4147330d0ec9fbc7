"""The bytes that a log's messages must have, so that equal ones need not be decoded."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from rlv_landing.errors import LandingError

from ...messages.fields import Field, Vehicle
from ...messages.tables import leaves
from ...messages.wire import (
    ENCAPSULATION,
    NANOSECONDS,
    SENTINEL_STAMP,
    STAMP,
    WORD,
    MessageLayout,
    sentinel_numbers,
)
from ..reader import LogMessage

# A longer message is not learned, which takes a decoding of it for each word. A landing's have a
# few hundred bytes, those of many legs a thousand or two.
LONGEST = 8192
DOUBLE = struct.Struct("<d")
STAMP_PATHS = ("header.stamp.sec", "header.stamp.nanosec")


class KnownBytes:
    """The bytes of a topic's messages, learned of one that is as it must be.

    All that differs between two right messages are the stamp and the table's numbers. What is
    packed has these at their places, and the learned message's bytes around them. A message of the
    same bytes is right. One of other bytes need not be wrong: there may be gaps between fields.

    Args:
        message: the message, which has been compared field by field.
        decode: decodes it.
        fields: those of the table that the topic carries.
        vehicle: what messages tell beside the outputs.

    Attributes:
        values: How many numbers and texts a message has.

    Raises:
        LandingError: The places of its numbers or its stamp are not found, or it is longer than
            `LONGEST`.
    """

    def __init__(
        self,
        message: LogMessage,
        decode: Callable[[LogMessage], Any],
        fields: Sequence[Field],
        vehicle: Vehicle,
    ) -> None:
        if len(message.data) > LONGEST:
            raise LandingError(f"a message of {len(message.data)} bytes is longer than {LONGEST}")
        decoded = dict(leaves(decode(message)))
        self.values = len(decoded)
        self._conversions = [(field.conversion(vehicle), field.outputs) for field in fields]
        offsets = _offsets(message, decode, decoded)
        paths = [path for field in fields for path in field.paths]
        if any(path not in offsets for path in paths):
            raise LandingError("not all numbers are found in the message's bytes")
        sentinels = sentinel_numbers(len(paths))
        data = bytearray(message.data)
        _put_stamp(data, decoded)
        for path, sentinel in zip(paths, sentinels):
            DOUBLE.pack_into(data, offsets[path], sentinel)
        self._pack = MessageLayout([bytes(data)], sentinels).pack

    def of(self, nanoseconds: int, values: Mapping[str, float]) -> bytes:
        """The bytes of the message at the stamp `nanoseconds` [ns] and the outputs `values`."""
        numbers: list[float] = []
        for convert, outputs in self._conversions:
            numbers += convert(*(values[name] for name in outputs))
        return self._pack(nanoseconds, numbers)


def _put_stamp(data: bytearray, decoded: Mapping[str, Any]) -> None:
    """Replaces the stamp, with which a header begins, by `SENTINEL_STAMP`."""
    stamp = [decoded.get(path) for path in STAMP_PATHS]
    if None in stamp or data[ENCAPSULATION : ENCAPSULATION + STAMP.size] != STAMP.pack(*stamp):
        raise LandingError("the stamp is not found in the message's bytes")
    STAMP.pack_into(data, ENCAPSULATION, *divmod(SENTINEL_STAMP, NANOSECONDS))


def _offsets(
    message: LogMessage, decode: Callable[[LogMessage], Any], decoded: Mapping[str, Any]
) -> dict[str, int]:
    """The offset of each float64 of a message [bytes], by its path.

    The lowest bit of each word is changed: where it is a number's, this number alone changes.
    """
    data, found = message.data, {}
    for at in range(ENCAPSULATION, len(data) - WORD + 1, WORD):
        changed_data = bytearray(data)
        changed_data[at] ^= 1
        try:
            changed = dict(leaves(decode(replace(message, data=bytes(changed_data)))))
        except LandingError:
            continue
        if changed.keys() != decoded.keys():
            continue
        others = [path for path, value in changed.items() if not _is_same(value, decoded[path])]
        # a change of a text's length, or of two small integers, is none of a number
        if len(others) == 1 and _bytes_of(decoded[others[0]]) == data[at : at + WORD]:
            found[others[0]] = at
    return found


def _is_same(a: Any, b: Any) -> bool:
    """Whether two leaves are the same, numbers bit for bit."""
    return bool(a == b) if _bytes_of(a) is None else _bytes_of(a) == _bytes_of(b)


def _bytes_of(value: Any) -> bytes | None:
    """The bytes of a float64; None for what is none."""
    return DOUBLE.pack(value) if isinstance(value, float) else None
