"""What an identification makes small: misfits to printed or measured numbers, and departures from sense."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..history import History
from ..landing import Landing
from ..paper import LEVELS, MEANINGS, RUN_AFTER_CONTACT, Reading, printed_scalars
from ..parameters import AuxiliaryStrut, Parameters
from ..quantities import LEGS, MODES
from ..sensors import SAMPLING, through_sensors
from .priors import FreeNumbers

# a misfit of this size counts as one: below it, scalars are as good as reached
TOLERANCE = 0.045
LARGEST_MISFIT = 2.0
CURVE_SAMPLES = 100
# peaks of a contact are read wrong by up to 10 % at 1 kHz: read at the tests' own sampling
EVERY = 1.0 / SAMPLING
FIELDS = ("id", "value", "unit")
# in counting: what a miss of each bound costs, most that of the widest, for there a feature of the curve is missed and not a digit; what
# a condition's misfit of one costs, far more; the misfit below which its pull grows no further; the part of Cauchy's loss that draws
# scalars far from every bound
WORTH = (1.0, 2.0, 4.0)
CONDITION_PRICE, NEAR_CONDITION, FAR_PULL = 30.0, 0.05, 0.05
BOUNDS = tuple(level / 100.0 for level in LEVELS)


@dataclass(frozen=True)
class Condition:
    """Sense that a landing must make: `measure` of its history at most `limit`; a departure by `scale` counts as a misfit of one."""

    name: str
    unit: str
    limit: float
    scale: float
    reason: str
    measure: Callable[[History], float]


def _switches(history: History) -> float:
    return float(max(np.abs(np.diff(history[f"leg[{leg}].contact.active"])).sum() for leg in (1, 2, 3)))


def _extreme(name: str, sign: float) -> Callable[[History], float]:
    return lambda history: float(max((sign * history[f"leg[{leg}].{name}"]).max() for leg in (1, 2, 3)))


def _auxiliary_yield(history: History) -> float:
    """The largest elastic stroke [m]: what is left of the stroke once the joints' play has been taken up on that side."""
    own = history.parameters.auxiliary_strut if history.parameters is not None else AuxiliaryStrut()
    strokes = [history[f"leg[{leg}].auxiliary_strut.stroke"] for leg in LEGS]
    return float(max(max(s.max() - own.play_compression, -s.min() - own.play_tension) for s in strokes))


CONDITIONS: tuple[Condition, ...] = (
    Condition("over-extension", "m", 2e-4, 1e-4, "a piston rests on its stop", _extreme("main_strut.stroke", -1.0)),
    Condition("contact switches of a leg", "", 4.0, 2.0, "a footpad lands, may lift once, and does not chatter", _switches),
    Condition(
        "lower chamber's pressure", "Pa", 3.5e7, 5e6, "what a reciprocating rod seal holds", _extreme("main_strut.pressure_lower", 1.0)
    ),
    Condition("auxiliary strut's yield", "m", 1.6e-3, 3e-4, "4.9 kN on a twelfth of an aluminium strut, play apart", _auxiliary_yield),
    Condition("penetration", "m", 2.5e-3, 5e-4, "a footpad does not sink into a test floor", _extreme("contact.penetration", 1.0)),
)


@dataclass(frozen=True)
class Wanted:
    """A number to be reached: a printed scalar's id and the `value` it shall have, in its unit (N, s, mm, m/s2)."""

    id: str
    mode: str
    value: float
    scale: float


def paper_targets() -> list[Wanted]:
    """The 48 numbers that the paper prints for its simulation, on the scale on which they are judged."""
    return [Wanted(s.id, s.mode, s.simulation, s.scale) for s in printed_scalars()]


def targets_of_tests() -> list[Wanted]:
    """The 35 numbers that the paper prints of its tests (the mean where it prints two), on the scale on which they are judged."""
    return [Wanted(s.id, s.mode, s.test, s.scale) for s in printed_scalars() if not np.isnan(s.test)]


