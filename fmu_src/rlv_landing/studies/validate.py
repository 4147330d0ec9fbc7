"""Section 5 of the paper anew: every printed scalar and the summary measures, beside simulation, tests, and the user's curves."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isnan
from typing import Any

from ..errors import LandingError
from ..history import History
from ..landing import DEFAULT_RTOL, Landing
from ..measures import DamperWork, damper_work, energy_discrepancy, leg_work, onset, rrms
from ..paper import LEVELS, RUN_AFTER_CONTACT, Comparison, compare, counts, paper_counts_against_test
from ..parameters import Parameters
from ..quantities import LEGS, MODES
from ..sensors import SAMPLING, Phase, even_step, through_sensors

Bounds = tuple[int, int, int]

# What `yue2022-tests` is stated to reach: scalars within 5, 10, 20 % of the paper's tests, read through their sensor chain, by mode.
STATED_OF_TESTS: dict[str, Bounds] = {"2-2": (0, 0, 0), "1-2-1": (0, 0, 0)}

# What `yue2022-figures` is stated to reach: scalars within 5, 10, 20 % of the paper's simulation, by mode.
STATED: dict[str, Bounds] = {"2-2": (18, 18, 20), "1-2-1": (20, 24, 28)}


@dataclass(frozen=True)
class CurveMeasure:
    """How far a landing's curve is from a measured one: RRMS as it is, and with the landing through the sensor chain (fractions)."""

    mode: str
    column: str
    rrms: float
    rrms_sensors: float


@dataclass(frozen=True)
class Validation:
    """What a validation found, by mode: histories at 5 kHz and through the sensor chain, comparisons, dampers' work; measured likewise."""

    histories: Mapping[str, History]
    sensed: Mapping[str, History]
    comparisons: Mapping[str, list[Comparison]]
    work: Mapping[str, dict[int, DamperWork]]
    measured: Mapping[str, History] = field(default_factory=dict)
    measured_work: Mapping[str, dict[int, DamperWork]] = field(default_factory=dict)
    curves: tuple[CurveMeasure, ...] = ()

    @property
    def modes(self) -> tuple[str, ...]:
        """The landing modes that were run."""
        return tuple(self.histories)

    @property
    def all_comparisons(self) -> list[Comparison]:
        """Those of all modes, in the paper's order."""
        return [c for mode in self.modes for c in self.comparisons[mode]]

    @property
    def counts(self) -> dict[str, int]:
        """Scalars within 5, 10, 20 % of the paper's simulation."""
        return counts(self.all_comparisons)

    @property
    def counts_against_test(self) -> dict[str, int]:
        """Scalars within 5, 10, 20 % of the paper's tests."""
        return counts(self.all_comparisons, "test")

    @property
    def counts_against_test_sensed(self) -> dict[str, int]:
        """The same with the landings as the tests' sensors would have recorded them."""
        return counts([c for mode in self.modes for c in compare(self.sensed[mode], mode)], "test")

    @property
    def paper_counts_against_test(self) -> dict[str, int]:
        """The same for the paper's own simulation."""
        return paper_counts_against_test(self.modes[0] if len(self.modes) == 1 else None)

    def discrepancies(self, mode: str, leg: int) -> tuple[float, float] | None:
        """Discrepancy [%] of the energies absorbed and dissipated from the measured ones, where the user gave force and stroke."""
        ours, measured = self.work[mode].get(leg), self.measured_work.get(mode, {}).get(leg)
        if ours is None or measured is None:
            return None
        return energy_discrepancy(ours.absorbed, measured.absorbed), energy_discrepancy(ours.dissipated, measured.dissipated)

    def record(self) -> dict[str, Any]:
        """All of it for JSON; what is not there is null. Errors and RRMS are fractions, discrepancies per cent."""
        return {
            "scalars": [
                {
                    "id": c.scalar.id,
                    "paper": c.scalar.simulation,
                    "test": _or_none(c.scalar.test),
                    "ours": _or_none(c.ours),
                    "error": _or_none(c.error),
                }
                for c in self.all_comparisons
            ],
            "counts": self.counts,
            "counts_against_test": self.counts_against_test,
            "counts_against_test_sensed": self.counts_against_test_sensed,
            "paper_counts_against_test": self.paper_counts_against_test,
            "measures": {mode: [self._leg_record(mode, leg) for leg in work] for mode, work in self.work.items()},
            "rrms": [{"mode": c.mode, "column": c.column, "rrms": c.rrms, "rrms_sensors": c.rrms_sensors} for c in self.curves],
        }

    def _leg_record(self, mode: str, leg: int) -> dict[str, Any]:
        found: dict[str, Any] = {"leg": leg, **self.work[mode][leg].record()}
        discrepancies = self.discrepancies(mode, leg)
        if discrepancies is not None:
            found["measured"] = self.measured_work[mode][leg].record()
            found["discrepancy_absorbed"], found["discrepancy_dissipated"] = discrepancies
        return found


