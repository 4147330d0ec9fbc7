"""A sample of the landing as ROS messages: SI units, REP-103 axes, stamps in simulation time.

Made from the table of fields, once as message objects and once, for speed, as serialised bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from operator import attrgetter, itemgetter, setitem
from typing import Any

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message

from .axes import to_ros
from .fields import Conversion, Vehicle, copied
from .message_types import message_class
from .tables import split, table_of, texts
from .topics import CLOCK, Topic
from .wire import NANOSECONDS, SENTINEL_STAMP, MessageLayout, sentinel_numbers


def set_stamp(stamp: Time, nanoseconds: int) -> None:
    """Sets a stamp from a count of nanoseconds."""
    stamp.sec, stamp.nanosec = divmod(nanoseconds, NANOSECONDS)


def set_vector(target: Any, vector: tuple[float, float, float]) -> None:
    """Sets x, y, z of a Point or Vector3."""
    target.x, target.y, target.z = vector


def _setter(message: Any, path: str, default: Any) -> Callable[[Any], None]:
    """Sets the field at `path` of `message`; an array is lengthened by `default` to hold it."""
    owner_path, key = split(path)
    owner = attrgetter(owner_path)(message) if owner_path else message
    if isinstance(key, str):
        return partial(setattr, owner, key)
    if key >= len(owner):
        owner.extend([default] * (key + 1 - len(owner)))
    return partial(setitem, owner, key)


class SampleMessages:
    """The messages that go out at every step, by topic, in the order of publication.

    The message objects are made once and filled again for each sample.

    Args:
        vehicle: what they tell beside the outputs.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        table = table_of(vehicle.interface)
        sampled = table.topics.sampled
        self.messages: dict[Topic, Any] = {
            topic: message_class(topic.type_name)() for topic in (CLOCK, *sampled)
        }
        # One stamp object for all: setting it stamps every message.
        self._stamp = Time()
        self.messages[CLOCK].clock = self._stamp
        for topic in sampled:
            message = self.messages[topic]
            message.header.stamp = self._stamp
            for path, text in texts(topic, vehicle).items():
                _setter(message, path, "")(text)
        self._setters = [
            _setter(self.messages[field.topic], path, 0.0)
            for field in table.fields
            for path in field.paths
        ]
        self._conversions = [
            (f.conversion(vehicle), table.indices(*f.outputs)) for f in table.fields
        ]

    def fill(self, nanoseconds: int, values: Sequence[float]) -> None:
        """Puts a sample into the messages.

        Args:
            nanoseconds: simulation time of the sample [ns].
            values: all outputs in the order of the vehicle's interface, SI, the paper's axes.
        """
        self.put(
            nanoseconds,
            (
                number
                for write, positions in self._conversions
                for number in write(*(values[i] for i in positions))
            ),
        )

    def put(self, nanoseconds: int, numbers: Iterable[float]) -> None:
        """Puts `numbers` into the messages, one for each path of the table, in its order."""
        set_stamp(self._stamp, nanoseconds)
        for set_number, number in zip(self._setters, numbers, strict=True):
            set_number(float(number))


class SampleBytes:
    """The serialised messages of `SampleMessages`: the same bytes, at a fraction of the cost.

    Args:
        vehicle: what they tell beside the outputs.

    `vehicle` is as given. `count` is that of the numbers that are packed. `topics` are in the order
    of the messages; `slices` are where each one's message is in what `pack` gives, and `places`
    where its numbers are in the message.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        messages = SampleMessages(vehicle)
        self.vehicle = vehicle
        self.topics: tuple[Topic, ...] = tuple(messages.messages)
        # What is packed: the sample, and after it what the messages carry that is not in it.
        self._computations: list[tuple[Conversion, Callable[[Sequence[float]], Any]]] = []
        positions, self.count = self._assign_positions()
        sentinels = sentinel_numbers(self.count)
        messages.put(SENTINEL_STAMP, (sentinels[i] for i in positions))
        carried = set(positions)
        self._layout = MessageLayout(
            [serialize_message(message) for message in messages.messages.values()],
            [number if i in carried else 0.0 for i, number in enumerate(sentinels)],
        )
        self.slices, self.places = self._layout.slices, self._layout.places

    def _assign_positions(self) -> tuple[list[int], int]:
        """Which of the packed numbers each path of the table holds, and how many are packed.

        Fields that copy outputs hold numbers of the sample, vectors in ROS axes two of them and
        one with the sign turned; what fields compute alike is packed once.
        """
        positions: list[int] = []
        table = table_of(self.vehicle.interface)
        count = len(self.vehicle.interface.outputs)
        self._turned = sorted(
            {table.index[field.outputs[2]] for field in table.fields if field.write is to_ros}
        )
        turned = {z: count + i for i, z in enumerate(self._turned)}
        count += len(turned)
        computed: dict[tuple[Conversion, tuple[str, ...]], range] = {}
        for field in table.fields:
            if field.write is copied:
                positions += table.indices(*field.outputs)
                continue
            if field.write is to_ros:
                x, y, z = table.indices(*field.outputs)
                positions += (x, turned[z], y)
                continue
            key = field.write, field.outputs
            if key not in computed:
                computed[key] = range(count, count + len(field.paths))
                count += len(field.paths)
                pick = _picker(table.indices(*field.outputs))
                self._computations.append((field.conversion(self.vehicle), pick))
            positions += computed[key]
        return positions, count

    def numbers(self, values: Sequence[float]) -> list[float]:
        """The `count` numbers of a sample: the outputs, and what the messages carry beside them.

        Args:
            values: all outputs in the order of the vehicle's interface, SI, the paper's axes.
        """
        numbers = [*values, *(-values[z] for z in self._turned)]
        for compute, pick in self._computations:
            numbers += compute(*pick(values))
        return numbers

    def pack(self, nanoseconds: int, values: Sequence[float]) -> bytes:
        """The messages of a sample, one after the other.

        Args:
            nanoseconds: simulation time of the sample [ns].
            values: all outputs in the order of the vehicle's interface, SI, the paper's axes.
        """
        return self.pack_numbers(nanoseconds, self.numbers(values))

    def pack_numbers(self, nanoseconds: int, numbers: Sequence[float]) -> bytes:
        """The messages of a sample by what `numbers` gives; `nanoseconds` as in `pack`."""
        return self._layout.pack(nanoseconds, numbers)


def _picker(positions: tuple[int, ...]) -> Callable[[Sequence[float]], Any]:
    """Picks the numbers at `positions` of a sequence, as a sequence even where it is one."""
    if len(positions) == 1:
        return itemgetter(slice(positions[0], positions[0] + 1))
    return itemgetter(*positions)
