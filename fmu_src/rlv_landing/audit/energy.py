"""The energy balance of a landing, term by term, its accounts, and the dampers' liquid mass."""

from __future__ import annotations

import numpy as np

from ..history import History
from ..landing import DEFAULT_RTOL
from .bounds import TIGHT_RTOL, Check
from .cases import Case

HELD = ("kinetic", "potential", "liquid", "auxiliary", "contact", "friction", "stop")
DISSIPATED = tuple(
    f"dissipated_{w}" for w in ("orifice", "seal", "stop", "auxiliary", "contact", "friction")
)
SUPPLIED = ("work_external", "work_ground", "work_transverse")


def energy(case: Case, until: float) -> tuple[dict[str, tuple[float, float]], list[Check]]:
    """Each term's energy [J] at start and end, and the checks of energy and mass.

    The checks are the balance at two tolerances, and the liquid mass.
    """
    history = case.landing(TIGHT_RTOL).run(until)
    terms = {
        t: (float(history[f"energy.{t}"][0]), float(history[f"energy.{t}"][-1]))
        for t in HELD + DISSIPATED + SUPPLIED
    }
    return terms, [
        Check("energy", imbalance(history)),
        Check("energy_default", imbalance(case.landing(DEFAULT_RTOL).run(until))),
        Check("liquid_mass", mass_change(history)),
    ]


def turned_over(history: History) -> float:
    """Energy [J] dissipated, and supplied or taken out from outside, by the end."""
    supplied = sum(abs(float(history[f"energy.{t}"][-1])) for t in SUPPLIED)
    return float(history["energy.dissipated"][-1]) + supplied


def imbalance(history: History) -> float:
    """Largest departure of the sum of all terms, of the energy turned over; inf where none was."""
    held = np.sum([history[f"energy.{t}"] for t in HELD + DISSIPATED], axis=0)
    left = held - np.sum([history[f"energy.{t}"] for t in SUPPLIED], axis=0)
    return _part(float(np.abs(left - left[0]).max()), history)


def largest_fall(history: History) -> float:
    """Largest fall of an account of dissipated energy from its highest value so far.

    It is a part of the energy turned over; inf if none was.
    """
    accounts = (history[f"energy.{t}"] for t in DISSIPATED)
    falls = [float((np.maximum.accumulate(a) - a).max()) for a in accounts]
    return _part(max(falls), history)


def mass_change(history: History) -> float:
    """Largest change of a damper's liquid mass, of that at the start; 0 without liquid."""
    masses = (history[f"leg[{leg}].main_strut.liquid_mass"] for leg in history.legs)
    return max((float(np.abs(m / m[0] - 1.0).max()) for m in masses if m.any()), default=0.0)


def _part(value: float, history: History) -> float:
    whole = turned_over(history)
    return value / whole if whole > 0.0 else float(np.inf)
