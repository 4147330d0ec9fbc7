"""One landing of a study: from a row of values to a row of responses.

What a worker runs, in a thread here or on a cluster.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from ... import __version__
from ...errors import LandingError
from ...landing import Landing
from ...parameters import PARAMETER_QUANTITIES, Parameters
from ...quantities import MODES, Quantity
from .design import Design
from .factors import VARIABLES
from .responses import Measure, known_responses
from .study import Study

MODE = "drop.mode"


@dataclass(frozen=True)
class Plan:
    """What every landing of a study has in common. Small, so that it travels with each task."""

    parameters: Parameters
    inputs: Mapping[str, float]
    until: float
    every: float
    rtol: float
    responses: tuple[str, ...]
    limits: Mapping[str, float]
    slide: float

    def __reduce__(self) -> tuple[type[Plan], tuple[Any, ...]]:
        return Plan, tuple(getattr(self, f.name) for f in fields(self))

    @cached_property
    def by_mode(self) -> dict[str, Parameters]:
        """The parameters of each mode."""
        return {mode: self.parameters.for_mode(mode) for mode in MODES}

    @cached_property
    def measure(self) -> Measure:
        """Takes the responses off a history."""
        return Measure(self.responses, self.limits, self.slide)

    def landing(self, values: Mapping[str, Any]) -> Landing:
        """The landing with these values, at its start.

        Raises LandingError where they do not fit.
        """
        mode = values.get(MODE, self.parameters.drop.mode)
        base = self.by_mode[mode] if mode in self.by_mode else self.parameters.for_mode(mode)
        changes = {
            name: value
            for name, value in values.items()
            if name in PARAMETER_QUANTITIES and name != MODE
        }
        inputs = {
            **self.inputs,
            **{name: value for name, value in values.items() if name not in PARAMETER_QUANTITIES},
        }
        return Landing(base.with_values(changes), rtol=self.rtol, inputs=inputs)

    def row(self, values: Mapping[str, Any]) -> list[Any]:
        """Version, error text (None where there is none), then the responses (None with an error)
        of the landing with these values.
        """
        try:
            landing = self.landing(values)
            history = landing.run(self.until, self.every)
            return [__version__, None, *self.measure(history, landing.statistics["rhs_calls"])]
        except Exception as e:
            told = str(e) if isinstance(e, LandingError) else f"{type(e).__name__}: {e}"
            return [__version__, told, *([None] * len(self.responses))]


def run_rows(plan: Plan, rows: Sequence[Mapping[str, Any]]) -> list[list[Any]]:
    """`Plan.row` of each."""
    return [plan.row(values) for values in rows]


class Task:
    """All landings of a study in order: their number, values by index, and what comes back.

    A sample lands once in each mode.
    """

    def __init__(self, study: Study, design: Design) -> None:
        self.study = study
        self.design = design
        inputs = {
            name: float(value)
            for name, value in study.fixed.items()
            if name not in PARAMETER_QUANTITIES
        }
        self.plan = Plan(
            study.parameters, inputs, study.until, study.every, study.rtol, study.responses, study.limits, study.slide
        )  # fmt: skip
        self.names = [MODE, *(name for name in design.columns if name != MODE)]
        self._modes = study.modes

    def __len__(self) -> int:
        return len(self.design) * max(1, len(self._modes))

    def sample(self, index: int) -> int:
        """The sample of a landing."""
        return index // max(1, len(self._modes))

    def label(self, index: int) -> str:
        """How errors call a landing; the rows of a table are counted from 1."""
        row = (
            f" (row {self.sample(index) + 1} of the table)" if self.study.table is not None else ""
        )
        return f"landing {index}{row}"

    def rows(self, first: int, last: int) -> list[dict[str, Any]]:
        """Values by name, the mode first, of the landings from `first` up to, not including,
        `last`.
        """
        if first >= last:
            return []
        count = max(1, len(self._modes))
        start = first // count
        samples = self.design.rows(start, (last - 1) // count + 1)
        default = self.study.parameters.drop.mode
        found = []
        for index in range(first, last):
            values = samples[index // count - start]
            mode = self._modes[index % count] if self._modes else values.get(MODE, default)
            found.append(
                {MODE: mode, **{name: value for name, value in values.items() if name != MODE}}
            )
        return found

    def about(self) -> dict[str, Any]:
        """All that decides the rows."""
        return {"version": __version__, **self.study.record(), "points": self.design.digest()}

    def quantities(self) -> list[Quantity]:
        """The columns of a row after index, sample and seed: values, then version, error,
        responses.
        """
        told = [Quantity("", "version of rlv-landing", name="version", kind="string"),
                Quantity("", "why there is no landing", name="error", kind="string")]  # fmt: skip
        return [
            *(VARIABLES[name] for name in self.names),
            *told,
            *(known_responses()[name] for name in self.plan.responses),
        ]
