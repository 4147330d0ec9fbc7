"""Arrays and records as kernels pass them to each other.

Compiled, all of this is addresses and structs (see `core_source`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from typing import Any, Protocol, TypeVar, overload

Record = TypeVar("Record")
Law = TypeVar("Law")

# In the compiled core, other threads run inside `with nogil`.
nogil = nullcontext()


class Doubles(Protocol):
    """Numbers that kernels read and write: an array or buffer of doubles.

    In the compiled core it is the address of the first.
    """

    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[float]: ...
    @overload
    def __getitem__(self, i: int, /) -> float: ...
    @overload
    def __getitem__(self, i: slice, /) -> Iterable[float]: ...
    def __setitem__(self, i: int, value: float, /) -> None: ...


# what a caller in Python hands over, and what a class keeps: in the compiled core a buffer with its
# length
Buffer = Doubles
# records of one kind, one behind the other: in the compiled core an array of structs
Records = list


def data(numbers: Buffer) -> Doubles:
    """The numbers of a buffer, for kernels."""
    return numbers


def copy(source: Doubles, target: Doubles, count: int) -> None:
    """Copy `count` numbers to another place."""
    for i in range(count):
        target[i] = source[i]


def stored(records: Sequence[Record]) -> Records[Record]:
    """A copy of `records` where kernels can read them."""
    return list(records)


def room(count: int, size: int) -> Records[Any]:
    """Room for `count` records of `size` numbers each.

    A kernel writes a record there before it reads it.
    """
    return [()] * count


def chosen(laws: Mapping[str, Law], kind: float) -> Law:
    """The law at place `kind` of `laws`, sorted by name.

    In the compiled core a function that returns what a chosen law gives branches on its kind.
    """
    return laws[sorted(laws)[int(kind)]]
