"""The readings of a landing that correspond to the scalars that the paper prints.

Each method states how the paper's words are understood. Its windows of time are those of the
paper's vehicle; `own_reading` reads other vehicles, and `measures` has the measures of any.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError
from ..history import History

FIRST_PEAK_WINDOW = 0.012
STROKE_WINDOW = 0.22
REBOUND_WINDOW = 0.25
UNLOADED = -250.0
RUN_AFTER_CONTACT = 0.8
REST_ANGLE = np.radians(0.5)
NAN = float("nan")


class Reading:
    """Reads the printed scalars from one landing's history.

    The history needs at least 0.8 s after the first contact, sampled at 1 kHz or finer. A scalar
    that the landing does not have, such as the peak of a leg that never touches the ground, is NaN.
    So is a turn of the stroke that comes after the paper's window.

    Raises:
        LandingError: No footpad touches, or the history is too short.
    """

    def __init__(self, history: History) -> None:
        self.h = history
        self.t = history.time
        self._contact = {leg: self._contact_time(leg) for leg in (1, 2, 3, 4)}
        first = min(self._contact.values())
        if not np.isfinite(first):
            raise LandingError("no footpad touches the ground in this history; run it longer")
        self.end = self._end(first)
        self._unloaded = UNLOADED
        if self.t[-1] < self.end - 1e-3:
            raise LandingError(
                f"the history ends at {self.t[-1]:g} s; "
                f"the paper's scalars need it until {self.end:g} s"
            )

    def _end(self, first: float) -> float:
        """The end of what is read [s], for the time of the first contact."""
        return first + RUN_AFTER_CONTACT

    def _window(self, length: float) -> float:
        """A window of time after a contact [s], for that of the paper's vehicle."""
        return length

    def _contact_time(self, leg: int) -> float:
        depth = f"leg[{leg}].contact.penetration"
        d = self.h[depth] if depth in self.h else self.h[f"leg[{leg}].contact.force_y"]
        touching = np.flatnonzero(d > 0.0)
        if not len(touching):
            return float("inf")
        i = int(touching[0])
        if i == 0 or depth not in self.h:
            return float(self.t[i])
        return float(self.t[i - 1] + (self.t[i] - self.t[i - 1]) * d[i - 1] / (d[i - 1] - d[i]))

    def _between(self, start: float, end: float) -> NDArray[np.intp]:
        return np.flatnonzero((self.t >= start) & (self.t <= end))

    def _peak(
        self, sign: float, values: NDArray[np.float64], start: float, end: float
    ) -> int | None:
        """The sample with the largest (`sign` 1) or smallest (-1) of `values`.

        The samples are those from `start` to `end` [s]; None where there is none.
        """
        window = self._between(start, end)
        return int(window[np.argmax(sign * values[window])]) if len(window) else None

    def _at(self, values: NDArray[np.float64], i: int | None) -> float:
        return NAN if i is None else float(values[i])

    def contact_time(self, leg: int) -> float:
        """Time at which the penetration passes 0 [s]."""
        return self._contact[leg] if np.isfinite(self._contact[leg]) else NAN

    def contact_force(self, leg: int) -> float:
        """Most negative strut force within 12 ms after that leg's contact [N]."""
        t = self._contact[leg]
        return self._at(
            self._force(leg),
            self._peak(-1.0, self._force(leg), t, t + self._window(FIRST_PEAK_WINDOW)),
        )

    def _force(self, leg: int) -> NDArray[np.float64]:
        return self.h[f"leg[{leg}].main_strut.force"]

    def _stroke(self, leg: int) -> NDArray[np.float64]:
        return self.h[f"leg[{leg}].main_strut.stroke"]

    def _auxiliary(self, leg: int) -> NDArray[np.float64]:
        return self.h[f"leg[{leg}].auxiliary_strut.force"]

    def _turn(self, sign: float, leg: int, start: float, length: float) -> int | None:
        """The sample at which the stroke turns, as `_peak`; None where it goes on after the end."""
        stroke = sign * self._stroke(leg)
        i = self._peak(1.0, stroke, start, start + length)
        goes_on = i is not None and i + 1 < len(stroke) and stroke[i + 1] > stroke[i]
        return None if goes_on else i

    def _maximum(self, leg: int) -> int | None:
        return self._turn(1.0, leg, self._contact[leg], STROKE_WINDOW)

    def maximum_stroke(self, leg: int) -> float:
        """Largest stroke within 0.22 s after contact [mm]."""
        return 1e3 * self._at(self._stroke(leg), self._maximum(leg))

    def maximum_stroke_time(self, leg: int) -> float:
        """Time of the maximum stroke [s]."""
        return self._at(self.t, self._maximum(leg))

    def maximum_stroke_force(self, leg: int) -> float:
        """Strut force at the maximum stroke [N]."""
        return self._at(self._force(leg), self._maximum(leg))

    def _first(self, condition: NDArray[np.bool_], start: float) -> float:
        found = np.flatnonzero(condition & (self.t >= start))
        return float(self.t[found[0]]) if len(found) else NAN

    def unloaded_from(self, leg: int) -> float:
        """First time after the maximum stroke with the force above -250 N [s]."""
        return self._first(self._force(leg) > self._unloaded, self.maximum_stroke_time(leg))

    def unloaded_until(self, leg: int) -> float:
        """First time at least 40 ms after `unloaded_from` with the force below -250 N [s]."""
        return self._first(
            self._force(leg) < self._unloaded, self.unloaded_from(leg) + self._window(0.04)
        )

    def _rebound(self, leg: int) -> int | None:
        return self._turn(-1.0, leg, self.maximum_stroke_time(leg), REBOUND_WINDOW)

    def rebound_stroke(self, leg: int) -> float:
        """Smallest stroke within 0.25 s after the maximum [mm]."""
        return 1e3 * self._at(self._stroke(leg), self._rebound(leg))

    def rebound_time(self, leg: int) -> float:
        """Time of the rebound's smallest stroke [s]."""
        return self._at(self.t, self._rebound(leg))

    def settled_stroke(self, leg: int) -> float:
        """Mean stroke over the last 0.15 s of the 0.8 s after first contact [mm]."""
        return self._settled(leg)

    def _settled(self, leg: int) -> float:
        return float(1e3 * self._stroke(leg)[self._between(self.end - 0.15, self.end)].mean())

    def _first_valley(self, leg: int) -> int | None:
        return self._peak(
            -1.0,
            self._force(leg),
            self._contact[leg] + self._window(FIRST_PEAK_WINDOW),
            self.maximum_stroke_time(leg) - self._window(0.02),
        )

    def first_valley_force(self, leg: int) -> float:
        """Most negative strut force of the first valley [N].

        The valley lasts from 12 ms after contact to 20 ms before the maximum stroke.
        """
        return self._at(self._force(leg), self._first_valley(leg))

    def first_valley_time(self, leg: int) -> float:
        """Time of the first valley [s]."""
        return self._at(self.t, self._first_valley(leg))

    def auxiliary_compression(self, leg: int) -> float:
        """Smallest auxiliary strut force within 30 ms after contact [N]."""
        t = self._contact[leg]
        return self._at(
            self._auxiliary(leg), self._peak(-1.0, self._auxiliary(leg), t, t + self._window(0.03))
        )

    def auxiliary_tension(self, leg: int) -> float:
        """Largest auxiliary strut force of the landing [N]."""
        return float(self._auxiliary(leg)[self._between(0.0, self.end)].max())

    def _auxiliary_peak_time(self, leg: int, start: float, end: float) -> float:
        return self._at(self.t, self._peak(1.0, self._auxiliary(leg), start, end))

    def auxiliary_first_peak_time(self, leg: int) -> float:
        """Time of the largest auxiliary strut force until 0.306 s [s]."""
        return self._auxiliary_peak_time(leg, self._contact[leg], 0.306)

    def auxiliary_second_peak_time(self, leg: int) -> float:
        """Time of the largest auxiliary strut force from 0.31 to 0.40 s [s]."""
        return self._auxiliary_peak_time(leg, 0.31, 0.40)

    def _acceleration(self, leg: int) -> int | None:
        t = self._contact[leg]
        return self._peak(
            1.0, self.h["body.top_axial_acceleration"], t, t + self._window(FIRST_PEAK_WINDOW)
        )

    def acceleration_peak(self, leg: int) -> float:
        """Largest axial acceleration at the top within 12 ms after that leg's contact [m/s2]."""
        return self._at(self.h["body.top_axial_acceleration"], self._acceleration(leg))

    def acceleration_peak_time(self, leg: int) -> float:
        """Time of that acceleration [s]."""
        return self._at(self.t, self._acceleration(leg))

    def rest_time(self, _leg: int) -> float:
        """Last time at which the pitch is more than 0.5 deg off its final mean [s].

        The mean is over the last 0.1 s.
        """
        return self._rest()

    def _rest(self) -> float:
        pitch = self.h["body.pitch"]
        settled = pitch[self._between(self.end - 0.1, self.end)].mean()
        moving = np.flatnonzero((np.abs(pitch - settled) > REST_ANGLE) & (self.t <= self.end))
        return float(self.t[moving[-1]]) if len(moving) else 0.0
