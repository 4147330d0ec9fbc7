"""The misfits that an identification makes small: to numbers, to curves, and to the conditions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..history import History
from ..parameters import Parameters
from ..quantities import MODES
from .conditions import CONDITIONS, Condition
from .free_numbers import FreeNumbers
from .soft_count import TOLERANCE, SoftCount
from .targets import Wanted, landed, read, reading_of

LARGEST_MISFIT = 2.0
CURVE_SAMPLES = 100


@dataclass(frozen=True)
class Series:
    """Measured curves of one landing of `mode`.

    Raises:
        LandingError: The mode is unknown.
    """

    mode: str
    curves: History

    def __post_init__(self) -> None:
        if self.mode not in MODES:
            raise unknown("landing mode", self.mode, MODES)

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
            ours = np.interp(self.curves.time[at], history.time, history[name])
            scale = TOLERANCE * np.sqrt(np.mean(wanted**2) * len(at))
            found += ((ours - wanted[at]) / scale).tolist()
        return found


class Objective:
    """Misfits of landings as a vector, for numbers on the unit cube.

    The landings are those of both modes, or of the modes that have targets or curves. There is one
    misfit for each scalar, then one for each sample of a curve, then one for each condition.

    Args:
        free: The free numbers.
        targets: The scalars to reach.
        series: The curves to reach.
        conditions: The conditions; the default's limits are those of the paper's prototype.
        sensors: Whether to read scalars from what the tests' sensors would have recorded
            (`rlv_landing.validation.sensors`), as fits the tests' numbers.
    """

    def __init__(
        self,
        free: FreeNumbers,
        targets: Iterable[Wanted],
        series: Iterable[Series] = (),
        conditions: Sequence[Condition] = CONDITIONS,
        *,
        sensors: bool = False,
    ) -> None:
        self.free = free
        self.targets = tuple(targets)
        self.series = tuple(series)
        self.conditions = tuple(conditions)
        self.sensors = sensors
        present = {t.mode for t in self.targets} | {s.mode for s in self.series}
        self.modes = [m for m in MODES if m in present]
        self.soft_count = SoftCount(len(self.targets), len(self.modes) * len(self.conditions))
        self.labels = [t.id for t in self.targets]
        self.labels += [
            f"{s.mode}: {n} at {t:g} s"
            for s in self.series
            for n in s.curves.names
            for t in s.curves.time[s.samples]
        ]
        self.labels += [f"{m}: {c.name}" for m in self.modes for c in self.conditions]

    def misfits(self, z: Iterable[float]) -> NDArray[np.float64]:
        """The misfits at `z`, one for each of `labels`.

        A misfit of size one is just acceptable. All are large where nothing lands.
        """
        try:
            return self._misfits(self.free.parameters(list(z)))
        except (LandingError, ArithmeticError, IndexError, ValueError):
            # what cannot be landed or read (no contact, no valley) is as bad as can be
            return np.full(len(self.labels), LARGEST_MISFIT / TOLERANCE)

    def _misfits(self, parameters: Parameters) -> NDArray[np.float64]:
        histories = {mode: self._land(parameters, mode) for mode in self.modes}
        found = self._scalar_misfits(histories)
        for s in self.series:
            found += s.misfits(histories[s.mode])
        found += [c.departure(histories[mode]) for mode in self.modes for c in self.conditions]
        return np.array(found)

    def _scalar_misfits(self, histories: dict[str, History]) -> list[float]:
        readings = {
            mode: reading_of(history, sensors=self.sensors)
            for mode, history in histories.items()
            if any(t.mode == mode for t in self.targets)
        }
        found = []
        for t in self.targets:
            error = (read(readings[t.mode], t) - t.value) / t.scale
            found.append((error if np.isfinite(error) else LARGEST_MISFIT) / TOLERANCE)
        return found

    def _land(self, parameters: Parameters, mode: str) -> History:
        end = max([0.0, *(float(s.curves.time[-1]) for s in self.series if s.mode == mode)])
        return landed(parameters, mode, end)

    def loss(self, z: Iterable[float]) -> float:
        """Cauchy's loss at `z`, as `cauchy_loss`."""
        return cauchy_loss(self.misfits(z))

    def missed(self, misfits: NDArray[np.float64]) -> float:
        """The softly counted misses among `misfits`, as `SoftCount.missed`."""
        return self.soft_count.missed(misfits)


def cauchy_loss(misfits: NDArray[np.float64]) -> float:
    """The sum of ln(1 + misfit^2): a few misfits that nothing can mend do not spoil the rest."""
    return float(np.log1p(misfits**2).sum())
