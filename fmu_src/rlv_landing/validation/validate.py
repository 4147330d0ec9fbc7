"""Validation: the scalars and measures of the paper's section 5 beside those of landings.

The user's own measured curves may be compared as well.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isnan
from typing import Any

from ..errors import LandingError
from ..history import History
from ..landing import DEFAULT_RTOL, Landing
from ..parameters import Parameters
from ..quantities import LEGS, MODES
from .measures import DamperWork, damper_work, energy_discrepancy, leg_work, onset, rrms
from .paper import Comparison, compare, counts, paper_counts_against_test
from .sensors import Phase, even_step, through_sensors
from .whole_strokes import whole_strokes


@dataclass(frozen=True)
class CurveMeasure:
    """The distance of a landing's curve from a measured one, as RRMS (fractions).

    `rrms` is of the curve as it is, `rrms_sensors` of the landing through the sensor chain.
    """

    mode: str
    column: str
    rrms: float
    rrms_sensors: float


@dataclass(frozen=True)
class Validation:
    """The results of a validation, by landing mode.

    Attributes:
        histories: The landings at 5 kHz.
        sensed: The same through the sensor chain.
        comparisons: The paper's scalars beside ours.
        work: The dampers' work by leg.
        measured: The user's measured curves.
        measured_work: The dampers' work in these.
        curves: The distance of each measured curve.
    """

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
    def parameters(self) -> Parameters | None:
        """The parameters of the first landing; masses and lengths are those of all."""
        return next(iter(self.histories.values())).parameters

    @property
    def all_comparisons(self) -> list[Comparison]:
        """The comparisons of all modes, in the paper's order."""
        return [c for mode in self.modes for c in self.comparisons[mode]]

    @property
    def counts(self) -> dict[str, int]:
        """The numbers of scalars within 5, 10, 20 % of the paper's simulation."""
        return counts(self.all_comparisons)

    @property
    def counts_against_test(self) -> dict[str, int]:
        """The numbers of scalars within 5, 10, 20 % of the paper's tests."""
        return counts(self.all_comparisons, "test")

    @property
    def counts_against_test_sensed(self) -> dict[str, int]:
        """The same numbers for the landings as the tests' sensors would have recorded them."""
        sensed = [c for mode in self.modes for c in compare(self.sensed[mode], mode)]
        return counts(sensed, "test")

    @property
    def paper_counts_against_test(self) -> dict[str, int]:
        """The same numbers for the paper's own simulation."""
        return paper_counts_against_test(self.modes[0] if len(self.modes) == 1 else None)

    @property
    def notes(self) -> list[str]:
        """A line for every damper whose measures the landing or the measured curves cut off."""
        return [
            f"{mode}, leg {leg}: {what} {done.note}"
            for what, by_mode in (
                ("the landing", self.work),
                ("the measured curve", self.measured_work),
            )
            for mode, work in by_mode.items()
            for leg, done in work.items()
            if done.note
        ]

    def discrepancies(self, mode: str, leg: int) -> tuple[float | None, float | None]:
        """Discrepancies [%] of the energies absorbed and dissipated from the measured ones.

        None where the user did not give force and stroke, or either energy is not known.
        """
        ours, measured = self.work[mode].get(leg), self.measured_work.get(mode, {}).get(leg)
        if ours is None or measured is None:
            return None, None
        absorbed, dissipated = (
            None if a is None or b is None else energy_discrepancy(a, b)
            for a, b in (
                (ours.absorbed, measured.absorbed),
                (ours.dissipated, measured.dissipated),
            )
        )
        return absorbed, dissipated

    def record(self) -> dict[str, Any]:
        """The results for JSON; missing values are null.

        Errors and RRMS are fractions, discrepancies per cent.
        """
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
            "measures": {
                mode: [self._leg_record(mode, leg) for leg in work]
                for mode, work in self.work.items()
            },
            "rrms": [
                {"mode": c.mode, "column": c.column, "rrms": c.rrms, "rrms_sensors": c.rrms_sensors}
                for c in self.curves
            ],
        }

    def _leg_record(self, mode: str, leg: int) -> dict[str, Any]:
        found: dict[str, Any] = {"leg": leg, **self.work[mode][leg].record()}
        if leg in self.measured_work.get(mode, {}):
            found["measured"] = self.measured_work[mode][leg].record()
            found["discrepancy_absorbed"], found["discrepancy_dissipated"] = self.discrepancies(
                mode, leg
            )
        return found


def validate(
    parameters: Parameters,
    modes: Iterable[str] = tuple(MODES),
    measured: Mapping[str, History] | None = None,
    phase: Phase = "zero",
    rtol: float = DEFAULT_RTOL,
) -> Validation:
    """Land in every mode and set the landings beside the paper and measured curves.

    A landing lasts 1 s, or until 0.9 s after the first contact if that is later. It goes on, for
    10 s at most, until every damper has ended its first rebound.

    Args:
        parameters: The parameters.
        modes: The landing modes.
        measured: Measured curves by mode.
        phase: Phase of the sensors' low-pass.
        rtol: Relative tolerance of the integrator.

    Raises:
        LandingError: No footpad touches, a landing cannot be run, or measured curves are uneven or
            do not overlap the landing.
    """
    measured = measured or {}
    histories: dict[str, History] = {}
    for mode in modes:
        landing = Landing(parameters, mode, rtol)
        histories[mode] = whole_strokes(landing)
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
        tuple(
            c
            for mode, curves in measured.items()
            for c in _curve_measures(mode, curves, histories[mode], sensed[mode])
        ),
    )


def _measured_work(curves: History) -> dict[int, DamperWork]:
    """The dampers' work in measured curves, by leg.

    Raises:
        LandingError: A damper is compressed by a force that is never negative.
    """
    found: dict[int, DamperWork] = {}
    for leg in LEGS:
        force, stroke = f"leg[{leg}].main_strut.force", f"leg[{leg}].main_strut.stroke"
        if force in curves and stroke in curves:
            found[leg] = damper_work(
                curves.time, curves[force], curves[stroke], onset(curves.time, curves[stroke])
            )
            if found[leg].state == "not compressed" and found[leg].largest > 0.0:
                raise LandingError(
                    f"{force} is never below 0 N while the stroke rises to "
                    f"{found[leg].largest:g} m; forces are negative in compression, turn the sign"
                )
    return found


def _curve_measures(
    mode: str, curves: History, raw: History, sensed: History
) -> list[CurveMeasure]:
    found = []
    for name in curves.names:
        try:
            plain, filtered = (
                rrms(h.time, h[name], curves.time, curves[name]) for h in (raw, sensed)
            )
        except LandingError as e:
            raise LandingError(f"{name}, mode {mode}: {e}") from None
        found.append(CurveMeasure(mode, name, plain, filtered))
    return found


def _or_none(value: float) -> float | None:
    return None if isnan(value) else value
