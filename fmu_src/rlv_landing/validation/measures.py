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
from .first_contact import first_contact
from .first_stroke import State, first_stroke
from .strut_work import StrutCurves, smooth_work, work_of

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
        end: Time at which the rebound ends [s]: of a stroke of 0, or else of the smallest.
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


def damper_work(
    time: Array,
    force: Array,
    stroke: Array,
    start: float,
    rate: Array | None = None,
    work: Array | None = None,
) -> DamperWork:
    """The first compression and rebound after the contact at `start`, found in the curve.

    Args:
        time: Times of the samples [s], (n,).
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
        start: Time of contact [s].
        rate: Rate of the stroke [m/s], (n,), where the curves are a model's: smooth, so that the
            stroke is largest and smallest between samples. None: they are measured.
        work: Energy taken up until each sample [J], (n,); None: it is summed up.

    Raises:
        LandingError: There is no sample from `start` on.
    """
    return _work_along(*_curves_from(start, time, force, stroke, rate, work))


def _curves_from(
    start: float, time: Array, force: Array, stroke: Array, rate: Array | None, work: Array | None
) -> tuple[StrutCurves, float]:
    """The curves from the first sample from `start` [s] on, and the work until that sample [J]."""
    first = int(np.searchsorted(time, start))
    if first == len(time):
        raise LandingError(
            f"the contact at {start:g} s is after the last sample at {time[-1]:g} s; "
            "give a time that the curves cover"
        )
    if work is not None:
        done = work
    else:
        done = work_of(force, stroke) if rate is None else smooth_work(time, force, stroke, rate)
    curves = StrutCurves(
        time[first:],
        force[first:],
        stroke[first:],
        None if rate is None else rate[first:],
        done[first:],
    )
    return curves, float(done[first])


def _work_along(curves: StrutCurves, start: float) -> DamperWork:
    """The first compression and rebound after the first sample; `start` is the work [J] before."""
    stroke = curves.stroke
    found, peak = first_stroke(stroke), int(np.argmax(stroke))
    result = DamperWork(
        found.state, float(curves.time[0]), float(stroke[peak]), float(curves.time[peak])
    )
    if found.top is None:
        return result
    force_max = float(-curves.force[: found.top + 1].min())
    if not force_max > 0.0:
        return replace(result, state="not compressed")
    top = curves.turn(found.top)
    absorbed = top.work - start
    result = replace(
        result,
        top=top.time,
        force_max=force_max,
        stroke_max=top.stroke,
        absorbed=absorbed,
        efficiency=buffering_efficiency(absorbed, force_max, top.stroke),
    )
    if found.end is None:
        return result
    end = curves.extended(found.top, found.end) or curves.turn(found.end)
    return replace(result, end=end.time, dissipated=end.work - start)


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

    The motion after toppling does not count. Where the extremes of the landing are known, `largest`
    is the landing's, between its samples too, and so is `force_max` unless a later compression has
    a larger force.
    """
    history = before_toppling(history)
    found: dict[int, DamperWork] = {}
    for leg in history.legs if legs is None else legs:
        contact = first_contact(history, leg)
        if contact is not None:
            last = float(history.time[max(contact.sample - 1, 0)])
            name = f"leg[{leg}].main_strut"
            rate, done = (_column(history, f"{name}.{what}") for what in ("stroke_rate", "work"))
            force, stroke = history[f"{name}.force"], history[f"{name}.stroke"]
            curves, begun = _curves_from(last, history.time, force, stroke, rate, done)
            if done is not None:
                begun = contact.value(history, f"{name}.work")
            work = replace(_work_along(curves, begun), start=contact.time)
            found[leg] = work if history.extremes is None else _with_peaks(work, history, leg)
    return found


def _column(history: History, name: str) -> Array | None:
    return history[name] if name in history.names else None


def _with_peaks(work: DamperWork, history: History, leg: int) -> DamperWork:
    """The work with the landing's largest stroke and force in the place of the samples'."""
    name = f"leg[{leg}].main_strut"
    stroke = history.extreme(f"{name}.stroke")
    work = replace(work, largest=stroke.maximum, largest_time=stroke.maximum_time)
    if work.top is None or work.stroke_max is None or work.absorbed is None:
        return work
    after = int(np.searchsorted(history.time, work.top)) + 1
    force = history.extreme(f"{name}.force")
    if after < len(history) and force.minimum_time > history.time[after - 1]:
        force = history.until(after).extreme(f"{name}.force")
    size = -force.minimum
    efficiency = buffering_efficiency(work.absorbed, size, work.stroke_max)
    return replace(work, force_max=size, efficiency=efficiency)


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
