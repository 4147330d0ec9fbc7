"""The rest of a landing: its drift, forces and energy.

The checks: what is lost on the way, what the ground carries, what still moves, and whether the
footpads creep.
"""

from __future__ import annotations

import numpy as np

from ..history import History
from ..landing import Landing
from .bounds import BOUNDS, TIGHT_RTOL, Check
from .cases import Case, weight
from .energy import largest_fall

# [s]: a heavy or lightly damped vehicle rocks for longer than REST_AFTER from its first contact; it
# gets LONGEST_WAIT to settle, in studies too, and here DECAY after that
REST_AFTER, LONGEST_WAIT, DECAY, DRIFT_TIME = 10.0, 60.0, 30.0, 5.0


def rest(case: Case) -> tuple[dict[str, float], list[Check]]:
    """The state at rest, 10 s after first contact, and the checks of rest.

    It is looked for on a deck without a sea, on which what has settled still moves with the deck.
    A vehicle that neither rests nor has toppled by then, and that friction can hold, is given up to
    60 s to settle, and 30 s more. The state has the time since when the vehicle has been settled
    (NaN if it is not, or has toppled), and how fast a footpad drifts in the 5 s after that; if it
    does, then once more 30 s later.
    """
    case = case.without_sea()
    landing = case.landing(TIGHT_RTOL)
    parts = _until_rest(landing, case)
    history, stands = parts[-1], _stands(parts)
    since = settled_since(next(h for h in parts if _settled(h))) if stands else float("nan")
    drift = _drift(landing)
    if stands and case.holds and drift > BOUNDS["rest_drift"].limit:
        # what has settled may still decay; a creep stays
        landing.advance_to(landing.time + DECAY)
        drift = _drift(landing)
    state = {
        "settled_since": since,
        "pitch": float(history["body.pitch"][-1]),
        "stability_margin": float(history["status.stability_margin"][-1]),
        **{
            f"stroke_{leg}": float(history[f"leg[{leg}].main_strut.stroke"][-1])
            for leg in history.legs
        },
    }
    whole = weight(case.parameters)
    carried = sum(float(history[f"leg[{leg}].contact.force_y"][-1]) for leg in history.legs)
    return state, [
        Check("dissipated", largest_fall(parts[0])),
        Check("rest_weight", abs(carried - whole) / whole if whole > 0.0 else float("nan")),
        Check("rest_speed", _speed(history), case.holds),
        Check("rest_drift", drift, case.holds),
        Check("rest_phase", float(stands), case.holds),
    ]


def _drift(landing: Landing) -> float:
    """The speed [m/s] of the footpad that drifts farthest in the next 5 s."""
    moved = landing.run(landing.time + DRIFT_TIME, DRIFT_TIME)
    return float(np.abs(feet(moved, -1) - feet(moved, 0)).max()) / DRIFT_TIME


def _until_rest(landing: Landing, case: Case) -> list[History]:
    """The landing until it rests, in parts of 10 s: one, if it has settled in that, or toppled.

    One that settles later, or in the last 5 s of that, gets 30 s more, for what has just settled
    still decays. What friction cannot hold slides, and is not waited for.
    """
    parts = [landing.run(case.parameters.drop.contact_time + REST_AFTER, 5e-3)]
    longest = round(LONGEST_WAIT / REST_AFTER) if case.holds else 1
    while not _settled(parts[-1]) and not _toppled(parts) and len(parts) < longest:
        parts.append(landing.run(landing.time + REST_AFTER, 5e-3))
    late = len(parts) > 1 or landing.time - settled_since(parts[0]) < DRIFT_TIME
    if late and _settled(parts[-1]):
        parts.append(landing.run(landing.time + DECAY, 5e-3))
    return parts


def _settled(history: History) -> bool:
    return bool(history["status.phase"][-1] == 2.0)


def _toppled(parts: list[History]) -> bool:
    return any(bool(np.any(h["status.phase"] == 3.0)) for h in parts)


def _stands(parts: list[History]) -> bool:
    return _settled(parts[-1]) and not _toppled(parts)


def feet(history: History, at: int) -> np.ndarray:
    """Footpads' places [m] along inertial x and z at a sample."""
    return np.array([history[f"leg[{leg}].footpad.{a}"][at] for leg in history.legs for a in "xz"])


def settled_since(history: History) -> float:
    """Time [s] of the first sample after which all are settled."""
    moving = np.flatnonzero(history["status.phase"] != 2.0)
    return float(history.time[min(int(moving[-1]) + 1, len(history) - 1)])


def _speed(history: History) -> float:
    across = ["body.vz"] if "body.vz" in history else []
    rates = [
        "body.vx",
        "body.vy",
        *across,
        *(
            f"leg[{leg}].{s}_strut.stroke_rate"
            for leg in history.legs
            for s in ("main", "auxiliary")
        ),
    ]
    return max(abs(float(history[name][-1])) for name in rates)
