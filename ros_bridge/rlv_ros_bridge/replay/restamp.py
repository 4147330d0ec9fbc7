"""Adds a shift to the stamps inside serialised messages.

A looped replay needs it, so that its time never runs backwards.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping

from rclpy.serialization import deserialize_message, serialize_message

from ..messages.message_types import message_class
from ..messages.samples import set_stamp
from ..messages.wire import ENCAPSULATION, NANOSECONDS

HEADER = "std_msgs/Header"
# Types that are lists of what carries a header: the list's name.
LISTS = {"visualization_msgs/msg/MarkerArray": "markers", "tf2_msgs/msg/TFMessage": "transforms"}


class Restamper:
    """Adds a shift to the stamps of messages with a header, of markers and of transforms.

    Args:
        types: type by topic. A header must be the message's first field.
        shift: what is added [ns].
    """

    def __init__(self, types: Mapping[str, str], shift: int) -> None:
        self._shift = shift
        self._stamped = {
            topic
            for topic, name in types.items()
            if next(iter(_fields(name).values()), "") == HEADER
        }
        self._lists = {topic: name for topic, name in types.items() if name in LISTS}

    def __call__(self, topic: str, data: bytes) -> bytes:
        """The serialised message `data` of `topic` with its stamps shifted.

        It is unchanged where its type has neither a header nor a list of what has headers.
        """
        if topic in self._stamped and len(data) >= ENCAPSULATION + 8:
            # The encapsulation's second byte is the byte order; the stamp comes right after it.
            form = "<iI" if data[1] & 1 else ">iI"
            seconds, nanoseconds = struct.unpack_from(form, data, ENCAPSULATION)
            stamp = divmod(seconds * NANOSECONDS + nanoseconds + self._shift, NANOSECONDS)
            shifted = bytearray(data)
            struct.pack_into(form, shifted, ENCAPSULATION, *stamp)
            return bytes(shifted)
        if topic in self._lists:
            name = self._lists[topic]
            message = deserialize_message(data, message_class(name))
            for element in getattr(message, LISTS[name]):
                stamp = element.header.stamp
                set_stamp(stamp, stamp.sec * NANOSECONDS + stamp.nanosec + self._shift)
            serialised: bytes = serialize_message(message)
            return serialised
        return data


def _fields(name: str) -> dict[str, str]:
    fields: dict[str, str] = message_class(name).get_fields_and_field_types()
    return fields
