"""A case landed, and its numbers beside ours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..errors import IntegrationError, LandingError
from ..landing import Landing
from ..outputs import Extreme
from ..studies.outcome import outcome
from ..studies.whole_landing import whole_landing
from .case_file import Case, Number


@dataclass(frozen=True)
class Compared:
    """A number of a case and ours [SI]; ours is None where the landing has none."""

    number: Number
    ours: float | None

    @property
    def part(self) -> float:
        """The difference in parts of the tolerance; infinite where there is none of ours."""
        if self.ours is None:
            return float("inf")
        off = abs(self.ours - self.number.theirs)
        if self.number.tolerance > 0.0:
            return off / self.number.tolerance
        return 0.0 if off == 0.0 else float("inf")

    @property
    def within(self) -> bool:
        """Whether ours is within the tolerance."""
        return self.ours is not None and (
            abs(self.ours - self.number.theirs) <= self.number.tolerance
        )


@dataclass(frozen=True)
class Result:
    """A case that was landed.

    Attributes:
        case: The case.
        compared: Its numbers.
        outcome: Our outcome; empty where the case tells none.
    """

    case: Case
    compared: tuple[Compared, ...]
    outcome: str = ""

    @property
    def missed(self) -> list[str]:
        """A line for every number that is beyond its tolerance."""
        lines = []
        for c in self.compared:
            n, unit = c.number, c.number.quantity.unit
            if not c.within:
                ours = "none" if c.ours is None else f"{c.ours:.9g} {unit}".rstrip()
                lines.append(
                    f"{self.case.name}: {n.label}: {ours}, {n.theirs:.9g} within {n.tolerance:.3g} "
                    f"{unit} is required".replace("  ", " ")
                )
        if self.outcome != self.case.outcome:
            lines.append(
                f"{self.case.name}: outcome {self.outcome}, {self.case.outcome} is required"
            )
        return lines

    def record(self) -> dict[str, Any]:
        """The result for JSON."""
        case = self.case
        return {
            "name": case.name,
            "title": case.title,
            "source": case.source,
            "page": case.page,
            "differences": case.differences,
            "passed": not self.missed,
            "numbers": [
                {
                    "what": c.number.label,
                    "unit": c.number.quantity.unit,
                    "theirs": c.number.theirs,
                    "ours": c.ours,
                    "tolerance": c.number.tolerance,
                    "within": c.within,
                    "page": c.number.page,
                }
                for c in self.compared
            ],
            "outcome": {"theirs": case.outcome, "ours": self.outcome} if case.outcome else None,
        }


def compare(case: Case) -> Result:
    """Land a case, and compare its numbers.

    Raises:
        LandingError, IntegrationError: It cannot be landed.
    """
    try:
        return _compare(case)
    except IntegrationError as e:
        raise IntegrationError(f"{case.name}: {e}") from None
    except LandingError as e:
        raise LandingError(f"{case.name}: {e}") from None


def _compare(case: Case) -> Result:
    landing = Landing(case.parameters, rtol=case.rtol, inputs=case.inputs)
    wanted = {t for n in case.numbers for t in (n.at, n.since) if t is not None}
    values: dict[float, Mapping[str, float]] = {}
    contacts: dict[int, float] = {}
    _note_contacts(landing, contacts)
    for time in sorted({*wanted, case.until}):
        if any(n.contact for n in case.numbers):
            while landing.advance_within_step(time, time, to_event=True):
                _note_contacts(landing, contacts)
                if landing.time == time:
                    break
        landing.advance_to(time)
        values[time] = landing.outputs()
    extremes = landing.extremes()
    compared = tuple(Compared(n, _ours(n, values, extremes, contacts)) for n in case.numbers)
    return Result(case, compared, _outcome(case) if case.outcome else "")


def _note_contacts(landing: Landing, contacts: dict[int, float]) -> None:
    now = landing.outputs()
    for leg in landing.interface.legs:
        if now[f"leg[{leg}].contact.penetration"] >= 0.0:
            contacts.setdefault(leg, landing.time)


def _ours(
    n: Number,
    values: Mapping[float, Mapping[str, float]],
    extremes: Mapping[str, Extreme],
    contacts: Mapping[int, float],
) -> float | None:
    if n.contact:
        return contacts.get(n.contact)
    name = n.quantity.name
    if n.peak:
        low, high = extremes[name].minimum, extremes[name].maximum
        return {"min": low, "max": high, "abs_max": max(abs(low), abs(high))}[n.peak]
    assert n.at is not None
    return values[n.at][name] - (values[n.since][name] if n.since is not None else 0.0)


def _outcome(case: Case) -> str:
    landing = Landing(case.parameters, rtol=case.rtol, inputs=case.inputs)
    return outcome(whole_landing(landing, case.until)).name
