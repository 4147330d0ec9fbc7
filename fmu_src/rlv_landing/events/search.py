"""Finds the first event on the way of a landing.

Events are: a footpad or the body touches the ground or leaves it; a main strut comes to an end stop
or leaves it; `status.phase` changes. The search reads the interpolants of the integrator's own
steps and changes none of them, so a landing has the same numbers whether events are looked for or
not.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from ..core import Solver
from ..interruptible import check_going

# an event is known to so many seconds: half the promised 1e-9 s
WIDTH = 5e-10
# a stroke [m] that is further from a stop's edge by no more than rounding is in the stop
ROUNDING = 1e-12
# at a time: the outputs' distances from their edges, and the phase; on which sides they are
Distances = tuple[Sequence[float], Sequence[bool]]


class EventSearch:
    """Takes the solver of one landing on, to the first event at most.

    Args:
        solver: The solver.
        names: The outputs' names.
        order: For each output its place in the solver's outputs and its factor.
        stops: Strokes at which the legs' main struts meet their compression stops [m].
    """

    def __init__(
        self,
        solver: Solver,
        names: Sequence[str],
        order: Sequence[tuple[int, float]],
        stops: Sequence[float],
    ) -> None:
        self._solver = solver
        self._y = array("d", bytes(8 * solver.n))
        self._out = array("d", bytes(8 * solver.system.row))
        places = {name: i for name, (i, _) in zip(names, order)}
        # legs that move alike have one place
        depths = {i for name, i in places.items() if name.endswith(".contact.penetration")}
        strokes = [i for name, i in places.items() if name.endswith(".main_strut.stroke")]
        ends = dict(zip(strokes, stops))
        # (place, edge): outputs for which it matters on which side of an edge they are
        depths |= {i for name, i in places.items() if name == "body.clearance"}
        self._edges = [(i, 0.0) for i in sorted(depths)] + [
            (i, edge) for i in sorted(ends) for edge in (ROUNDING, ends[i])
        ]
        self._phase = places["status.phase"]

    def advance(self, start: float, time: float) -> tuple[float, bool]:
        """Take the solver on to `time` [s], or to the first event after `start` [s].

        `start` is inside the solver's last step.

        Returns:
            The time reached [s], and whether there is an event at it.

        Raises:
            IntegrationError: The solver cannot go on.
        """
        solver = self._solver
        check_going(solver)
        here = self._distances(start)
        while start < time:
            if solver.t <= start:
                if not solver.advance_some(time, 1):
                    check_going(solver)
                continue
            until = min(solver.t, time)
            there = self._distances(until)
            found = self._first_change(start, here, until, there)
            if found is not None:
                return found, True
            start, here = until, there
        return time, False

    def _distances(self, t: float) -> Distances:
        """Distances and sides at time `t` [s], inside the solver's last step."""
        self._solver.interpolate(t, self._y)
        self._solver.outputs_at(t, self._y, self._out)
        row = self._out
        distances = [row[i] - edge for i, edge in self._edges]
        return [*distances, row[self._phase]], [d > 0.0 for d in distances]

    def _first_change(
        self, start: float, first: Distances, end: float, last: Distances
    ) -> float | None:
        """Time [s] of the first event after `start`, until `end`, both inside the last step.

        An event that another undoes within the step is found where the parabola through start,
        middle and end says that an edge is passed.
        """
        middle = 0.5 * (start + end)
        if not start < middle < end:
            return end if _differ(first, last) else None
        amid = self._distances(middle)
        if _differ(first, amid):
            return self._narrowed(start, first, middle)
        if _differ(first, last):
            return self._narrowed(middle, first, end)
        for part in turns(first[0], amid[0], last[0]):
            at = start + part * (end - start)
            if start < at < end and _differ(first, self._distances(at)):
                return self._narrowed(start, first, at)
        return None

    def _narrowed(self, low: float, first: Distances, high: float) -> float:
        """Time [s] just after an event between `low`, where all is as at `first`, and `high`."""
        while high - low > WIDTH:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            if _differ(first, self._distances(middle)):
                high = middle
            else:
                low = middle
        return high


def _differ(one: Distances, other: Distances) -> bool:
    """Whether marks or phases differ."""
    return one[1] != other[1] or one[0][-1] != other[0][-1]


def turns(first: Sequence[float], amid: Sequence[float], last: Sequence[float]) -> list[float]:
    """Parts of a step at which parabolas turn beyond the edge that they do not pass otherwise.

    Args:
        first: Distances from the edges [m] at the step's start, and the phase, which is left out.
        amid: The same at its middle.
        last: The same at its end.
    """
    found = []
    for a, b, c in zip(first[:-1], amid[:-1], last[:-1]):
        slope, bend = 4.0 * b - 3.0 * a - c, 2.0 * (a + c) - 4.0 * b
        if bend == 0.0:
            continue
        part = -0.5 * slope / bend
        if 0.0 < part < 1.0 and (a + part * (slope + part * bend) > 0.0) != (a > 0.0):
            found.append(part)
    return sorted(found)
