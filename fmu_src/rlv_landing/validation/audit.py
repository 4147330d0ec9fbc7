"""The audit of a landing: conservation laws, rest state and convergence.

Each is measured and compared with a bound that has its reason.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..history import History
from ..landing import DEFAULT_RTOL, Landing
from ..parameters import Parameters
from ..quantities import LEGS, MODES, OUTPUT_NAMES
from .bounds import BOUNDS
from .convergence import Convergence, convergence
from .momentum import impulse, momentum

TIGHT_RTOL = 1e-8
AFTER_CONTACT = 1.0
REST_AFTER = 10.0
FLIGHT = 0.3
SAMPLE_STEP, FINE_STEP, FINE_BEFORE, FINE_AFTER = 5e-5, 1e-6, 5e-5, 5e-4

HELD = ("kinetic", "potential", "liquid", "auxiliary", "contact", "stop")
DISSIPATED = tuple(
    f"dissipated_{w}" for w in ("orifice", "seal", "stop", "auxiliary", "contact", "friction")
)
SUPPLIED = ("work_external", "work_ground", "work_transverse")


@dataclass(frozen=True)
class Check:
    """One value and its bound, by the bound's `id`.

    `applies` is False where the bound is not valid for these parameters.
    """

    id: str
    value: float
    applies: bool = True

    @property
    def passed(self) -> bool:
        """Whether the value is on the right side of its bound, or the bound does not apply."""
        bound = BOUNDS[self.id]
        return not self.applies or (
            self.value <= bound.limit if bound.side == "at most" else self.value >= bound.limit
        )


@dataclass(frozen=True)
class Audit:
    """The audit of one landing mode.

    Attributes:
        mode: The landing mode.
        checks: Every check.
        energy: Energies [J] at start and end by term.
        convergence: The integrator's error by its tolerance.
        rest: The rest state by name [SI].
    """

    mode: str
    checks: tuple[Check, ...]
    energy: dict[str, tuple[float, float]]
    convergence: Convergence
    rest: dict[str, float]

    @property
    def missed(self) -> list[Check]:
        """The checks that missed their bounds."""
        return [c for c in self.checks if not c.passed]

    def record(self) -> dict[str, Any]:
        """The audit for JSON."""
        c = self.convergence
        return {
            "mode": self.mode,
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
            "convergence": {
                "reference_rtol": c.reference,
                "smooth_arc": [c.start, c.end],
                "smooth": [vars(e) for e in c.smooth],
                "contacts": [vars(e) for e in c.contacts],
                "smooth_slope": c.smooth_slope,
                "contacts_slope": c.contacts_slope,
            },
            "rest": {name: _finite(v) for name, v in self.rest.items()},
        }


def audit(parameters: Parameters, modes: Iterable[str] = tuple(MODES)) -> list[Audit]:
    """Audit the landing of `parameters` in every mode of `modes`.

    Raises:
        LandingError: A landing cannot be run.
    """
    return [_audit(parameters.for_mode(mode)) for mode in modes]


def _audit(parameters: Parameters) -> Audit:
    until = parameters.drop.contact_time + AFTER_CONTACT
    energy, checks = _energy(parameters, until)
    rest, rest_checks = _rest(parameters)
    found = convergence(parameters, until)
    default = next(i for i, e in enumerate(found.smooth) if e.rtol == DEFAULT_RTOL)
    checks += _flight(parameters) + _contact(parameters, until) + rest_checks
    checks += [
        Check("smooth_error", found.smooth[default].worst),
        Check("smooth_slope", found.smooth_slope),
        Check("contacts_error", found.contacts[default].stroke),
        Check("contacts_force", found.contacts[default].force),
    ]
    return Audit(parameters.drop.mode, tuple(checks), energy, found, rest)


def _energy(
    parameters: Parameters, until: float
) -> tuple[dict[str, tuple[float, float]], list[Check]]:
    """The energy balance, summed here term by term, and the dampers' liquid mass."""

    def balance(rtol: float) -> tuple[History, float]:
        history = Landing(parameters, rtol=rtol).run(until)
        held = np.sum([history[f"energy.{t}"] for t in HELD + DISSIPATED], axis=0)
        left = held - np.sum([history[f"energy.{t}"] for t in SUPPLIED], axis=0)
        turned_over = history["energy.dissipated"][-1] + sum(
            abs(history[f"energy.{t}"][-1]) for t in SUPPLIED
        )
        return history, float(
            np.abs(left - left[0]).max() / turned_over
        ) if turned_over > 0.0 else np.inf

    history, tight = balance(TIGHT_RTOL)
    mass = max(
        float(np.abs(m / m[0] - 1.0).max())
        for m in (history[f"leg[{leg}].main_strut.liquid_mass"] for leg in LEGS)
    )
    terms = {
        t: (float(history[f"energy.{t}"][0]), float(history[f"energy.{t}"][-1]))
        for t in HELD + DISSIPATED + SUPPLIED
    }
    return terms, [
        Check("energy", tight),
        Check("energy_default", balance(DEFAULT_RTOL)[1]),
        Check("liquid_mass", mass),
    ]


