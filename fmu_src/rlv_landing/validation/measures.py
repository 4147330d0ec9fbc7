"""The paper's summary measures: a damper's work, and curves beside measured ones.

Yue et al. (2022), section 5. Forces are those of the outputs: negative in compression [N]. Strokes
[m] are positive in compression. Energies [J] are positive where the damper takes them up.
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

    Attributes:
        start: Time of contact [s].
        top: Time of the largest stroke [s].
        end: Time of the smallest stroke after `top` [s].
        force_max: Largest compressive force during the compression, positive [N].
        stroke_max: Largest stroke [m].
        absorbed: Energy taken up until `top` (the paper's energy 1 and its Ed) [J].
        dissipated: Part of it that is not given back until `end` (the paper's energy 2) [J].
        efficiency: absorbed / (force_max stroke_max).
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
        """The measures for JSON."""
        return asdict(self)


def work_of(force: Array, stroke: Array) -> float:
    """Energy [J] that a damper takes up along a curve, positive in compression.

    E = int -F s' dt = -int F ds, Eq. (44) [paper]. It is summed by trapezoids over the stroke:
    exact for a force that is linear in stroke between samples.

    Args:
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
    """
    return float(-trapezoid(force, stroke))


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
    """The first compression and rebound after the contact at `start`.

    The windows are the paper's: 0.22 s for the largest stroke, 0.25 s after it for the smallest.

    Args:
        time: Times of the samples [s], (n,).
        force: Axial force, negative in compression [N], (n,).
        stroke: Stroke, positive in compression [m], (n,).
        start: Time of contact [s].

    Raises:
        LandingError: The strut is not compressed after `start`.
    """
    window = np.flatnonzero((time >= start) & (time <= start + STROKE_WINDOW))
    if not len(window) or not stroke[window].max() > 0.0:
        raise LandingError(
            f"the strut is not compressed within {STROKE_WINDOW:g} s after t = {start:g} s; "
            "it has no work to measure"
        )
    first, top = int(window[0]), int(window[np.argmax(stroke[window])])
    after = np.flatnonzero((time >= time[top]) & (time <= time[top] + REBOUND_WINDOW))
    end = int(after[np.argmin(stroke[after])])
    compression, period = slice(first, top + 1), slice(first, end + 1)
    absorbed = work_of(force[compression], stroke[compression])
    force_max, stroke_max = float(-force[compression].min()), float(stroke[top])
    return DamperWork(
        start=float(time[first]),
        top=float(time[top]),
        end=float(time[end]),
        force_max=force_max,
        stroke_max=stroke_max,
        absorbed=absorbed,
        dissipated=work_of(force[period], stroke[period]),
        efficiency=buffering_efficiency(absorbed, force_max, stroke_max),
    )


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


def leg_work(history: History) -> dict[int, DamperWork]:
    """The work of every damper that a landing compressed, by leg.

    Contact is the first sample at which the ground pushes on the footpad.
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
        raise LandingError("the measured curve is 0 throughout; RRMS has nothing to relate to")
    difference = np.interp(test_time[inside], time, values) - test
    return float(np.sqrt(np.mean(difference**2))) / size
