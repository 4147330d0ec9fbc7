"""The summary of a landing: outcome, and the peaks of every leg."""

from __future__ import annotations

from typing import Any

import numpy as np

from .history import History

OUTCOMES = ("falling", "in contact, not yet at rest", "settled", "toppled")


def summarise(history: History) -> dict[str, Any]:
    """The summary of a landing.

    An item whose column the history lacks is left out (a log has no stability margin).

    Returns:
        Outcome, end time [s], smallest stability margin [m], and per leg: contact time [s], peak
        forces [N] and stroke [m] with their times [s].
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
    for leg in (1, 2, 3, 4):
        force = history[f"leg[{leg}].main_strut.force"]
        stroke = history[f"leg[{leg}].main_strut.stroke"]
        auxiliary = history[f"leg[{leg}].auxiliary_strut.force"]
        touching = np.flatnonzero(history[f"leg[{leg}].contact.force_y"] > 0.0)
        legs.append(
            {
                "leg": leg,
                "contact_time": float(t[touching[0]]) if len(touching) else None,
                "main_strut_force_min": float(force.min()),
                "main_strut_force_min_time": float(t[force.argmin()]),
                "main_strut_stroke_max": float(stroke.max()),
                "main_strut_stroke_max_time": float(t[stroke.argmax()]),
                "auxiliary_strut_force_min": float(auxiliary.min()),
                "auxiliary_strut_force_max": float(auxiliary.max()),
            }
        )
    result["legs"] = legs
    if history.parameters is not None:
        limit = history.parameters.main_strut.stroke_max
        result["bottomed_out"] = [
            leg["leg"] for leg in legs if leg["main_strut_stroke_max"] > limit
        ]
    return result
