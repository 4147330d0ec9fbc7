"""The numbers that an identification wants to reach, and those that landings reach of them.

They are scalars that the paper prints, or responses of sweeps, such as
`leg[1].main_strut.force.min`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..history import History, joined
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import MODES
from ..studies.sweep.responses import Measure
from ..studies.whole_landing import whole_landing
from ..text.units import DIMENSIONLESS, parse_unit
from ..validation.paper import MEANINGS, RUN_AFTER_CONTACT, Reading, printed_scalars
from ..validation.sensors import SAMPLING, through_sensors

# peaks of a contact are read wrong by up to 10 % at 1 kHz: landings are read at the tests' sampling
EVERY = 1.0 / SAMPLING


@dataclass(frozen=True)
class Wanted:
    """A number to be reached.

    Attributes:
        id: The id of a printed scalar, or the name of a response of sweeps.
        mode: The landing mode.
        value: The value wanted, in `unit`.
        scale: The scale on which a difference is judged, in `unit`.
        unit: The unit: a printed scalar's own (N, s, mm, m/s2), of a response any of its dimension.
        weight: A factor of its misfit.
    """

    id: str
    mode: str
    value: float
    scale: float
    unit: str = ""
    weight: float = 1.0

    @property
    def printed(self) -> bool:
        """Whether it is one of the scalars that the paper prints."""
        return self.id in MEANINGS

    @property
    def label(self) -> str:
        """Its id; a response's with its landing mode."""
        return self.id if self.printed else f"{self.mode}: {self.id}"


@dataclass(frozen=True)
class Fit:
    """One number wanted beside that of a landing, in its unit; NaN where the landing has none."""

    wanted: Wanted
    ours: float

    @property
    def error(self) -> float:
        """(ours - wanted)/scale."""
        return (self.ours - self.wanted.value) / self.wanted.scale

    @property
    def plain_error(self) -> float:
        """(ours - wanted)/|wanted|, however near to zero that is; NaN where it is zero."""
        return (self.ours - self.wanted.value) / (abs(self.wanted.value) or float("nan"))


def paper_targets() -> list[Wanted]:
    """The 48 numbers that the paper prints of its simulation, on the scale that judges them."""
    return [Wanted(s.id, s.mode, s.simulation, s.scale, s.unit) for s in printed_scalars()]


def targets_of_tests() -> list[Wanted]:
    """The 35 numbers that the paper prints of its tests, on the scale that judges them.

    Where it prints two tests, the mean.
    """
    return [
        Wanted(s.id, s.mode, s.test, s.scale, s.unit)
        for s in printed_scalars()
        if not np.isnan(s.test)
    ]


def landed(parameters: Parameters, mode: str, end: float = 0.0) -> History:
    """The history of a landing in `mode`, at 5 kHz.

    It lasts as long as the paper's scalars need it, or until `end` [s] if that is later.

    Raises:
        LandingError: As `Landing`.
    """
    own = parameters.for_mode(mode)
    return Landing(own).run(max(own.drop.contact_time + RUN_AFTER_CONTACT + 0.02, end), EVERY)


class Landed:
    """The landing of `parameters` in one mode, run when it is first needed.

    Args:
        parameters: The parameters.
        mode: The landing mode.
        end: The time [s] until which curves need the landing.
        sensors: Whether to read numbers from what the tests' sensors would have recorded.
    """

    def __init__(
        self, parameters: Parameters, mode: str, end: float = 0.0, *, sensors: bool = False
    ) -> None:
        self._parameters = parameters
        self._mode = mode
        self._end = end
        self._sensors = sensors

    @cached_property
    def history(self) -> History:
        """The landing as long as the paper's scalars and the curves need it, see `landed`."""
        return landed(self._parameters, self._mode, self._end)

    @cached_property
    def reading(self) -> Reading:
        """The reading of the paper's scalars."""
        return Reading(self._sensed(self.history))

    @cached_property
    def _whole(self) -> History:
        """The landing until it is decided, as in sweeps."""
        own = self._parameters.for_mode(self._mode)
        return self._sensed(whole_landing(Landing(own), every=EVERY))

    def _sensed(self, history: History) -> History:
        """What the sensors recorded of a landing.

        What still rocks when its samples become coarser is far slower than their filters, and is
        joined as it is.
        """
        if not self._sensors:
            return history
        coarser = np.flatnonzero(np.diff(history.time) > 1.5 * EVERY)
        last = int(coarser[0]) if len(coarser) else len(history) - 1
        sensed = through_sensors(_part(history, 0, last + 1))
        return joined([sensed, _part(history, last, len(history))])

    def read(self, wanted: Sequence[Wanted]) -> list[float]:
        """The numbers that stand beside those wanted, in their units; NaN where there is none.

        Raises:
            LandingError: As `Landing` and `Reading`.
        """
        names = [t.id for t in wanted if not t.printed]
        found = dict(zip(names, Measure(names)(self._whole, 0))) if names else {}
        return [self._printed(t) if t.printed else _in_unit(t, found[t.id]) for t in wanted]

    def _printed(self, wanted: Wanted) -> float:
        meaning, leg = MEANINGS[wanted.id]
        return meaning(self.reading, leg)


def _part(history: History, first: int, last: int) -> History:
    """The samples from `first` up to, not including, `last`."""
    of = slice(first, last)
    return History(history.time[of], history.names, history.data[of], history.parameters)


def _in_unit(wanted: Wanted, value: float | None) -> float:
    if value is None or not np.isfinite(value):
        return float("nan")
    return (parse_unit(wanted.unit) if wanted.unit else DIMENSIONLESS).from_si(float(value))


def fit_of(parameters: Parameters, wanted: Iterable[Wanted], *, sensors: bool = False) -> list[Fit]:
    """The numbers that landings of `parameters` reach, beside the wanted ones, mode by mode.

    Args:
        parameters: The parameters.
        wanted: The numbers wanted.
        sensors: Whether to read what the tests' sensors would have recorded.

    Raises:
        LandingError: As `Landing` and `Reading`.
    """
    wanted = list(wanted)
    fits = []
    for mode in MODES:
        own = [t for t in wanted if t.mode == mode]
        if own:
            fits += list(map(Fit, own, Landed(parameters, mode, sensors=sensors).read(own)))
    return fits