def read_targets(path: Path) -> list[Wanted]:
    """Targets from a CSV file `id,value,unit`: the paper's ids (`rlv-landing validate`), measured values, in the ids' own units.

    Raises LandingError: missing file or columns, unknown id, another unit, a value that is not a finite number.
    """
    known = {s.id: s for s in printed_scalars()}
    targets = []
    for line, row in _rows(path):
        for field in FIELDS:
            if not row.get(field):
                raise LandingError(f"{path}, line {line}: no {field}; columns are {', '.join(FIELDS)}")
        if row["id"] not in known:
            raise unknown(f"scalar in {path}, line {line},", row["id"], known)
        s = known[row["id"]]
        if row["unit"] != s.unit:
            raise LandingError(f"{path}, line {line}: {s.id} is in {row['unit']!r}; give it in {s.unit}")
        value = _finite(row["value"], f"{path}, line {line}: {s.id}", s.unit)
        targets.append(Wanted(s.id, s.mode, value, max(abs(value), s.scale if abs(value) < 0.1 * s.scale else 0.0)))
    if not targets:
        raise LandingError(f"{path} holds no targets; write a line for each: id,value,unit")
    return targets


def _rows(path: Path) -> Iterable[tuple[int, dict[str, str]]]:
    try:
        with path.open(newline="", encoding="utf-8") as f:
            return [(i + 2, row) for i, row in enumerate(csv.DictReader(f))]
    except OSError as e:
        raise LandingError(f"{path} cannot be read: {e.strerror or e}") from None


