"""Moves the stamps inside serialised messages on, so that a looped replay's time never runs
backwards.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping

from rclpy.serialization import deserialize_message, serialize_message

from .message_types import message_class
from .samples import NANOSECONDS, set_stamp

HEADER = "std_msgs/Header"
# Types that are lists of what carries a header: the list's name.
LISTS = {"visualization_msgs/msg/MarkerArray": "markers", "tf2_msgs/msg/TFMessage": "transforms"}
# CDR: four bytes of encapsulation, the second of which tells the byte order; then the header's
# stamp, a message's first field.
AT = 4


class Restamper:
    """Adds `shift` [ns] to the stamps of messages whose first field is a header, of markers and of
    transforms. `types` is type by topic.
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
        """The message `data` of `topic`, moved on; unchanged where it carries no stamp that we know
        of.
        """
        if topic in self._stamped:
            form = "<iI" if data[1] & 1 else ">iI"
            seconds, nanoseconds = struct.unpack_from(form, data, AT)
            moved = bytearray(data)
            struct.pack_into(
                form,
                moved,
                AT,
                *divmod(seconds * NANOSECONDS + nanoseconds + self._shift, NANOSECONDS),
            )
            return bytes(moved)
        if topic in self._lists:
            name = self._lists[topic]
            message = deserialize_message(data, message_class(name))
            for element in getattr(message, LISTS[name]):
                stamp = element.header.stamp
                set_stamp(stamp, stamp.sec * NANOSECONDS + stamp.nanosec + self._shift)
            moved_message: bytes = serialize_message(message)
            return moved_message
        return data


def _fields(name: str) -> dict[str, str]:
    fields: dict[str, str] = message_class(name).get_fields_and_field_types()
    return fields
