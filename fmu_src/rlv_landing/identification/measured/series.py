"""Measured curves that an identification wants to reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import LandingError, unknown
from ...history import History
from ...quantities import MODES, OUTPUTS_BY_NAME, shown
from ..counting.soft_count import TOLERANCE

Vector = NDArray[np.float64]
CURVE_SAMPLES = 100
# the time after the first contact [s] by which curves of a landing have begun, and have ended
LATEST_START, LATEST_END = 5.0, 30.0


@dataclass(frozen=True)
class CurveFit:
    """One measured curve beside that of a landing.

    Attributes:
        mode: The landing mode.
        name: The output.
        unit: The unit of `rms` and `largest`.
        samples: The number of its samples.
        rms: The root mean square of ours - measured, over all samples.
        largest: The largest magnitude of ours - measured.
        relative: `rms` as a part of the measured curve's own root mean square.
    """

    mode: str
    name: str
    unit: str
    samples: int
    rms: float
    largest: float
    relative: float


@dataclass(frozen=True)
class Series:
    """Measured curves of one landing of `mode`.

    Raises:
        LandingError: The mode is unknown, or a curve is 0 throughout.
    """

    mode: str
    curves: History

    def __post_init__(self) -> None:
        if self.mode not in MODES:
            raise unknown("landing mode", self.mode, MODES)
        for name in self.curves.names:
            if not np.any(self.curves[name]):
                raise LandingError(
                    f"{name} of {self.mode} is 0 throughout, and differences from it have no size "
                    "to be judged on; leave the column out"
                )

    @property
    def end(self) -> float:
        """The time of the last sample [s]."""
        return float(self.curves.time[-1])

    def check_times(self, contact: float) -> None:
        """Check that the curves lie in a landing whose first contact is at `contact` [s].

        Raises:
            LandingError: They begin before the landing, or too late, or end too late.
        """
        start, end = float(self.curves.time[0]), self.end
        at = f"the first contact is at drop.contact_time = {contact:g} s"
        shift = "shift the times so that the curves' first contact is there, or set it to theirs"
        if start < 0.0:
            raise LandingError(
                f"curves of {self.mode} begin at {start:g} s, before the landing at 0 s; leave "
                f"those rows out, or {at}: {shift}"
            )
        if start > contact + LATEST_START:
            raise LandingError(
                f"curves of {self.mode} begin at {start:g} s, but {at}; {shift} "
                f"(at most {LATEST_START:g} s after it they must have begun)"
            )
        if end > contact + LATEST_END:
            raise LandingError(
                f"curves of {self.mode} end at {end:g} s, more than {LATEST_END:g} s after the "
                f"contact at {contact:g} s; leave out what comes after the landing"
            )

    @property
    def samples(self) -> NDArray[np.intp]:
        """The samples that are compared: all, or CURVE_SAMPLES spread over the curve."""
        count = min(len(self.curves), CURVE_SAMPLES)
        return np.unique(np.linspace(0, len(self.curves) - 1, count).round().astype(np.intp))

    def misfits(self, history: History) -> list[float]:
        """The misfits of a landing, column by column.

        The squares of a column's misfits add up to its relative mean square over TOLERANCE^2.
        """
        at, found = self.samples, []
        for name in self.curves.names:
            wanted = self.curves[name]
            scale = TOLERANCE * np.sqrt(np.mean(wanted**2) * len(at))
            found += (self._differences(history, name)[at] / scale).tolist()
        return found

    def fits(self, history: History) -> list[CurveFit]:
        """Each curve beside that of a landing, in the unit that people read."""
        found = []
        for name in self.curves.names:
            off, (unit, size) = self._differences(history, name), shown(OUTPUTS_BY_NAME[name])
            rms = float(np.sqrt(np.mean(off**2)))
            own = float(np.sqrt(np.mean(self.curves[name] ** 2)))
            largest = float(np.abs(off).max()) / size
            found.append(CurveFit(self.mode, name, unit, len(off), rms / size, largest, rms / own))
        return found

    def _differences(self, history: History, name: str) -> Vector:
        """Ours less the measured values, at the measured times."""
        return np.interp(self.curves.time, history.time, history[name]) - self.curves[name]
