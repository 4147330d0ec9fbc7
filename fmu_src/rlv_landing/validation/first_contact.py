"""The first contact of a footpad, which lies between two samples.

Derived: the paper's curves do not show it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..history import History

Array = NDArray[np.float64]
# samples of the flight before the contact by which what is smooth goes on to it
BEFORE = 3


@dataclass(frozen=True)
class FirstContact:
    """The first contact of a leg's footpad.

    Attributes:
        sample: The first sample at which the ground pushes on the footpad.
        time: Time of the contact [s]: the penetration of the samples before, which is that of a
            free flight, goes on to 0. It is that of `sample` where there are none before it or no
            penetration is known.
    """

    sample: int
    time: float

    def value(self, time: Array, values: Array) -> float:
        """What is smooth until the contact, at the contact.

        Args:
            time: Times of all samples [s], (n,).
            values: Its values at these, (n,).
        """
        if not self.sample or self.time == time[self.sample]:
            return float(values[self.sample])
        start, curve = _curve(time, values, self.sample)
        return float(np.polyval(curve, self.time - start))


def first_contact(history: History, leg: int) -> FirstContact | None:
    """The first contact of the footpad of `leg`; None where the ground never pushes on it."""
    pushed = history[f"leg[{leg}].contact.force_y"] > 0.0
    sample = int(np.argmax(pushed))
    if not pushed[sample]:
        return None
    time = float(history.time[sample])
    name = f"leg[{leg}].contact.penetration"
    if not sample or name not in history:
        return FirstContact(sample, time)
    start, curve = _curve(history.time, history[name], sample)
    before = float(history.time[sample - 1])
    roots = start + np.roots(curve)
    inside = [t for t in roots[np.isreal(roots)].real if before <= t <= time]
    return FirstContact(sample, float(min(inside, default=time)))


def _curve(time: Array, values: Array, sample: int) -> tuple[float, Array]:
    """The parabola through the samples before `sample`, over the time from the last of these on."""
    first = max(sample - BEFORE, 0)
    start = float(time[sample - 1])
    curve: Array = np.polyfit(
        time[first:sample] - start, values[first:sample], min(BEFORE, sample) - 1
    )
    return start, curve
