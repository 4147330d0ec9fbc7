"""One landing of an envelope: made, judged, and put in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...errors import LandingError
from ...landing import Landing
from ...parameters import PARAMETER_QUANTITIES
from ..outcome import Passed, outcome
from ..whole_landing import whole_landing
from .study import EnvelopeStudy

FAILED = "failed"
# landings of each outcome are lost by each criterion; a landing that the integrator could not make
# is always lost
LOST = {
    "toppled": {"toppled", FAILED},
    "bottomed out": {"toppled", "bottomed out", FAILED},
    "slid": {"toppled", "bottomed out", "slid", FAILED},
    "limit": {"toppled", FAILED},
}


@dataclass(frozen=True)
class Landed:
    """One landing of an envelope.

    `name`, `time` [s], `leg` and `first_limit` as in `Outcome`, and `failed` where the integrator
    gave up, with its message in `error`; `towards` the side, +x or -x, to which it toppled;
    `stability_min` and `stroke_left` [m].
    """

    name: str
    time: float
    leg: int | None = None
    towards: str = ""
    first_limit: Passed | None = None
    stability_min: float = float("nan")
    stroke_left: float = float("nan")
    error: str = ""

    def lost(self, criterion: str) -> bool:
        """Whether the landing is lost by the criterion."""
        return self.name in LOST[criterion] or (
            criterion == "limit" and self.first_limit is not None
        )

    @property
    def condition(self) -> str:
        """What is critical: which way it topples, which leg bottoms out first, which limit is
        passed first.
        """
        parts = [f"topples to {self.towards}" if self.name == "toppled" else self.name]
        if self.leg is not None:
            bottomed = f"leg {self.leg} bottoms out"
            parts = [bottomed] if self.name == "bottomed out" else [*parts, bottomed]
        if self.first_limit is not None:
            of = f"leg {self.first_limit.leg} " if self.first_limit.leg is not None else ""
            parts.append(f"{of}passes {self.first_limit.name} first")
        return ", ".join(parts)

    @classmethod
    def from_record(cls, record: Mapping[str, Any]) -> Landed:
        """The same from what `asdict` made of it."""
        limit = record["first_limit"]
        return cls(**{**record, "first_limit": None if limit is None else Passed(**limit)})


def land(study: EnvelopeStudy, values: Mapping[str, float | str]) -> Landed:
    """One landing with `values` of the axes and the family.

    Raises LandingError where the values make no landing (out of bounds, the flight starts below the
    ground).
    """
    own = {name: float(value) for name, value in values.items() if name not in PARAMETER_QUANTITIES}
    inputs = {**study.inputs, **own}
    landing = Landing(study.parameters_with(values), rtol=study.rtol, inputs=inputs)
    try:
        history = whole_landing(landing, study.until, study.every)
    except LandingError as e:
        return Landed(FAILED, landing.time, error=str(e))
    found = outcome(history, study.limits, study.slide)
    towards = ""
    if found.name == "toppled":
        slope = landing.parameters.ground.slope + history.ground.at(history.time[-1])[1]
        towards = "+x" if history["body.pitch"][-1] > slope else "-x"
    margins = found.margins
    return Landed(
        found.name,
        found.time,
        found.leg,
        towards,
        found.first_limit,
        margins["stability_min"],
        margins["stroke_left"],
    )
