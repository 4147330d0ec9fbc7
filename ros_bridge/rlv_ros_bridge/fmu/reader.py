"""Reads values of one type from an instance of an FMU, all in one call."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from operator import itemgetter
from typing import Any

from .description import Place
from .fmi2 import Fmi2
from .fmi3 import Fmi3


class Reader:
    """Reads the values at `places`, which are of one type, in their order.

    Attributes:
        name: The name of the FMI function.
        read: Reads them; gives the status.

    Args:
        instance: The instance.
        kind: The type, by FMI 2.0's name in small letters.
        places: Where the values are.
    """

    def __init__(self, instance: Fmi2 | Fmi3, kind: str, places: Sequence[Place]) -> None:
        self.name, c_type = instance.GETTERS[kind]
        sizes = {place.reference: place.size for place in places}
        starts, count = {}, 0
        for reference, size in sizes.items():
            starts[reference] = count
            count += size
        # the function has the addresses of both arrays, which are kept alive here
        self._references = (ctypes.c_uint * len(sizes))(*sizes)
        self._values: Any = (c_type * count)()
        self.read = instance.getter(kind, self._references, self._values)
        order = [starts[place.reference] + place.element for place in places]
        self._chosen = None if order == list(range(count)) else itemgetter(*order, order[0])

    def values(self) -> list[Any]:
        """What was read last."""
        if self._chosen is None:
            values: list[Any] = self._values[:]
            return values
        # with one value more, so that one alone is a tuple too
        return list(self._chosen(self._values)[:-1])
