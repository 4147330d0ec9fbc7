"""The summary of a landing: outcome, the peaks of every leg, and the work of its damper."""

from __future__ import annotations

from typing import Any

import numpy as np

from .history import History
from .validation.measures import first_push, leg_work

UNFINISHED = {
    "in compression": "its largest stroke, efficiency and energies are not known",
    "in rebound": "its dissipated energy is not known",
}
OUTCOMES = ("falling", "in contact, not yet at rest", "settled", "toppled")


def summarise(history: History) -> dict[str, Any]:
    """The summary of a landing.

    An item whose column the history lacks is left out (a log has no stability margin).

    Returns:
        Outcome, end time [s], smallest stability margin [m], and per leg: contact time [s], peak
        forces [N] and stroke [m] with their times [s], all until the end; and the first compression
        and rebound, as `DamperWork` has them: how far they are known, energies [J], efficiency.
    """
    t = history.time
    result: dict[str, Any] = {"end_time": float(t[-1])}
    if "status.phase" in history:
        result["outcome"] = OUTCOMES[int(history["status.phase"][-1])]
    if "status.stability_margin" in history:
        result["stability_margin_min"] = float(history["status.stability_margin"].min())
    if "energy.balance" in history:
        result["energy_balance_worst"] = float(np.abs(history["energy.balance"]).max())
    result["top_axial_acceleration_max"] = float(history["body.top_axial_acceleration"].max())
    legs: list[dict[str, Any]] = []
    work = leg_work(history)
    for leg in (1, 2, 3, 4):
        force = history[f"leg[{leg}].main_strut.force"]
        stroke = history[f"leg[{leg}].main_strut.stroke"]
        auxiliary = history[f"leg[{leg}].auxiliary_strut.force"]
        first, done = first_push(history, leg), work.get(leg)
        legs.append(
            {
                "leg": leg,
                "contact_time": None if first is None else float(t[first]),
                "main_strut_force_min": float(force.min()),
                "main_strut_force_min_time": float(t[force.argmin()]),
                "main_strut_stroke_max": float(stroke.max()),
                "main_strut_stroke_max_time": float(t[stroke.argmax()]),
                "auxiliary_strut_force_min": float(auxiliary.min()),
                "auxiliary_strut_force_max": float(auxiliary.max()),
                "main_strut_first_stroke": "not compressed" if done is None else done.state,
                "main_strut_absorbed": None if done is None else done.absorbed,
                "main_strut_dissipated": None if done is None else done.dissipated,
                "main_strut_efficiency": None if done is None else done.efficiency,
            }
        )
    result["legs"] = legs
    if history.parameters is not None:
        limit = history.parameters.main_strut.stroke_max
        result["bottomed_out"] = [
            leg["leg"] for leg in legs if leg["main_strut_stroke_max"] > limit
        ]
    return result


def unfinished(summary: dict[str, Any]) -> list[str]:
    """A line for each stroke that the landing's end cuts off: legs, and what is not known."""
    lines = []
    for state, missing in UNFINISHED.items():
        legs = [
            str(leg["leg"]) for leg in summary["legs"] if leg["main_strut_first_stroke"] == state
        ]
        if legs:
            lines.append(
                f"at the end, {summary['end_time']:.3f} s, the damper of leg {', '.join(legs)} is "
                f"still {state}: {missing}; run it longer"
            )
    return lines
