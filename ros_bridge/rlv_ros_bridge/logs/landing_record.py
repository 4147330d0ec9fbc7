"""A log's record of its landing's summary, so that nobody reads the messages for it.

It is a metadata record at the log's end. `landing` is a JSON object: what `rlv_landing.summary`
says of the landing's messages, with the outcome, and `acceleration_peak` for each leg. SI units.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from rlv_landing.core import Phase
from rlv_landing.errors import LandingError
from rlv_landing.history import History
from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS
from rlv_landing.summary import OUTCOMES, summarise
from rlv_landing.validation.first_stroke import State
from rlv_landing.validation.paper import reading_of

from ..fmu.peaks import Found, known_extremes

RECORD = "rlv_landing_summary"
LANDING = "landing"
# Samples that are kept for it: those of a minute in steps of 1 ms. A landing is over by then; of
# one whose legs are not at rest, or do not touch until then, there is no such record.
MOST_SAMPLES = 60_000
PHASE = "status.phase"
# names of the phases, as in `/diagnostics`, in the order of `rlv_landing.summary.OUTCOMES`
PHASES = tuple(phase.name.lower() for phase in Phase)
# what the messages have, too, so that both give the same
OF_A_LEG = (
    *("main_strut.force", "main_strut.stroke", "main_strut.stroke_rate"),
    "contact.force_y",
)
ENDED = ("complete", "not compressed")
# A text longer than this is none of it [characters].
LONGEST = 64 * 1024
# The fields of a leg, and what is neither number nor None among them and among the landing's.
LEG_NUMBERS = (
    *("main_strut_force_min", "main_strut_stroke_max", "auxiliary_strut_force_min"),
    *("auxiliary_strut_force_max", "contact_force_max"),
)
LEG_OPTIONAL = (
    *("contact_time", "main_strut_absorbed", "main_strut_dissipated", "main_strut_efficiency"),
    "acceleration_peak",
)


def landing_summary(history: History, outcome: str = "") -> dict[str, Any]:
    """The summary of a log's landing.

    It is that of `rlv_landing.summary`, with `acceleration_peak` [m/s2] for each leg: the largest
    at the top within 12 ms after its contact; None where the history ends before.

    Args:
        history: the landing.
        outcome: one of `OUTCOMES`, where the history has no phase.
    """
    landing = summarise(history)
    if outcome:
        landing["outcome"] = outcome
    try:
        reading = reading_of(history)
    except LandingError:
        return landing
    for leg in landing["legs"]:
        peak = reading.acceleration_peak(leg["leg"])
        leg["acceleration_peak"] = peak if peak == peak else None
    return landing


class LandingRows:
    """The first samples of a landing, for its summary at the log's end.

    Args:
        parameters: the landing's parameters.
    """

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        interface = parameters.interface
        self._columns = (
            *(f"leg[{leg}].{name}" for leg in interface.legs for name in OF_A_LEG),
            "body.top_axial_acceleration",
        )
        places = interface.output_names.index
        self._places = [places(name) for name in self._columns]
        self._phase_at = places(PHASE)
        self._times: list[NDArray[np.float64]] = []
        self._rows: list[NDArray[np.float64]] = []
        self._room = MOST_SAMPLES
        # time [s] and phase of the last sample
        self._last = 0.0, 0

    def add(self, times: NDArray[np.float64], samples: NDArray[np.float64]) -> None:
        """Adds samples.

        Args:
            times: (samples,) their times [s].
            samples: (samples, numbers) the numbers of each: its outputs in the order of the
                interface come first.
        """
        self._last = float(times[-1]), int(samples[-1, self._phase_at])
        if self._room:
            self._times.append(times[: self._room].copy())
            self._rows.append(samples[: self._room, self._places])
            self._room -= len(self._times[-1])

    def texts(self, peaks: Mapping[str, Found]) -> dict[str, str]:
        """The record's texts by name; empty where it cannot be made.

        Args:
            peaks: value and time of each peak by `OUTPUT.SIDE`.
        """
        if not self._times:
            return {}
        time, data = np.concatenate(self._times), np.concatenate(self._rows)
        history = History(time, self._columns, data, self._parameters)
        history.extremes = known_extremes(peaks, history)
        end, phase = self._last
        try:
            landing = landing_summary(history, OUTCOMES[phase])
            landing["end_time"] = end
            if end > time[-1] and not _is_over(landing):
                return {}
            return {LANDING: json.dumps(landing, allow_nan=False)}
        except (LandingError, KeyError, ValueError):
            return {}


def _is_over(landing: Mapping[str, Any]) -> bool:
    """Whether each leg has rebounded, or never touches."""
    return all(
        leg["main_strut_first_stroke"] in ENDED
        and (leg["contact_time"] is not None or leg["contact_force_max"] == 0.0)
        for leg in landing["legs"]
    )


def read_landing(texts: Mapping[str, str], legs: Sequence[int] = LEGS) -> dict[str, Any] | None:
    """The summary in the record; None where there is none of its layout.

    Args:
        texts: the record.
        legs: the numbers of the vehicle's legs.
    """
    if len(texts.get(LANDING, "")) > LONGEST:
        return None
    try:
        landing = json.loads(texts[LANDING])
        numbers = [landing["end_time"], landing["top_axial_acceleration_max"]]
        for number, leg in zip(legs, landing["legs"], strict=True):
            numbers += [leg[name] for name in LEG_NUMBERS]
            numbers += [leg[name] for name in LEG_OPTIONAL if leg.get(name) is not None]
            numbers += [leg["main_strut_stroke_max_time"]]
            if leg["leg"] != number or leg["main_strut_first_stroke"] not in get_args(State):
                return None
            if not leg.keys() >= set(LEG_OPTIONAL[:-1]):
                return None
        if landing["outcome"] not in OUTCOMES or landing["peaks_of"] not in ("landing", "samples"):
            return None
        if not set(landing["bottomed_out"]) <= set(legs):
            return None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    whole = all(isinstance(n, (int, float)) and np.isfinite(n) for n in numbers)
    return dict(landing) if whole else None
