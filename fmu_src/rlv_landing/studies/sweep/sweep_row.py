"""One landing of a study: from a row of values to a row of responses.

A worker runs it, in a thread of this process or on a cluster.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from ... import __version__
from ...errors import LandingError, reason_of
from ...history import History
from ...landing import Landing
from ...parameters import PARAMETER_QUANTITIES, Parameters
from ...quantities import Quantity
from ..variables import POLAR, VARIABLES, is_parameter, resolved
from ..whole_landing import whole_landing
from .design import Design
from .responses import Measure, known_responses
from .study import Study

MODE = "drop.mode"


@dataclass(frozen=True)
class Plan:
    """Everything that all landings of a study share; small, because each task carries it.

    Attributes:
        parameters: The parameters that are not varied.
        inputs: Constant inputs by name [SI].
        polar: Constant speed and direction by name [SI].
        until: End of each landing [s]; None: when it is decided, 60 s after contact at the latest.
        every: Time between samples [s].
        rtol: Relative tolerance of the integrator.
        responses: Names of the responses.
        limits: Limits by name [SI].
        slide: Largest distance that a footpad may move without having slid [m].
        standing: Whether a landing may end where the vehicle stands, before it is at rest.
    """

    parameters: Parameters
    inputs: Mapping[str, float]
    polar: Mapping[str, float]
    until: float | None
    every: float
    rtol: float
    responses: tuple[str, ...]
    limits: Mapping[str, float]
    slide: float
    standing: bool = False

    def __reduce__(self) -> tuple[type[Plan], tuple[Any, ...]]:
        return Plan, tuple(getattr(self, f.name) for f in fields(self))

    @cached_property
    def _by_mode(self) -> dict[str, Parameters]:
        """The parameters of the modes that have been landed."""
        return {}

    def parameters_for(self, mode: str) -> Parameters:
        """The parameters of the landing `mode`."""
        if mode not in self._by_mode:
            self._by_mode[mode] = self.parameters.for_mode(mode)
        return self._by_mode[mode]

    @cached_property
    def measure(self) -> Measure:
        """Takes the responses from a history."""
        return Measure(self.responses, self.limits, self.slide)

    def landing(self, values: Mapping[str, Any]) -> Landing:
        """The landing with these values, at its start.

        Args:
            values: Parameters and inputs by name [SI].

        Raises:
            LandingError: The values make no landing.
        """
        base = self.parameters_for(values.get(MODE, self.parameters.drop.mode))
        changed = resolved({**self.polar, **values}, base)
        parameters = {n: v for n, v in changed.items() if n in PARAMETER_QUANTITIES and n != MODE}
        inputs = {n: v for n, v in changed.items() if n not in PARAMETER_QUANTITIES}
        return Landing(
            base.with_values(parameters), rtol=self.rtol, inputs={**self.inputs, **inputs}
        )

    def history(self, landing: Landing) -> History:
        """Make a landing, until the study's end or until it is decided.

        Raises:
            LandingError: As `Landing.run`.
        """
        return whole_landing(
            landing,
            self.until,
            self.every,
            decided=self.until is None,
            standing=self.standing,
        )

    def sweep_row(self, values: Mapping[str, Any]) -> list[Any]:
        """Make the landing with these values and take its responses.

        Args:
            values: Parameters and inputs by name [SI].

        Returns:
            The version, the error's text (None where there is none), then the responses (None with
            an error).
        """
        try:
            landing = self.landing(values)
            history = self.history(landing)
            return [__version__, None, *self.measure(history, landing.statistics["rhs_calls"])]
        except Exception as e:
            error = str(e) if isinstance(e, LandingError) else f"{type(e).__name__}: {reason_of(e)}"
            return [__version__, error, *([None] * len(self.responses))]


def sweep_rows(plan: Plan, rows: Sequence[Mapping[str, Any]]) -> list[list[Any]]:
    """`Plan.sweep_row` of each row of values."""
    return [plan.sweep_row(values) for values in rows]


class Task:
    """All landings of a study in order: their number, values by index, and columns.

    A sample lands once in each mode.
    """

    def __init__(self, study: Study, design: Design) -> None:
        self.study = study
        self.design = design
        numbers = {n: float(v) for n, v in study.fixed.items() if n not in PARAMETER_QUANTITIES}
        self.plan = Plan(
            parameters=study.parameters,
            inputs={n: v for n, v in numbers.items() if not is_parameter(n)},
            polar={n: v for n, v in numbers.items() if n in POLAR},
            until=study.until,
            every=study.every,
            rtol=study.rtol,
            responses=study.responses,
            limits=study.limits,
            slide=study.slide,
            standing=study.end == "stands",
        )
        self.names = [MODE, *(name for name in design.columns if name != MODE)]
        self._modes = study.modes

    def __len__(self) -> int:
        return len(self.design) * max(1, len(self._modes))

    def sample(self, index: int) -> int:
        """The sample of a landing."""
        return index // max(1, len(self._modes))

    def label(self, index: int) -> str:
        """The name of a landing in errors; rows of a table are counted from 1."""
        row = (
            f" (row {self.sample(index) + 1} of the table)" if self.study.table is not None else ""
        )
        return f"landing {index}{row}"

    def rows(self, first: int, last: int) -> list[dict[str, Any]]:
        """Values by name of the landings from `first` up to, not including, `last`.

        The mode is the first value.
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
        """Everything that decides the rows."""
        return {"version": __version__, **self.study.record(), "points": self.design.digest()}

    def quantities(self) -> list[Quantity]:
        """The columns of a row after index, sample and seed.

        They are values, version, error and responses.
        """
        version = Quantity("", "version of rlv-landing", name="version", kind="string")
        error = Quantity("", "why there is no landing", name="error", kind="string")
        return [
            *(VARIABLES[name] for name in self.names),
            version,
            error,
            *(known_responses(self.study.interface)[name] for name in self.plan.responses),
        ]