def _finite(text: str, what: str, unit: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise LandingError(f"{what} = {text!r} is not a number; give it in {unit}") from None
    if not np.isfinite(value):
        raise LandingError(f"{what} = {value:g} {unit} must be finite")
    return value


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
        return np.unique(np.linspace(0, len(self.curves) - 1, min(len(self.curves), CURVE_SAMPLES)).round().astype(np.intp))


class Objective:
    """Misfits of the landings of both modes (or of those that have targets) as a vector, for numbers on the unit cube.

    One for each scalar; for curves one a sample, so that the squares of a curve's misfits add up to its relative mean square.

    `conditions` hold the landings to sense; their limits are those of the paper's prototype. With `sensors`, scalars are read off what
    the tests' sensors would have recorded of a landing (`rlv_landing.sensors`), as fits the tests' numbers.
    """

    def __init__(
        self, free: FreeNumbers, targets: Iterable[Wanted], series: Iterable[Series] = (), conditions: Sequence[Condition] = CONDITIONS,
        *, sensors: bool = False,
    ) -> None:  # fmt: skip
        self.sensors = sensors
        self.free = free
        self.targets = tuple(targets)
        self.series = tuple(series)
        self.conditions = tuple(conditions)
        present = {t.mode for t in self.targets} | {s.mode for s in self.series}
        self.modes = [m for m in MODES if m in present]
        self.labels = [t.id for t in self.targets]
        self.labels += [f"{s.mode}: {n} at {t:g} s" for s in self.series for n in s.curves.names for t in s.curves.time[s.samples]]
        self.labels += [f"{m}: {c.name}" for m in self.modes for c in self.conditions]

    def misfits(self, z: Iterable[float]) -> NDArray[np.float64]:
        """One number a target, series column and condition; of size one where it is just acceptable. All large where nothing lands."""
        try:
            return self._misfits(self.free.parameters(list(z)))
        except (LandingError, ArithmeticError, IndexError, ValueError):
            # what cannot be landed or read (no contact, no valley) is as bad as can be
            return np.full(len(self.labels), LARGEST_MISFIT / TOLERANCE)

    def _misfits(self, parameters: Parameters) -> NDArray[np.float64]:
        histories = {mode: self._land(parameters, mode) for mode in self.modes}
        readings = {mode: self._reading(h) for mode, h in histories.items() if any(t.mode == mode for t in self.targets)}
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

    def _reading(self, history: History) -> Reading:
        return Reading(through_sensors(history) if self.sensors else history)

    def _land(self, parameters: Parameters, mode: str) -> History:
        end = max([0.0, *(float(s.curves.time[-1]) for s in self.series if s.mode == mode)])
        return landed(parameters, mode, end)

    def loss(self, z: Iterable[float]) -> float:
        """Sum of ln(1 + misfit^2): a few misfits that nothing can mend do not spoil the rest (Cauchy's loss)."""
        return float(np.log1p(self.misfits(z) ** 2).sum())

    def missed(self, misfits: NDArray[np.float64], softness: float = 0.05) -> float:
        """How many scalars miss the bounds of 5, 10 and 20 %, counted softly and summed at WORTH 1, 2 and 4, plus the conditions' penalty.

        A scalar of error e counts 1/(1 + exp((p - e)/(softness p))) at the bound p. A small part of Cauchy's loss draws far ones nearer.
        """
        scalars, conditions = misfits[: len(self.targets)], misfits[len(misfits) - len(self.modes) * len(self.conditions) :]
        counted = (np.array(WORTH) @ _soft_misses(np.abs(scalars) * TOLERANCE, softness)).sum()
        return float(counted + FAR_PULL * np.log1p(scalars**2).sum() + CONDITION_PRICE * conditions.sum())

    def pulls(self, misfits: NDArray[np.float64], softness: float) -> NDArray[np.float64]:
        """The weights w with which 1/2 sum w misfit^2 has the slope of `missed`: d missed/d|misfit| over |misfit|."""
        sizes = np.maximum(np.abs(misfits), 1e-3)
        scalars, conditions = sizes[: len(self.targets)], misfits[len(misfits) - len(self.modes) * len(self.conditions) :]
        misses = _soft_misses(scalars * TOLERANCE, softness)
        slopes = np.array(WORTH) / np.array(BOUNDS) @ (misses * (1.0 - misses)) * (TOLERANCE / softness)
        weights = np.zeros(len(misfits))
        weights[: len(scalars)] = slopes / scalars + 2.0 * FAR_PULL / (1.0 + scalars**2)
        departed = conditions > 0.0
        weights[len(misfits) - len(conditions) :][departed] = CONDITION_PRICE / np.maximum(conditions[departed], NEAR_CONDITION)
        return weights


def _soft_misses(errors: NDArray[np.float64], softness: float) -> NDArray[np.float64]:
    bounds = np.array(BOUNDS)[:, None]
    found: NDArray[np.float64] = 1.0 / (1.0 + np.exp(np.clip((bounds - errors) / (softness * bounds), -500.0, 500.0)))
    return found


@dataclass(frozen=True)
class Fit:
    """One number wanted beside the landing's, in its unit; `error` is (ours - wanted)/scale, `plain_error` (ours - wanted)/|wanted|."""

    wanted: Wanted
    ours: float

    @property
    def error(self) -> float:
        """A fraction of the wanted number's scale."""
        return (self.ours - self.wanted.value) / self.wanted.scale

    @property
    def plain_error(self) -> float:
        """A fraction of the wanted number itself, however near to zero it is."""
        return (self.ours - self.wanted.value) / abs(self.wanted.value)


def fit_of(parameters: Parameters, wanted: Iterable[Wanted], *, sensors: bool = False) -> list[Fit]:
    """What landings of `parameters` reach of `wanted`, read as an objective reads it. Raises LandingError as `Landing` and `Reading` do."""
    wanted = list(wanted)
    histories = {mode: landed(parameters, mode) for mode in MODES if any(t.mode == mode for t in wanted)}
    readings = {mode: Reading(through_sensors(h) if sensors else h) for mode, h in histories.items()}
    return [Fit(t, MEANINGS[t.id][0](readings[t.mode], MEANINGS[t.id][1])) for t in wanted]


def landed(parameters: Parameters, mode: str, end: float = 0.0) -> History:
    """The history of a landing in `mode`, as long as the paper's scalars need it, or until `end` [s], at 5 kHz."""
    own = parameters.for_mode(mode)
    return Landing(own).run(max(own.drop.contact_time + RUN_AFTER_CONTACT + 0.02, end), EVERY)
