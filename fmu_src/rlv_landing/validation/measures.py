"""The paper's summary measures: a damper's work, and curves beside measured ones.

Yue et al. (2022), section 5. Forces are those of the outputs: negative in compression [N]. Strokes
[m] are positive in compression. Energies [J] are positive where the damper takes them up.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core import Phase
from ..errors import LandingError
from ..history import History
from .first_stroke import State, first_stroke

Array = NDArray[np.float64]
ONSET = 0.02


@dataclass(frozen=True)
class DamperWork:
    """One damper's first compression and rebound, as far as the curves show them.

    What the curves do not show is None: `top` to `efficiency` where they end in the compression or
    the damper was not compressed, `end` and `dissipated` where they end in the rebound as well.

    Attributes:
        state: `not compressed`, `in compression`, `in rebound` or `complete`, see `FirstStroke`.
        start: Time of contact [s].
        largest: Largest stroke from the contact to the end of the curves [m].
        largest_time: Its time [s].
        top: Time of the largest stroke of the first compression [s].
        end: Time of the smallest stroke of the rebound [s].
        force_max: Largest compressive force during the compression, positive [N].
        stroke_max: Largest stroke of the first compression [m].
        absorbed: Energy taken up until `top` (the paper's energy 1 and its Ed) [J].
        dissipated: Part of it that is not given back until `end` (the paper's energy 2) [J].
        efficiency: absorbed / (force_max stroke_max).
    """

    state: State
    start: float
    largest: float
    largest_time: float
    top: float | None = None
    end: float | None = None
    force_max: float | None = None
    stroke_max: float | None = None
    absorbed: float | None = None
    dissipated: float | None = None
    efficiency: float | None = None

    def record(self) -> dict[str, Any]:
        """The measures for JSON."""
        return asdict(self)

    @property
    def note(self) -> str:
        """Reason why measures are missing; empty where none is."""
        return {
            "not compressed": "its damper was not compressed",
            "in compression": "ends in the first compression: no measures; run it longer",
            "in rebound": "ends in the first rebound: dissipated is not known; run it longer",
            "complete": "",
        }[self.state]


def work_of(force: Array, stroke: Array) -> float:
    """Energy [J] that a damper takes up along a curve, positive in compression.

    E = int -F s' dt = -int F ds, Eq. (44) [paper]. It is summed by trapezoids over the stroke:
    exact for a force that is linear in stroke between samples.

    Args:
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
    """
    return float(-np.trapezoid(force, stroke))


def buffering_efficiency(absorbed: float, force_max: float, stroke_max: float) -> float:
    """Absorbed energy as a part of the largest force times the largest stroke.

    eta = Ed/(Fmax Smax). [paper]

    Args:
        absorbed: Absorbed energy [J].
        force_max: Largest compressive force [N].
        stroke_max: Largest stroke [m].

    Raises:
        LandingError: Force or stroke is not above 0: a damper that was not compressed has no
            efficiency.
    """
    if not (force_max > 0.0 and stroke_max > 0.0):
        raise LandingError(
            f"force_max = {force_max:g} N and stroke_max = {stroke_max:g} m must be above 0: "
            "this damper was not compressed"
        )
    return absorbed / (force_max * stroke_max)


def energy_discrepancy(energy: float, measured: float) -> float:
    """Discrepancy [%] of a simulated energy from a measured one: 100 |Es - Ee|/Ee.

    Eq. (45) [paper]. The paper's sentence calls Es the experiment's and Ee the simulation's; the
    subscripts, and the RRMS beside it, have it the other way.

    Args:
        energy: Simulated energy [J].
        measured: Measured energy [J].

    Raises:
        LandingError: The measured energy is 0 or not finite.
    """
    if not abs(measured) > 0.0 or not np.isfinite(measured):
        raise LandingError(
            f"measured energy = {measured:g} J cannot be compared with; "
            "it must be finite and not 0 J"
        )
    return float(100.0 * abs(energy - measured) / abs(measured))


def damper_work(time: Array, force: Array, stroke: Array, start: float) -> DamperWork:
    """The first compression and rebound after the contact at `start`, found in the curve.

    Args:
        time: Times of the samples [s], (n,).
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
        start: Time of contact [s].

    Raises:
        LandingError: There is no sample from `start` on.
    """
    first = int(np.searchsorted(time, start))
    if first == len(time):
        raise LandingError(
            f"the contact at {start:g} s is after the last sample at {time[-1]:g} s; "
            "give a time that the curves cover"
        )
    time, force, stroke = time[first:], force[first:], stroke[first:]
    found, peak = first_stroke(stroke), int(np.argmax(stroke))
    work = DamperWork(found.state, float(time[0]), float(stroke[peak]), float(time[peak]))
    if found.top is None:
        return work
    compression = slice(0, found.top + 1)
    absorbed = work_of(force[compression], stroke[compression])
    force_max, stroke_max = float(-force[compression].min()), float(stroke[found.top])
    if not force_max > 0.0:
        return replace(work, state="not compressed")
    work = replace(
        work,
        top=float(time[found.top]),
        force_max=force_max,
        stroke_max=stroke_max,
        absorbed=absorbed,
        efficiency=buffering_efficiency(absorbed, force_max, stroke_max),
    )
    if found.end is None:
        return work
    period = slice(0, found.end + 1)
    dissipated = work_of(force[period], stroke[period])
    return replace(work, end=float(time[found.end]), dissipated=dissipated)


def onset(time: Array, stroke: Array) -> float:
    """Time [s] at which the compression of a measured strut starts.

    It is the last sample before the stroke first passes 2 % of its largest.
    """
    passed = np.flatnonzero(stroke > ONSET * stroke.max())
    return (
        float(time[max(int(passed[0]) - 1, 0)])
        if len(passed) and stroke.max() > 0.0
        else float(time[0])
    )


def leg_work(history: History, legs: Iterable[int] | None = None) -> dict[int, DamperWork]:
    """The work of the dampers of those of `legs` that touch the ground, by leg; None: of all.

    Contact is the first sample at which the ground pushes on the footpad. The motion after toppling
    does not count. `largest` is the landing's, between its samples too, where it is known.
    """
    history = before_toppling(history)
    found: dict[int, DamperWork] = {}
    for leg in history.legs if legs is None else legs:
        first = first_push(history, leg)
        if first is not None:
            stroke = f"leg[{leg}].main_strut.stroke"
            work = damper_work(
                history.time,
                history[f"leg[{leg}].main_strut.force"],
                history[stroke],
                float(history.time[max(first - 1, 0)]),
            )
            if history.extremes is not None:
                peak = history.extreme(stroke)
                work = replace(work, largest=peak.maximum, largest_time=peak.maximum_time)
            found[leg] = work
    return found


def first_push(history: History, leg: int) -> int | None:
    """The first sample with the ground pushing on the leg's footpad; None without any."""
    pushed = history[f"leg[{leg}].contact.force_y"] > 0.0
    first = int(np.argmax(pushed))
    return first if pushed[first] else None


def before_toppling(history: History) -> History:
    """The landing until it topples for good; the whole where it does not or no phase is known."""
    phase = history["status.phase"] if "status.phase" in history else np.zeros(1)
    if phase[-1] != Phase.TOPPLED:
        return history
    other = np.flatnonzero(phase != Phase.TOPPLED)
    end = int(other[-1]) + 2 if len(other) else 1
    return history.until(end)


def rrms(time: Array, values: Array, test_time: Array, test_values: Array) -> float:
    """Relative root mean square rms(simulation - test)/rms(test), a fraction.

    It is taken at the test's times that the simulation covers; the simulation is interpolated.
    [paper: name; derived: formula]

    Args:
        time: Times of the simulation [s], (n,).
        values: The simulation's values, (n,).
        test_time: Times of the test [s], (m,).
        test_values: The test's values, (m,).

    Raises:
        LandingError: Fewer than two of the test's times are covered, or the test is 0 throughout.
    """
    inside = (test_time >= time[0]) & (test_time <= time[-1])
    if inside.sum() < 2:
        raise LandingError(
            f"the measured curve (t = {test_time[0]:g} to {test_time[-1]:g} s) and the landing "
            f"(t = {time[0]:g} to {time[-1]:g} s) do not overlap; "
            "shift the measured times to the landing's"
        )
    test = test_values[inside]
    size = float(np.sqrt(np.mean(test**2)))
    if size == 0.0:
        raise LandingError(
            "the measured curve is 0 throughout, and RRMS has nothing to relate to; "
            "leave the column out"
        )
    difference = np.interp(test_time[inside], time, values) - test
    return float(np.sqrt(np.mean(difference**2))) / size
