"""How the integrator's error follows its tolerance: on a smooth arc of a landing, and across all of
its contacts.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import LandingError
from ..history import History
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import LEGS

REFERENCE_RTOLS = (1e-12, 1e-11, 1e-10)
RTOLS = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
SEARCH_STEP = 1e-4
SAMPLE_STEP = 5e-4
AFTER_EVENT, BEFORE_EVENT = 2e-3, 1e-3


@dataclass(frozen=True)
class Errors:
    """Largest errors of a run at `rtol` against one at 1e-12, as parts of the landing's largest
    main strut force and stroke; its steps.
    """

    rtol: float
    steps: int
    force: float
    stroke: float

    @property
    def worst(self) -> float:
        """The larger of both."""
        return max(self.force, self.stroke)


@dataclass(frozen=True)
class Convergence:
    """Errors against a run at `reference`: on the arc from `start` to `end` [s], begun from one and
    the same state, and over the whole landing; `*_slope` is how many decades the worst error falls
    with a decade of tolerance (1: in proportion).
    """

    reference: float
    start: float
    end: float
    smooth: tuple[Errors, ...]
    contacts: tuple[Errors, ...]
    smooth_slope: float
    contacts_slope: float

    def record(self) -> dict[str, Any]:
        """The same for JSON."""
        return {
            "reference_rtol": self.reference,
            "smooth_arc": [self.start, self.end],
            "smooth": [vars(e) for e in self.smooth],
            "contacts": [vars(e) for e in self.contacts],
            "smooth_slope": self.smooth_slope,
            "contacts_slope": self.contacts_slope,
        }


def convergence(parameters: Parameters, until: float) -> Convergence:
    """Measure both, for the landing of `parameters` in their own mode until `until` [s].

    The reference runs by the other method, Dormand-Prince, at rtol 1e-12, or at 1e-11 or 1e-10
    where round-off at a corner of the friction stops it. Raises LandingError where none of them
    gets through.
    """
    rtol_used, reference, whole = _reference(parameters, until)
    reference.reset()
    start, end = smooth_arc(reference.run(until, SEARCH_STEP))
    reference.reset()
    reference.advance_to(start)
    state = reference.state()
    arc = reference.run(end, SAMPLE_STEP)
    smooth, contacts = [], []
    for rtol in RTOLS:
        landing = Landing(parameters, rtol=rtol)
        contacts.append(_errors(landing, landing.run(until, SAMPLE_STEP), whole, whole, rtol, 0))
        landing.restore(state)
        before = landing.statistics["steps"]
        smooth.append(_errors(landing, landing.run(end, SAMPLE_STEP), arc, whole, rtol, before))
    return Convergence(
        rtol_used, start, end, tuple(smooth), tuple(contacts), _slope(smooth), _slope(contacts)
    )


def _reference(parameters: Parameters, until: float) -> tuple[float, Landing, History]:
    for rtol in REFERENCE_RTOLS[:-1]:
        landing = Landing(parameters, rtol=rtol, method="dormand-prince")
        with suppress(LandingError):
            return rtol, landing, landing.run(until, SAMPLE_STEP)
    landing = Landing(parameters, rtol=REFERENCE_RTOLS[-1], method="dormand-prince")
    return REFERENCE_RTOLS[-1], landing, landing.run(until, SAMPLE_STEP)


def smooth_arc(history: History) -> tuple[float, float]:
    """Start and end [s] of the longest time in contact without an event, with 2 ms after and 1 ms
    before one left out.

    An event is where the equations have a corner: a footpad touches or leaves, its friction turns,
    a chamber's pressure passes the other's (the orifice changes area), a strut meets or leaves its
    stop at full extension.
    """
    signs = []
    for leg in LEGS:
        strut = f"leg[{leg}].main_strut"
        signs += [
            history[f"leg[{leg}].contact.active"],
            np.sign(history[f"leg[{leg}].contact.force_x"]),
        ]
        signs += [
            np.sign(history[f"{strut}.pressure_lower"] - history[f"{strut}.pressure_upper"]),
            np.sign(history[f"{strut}.stroke"]),
        ]
    changes = np.any(np.diff(np.array(signs), axis=1) != 0.0, axis=0)
    touching = np.any([history[f"leg[{leg}].contact.active"] > 0.0 for leg in LEGS], axis=0)
    events = np.flatnonzero(changes | ~touching[1:])
    ends = np.concatenate(([0], events, [len(history) - 1]))
    i = int(np.argmax(np.diff(ends)))
    start, end = float(history.time[ends[i]]), float(history.time[ends[i + 1]])
    short = min(1.0, 0.3 * (end - start) / AFTER_EVENT)
    return start + short * AFTER_EVENT, end - short * BEFORE_EVENT


def _errors(
    landing: Landing, found: History, reference: History, whole: History, rtol: float, before: int
) -> Errors:
    def worst(what: str) -> float:
        names = [f"leg[{leg}].main_strut.{what}" for leg in LEGS]
        size = max(float(np.abs(whole[name]).max()) for name in names)
        return (
            max(float(np.abs(found[name] - reference[name]).max()) for name in names) / size
            if size > 0.0
            else 0.0
        )

    return Errors(rtol, landing.statistics["steps"] - before, worst("force"), worst("stroke"))


def _slope(errors: list[Errors]) -> float:
    sizes = np.log10([max(e.worst, 1e-16) for e in errors])
    return float(np.polyfit(np.log10([e.rtol for e in errors]), sizes, 1)[0])
