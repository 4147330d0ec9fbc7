"""The summary of a landing: outcome, the peaks of every leg, and the work of its damper."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .history import History
from .outputs import Extreme
from .validation.first_contact import first_contact
from .validation.measures import DamperWork, leg_work

UNFINISHED = {
    "in compression": "largest stroke, efficiency and energies are not known",
    "in rebound": "the dissipated energy is not known",
}
OUTCOMES = ("falling", "in contact, not yet at rest", "settled", "toppled")


def summarise(history: History) -> dict[str, Any]:
    """The summary of a landing.

    An item that the history lacks is left out (a log's messages have no stability margin).

    Returns:
        Outcome, end time [s], smallest stability margin [m], and per leg: contact time [s], peak
        forces [N] and stroke [m] with their times [s], all until the end; and the first compression
        and rebound, as `DamperWork` has them: how far they are known, energies [J], efficiency.
        Of a vehicle with body points their least distance from the ground [m], and when they met it
        first [s], None if never. `peaks_of` is `landing` where peaks are those between the samples
        too, else `samples`.
    """
    t = history.time
    result: dict[str, Any] = {
        "end_time": float(t[-1]),
        "peaks_of": "samples" if history.extremes is None else "landing",
    }
    if "status.phase" in history:
        result["outcome"] = OUTCOMES[int(history["status.phase"][-1])]
    if _has(history, "status.stability_margin"):
        result["stability_margin_min"] = history.extreme("status.stability_margin").minimum
    if history.parameters is not None and history.parameters.vehicle.body_points:
        result |= _clearance(history)
    if "energy.balance" in history:
        result["energy_balance_worst"] = float(np.abs(history["energy.balance"]).max())
    top = history.extreme("body.top_axial_acceleration")
    result["top_axial_acceleration_max"] = top.maximum
    result["top_axial_acceleration_max_time"] = top.maximum_time
    work = leg_work(history)
    legs = [_leg_summary(history, leg, work.get(leg)) for leg in history.legs]
    result["legs"] = legs
    if history.parameters is not None:
        result["bottomed_out"] = [
            leg["leg"]
            for leg in legs
            if leg["main_strut_stroke_max"]
            > history.parameters.of_leg(leg["leg"]).main_strut.stroke_max
        ]
    return result


def _leg_summary(history: History, leg: int, work: DamperWork | None) -> dict[str, Any]:
    """The items of a leg; `work` is None for one that was not compressed."""
    force = history.extreme(f"leg[{leg}].main_strut.force")
    stroke = history.extreme(f"leg[{leg}].main_strut.stroke")
    auxiliary = _auxiliary_force(history, leg)
    contact = first_contact(history, leg)
    return {
        "leg": leg,
        "contact_time": None if contact is None else contact.time,
        "main_strut_force_min": force.minimum,
        "main_strut_force_min_time": force.minimum_time,
        "main_strut_stroke_max": stroke.maximum,
        "main_strut_stroke_max_time": stroke.maximum_time,
        "auxiliary_strut_force_min": auxiliary.minimum,
        "auxiliary_strut_force_min_time": auxiliary.minimum_time,
        "auxiliary_strut_force_max": auxiliary.maximum,
        "auxiliary_strut_force_max_time": auxiliary.maximum_time,
        **_contact_force(history, leg),
        "main_strut_first_stroke": "not compressed" if work is None else work.state,
        "main_strut_absorbed": None if work is None else work.absorbed,
        "main_strut_dissipated": None if work is None else work.dissipated,
        "main_strut_efficiency": None if work is None else work.efficiency,
    }


def _auxiliary_force(history: History, leg: int) -> Extreme:
    """The extremes of the auxiliary struts' force; of a tripod's two the farther ones."""
    one = history.extreme(f"leg[{leg}].auxiliary_strut.force")
    second = f"leg[{leg}].auxiliary_strut_2.force"
    if not _has(history, second):
        return one
    two = history.extreme(second)
    low, high = min(one, two), max((one, two), key=lambda found: found.maximum)
    return Extreme(*low[:2], *high[2:])


def _clearance(history: History) -> dict[str, float | None]:
    """The least distance of the body's points from the ground [m], and when they met it first [s].

    That is known to a sample; None where they did not.
    """
    name = "body.clearance"
    if not _has(history, name):
        return {}
    least = history.extreme(name)
    first = least.minimum_time
    if name in history and (history[name] < 0.0).any():
        first = float(history.time[np.argmax(history[name] < 0.0)])
    return {
        "body_clearance_min": least.minimum,
        "body_strike_time": first if least.minimum < 0.0 else None,
    }


def _has(history: History, name: str) -> bool:
    return name in history or (history.extremes is not None and name in history.extremes)


def _contact_force(history: History, leg: int) -> dict[str, float]:
    """The largest force [N] of the ground on a footpad and its time [s]."""
    name = f"leg[{leg}].contact.force"
    if _has(history, name):
        found = history.extreme(name)
        force, time = found.maximum, found.maximum_time
    else:
        x, y, z = (history[f"{name}_{axis}"] for axis in "xyz")
        forces = np.sqrt(x * x + y * y + z * z)
        at = int(np.argmax(forces))
        force, time = float(forces[at]), float(history.time[at])
    return {"contact_force_max": force, "contact_force_max_time": time}


def dampers_of(legs: Sequence[object]) -> str:
    """The dampers of these legs, in words."""
    numbers = ", ".join(map(str, legs))
    return f"the damper of leg {numbers}" if len(legs) == 1 else f"the dampers of legs {numbers}"


def unfinished(summary: dict[str, Any]) -> list[str]:
    """A line for each kind of stroke that the end cuts off: legs, and what is not known."""
    lines = []
    for state, missing in UNFINISHED.items():
        legs = [
            str(leg["leg"]) for leg in summary["legs"] if leg["main_strut_first_stroke"] == state
        ]
        if legs:
            lines.append(
                f"at the end, {summary['end_time']:.3f} s, {dampers_of(legs)} "
                f"{'is' if len(legs) == 1 else 'are'} still {state}: {missing}; run it longer"
            )
    last = summary["end_time"] - 1e-9
    growing = [
        str(leg["leg"])
        for leg in summary["legs"]
        if leg["main_strut_first_stroke"] != "in compression"
        and leg["main_strut_stroke_max"] > 0.0
        and leg["main_strut_stroke_max_time"] >= last
    ]
    if growing:
        lines.append(
            f"at the end, {summary['end_time']:.3f} s, {dampers_of(growing)} "
            f"{'goes' if len(growing) == 1 else 'go'} in further than ever before: the largest "
            "stroke is not known; run it longer"
        )
    return lines
