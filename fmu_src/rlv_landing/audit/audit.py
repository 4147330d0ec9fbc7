"""The audit of a landing: conservation laws, rest, and convergence.

Each is measured and compared with a bound that has its reason.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from typing import Any

from ..landing import DEFAULT_RTOL
from ..parameters import Parameters
from ..quantities import MODES
from .bounds import BOUNDS, Check
from .cases import Case, cases
from .convergence import Convergence, convergence
from .energy import energy
from .momentum import contact, flight
from .rest import rest
from .transverse import AFTER_CONTACT


@dataclass(frozen=True)
class Audit:
    """The audit of one case in one landing mode.

    Attributes:
        mode: The landing mode.
        case: The case: the vehicle as it is, on a slope, or under a side load.
        checks: Every check.
        energy: Energies [J] at start and end by term.
        rest: The rest state by name [SI].
        convergence: The integrator's error by its tolerance, for the vehicle as it is.
    """

    mode: str
    case: str
    checks: tuple[Check, ...]
    energy: dict[str, tuple[float, float]]
    rest: dict[str, float]
    convergence: Convergence | None = None

    @property
    def missed(self) -> list[Check]:
        """The checks that missed their bounds."""
        return [c for c in self.checks if not c.passed]

    def record(self) -> dict[str, Any]:
        """The audit for JSON."""
        return {
            "mode": self.mode,
            "case": self.case,
            "passed": not self.missed,
            "checks": [
                {
                    "id": c.id,
                    "value": _finite(c.value),
                    "applies": c.applies,
                    "passed": c.passed,
                    **_bound(c.id),
                }
                for c in self.checks
            ],
            "energy": {
                term: {"start": start, "end": end} for term, (start, end) in self.energy.items()
            },
            "rest": {name: _finite(v) for name, v in self.rest.items()},
            "convergence": None if self.convergence is None else self.convergence.record(),
        }


def audit(parameters: Parameters, modes: Iterable[str] = tuple(MODES)) -> list[Audit]:
    """Audit the landing of `parameters` in every mode of `modes`.

    Energy, mass and rest are audited in all cases; momentum and convergence for the vehicle as it
    is.

    Raises:
        LandingError: A landing cannot be run.
    """
    return [found for mode in modes for found in _audit_mode(parameters.for_mode(mode))]


def _audit_mode(parameters: Parameters) -> list[Audit]:
    as_it_is, *others = cases(parameters)
    return [_complete(as_it_is), *(Audit(parameters.drop.mode, c.name, *_core(c)) for c in others)]


def _core(
    case: Case,
) -> tuple[tuple[Check, ...], dict[str, tuple[float, float]], dict[str, float]]:
    """Checks of energy, mass and rest; energies by term; the rest state."""
    terms, checks = energy(case, _end(case))
    state, at_rest = rest(case)
    return (*checks, *at_rest), terms, state


def _complete(case: Case) -> Audit:
    parameters = case.parameters
    checks, terms, state = _core(case)
    found = convergence(parameters, _end(case))
    default = next(i for i, e in enumerate(found.smooth) if e.rtol == DEFAULT_RTOL)
    checks += (
        *flight(parameters),
        *contact(parameters, _end(case)),
        Check("smooth_error", found.smooth[default].worst),
        Check("smooth_slope", found.smooth_slope),
        Check("contacts_error", found.contacts[default].stroke),
        Check("contacts_force", found.contacts[default].force),
    )
    return Audit(parameters.drop.mode, case.name, checks, terms, state, found)


def _end(case: Case) -> float:
    return case.parameters.drop.contact_time + AFTER_CONTACT


def _bound(name: str) -> dict[str, Any]:
    b = BOUNDS[name]
    return {"what": b.what, "unit": b.unit, "limit": b.limit, "side": b.side, "reason": b.reason}


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
