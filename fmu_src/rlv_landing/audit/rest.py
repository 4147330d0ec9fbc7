"""The rest of a landing: its drift, forces and energy.

The checks: what is lost on the way, what the ground carries, what still moves, and whether the
footpads creep.
"""

from __future__ import annotations

import numpy as np

from ..history import History
from ..quantities import LEGS
from .bounds import TIGHT_RTOL, Check
from .cases import Case, weight
from .energy import largest_fall

REST_AFTER, DRIFT_TIME = 10.0, 5.0


def rest(case: Case) -> tuple[dict[str, float], list[Check]]:
    """The state 10 s after first contact, and the checks of rest.

    The state has the time since when the vehicle has been settled (NaN if it is not, or has
    toppled), and how fast a footpad drifts in the 5 s after that.
    """
    landing = case.landing(TIGHT_RTOL)
    history = landing.run(case.parameters.drop.contact_time + REST_AFTER, 5e-3)
    before = feet(history, -1)
    drift = float(
        np.abs(feet(landing.run(landing.time + DRIFT_TIME, DRIFT_TIME), -1) - before).max()
    )
    phase = history["status.phase"]
    stands = bool(phase[-1] == 2.0) and not np.any(phase == 3.0)
    state = {
        "settled_since": settled_since(history) if stands else float("nan"),
        "pitch": float(history["body.pitch"][-1]),
        "stability_margin": float(history["status.stability_margin"][-1]),
        **{f"stroke_{leg}": float(history[f"leg[{leg}].main_strut.stroke"][-1]) for leg in LEGS},
    }
    whole = weight(case.parameters)
    carried = sum(float(history[f"leg[{leg}].contact.force_y"][-1]) for leg in LEGS)
    return state, [
        Check("dissipated", largest_fall(history)),
        Check("rest_weight", abs(carried - whole) / whole if whole > 0.0 else float("nan")),
        Check("rest_speed", _speed(history), case.holds),
        Check("rest_drift", drift / DRIFT_TIME, case.holds),
        Check("rest_phase", float(stands), case.holds),
    ]


def feet(history: History, at: int) -> np.ndarray:
    """Footpads' places [m] along inertial x and z at a sample."""
    return np.array([history[f"leg[{leg}].footpad.{a}"][at] for leg in LEGS for a in "xz"])


def settled_since(history: History) -> float:
    """Time [s] of the first sample after which all are settled."""
    moving = np.flatnonzero(history["status.phase"] != 2.0)
    return float(history.time[min(int(moving[-1]) + 1, len(history) - 1)])


def _speed(history: History) -> float:
    rates = [
        "body.vx",
        "body.vy",
        *(f"leg[{leg}].{s}_strut.stroke_rate" for leg in LEGS for s in ("main", "auxiliary")),
    ]
    return max(abs(float(history[name][-1])) for name in rates)
