"""The numbers that an identification wants to reach, and those that landings reach of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import LandingError, unknown
from ..history import History
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import MODES, Quantity
from ..text.files import read_csv
from ..text.units import parse_unit
from ..text.values import parse_value
from ..validation.paper import MEANINGS, RUN_AFTER_CONTACT, Reading, printed_scalars
from ..validation.sensors import SAMPLING, through_sensors

# peaks of a contact are read wrong by up to 10 % at 1 kHz: landings are read at the tests' sampling
EVERY = 1.0 / SAMPLING
# units of the paper's numbers
SI_UNITS = {"N": "N", "s": "s", "mm": "m", "m/s2": "m/s2"}
FIELDS = ("id", "value", "unit")


@dataclass(frozen=True)
class Wanted:
    """A number to be reached.

    Attributes:
        id: The id of the printed scalar that it stands for.
        mode: The landing mode.
        value: The value wanted, in the scalar's unit (N, s, mm, m/s2).
        scale: The scale on which a difference is judged, in the same unit.
    """

    id: str
    mode: str
    value: float
    scale: float


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
    return [Wanted(s.id, s.mode, s.simulation, s.scale) for s in printed_scalars()]


def targets_of_tests() -> list[Wanted]:
    """The 35 numbers that the paper prints of its tests, on the scale that judges them.

    Where it prints two tests, the mean.
    """
    return [
        Wanted(s.id, s.mode, s.test, s.scale) for s in printed_scalars() if not np.isnan(s.test)
    ]


def read_targets(path: Path) -> list[Wanted]:
    """Targets from a CSV file `id,value,unit`.

    Ids are the paper's (`rlv-landing validate` prints them), values measured ones in any unit of
    the id's dimension.

    Raises:
        LandingError: There is no such file or column, an id is unknown, or a value is not a finite
            number or has the wrong unit.
    """
    targets = [_target(path, line, row) for line, row in _rows(path)]
    if not targets:
        raise LandingError(f"{path} holds no targets; write a line for each: id,value,unit")
    return targets


def _target(path: Path, line: int, row: dict[str, str]) -> Wanted:
    known = {s.id: s for s in printed_scalars()}
    for field in FIELDS:
        if not row.get(field):
            raise LandingError(f"{path}, line {line}: no {field}; columns are {', '.join(FIELDS)}")
    if row["id"] not in known:
        raise unknown(f"scalar in {path}, line {line},", row["id"], known)
    s = known[row["id"]]
    q = Quantity(SI_UNITS[s.unit], s.quantity, name=s.id, display_unit=s.unit)
    try:
        value = parse_unit(s.unit).from_si(float(parse_value(q, row["value"], row["unit"])))
    except LandingError as e:
        raise LandingError(f"{path}, line {line}: {e}") from None
    near_zero = abs(value) < 0.1 * s.scale
    return Wanted(s.id, s.mode, value, s.scale if near_zero else abs(value))


def _rows(path: Path) -> Iterable[tuple[int, dict[str, str]]]:
    names: list[str] = []
    for line, row in read_csv(
        path, "targets", f"targets {path} cannot be read: there is no such file"
    ):
        cells = [cell.strip() for cell in row]
        if names:
            yield line, dict(zip(names, cells))
        else:
            names = cells


def landed(parameters: Parameters, mode: str, end: float = 0.0) -> History:
    """The history of a landing in `mode`, at 5 kHz.

    It lasts as long as the paper's scalars need it, or until `end` [s] if that is later.

    Raises:
        LandingError: As `Landing`.
    """
    own = parameters.for_mode(mode)
    return Landing(own).run(max(own.drop.contact_time + RUN_AFTER_CONTACT + 0.02, end), EVERY)


def reading_of(history: History, *, sensors: bool) -> Reading:
    """The reading of a history, or of what the tests' sensors would have recorded of it.

    Raises:
        LandingError: As `Reading`.
    """
    return Reading(through_sensors(history) if sensors else history)


def read(reading: Reading, wanted: Wanted) -> float:
    """The number of a landing that stands beside the wanted one, in its unit; NaN if none."""
    meaning, leg = MEANINGS[wanted.id]
    return meaning(reading, leg)


def fit_of(parameters: Parameters, wanted: Iterable[Wanted], *, sensors: bool = False) -> list[Fit]:
    """What landings of `parameters` reach of the wanted numbers.

    Args:
        parameters: The parameters.
        wanted: The numbers wanted.
        sensors: Whether to read what the tests' sensors would have recorded.

    Raises:
        LandingError: As `Landing` and `Reading`.
    """
    wanted = list(wanted)
    readings = {
        mode: reading_of(landed(parameters, mode), sensors=sensors)
        for mode in MODES
        if any(t.mode == mode for t in wanted)
    }
    return [Fit(t, read(readings[t.mode], t)) for t in wanted]
