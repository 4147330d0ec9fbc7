"""The integrator's error as a function of its tolerance.

It is measured on a smooth arc of a landing, and across all of its contacts.
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

REFERENCE_RTOLS = (1e-12, 1e-11, 1e-10)
RTOLS = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
SEARCH_STEP = 1e-4
SAMPLE_STEP = 5e-4
AFTER_EVENT, BEFORE_EVENT = 2e-3, 1e-3


@dataclass(frozen=True)
class Errors:
    """The largest errors of a run against the reference run.

    Attributes:
        rtol: The run's relative tolerance.
        steps: The run's steps.
        force: Error of the main struts' forces, as a part of the landing's largest.
        stroke: Error of the main struts' strokes, as a part of the landing's largest.
    """

    rtol: float
    steps: int
    force: float
    stroke: float

    @property
    def worst(self) -> float:
        """The larger of both errors."""
        return max(self.force, self.stroke)


@dataclass(frozen=True)
class Convergence:
    """Errors by tolerance.

    Attributes:
        reference: The reference run's relative tolerance.
        start: Start of the smooth arc [s].
        end: End of the smooth arc [s].
        smooth: Errors on the arc; all runs start there from one and the same state.
        contacts: Errors over the whole landing.
        smooth_slope: Decades of the worst error on the arc per decade of tolerance (1: in
            proportion).
        contacts_slope: The same over the whole landing.
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
    """Measure the errors for the landing of `parameters` in their own mode, to `until` [s].

    The reference runs by the other method, Dormand-Prince, at rtol 1e-12, or at 1e-11 or 1e-10
    where round-off at a corner of the friction stops it.

    Raises:
        LandingError: No reference run succeeds.
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
    """Start and end [s] of the longest period in contact without an event.

    The period ends 1 ms before the next event and starts 2 ms after the last. At an event the
    equations have a corner: a footpad touches or leaves, its friction turns, a chamber's pressure
    passes the other's (the orifice changes area), or a strut meets or leaves its stop at full
    extension.
    """
    signs = []
    for leg in history.legs:
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
    touching = np.any([history[f"leg[{leg}].contact.active"] > 0.0 for leg in history.legs], axis=0)
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
        names = [f"leg[{leg}].main_strut.{what}" for leg in found.legs]
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
