"""The paper's scalars read from landings of other vehicles than the paper's.

Their compression, rebound and rest take other times. So these are found in the landing's curves,
and the short windows after a contact grow with the time that the first leg's compression takes.
Times of the paper's own clock have no like in another landing.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from ..history import History
from .first_stroke import LAST, FirstStroke, first_stroke, is_still
from .measures import before_toppling
from .reading import NAN, REST_ANGLE, UNLOADED, Reading

# of the leg that touches first, in the preset `yue2022-figures` and mode 2-2: the time that its
# compression takes [s], and its largest force in it [N]
PAPER_COMPRESSION, PAPER_FORCE = 0.117, 4540.0


class OwnReading(Reading):
    """Reads the printed scalars from a landing of another vehicle than the paper's.

    What the curves do not show, because they end before or the vehicle does not rest, is NaN.

    Raises:
        LandingError: No footpad touches.
    """

    def __init__(self, history: History) -> None:
        super().__init__(before_toppling(history))
        self._turns = cache(self._first_stroke)
        leg = min(self._contact, key=self._contact.__getitem__)
        top = self._maximum(leg)
        compression = PAPER_COMPRESSION if top is None else self.t[top] - self._contact[leg]
        self._slower = float(compression) / PAPER_COMPRESSION
        force = self._force(leg)[: top + 1 if top is not None else None]
        self._unloaded = min(UNLOADED * float(-force.min()) / PAPER_FORCE, 0.0)

    def _end(self, first: float) -> float:
        return float(self.t[-1])

    def _window(self, length: float) -> float:
        return length * self._slower

    def _first_stroke(self, leg: int) -> tuple[int, FirstStroke]:
        """The first sample after the leg's contact, and its compression and rebound from there."""
        first = int(np.searchsorted(self.t, self._contact[leg]))
        return first, first_stroke(self._stroke(leg)[first:])

    def _maximum(self, leg: int) -> int | None:
        first, found = self._turns(leg)
        return None if found.top is None else first + found.top

    def _rebound(self, leg: int) -> int | None:
        first, found = self._turns(leg)
        return None if found.end is None else first + found.end

    def _settled(self, leg: int) -> float:
        """Mean stroke of the last quarter after the contact, where it rests in it [mm]."""
        first, _ = self._turns(leg)
        stroke = self._stroke(leg)[first:]
        if not len(stroke) or not is_still(stroke, float(stroke.max())):
            return NAN
        return float(1e3 * stroke[int((1.0 - LAST) * (len(stroke) - 1)) :].mean())

    def _rest(self) -> float:
        """Last time at which the pitch is more than 0.5 deg off its final mean [s].

        The mean is over the last quarter of the landing after its first contact, in which the pitch
        must not be.
        """
        last = self.end - LAST * (self.end - min(self._contact.values()))
        pitch = self.h["body.pitch"]
        off = np.abs(pitch - pitch[self._between(last, self.end)].mean()) > REST_ANGLE
        moving = np.flatnonzero(off)
        found = float(self.t[moving[-1]]) if len(moving) else 0.0
        return found if found < last else NAN

    def _auxiliary_peak_time(self, leg: int, start: float, end: float) -> float:
        """NaN: start and end are times of the paper's own landing."""
        return NAN
