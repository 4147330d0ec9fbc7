"""The extremes of outputs, by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from .quantities import OUTPUT_NAMES


class Extreme(NamedTuple):
    """The least and the greatest value of an output over a span of time, and when it was first so.

    Within 0.1 % of the value, or 0.01 % of what the output has gone through where that is more,
    whatever the samples and communication steps.
    """

    minimum: float  # in the output's unit
    minimum_time: float  # [s]
    maximum: float  # in the output's unit
    maximum_time: float  # [s]


def by_name(found: Sequence[float], order: Sequence[tuple[int, float]]) -> dict[str, Extreme]:
    """The extremes by output.

    Args:
        found: The four blocks that `Solver.extremes` writes: least values, their times, greatest
            values, their times.
        order: For each output its place in a block and its factor, as `output_order` gives.
    """
    row = len(found) // 4
    extremes = {}
    for name, (i, factor) in zip(OUTPUT_NAMES, order):
        low, low_time, high, high_time = (found[row * block + i] for block in range(4))
        extremes[name] = (
            Extreme(low, low_time, high, high_time)
            if factor > 0.0
            else Extreme(-high, high_time, -low, low_time)
        )
    return extremes
