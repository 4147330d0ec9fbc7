"""One landing of an envelope, with its outcome by the study's limits."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...errors import LandingError
from ...landing import Landing
from ..criteria import FAILED, is_lost
from ..limits import LIMITS, PassedLimit
from ..on_ground import towards
from ..outcome import SEVERITY, judged
from ..variables import is_parameter
from ..whole_landing import whole_landing
from .study import EnvelopeStudy

SIDE = re.compile(r"(?:[+-]x|legs [1-8], [1-8]|-?\d{1,3} deg)?")


@dataclass(frozen=True)
class JudgedLanding:
    """One landing of an envelope.

    Attributes:
        name: As in `Outcome`, or `failed` where the integrator stopped.
        time: As in `Outcome` [s].
        leg: As in `Outcome`.
        towards: The side to which it toppled: +x or -x, in space over which legs, "legs 1, 2", or
            else the direction in which it leans, "30 deg"; empty where it did not topple.
        first_limit: As in `Outcome`.
        stability_min: Smallest stability margin [m].
        stroke_left: Least stroke left to a damper's stop [m].
        error: The integrator's message where it failed.
    """

    name: str
    time: float
    leg: int | None = None
    towards: str = ""
    first_limit: PassedLimit | None = None
    stability_min: float = float("nan")
    stroke_left: float = float("nan")
    error: str = ""

    def lost(self, criterion: str) -> bool:
        """Whether the landing is lost by the criterion."""
        return is_lost(criterion, self.name, limit_passed=self.first_limit is not None)

    @property
    def condition(self) -> str:
        """The critical condition, in words.

        It names the side to which the vehicle topples, the leg that bottoms out first, and the
        limit that is passed first.
        """
        way = "over" if self.towards.startswith("legs") else "to"
        parts = [f"topples {way} {self.towards}" if self.name == "toppled" else self.name]
        if self.leg is not None:
            bottomed = f"leg {self.leg} bottoms out"
            parts = [bottomed] if self.name == "bottomed out" else [*parts, bottomed]
        if self.first_limit is not None:
            of = f"leg {self.first_limit.leg} " if self.first_limit.leg is not None else ""
            parts.append(f"{of}passes {self.first_limit.name} first")
        return ", ".join(parts)

    @classmethod
    def from_record(cls, record: Mapping[str, Any], legs: int) -> JudgedLanding:
        """The landing of a record that `asdict` made, of a vehicle on so many `legs`.

        Raises:
            ValueError: The record is no landing's.
        """
        try:
            limit = record["first_limit"]
            passed = None if limit is None else PassedLimit(**limit)
            found = cls(**{**record, "first_limit": passed})
        except (KeyError, TypeError) as e:
            raise ValueError(f"it is no landing: {e}") from None
        found._check(legs)
        return found

    def _check(self, most: int) -> None:
        limit = self.first_limit
        numbers = [self.time, self.stability_min, self.stroke_left]
        legs = [self.leg]
        if limit is not None:
            numbers += [limit.time, limit.limit]
            legs.append(limit.leg)
            if limit.name not in LIMITS:
                raise ValueError(f"{limit.name!r} is no limit")
        if self.name not in (*SEVERITY, FAILED):
            raise ValueError(f"{self.name!r} is no outcome")
        if not all(type(v) in (int, float) for v in numbers):
            raise ValueError("its times, margins and limits are no numbers")
        if not all(leg is None or (type(leg) is int and 1 <= leg <= most) for leg in legs):
            raise ValueError(f"leg {self.leg!r} is none of {most}")
        if not isinstance(self.towards, str) or not SIDE.fullmatch(self.towards):
            raise ValueError(f"{self.towards!r} is no side")
        if not isinstance(self.error, str):
            raise ValueError(f"{self.error!r} is no text")


def judged_landing(study: EnvelopeStudy, values: Mapping[str, float | str]) -> JudgedLanding:
    """Make one landing with `values` of the axes and the family, and judge it.

    Args:
        study: The study.
        values: Parameters and inputs by name [SI].

    Raises:
        LandingError: The values make no landing: out of bounds, or the flight starts below the
            ground.
    """
    own = {name: float(value) for name, value in values.items() if not is_parameter(name)}
    inputs = {**study.inputs, **own}
    parameters = study.parameters_with(values)
    landing = Landing(parameters, rtol=study.rtol, inputs=inputs)
    try:
        history = whole_landing(landing, study.until, study.every)
    except LandingError as e:
        return JudgedLanding(FAILED, landing.time, error=str(e))
    found, before = judged(history, study.limits, study.slide)
    side = ""
    if found.name == "toppled":
        # in space where it passed its feet: what it does after that says nothing
        side = towards(before if found.direction is not None else history)
    margins = found.margins
    return JudgedLanding(
        name=found.name,
        time=found.time,
        leg=found.leg,
        towards=side,
        first_limit=found.first_limit,
        stability_min=margins["stability_min"],
        stroke_left=margins["stroke_left"],
    )
