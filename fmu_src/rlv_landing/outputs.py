"""Outputs and their extremes as users read them: by name, with mirror images."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from math import inf
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

from .core import Solver
from .quantities import LEG_QUANTITIES, MIRRORED, SHARED_QUANTITIES, SPACE, groups_of

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray


def output_order(mode: str, outputs: int) -> list[tuple[int, float]]:
    """For each of so many outputs: where the kernel's outputs hold it, and its factor.

    The factor -1 turns Z of a mirror image.
    """
    if mode == SPACE:
        return [(i, 1.0) for i in range(outputs)]
    shared = len(SHARED_QUANTITIES)
    order = [(i, 1.0) for i in range(shared)]
    where = {leg: (group, side) for group, g in enumerate(groups_of(mode)) for leg, side in g.legs}
    for leg in sorted(where):
        group, side = where[leg]
        for i, q in enumerate(LEG_QUANTITIES):
            order.append(
                (
                    shared + len(LEG_QUANTITIES) * group + i,
                    float(side) if q.name in MIRRORED else 1.0,
                )
            )
    return order


class Extreme(NamedTuple):
    """The least and the greatest value of an output over a span of time, and when it was first so.

    Within 0.1 % of the value, or 0.01 % of what the output has gone through where that is more,
    whatever the samples and communication steps.

    Attributes:
        minimum: The least value, in the output's unit.
        minimum_time: When it was first reached [s].
        maximum: The greatest value, in the output's unit.
        maximum_time: When it was first reached [s].
    """

    minimum: float
    minimum_time: float
    maximum: float
    maximum_time: float


class Extremes(Mapping[str, Extreme]):
    """The extremes by output, each made when it is asked for.

    Args:
        found: The four blocks that `Solver.extremes` writes: least values, their times, greatest
            values, their times.
        places: For each output its place in a block and its factor, as `output_order` gives.
    """

    def __init__(self, found: Sequence[float], places: Mapping[str, tuple[int, float]]) -> None:
        self._found = found
        self._row = len(found) // 4
        self._places = places

    def __getitem__(self, name: str) -> Extreme:
        i, factor = self._places[name]
        low, low_time, high, high_time = self._found[i :: self._row]
        if factor > 0.0:
            return Extreme(low, low_time, high, high_time)
        return Extreme(-high, high_time, -low, low_time)

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)


class Layout(NamedTuple):
    """Where a solver's row has the outputs of an interface."""

    order: Sequence[tuple[int, float]]  # as `output_order`
    places: Mapping[str, tuple[int, float]]  # the same by name
    pick: Callable[[Sequence[float]], tuple[float, ...]]
    turned: Sequence[int]  # the outputs whose factor is -1
    straight: bool  # the row begins with the outputs in their order


@lru_cache(maxsize=64)
def layout_of(mode: str, names: tuple[str, ...]) -> Layout:
    """The layout of a solver's row for outputs of these names."""
    order = output_order(mode, len(names))
    return Layout(
        order,
        dict(zip(names, order)),
        itemgetter(*(i for i, _ in order)),
        [k for k, (_, factor) in enumerate(order) if factor < 0.0],
        all(one == (k, 1.0) for k, one in enumerate(order)),
    )


class OutputReader:
    """Reads the outputs and extremes of a solver in the order of its interface.

    The outputs at a time are computed once; `forget` says that they have changed.

    Args:
        solver: The solver of a landing.
        mode: The landing mode.
        names: The outputs' names.
    """

    def __init__(self, solver: Solver, mode: str, names: Sequence[str]) -> None:
        self._solver = solver
        self._y = array("d", bytes(8 * solver.system.n))
        self._row = array("d", bytes(8 * solver.system.row))
        self._time = inf
        self._layout = layout_of(mode, tuple(names))

    def forget(self) -> None:
        """Compute the outputs anew when they are read next."""
        self._time = inf

    def values(self, time: float) -> list[float]:
        """All outputs at `time` [s], inside the last internal step."""
        if self._time != time:
            self._solver.interpolate(time, self._y)
            self._solver.outputs_at(time, self._y, self._row)
            self._time = time
        values = list(self._layout.pick(self._row))
        for i in self._layout.turned:
            values[i] = -values[i]
        return values

    def extremes(self, time: float, names: Sequence[str] | None = None) -> dict[str, Extreme]:
        """The extremes from the start to `time` [s], inside the last internal step, by name.

        Args:
            time: The time [s].
            names: The outputs [all].
        """
        found = self._blocks()
        self._solver.extremes(time, found)
        extremes = Extremes(found, self._layout.places)
        return {name: extremes[name] for name in (extremes if names is None else names)}

    def extremes_of_span(self, time: float) -> Extremes:
        """The extremes from the time of `Solver.open_span` to `time` [s], by name."""
        found = self._blocks()
        self._solver.extremes_of_span(time, found)
        return Extremes(found, self._layout.places)

    def _blocks(self) -> array[float]:
        return array("d", bytes(8 * 4 * len(self._row)))

    def columns(self, rows: NDArray[float64]) -> NDArray[float64]:
        """The outputs of a solver's `rows` [samples x row], as an array [samples x outputs].

        Its columns are contiguous: what studies make of one takes a fraction of the time.
        """
        import numpy as np

        if self._layout.straight:
            return np.asfortranarray(rows[:, : len(self._layout.order)])
        found = np.ascontiguousarray(rows.T)[[i for i, _ in self._layout.order]]
        found[self._layout.turned] *= -1.0
        return found.T
