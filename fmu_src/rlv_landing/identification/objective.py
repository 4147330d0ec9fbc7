"""The misfits that an identification makes small: to numbers, to curves, and to the conditions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError
from ..parameters import Parameters
from ..quantities import MODES
from .conditions import CONDITIONS, Condition
from .counting.soft_count import TOLERANCE, SoftCount
from .free_numbers import FreeNumbers
from .measured.series import Series
from .targets import Landed, Wanted, paper_targets, targets_of_tests

LARGEST_MISFIT = 2.0


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

    Raises:
        LandingError: Curves lie outside the landing of their mode, as `Series.check_times`.
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
        for s in self.series:
            s.check_times(free.base.for_mode(s.mode).drop.contact_time)
        self.soft_count = SoftCount(
            len(self.targets),
            len(self.modes) * len(self.conditions),
            tuple(t.weight for t in self.targets),
        )
        self.labels = [t.label for t in self.targets]
        self.labels += [
            f"{s.mode}: {n} at {t:g} s"
            for s in self.series
            for n in s.curves.names
            for t in s.curves.time[s.samples]
        ]
        self.labels += [f"{m}: {c.name}" for m in self.modes for c in self.conditions]

    @property
    def of_paper(self) -> bool:
        """Whether the targets are just what the paper prints of the modes that are fitted."""
        printed = targets_of_tests() if self.sensors else paper_targets()
        return not self.series and self.targets == tuple(t for t in printed if t.mode in self.modes)

    def fingerprint(self) -> str:
        """A digest of the curves and of the values that the search starts from, free or not."""
        base = self.free.base
        digest = sha256(repr([list(base.for_mode(mode).items()) for mode in self.modes]).encode())
        for s in self.series:
            digest.update(s.curves.time.tobytes() + s.curves.data.tobytes())
        return digest.hexdigest()

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
        landings = {mode: self.landing(parameters, mode) for mode in self.modes}
        found = self._scalar_misfits(landings)
        for s in self.series:
            found += s.misfits(landings[s.mode].history)
        found += [
            c.departure(landings[mode].history) for mode in self.modes for c in self.conditions
        ]
        return np.array(found)

    def _scalar_misfits(self, landings: dict[str, Landed]) -> list[float]:
        ours: dict[str, float] = {}
        for mode, landing in landings.items():
            own = [t for t in self.targets if t.mode == mode]
            ours.update(zip((t.label for t in own), landing.read(own) if own else ()))
        found = []
        for t in self.targets:
            error = (ours[t.label] - t.value) / t.scale
            found.append(t.weight * (error if np.isfinite(error) else LARGEST_MISFIT) / TOLERANCE)
        return found

    def landing(self, parameters: Parameters, mode: str) -> Landed:
        """The landing of `parameters` in one of the modes, as long as the curves need it."""
        end = max([0.0, *(s.end for s in self.series if s.mode == mode)])
        return Landed(parameters, mode, end, sensors=self.sensors)

    def loss(self, z: Iterable[float]) -> float:
        """Cauchy's loss at `z`, as `cauchy_loss`."""
        return cauchy_loss(self.misfits(z))

    def missed(self, misfits: NDArray[np.float64]) -> float:
        """The softly counted misses among `misfits`, as `SoftCount.missed`."""
        return self.soft_count.missed(misfits)


def cauchy_loss(misfits: NDArray[np.float64]) -> float:
    """The sum of ln(1 + misfit^2): a few misfits that stay large do not dominate."""
    return float(np.log1p(misfits**2).sum())
