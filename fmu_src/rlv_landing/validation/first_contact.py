"""The first contact of a footpad, which lies between two samples.

Derived: the paper's curves do not show it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import copysign, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..history import History

Array = NDArray[np.float64]
# samples of the flight before the contact by which what is smooth goes on to it
BEFORE = 3
# a contact that comes before so long [s], or with fewer samples before it, is looked for in the
# landing itself, where that can be repeated: some microseconds are much of its time then
EARLY = 0.02
# the contact is between two looks at the landing that are this near to each other [s]
NEAR = 2e-5
# a footpad that is no further above the ground at the start touches it [m]
TOUCHING = 1e-9


@dataclass(frozen=True)
class FirstContact:
    """The first contact of a leg's footpad.

    Attributes:
        sample: The first sample from the contact on. The ground pushes on the footpad there, unless
            it left the ground again between two samples.
        time: Time of the contact [s]: the penetration of the samples before, which is that of a
            free flight, goes on to 0. Of a contact within the first samples it is exact where the
            landing can be repeated. It is that of `sample`, or of the integrator's first step in
            contact, where neither is known.
        outputs: All outputs at that time, where it is exact; else None.
    """

    sample: int
    time: float
    outputs: Mapping[str, float] | None = None

    def value(self, history: History, name: str) -> float:
        """An output that is smooth until the contact, at the contact."""
        if self.outputs is not None:
            return self.outputs[name]
        time, values = history.time, history[name]
        if not self.sample or self.time == time[self.sample]:
            return float(values[self.sample])
        curve = _curve(time, values, self.sample)
        return curve.at(self.time - float(time[self.sample - 1]))


def first_contact(history: History, leg: int) -> FirstContact | None:
    """The first contact of the footpad of `leg`; None where the ground never pushes on it.

    It is found once, and kept with the history.
    """
    if leg not in history.first_contacts:
        history.first_contacts[leg] = _found(history, leg)
    contact: FirstContact | None = history.first_contacts[leg]
    return contact


def _found(history: History, leg: int) -> FirstContact | None:
    found = _first_known(history, leg)
    if found is None:
        return None
    sample, last = found
    name = f"leg[{leg}].contact.penetration"
    if not sample or name not in history:
        return FirstContact(sample, last)
    depth, before = history[name], float(history.time[sample - 1])
    if sample == 1 and depth[0] > -TOUCHING:
        return FirstContact(sample, before)
    if sample < BEFORE or last - float(history.time[0]) < EARLY:
        exact = _exact(history, sample, before, last, name)
        if exact is not None:
            return exact
    inside = [t for x in _curve(history.time, depth, sample).roots() if before <= (t := before + x)]
    return FirstContact(sample, min([*inside, last]))


def _exact(
    history: History, sample: int, before: float, last: float, depth: str
) -> FirstContact | None:
    """The contact between two times of the landing; None where it cannot be repeated.

    Two near times are looked for, between which all outputs are linear.
    """
    looks = history.looks()
    if looks is None:
        return None
    with looks as look:
        # what follows begins there
        first = look(before)
        above = max(before, last - NEAR)
        first, second = look(above), look(last)
        while first[depth] >= 0.0 and above > before:
            above, last, second = max(before, above - 8.0 * (last - above)), above, first
            first = look(above)
        while last - above > NEAR:
            middle = 0.5 * (above + last)
            found = look(middle)
            if found[depth] < 0.0:
                above, first = middle, found
            else:
                last, second = middle, found
    if not first[depth] < 0.0 <= second[depth]:
        return None
    part = first[depth] / (first[depth] - second[depth])
    values = {name: first[name] + part * (second[name] - first[name]) for name in history.names}
    return FirstContact(sample, above + part * (last - above), values)


def _first_known(history: History, leg: int) -> tuple[int, float] | None:
    """The first sample from the contact on, and a time [s] until then at which it is known."""
    pushed = history[f"leg[{leg}].contact.force_y"] > 0.0
    sample = int(np.argmax(pushed))
    touches, name = bool(pushed[sample]), f"leg[{leg}].contact.active"
    time = float(history.time[sample])
    if history.extremes is not None and name in history.extremes:
        active = history.extremes[name]
        until = active.maximum_time
        known = active.maximum > 0.0 and history.time[0] <= until <= history.time[-1]
        if known and not (touches and time <= until):
            return int(np.searchsorted(history.time, until)), until
    return (sample, time) if touches else None


class _Parabola(NamedTuple):
    """c + b x + a x^2."""

    c: float
    b: float
    a: float

    def at(self, x: float) -> float:
        return self.c + x * (self.b + x * self.a)

    def roots(self) -> list[float]:
        """Where it is 0; none where it is constant."""
        c, b, a = self
        inside = b * b - 4.0 * a * c
        if inside < 0.0:
            return []
        # of both signs the one that does not cancel
        q = -0.5 * (b + copysign(sqrt(inside), b))
        return [*([q / a] if a else []), *([c / q] if q else [])]


def _curve(time: Array, values: Array, sample: int) -> _Parabola:
    """The parabola through the samples before `sample`, over the time from the last of these on."""
    first = max(sample - BEFORE, 0)
    v: list[float] = values[first:sample].tolist()
    t: list[float] = time[first:sample].tolist()
    if len(v) < 2:
        return _Parabola(v[-1], 0.0, 0.0)
    rise = (v[-1] - v[-2]) / (t[-1] - t[-2])
    if len(v) < BEFORE:
        return _Parabola(v[-1], rise, 0.0)
    bend = (rise - (v[-2] - v[-3]) / (t[-2] - t[-3])) / (t[-1] - t[-3])
    return _Parabola(v[-1], rise + bend * (t[-1] - t[-2]), bend)