def _flight(parameters: Parameters) -> list[Check]:
    """Momentum in 0.3 s of turning free flight.

    The flight's state at touchdown is the landing's, but faster downward by gravity times 0.3 s.
    """
    drop, g = parameters.drop, parameters.ground.gravity
    rate = drop.pitch_rate if abs(drop.pitch_rate) > 0.1 else 0.2
    speed = max(drop.vertical_velocity - g * FLIGHT, -50.0)
    flying = replace(
        parameters,
        drop=replace(drop, contact_time=FLIGHT, vertical_velocity=speed, pitch_rate=rate),
        by_mode={},
    )
    history = Landing(flying, rtol=TIGHT_RTOL).run(0.95 * FLIGHT)
    found, given = momentum(history, flying), impulse(history, flying)
    size = _mass(parameters) * max(g, 1.0) * FLIGHT
    linear = (
        max(np.abs(a - a[0] - b).max() for a, b in ((found.x, given.x), (found.y, given.y))) / size
    )
    angular = np.ptp(found.about_cg) / np.abs(found.about_cg).max()
    consistent = parameters.vehicle.transverse_load_at == "footpad"
    return [
        Check("flight_momentum", float(linear)),
        Check("flight_angular", float(angular), consistent),
    ]


def _contact(parameters: Parameters, until: float) -> list[Check]:
    """The change of momentum against the integral of contact forces and weight."""
    landing = Landing(parameters, rtol=TIGHT_RTOL)
    coarse = np.arange(int(until / SAMPLE_STEP) + 1) * SAMPLE_STEP
    history = _sample(landing, coarse)
    active = np.array([history[f"leg[{leg}].contact.active"] for leg in LEGS])
    changes = np.flatnonzero(np.any(np.diff(active, axis=1) != 0.0, axis=0))
    fine = [
        np.arange(coarse[i] - FINE_BEFORE, coarse[i + 1] + FINE_AFTER, FINE_STEP) for i in changes
    ]
    times = np.unique(np.round(np.concatenate([coarse, *fine]), 9))
    landing.reset()
    history = _sample(landing, times[(times >= 0.0) & (times <= until)])
    found, given = momentum(history, parameters), impulse(history, parameters)

    def left(a: Any, b: Any) -> float:
        return float(np.abs(a - a[0] - b).max() / np.ptp(a))

    return [
        Check("momentum_x", left(found.x, given.x)),
        Check("momentum_y", left(found.y, given.y)),
        Check(
            "angular",
            left(found.about_origin, given.about_origin),
            parameters.vehicle.transverse_load_at == "footpad",
        ),
    ]


def _sample(landing: Landing, times: Any) -> History:
    def values(time: float) -> list[float]:
        landing.advance_to(time)
        return landing.values()

    return History(
        times, OUTPUT_NAMES, np.array([values(t) for t in times.tolist()]), landing.parameters
    )


def _rest(parameters: Parameters) -> tuple[dict[str, float], list[Check]]:
    """The state 10 s after first contact, and the time from which the vehicle has been settled.

    That time is NaN where it is not settled or has toppled.
    """
    history = Landing(parameters, rtol=TIGHT_RTOL).run(
        parameters.drop.contact_time + REST_AFTER, 5e-3
    )
    phase = history["status.phase"]
    settled = phase == 2.0
    stands = bool(settled[-1]) and not np.any(phase == 3.0)
    moving = np.flatnonzero(~settled)
    since = (
        float(history.time[min(int(moving[-1]) + 1, len(history) - 1)]) if stands else float("nan")
    )
    weight = _mass(parameters) * parameters.ground.gravity
    carried = sum(float(history[f"leg[{leg}].contact.force_y"][-1]) for leg in LEGS)
    rates = [
        "body.vx",
        "body.vy",
        *(f"leg[{leg}].{s}_strut.stroke_rate" for leg in LEGS for s in ("main", "auxiliary")),
    ]
    speed = max(abs(float(history[name][-1])) for name in rates)
    state = {
        "settled_since": since,
        "pitch": float(history["body.pitch"][-1]),
        "stability_margin": float(history["status.stability_margin"][-1]),
    }
    state.update(
        {f"stroke_{leg}": float(history[f"leg[{leg}].main_strut.stroke"][-1]) for leg in LEGS}
    )
    off = abs(carried - weight) / weight if weight > 0.0 else float("nan")
    return state, [
        Check("rest_weight", off),
        Check("rest_speed", speed),
        Check("rest_phase", float(stands)),
    ]


def _mass(parameters: Parameters) -> float:
    return parameters.vehicle.mass + len(LEGS) * parameters.vehicle.footpad_mass


def _bound(name: str) -> dict[str, Any]:
    b = BOUNDS[name]
    return {"what": b.what, "unit": b.unit, "limit": b.limit, "side": b.side, "reason": b.reason}


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
