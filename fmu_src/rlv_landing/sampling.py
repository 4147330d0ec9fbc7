"""The samples of a run: how many there are, and whether this machine can take them."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, NamedTuple

from .effort import SECONDS_PER_SAMPLE, SECONDS_PER_SECOND, check_duration, check_memory
from .errors import LandingError
from .state import LATEST

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from .assembly import DeckMotion
    from .touchdown import GroundMotion


class Samples(NamedTuple):
    """Samples of a landing as its solver writes them.

    Attributes:
        time: Their times [s], (n,).
        rows: The kernel's outputs, (n, row); `outputs.output_order` tells what stands where.
        ground: Motion of the ground from the first of the times on.
    """

    time: NDArray[float64]
    rows: NDArray[float64]
    ground: GroundMotion | DeckMotion


def sample_count(
    start: float,
    until: float,
    every: float,
    numbers: int,
    *,
    costs: tuple[float, float] = (SECONDS_PER_SECOND, SECONDS_PER_SAMPLE),
) -> int:
    """The number of samples from `start` until `until` [s], one every `every` [s].

    Args:
        start: Time of the first sample [s].
        until: Time that no sample is behind [s].
        every: Time between two samples [s].
        numbers: Numbers that are held for each sample at once.
        costs: Least wall time that a second of landing takes, and a sample of it [s].

    Raises:
        LandingError: `every` is not above 0, `until` is not ahead, the samples need more memory
            than is free, or the landing would take longer than 30 days.
    """
    if not 0.0 < every < inf:
        raise LandingError(f"every = {every:g} s must be finite and above 0 s")
    if not start < until <= LATEST:
        raise LandingError(
            f"until = {until:g} s must be finite, after the present time, {start:g} s, "
            f"and at most {LATEST:g} s"
        )
    span = f"a landing until {until:g} s in samples of {every:g} s"
    remedy = "land shorter, or sample more seldom"
    count = (until - start) / every
    check_memory(span, 8.0 * numbers * count, remedy)
    seconds = costs[0] * (until - start) + costs[1] * count
    check_duration(span, seconds, remedy)
    # a rounding of the quotient takes no sample away
    return int(count * (1.0 + 1e-12) + 1e-9) + 1
