"""The way of the ground to a position that was set, and the time that it takes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

# longest time that the way to a position takes, unless a step of the caller is longer [s]
LONGEST_INTERVAL = 1.0
# A shorter part of the interval before is the interval of another source. Positions of one source
# that the caller looks for at each step come n or n + 1 steps apart, so at least half.
OTHER_SOURCE = 0.45


class Way(NamedTuple):
    """The way of the ground to the position [m, rad] that was set last. Times are in s."""

    goal: float  # position as it was set, at the solver's t_input
    last_set: float
    since: float  # time at which the goal was last set to another place
    interval: float  # time between such settings; 0 before the first
    end: float  # time at which the ground is at the goal


def next_interval(before: float, spacing: float) -> float:
    """The time that the way to a new position takes [s].

    It is the spacing of positions. If that varies, the longest counts, until one is that of another
    source: so the ground does not arrive early and stand. A stand counts as a spacing, so that no
    position after it is reached faster than the vehicle bears. If positions come often from then
    on, the second counts as that of another source.

    Args:
        before: That of the last way [s]; 0 if there was none.
        spacing: Time since the last new position, or since the start [s].
    """
    spacing = min(spacing, LONGEST_INTERVAL)
    return spacing if spacing < OTHER_SOURCE * before else max(before, spacing)


def reached(end: float, t: float) -> bool:
    """Whether the time `end` [s] is not after `t` [s], but for the rounding of sums of steps."""
    return end <= t + 1e-12 * (1.0 + t)


def ways_of(numbers: Sequence[float]) -> list[Way]:
    """The ways of the ground's positions from their numbers, one after the other."""
    size = len(Way._fields)
    return [Way(*numbers[at : at + size]) for at in range(0, len(numbers), size)]


def way_faults(
    numbers: Sequence[float], positions: Sequence[int], rates: Sequence[float], time: float
) -> Iterator[str]:
    """The faults of the ways in a state.

    Args:
        numbers: Those of the ways, as for `ways_of`.
        positions: Places of the positions among the inputs.
        rates: Rates of the solver's inputs [unit/s].
        time: Time of the state [s].
    """
    for i, way in zip(positions, ways_of(numbers)):
        if not 0.0 <= way.since <= time:
            yield f"a ground position set at {way.since:g} s, not a time until {time:g} s"
        if not 0.0 <= way.interval <= LONGEST_INTERVAL:
            yield (
                f"ground positions {way.interval:g} s apart, outside [0, {LONGEST_INTERVAL:g}] s"
            )
        if rates[i] != 0.0 and not reached(time, way.end):
            yield f"a ground on its way to a position that it had at {way.end:g} s"