def validate(
    parameters: Parameters,
    modes: Iterable[str] = tuple(MODES),
    measured: Mapping[str, History] | None = None,
    phase: Phase = "zero",
    rtol: float = DEFAULT_RTOL,
) -> Validation:
    """Land `parameters` in every mode and set the landing beside the paper, and beside the user's `measured` curves by mode.

    Raises LandingError: no contact, a landing that cannot be run, measured curves that are uneven or do not overlap the landing.
    """
    measured = measured or {}
    histories: dict[str, History] = {}
    for mode in modes:
        landing = Landing(parameters, mode, rtol)
        until = max(1.0, landing.parameters.drop.contact_time + RUN_AFTER_CONTACT + 0.1)
        histories[mode] = landing.run(until, 1.0 / SAMPLING)
    for curves in measured.values():
        even_step(curves)
    sensed = {mode: through_sensors(history, phase) for mode, history in histories.items()}
    return Validation(
        histories,
        sensed,
        {mode: compare(history, mode) for mode, history in histories.items()},
        {mode: leg_work(history) for mode, history in histories.items()},
        measured,
        {mode: _measured_work(curves) for mode, curves in measured.items()},
        tuple(c for mode, curves in measured.items() for c in _curve_measures(mode, curves, histories[mode], sensed[mode])),
    )


def _measured_work(curves: History) -> dict[int, DamperWork]:
    found: dict[int, DamperWork] = {}
    for leg in LEGS:
        force, stroke = f"leg[{leg}].main_strut.force", f"leg[{leg}].main_strut.stroke"
        if force in curves and stroke in curves:
            found[leg] = damper_work(curves.time, curves[force], curves[stroke], onset(curves.time, curves[stroke]))
    return found


def _curve_measures(mode: str, curves: History, raw: History, sensed: History) -> list[CurveMeasure]:
    found = []
    for name in curves.names:
        try:
            plain, filtered = (rrms(h.time, h[name], curves.time, curves[name]) for h in (raw, sensed))
        except LandingError as e:
            raise LandingError(f"{name}, mode {mode}: {e}") from None
        found.append(CurveMeasure(mode, name, plain, filtered))
    return found


def parse_bounds(text: str) -> Bounds:
    """`42/46/48` as the least counts within 5, 10 and 20 %. Raises LandingError for anything else, and where they fall."""
    match = re.fullmatch(r"\s*(\d+)\s*/\s*(\d+)\s*/\s*(\d+)\s*", text)
    if match is None:
        raise LandingError(f"--require {text!r} is not three counts; write the least within 5, 10 and 20 %: 36/41/45, or none")
    a, b, c = (int(n) for n in match.groups())
    if not a <= b <= c:
        raise LandingError(f"--require {text!r} falls: what is within 5 % is within 10 % too; write them rising, for example 36/41/45")
    return a, b, c


def stated_bounds(modes: Iterable[str], stated: Mapping[str, Bounds] = STATED) -> Bounds:
    """The counts that a preset is `stated` to reach in `modes` together: `yue2022-figures` against the simulation by default."""
    modes = tuple(modes)
    a, b, c = (sum(stated[mode][i] for mode in modes) for i in range(len(LEVELS)))
    return a, b, c


def missed_bounds(found: Mapping[str, int], bounds: Bounds, of: str = "the paper's simulation") -> list[str]:
    """A line for every count below its bound. Raises LandingError where a bound asks for more scalars than there are."""
    if bounds[-1] > found["of"]:
        raise LandingError(f"--require asks for {bounds[-1]} scalars within 20 %, there are {found['of']}; ask for at most that")
    return [
        f"within {level} % of {of}: {found[f'within_{level}']} of {found['of']}, at least {bound} are required"
        for level, bound in zip(LEVELS, bounds)
        if found[f"within_{level}"] < bound
    ]


def _or_none(value: float) -> float | None:
    return None if isnan(value) else value
