"""The paper's summary measures of a damper's work and of curves beside measured ones.

Yue et al. (2022), section 5.

Forces are the user's: negative in compression [N]; strokes [m] are positive in compression.
Energies [J] that the damper takes up are positive.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from ..errors import LandingError
from ..history import History
from ..quantities import LEGS
from .reading import REBOUND_WINDOW, STROKE_WINDOW

Array = NDArray[np.float64]
ONSET = 0.02


@dataclass(frozen=True)
class DamperWork:
    """One damper's first compression and rebound.

    `start`, `top`, `end` [s] are the times of contact, of the largest stroke and of the smallest
    stroke after it; `force_max` [N] is the largest compressive force during compression, positive;
    `stroke_max` [m]; `absorbed` [J] the energy taken up until `top` (the paper's energy 1 and its
    Ed), `dissipated` [J] what of it is not given back until `end` (energy 2); `efficiency` =
    absorbed/(force_max stroke_max).
    """

    start: float
    top: float
    end: float
    force_max: float
    stroke_max: float
    absorbed: float
    dissipated: float
    efficiency: float

    def record(self) -> dict[str, float]:
        """The same for JSON."""
        return asdict(self)


def work_of(force: Array, stroke: Array) -> float:
    """Energy [J] that a damper takes up along a curve: E = int -F s' dt = -int F ds, Eq.

    (44); positive in compression. [paper]

    Trapezoids over the stroke: exact for a force that is linear in stroke between samples.
    """
    return float(-trapezoid(force, stroke))


def buffering_efficiency(absorbed: float, force_max: float, stroke_max: float) -> float:
    """Share of the rectangle force_max [N] times stroke_max [m] that was absorbed [J]: eta =
    Ed/(Fmax Smax). [paper]

    Raises LandingError unless force and stroke are above 0: a damper that was not compressed has no
        efficiency.
    """
    if not (force_max > 0.0 and stroke_max > 0.0):
        raise LandingError(
            f"force_max = {force_max:g} N and stroke_max = {stroke_max:g} m must be above 0: this damper was not compressed"
        )
    return absorbed / (force_max * stroke_max)


def energy_discrepancy(energy: float, measured: float) -> float:
    """100 |Es - Ee|/Ee [%] of a simulated `energy` beside a `measured` one, Eq. (45). [paper]

    The paper's sentence calls Es the experiment's and Ee the simulation's; the subscripts, and the
    RRMS beside it, have it the other way. Raises LandingError where the measured energy is 0 or not
    finite.
    """
    if not abs(measured) > 0.0 or not np.isfinite(measured):
        raise LandingError(
            f"measured energy = {measured:g} J cannot be compared with; it must be finite and not 0 J"
        )
    return float(100.0 * abs(energy - measured) / abs(measured))


def damper_work(time: Array, force: Array, stroke: Array, start: float) -> DamperWork:
    """The first compression and rebound after the contact at `start` [s], with the paper's windows:
    0.22 s for the largest stroke, 0.25 s after it for the smallest. Raises LandingError where the
    strut is not compressed after `start`.
    """
    window = np.flatnonzero((time >= start) & (time <= start + STROKE_WINDOW))
    if not len(window) or not stroke[window].max() > 0.0:
        raise LandingError(
            f"the strut is not compressed within {STROKE_WINDOW:g} s after t = {start:g} s; it has no work to measure"
        )
    first, top = int(window[0]), int(window[np.argmax(stroke[window])])
    after = np.flatnonzero((time >= time[top]) & (time <= time[top] + REBOUND_WINDOW))
    end = int(after[np.argmin(stroke[after])])
    compression, period = slice(first, top + 1), slice(first, end + 1)
    absorbed = work_of(force[compression], stroke[compression])
    force_max, stroke_max = float(-force[compression].min()), float(stroke[top])
    return DamperWork(
        float(time[first]), float(time[top]), float(time[end]), force_max, stroke_max,
        absorbed, work_of(force[period], stroke[period]), buffering_efficiency(absorbed, force_max, stroke_max),
    )  # fmt: skip


def onset(time: Array, stroke: Array) -> float:
    """When a measured strut starts to be compressed [s]: the last sample before the stroke first
    passes 2 % of its largest.
    """
    passed = np.flatnonzero(stroke > ONSET * stroke.max())
    return (
        float(time[max(int(passed[0]) - 1, 0)])
        if len(passed) and stroke.max() > 0.0
        else float(time[0])
    )


def leg_work(history: History) -> dict[int, DamperWork]:
    """The work of every damper that a landing compressed, by leg; contact is when the ground first
    pushes on the footpad.
    """
    found: dict[int, DamperWork] = {}
    for leg in LEGS:
        touching = np.flatnonzero(history[f"leg[{leg}].contact.force_y"] > 0.0)
        stroke = history[f"leg[{leg}].main_strut.stroke"]
        if len(touching) and stroke[touching[0] :].max() > 0.0:
            start = float(history.time[max(int(touching[0]) - 1, 0)])
            found[leg] = damper_work(
                history.time, history[f"leg[{leg}].main_strut.force"], stroke, start
            )
    return found


def rrms(time: Array, values: Array, test_time: Array, test_values: Array) -> float:
    """rms(simulation - test)/rms(test), a fraction, at the test's times that the simulation covers;
    the simulation is interpolated. [paper: name; derived: formula]

    Raises LandingError where fewer than two of the test's times are covered or the test is 0
    throughout.
    """
    inside = (test_time >= time[0]) & (test_time <= time[-1])
    if inside.sum() < 2:
        raise LandingError(
            f"the measured curve (t = {test_time[0]:g} to {test_time[-1]:g} s) and the landing (t = {time[0]:g} to {time[-1]:g} s) "
            "do not overlap; shift the measured times to the landing's"
        )
    test = test_values[inside]
    size = float(np.sqrt(np.mean(test**2)))
    if size == 0.0:
        raise LandingError("the measured curve is 0 throughout; RRMS has nothing to relate to")
    difference = np.interp(test_time[inside], time, values) - test
    return float(np.sqrt(np.mean(difference**2))) / size
