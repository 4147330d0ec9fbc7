"""What an identification makes small: misfits to printed or measured numbers, and departures from
sense.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..history import History
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import MODES, Quantity
from ..text_files import read_csv
from ..units import parse_unit
from ..validation.paper import MEANINGS, RUN_AFTER_CONTACT, Reading, compare, printed_scalars
from ..values import parse_value
from .priors import FreeNumbers

# a misfit of this size counts as one: below it, scalars are as good as reached
TOLERANCE = 0.045
LARGEST_MISFIT = 2.0
CURVE_SAMPLES = 100
EVERY = 1e-3
RTOL = 1e-5
# units of the paper's numbers
SI_UNITS = {"N": "N", "s": "s", "mm": "m", "m/s2": "m/s2"}
FIELDS = ("id", "value", "unit")


@dataclass(frozen=True)
class Condition:
    """Sense that a landing must make: `measure` of its history at most `limit`; a departure by
    `scale` counts as a misfit of one.
    """

    name: str
    unit: str
    limit: float
    scale: float
    reason: str
    measure: Callable[[History], float]


def _switches(history: History) -> float:
    return float(
        max(np.abs(np.diff(history[f"leg[{leg}].contact.active"])).sum() for leg in (1, 2, 3))
    )


def _extreme(name: str, sign: float) -> Callable[[History], float]:
    return lambda history: float(
        max((sign * history[f"leg[{leg}].{name}"]).max() for leg in (1, 2, 3))
    )


def _auxiliary_stroke(history: History) -> float:
    return float(
        max(np.abs(history[f"leg[{leg}].auxiliary_strut.stroke"]).max() for leg in (1, 2, 3))
    )


CONDITIONS: tuple[Condition, ...] = (
    Condition(
        "over-extension",
        "m",
        2e-4,
        1e-4,
        "a piston rests on its stop",
        _extreme("main_strut.stroke", -1.0),
    ),
    Condition(
        "contact switches of a leg",
        "",
        4.0,
        2.0,
        "a footpad lands, may lift once, and does not chatter",
        _switches,
    ),
    Condition(
        "lower chamber's pressure",
        "Pa",
        3.5e7,
        5e6,
        "what a reciprocating rod seal holds",
        _extreme("main_strut.pressure_lower", 1.0),
    ),
    Condition(
        "auxiliary strut's stroke",
        "m",
        1.6e-3,
        3e-4,
        "4.9 kN on a twelfth of an aluminium strut's stiffness",
        _auxiliary_stroke,
    ),
    Condition(
        "penetration",
        "m",
        2.5e-3,
        5e-4,
        "a footpad does not sink into a test floor",
        _extreme("contact.penetration", 1.0),
    ),
)


@dataclass(frozen=True)
class Wanted:
    """A number to be reached: a printed scalar's id and the `value` it shall have, in its unit (N,
    s, mm, m/s2).
    """

    id: str
    mode: str
    value: float
    scale: float


def paper_targets() -> list[Wanted]:
    """The 48 numbers that the paper prints for its simulation, on the scale on which they are
    judged.
    """
    return [Wanted(s.id, s.mode, s.simulation, s.scale) for s in printed_scalars()]


def read_targets(path: Path) -> list[Wanted]:
    """Targets from a CSV file `id,value,unit`: the paper's ids (`rlv-landing validate`), measured
    values, in any unit of the ids' dimension.

    Raises LandingError: missing file or columns, unknown id, a wrong unit, a value that is not a
        finite number.
    """
    known = {s.id: s for s in printed_scalars()}
    targets = []
    for line, row in _rows(path):
        for field in FIELDS:
            if not row.get(field):
                raise LandingError(
                    f"{path}, line {line}: no {field}; columns are {', '.join(FIELDS)}"
                )
        if row["id"] not in known:
            raise unknown(f"scalar in {path}, line {line},", row["id"], known)
        s = known[row["id"]]
        q = Quantity(SI_UNITS[s.unit], s.quantity, name=s.id, display_unit=s.unit)
        try:
            value = parse_unit(s.unit).from_si(float(parse_value(q, row["value"], row["unit"])))
        except LandingError as e:
            raise LandingError(f"{path}, line {line}: {e}") from None
        targets.append(
            Wanted(
                s.id, s.mode, value, max(abs(value), s.scale if abs(value) < 0.1 * s.scale else 0.0)
            )
        )
    if not targets:
        raise LandingError(f"{path} holds no targets; write a line for each: id,value,unit")
    return targets


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


@dataclass(frozen=True)
class Series:
    """Measured curves of one landing of `mode`. Raises LandingError for an unknown mode."""

    mode: str
    curves: History

    def __post_init__(self) -> None:
        if self.mode not in MODES:
            raise unknown("landing mode", self.mode, MODES)

    @property
    def samples(self) -> NDArray[np.intp]:
        """The samples that are compared: all, or CURVE_SAMPLES spread over the curve."""
        return np.unique(
            np.linspace(0, len(self.curves) - 1, min(len(self.curves), CURVE_SAMPLES))
            .round()
            .astype(np.intp)
        )


class Objective:
    """Misfits of the landings of both modes (or of those that have targets) as a vector, for
    numbers on the unit cube.

    One for each scalar; for curves one a sample, so that the squares of a curve's misfits add up to
    its relative mean square.

    `conditions` hold the landings to sense; their limits are those of the paper's prototype.
    """

    def __init__(
        self,
        free: FreeNumbers,
        targets: Iterable[Wanted],
        series: Iterable[Series] = (),
        conditions: Sequence[Condition] = CONDITIONS,
    ) -> None:
        self.free = free
        self.targets = tuple(targets)
        self.series = tuple(series)
        self.conditions = tuple(conditions)
        present = {t.mode for t in self.targets} | {s.mode for s in self.series}
        self.modes = [m for m in MODES if m in present]
        self.labels = [t.id for t in self.targets]
        self.labels += [
            f"{s.mode}: {n} at {t:g} s"
            for s in self.series
            for n in s.curves.names
            for t in s.curves.time[s.samples]
        ]
        self.labels += [f"{m}: {c.name}" for m in self.modes for c in self.conditions]

    def misfits(self, z: Iterable[float]) -> NDArray[np.float64]:
        """One number a target, series column and condition; of size one where it is just
        acceptable. All large where nothing lands.
        """
        try:
            return self._misfits(self.free.parameters(list(z)))
        except (LandingError, ArithmeticError, IndexError, ValueError):
            # what cannot be landed or read (no contact, no valley) is as bad as can be
            return np.full(len(self.labels), LARGEST_MISFIT / TOLERANCE)

    def _misfits(self, parameters: Parameters) -> NDArray[np.float64]:
        histories = {mode: self._land(parameters, mode) for mode in self.modes}
        readings = {
            mode: Reading(h)
            for mode, h in histories.items()
            if any(t.mode == mode for t in self.targets)
        }
        found = []
        for t in self.targets:
            read, leg = MEANINGS[t.id]
            error = (read(readings[t.mode], leg) - t.value) / t.scale
            found.append((error if np.isfinite(error) else LARGEST_MISFIT) / TOLERANCE)
        for s in self.series:
            at = s.samples
            for name in s.curves.names:
                wanted = s.curves[name]
                ours = np.interp(s.curves.time[at], histories[s.mode].time, histories[s.mode][name])
                scale = TOLERANCE * np.sqrt(np.mean(wanted**2) * len(at))
                found += ((ours - wanted[at]) / scale).tolist()
        for mode in self.modes:
            for c in self.conditions:
                found.append(max(0.0, (c.measure(histories[mode]) - c.limit) / c.scale))
        return np.array(found)

    def _land(self, parameters: Parameters, mode: str) -> History:
        own = parameters.for_mode(mode)
        end = own.drop.contact_time + RUN_AFTER_CONTACT + 0.02
        end = max([end, *(float(s.curves.time[-1]) for s in self.series if s.mode == mode)])
        return Landing(own, rtol=RTOL).run(end, EVERY)

    def loss(self, z: Iterable[float]) -> float:
        """Sum of ln(1 + misfit^2): a few misfits that nothing can mend do not spoil the rest
        (Cauchy's loss).
        """
        return float(np.log1p(self.misfits(z) ** 2).sum())


def fit_of(parameters: Parameters, every: float = 2e-4) -> list[tuple[str, float, float, float]]:
    """(id, wanted, ours, error) of every scalar that the paper prints, at full accuracy."""
    rows = []
    for mode in MODES:
        own = parameters.for_mode(mode)
        history = Landing(own).run(own.drop.contact_time + RUN_AFTER_CONTACT + 0.02, every)
        rows += [
            (c.scalar.id, c.scalar.simulation, c.ours, c.error) for c in compare(history, mode)
        ]
    return rows
