"""Outputs and their extremes as users read them: by name, with mirror images."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
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


def by_name(
    found: Sequence[float], names: Sequence[str], order: Sequence[tuple[int, float]]
) -> dict[str, Extreme]:
    """The extremes by output.

    Args:
        found: The four blocks that `Solver.extremes` writes: least values, their times, greatest
            values, their times.
        names: The outputs' names.
        order: For each output its place in a block and its factor, as `output_order` gives.
    """
    row = len(found) // 4
    extremes = {}
    for name, (i, factor) in zip(names, order):
        low, low_time, high, high_time = (found[row * block + i] for block in range(4))
        extremes[name] = (
            Extreme(low, low_time, high, high_time)
            if factor > 0.0
            else Extreme(-high, high_time, -low, low_time)
        )
    return extremes


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
        self._names = names
        self._y = array("d", bytes(8 * solver.system.n))
        self._row = array("d", bytes(8 * solver.system.row))
        self._time = inf
        self._order = output_order(mode, len(names))
        self._pick = itemgetter(*(i for i, _ in self._order))
        self._turned = [k for k, (_, factor) in enumerate(self._order) if factor < 0.0]

    def forget(self) -> None:
        """Compute the outputs anew when they are read next."""
        self._time = inf

    def values(self, time: float) -> list[float]:
        """All outputs at `time` [s], inside the last internal step."""
        if self._time != time:
            self._solver.interpolate(time, self._y)
            self._solver.outputs_at(time, self._y, self._row)
            self._time = time
        values = list(self._pick(self._row))
        for i in self._turned:
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
        if names is None:
            return by_name(found, self._names, self._order)
        places = [self._names.index(name) for name in names]
        return by_name(found, names, [self._order[i] for i in places])

    def extremes_of_span(self, time: float) -> dict[str, Extreme]:
        """The extremes from the time of `Solver.open_span` to `time` [s], by name."""
        found = self._blocks()
        self._solver.extremes_of_span(time, found)
        return by_name(found, self._names, self._order)

    def _blocks(self) -> array[float]:
        return array("d", bytes(8 * 4 * len(self._row)))

    def columns(self, rows: NDArray[float64]) -> NDArray[float64]:
        """The outputs of a solver's `rows` [samples x row], as an array [samples x outputs].

        Its columns are contiguous: what studies make of one takes a fraction of the time.
        """
        import numpy as np

        found = np.ascontiguousarray(rows.T)[[i for i, _ in self._order]]
        found[self._turned] *= -1.0
        return found.T
