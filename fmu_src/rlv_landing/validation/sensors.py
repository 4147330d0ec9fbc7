"""The drop tests' sensor chain, for the history of a landing or of a log.

Yue et al. (2022), section 4, state: sampling at 5 kHz; damper strokes smoothed by Savitzky and
Golay (order 2, window 31); the acceleration along the body's axis low-passed at 100 Hz; forces
neither smoothed nor filtered.

The paper names neither the low-pass nor its phase, only its cut-off: a Butterworth filter with four
poles and 3 dB at 100 Hz here [closure]. `phase="zero"` (default) is channel class 60 of impact
tests (ISO 6487, SAE J211): order 2, forward and backward, of a cut-off such that both passes
together have 3 dB at 100 Hz. Peaks keep their times, as they do in the centred Savitzky-Golay
smoothing, so that all channels share one time axis. `phase="forward"` runs order 4 once, as a
filter in the instrument would: slow signals come 4.2 ms late.
"""

from __future__ import annotations

from fractions import Fraction
from math import atan, inf, pi, sqrt, tan
from typing import Literal

import numpy as np
import scipy
from numpy.typing import NDArray

from ..errors import LandingError, unknown
from ..history import History
from ..quantities import LEGS, OUTPUT_QUANTITIES

Phase = Literal["zero", "forward"]

SAMPLING = 5000.0
STROKE_ORDER, STROKE_WINDOW = 2, 31
# 3 dB frequency [Hz] and poles of the low-pass, all passes together
CUTOFF, POLES = 100.0, 4
# of two passes of order n each has 1.5 dB where both have 3 dB: (sqrt(2) - 1)^(1/(2 n)) of its own
# cut-off
BOTH_PASSES = (sqrt(2.0) - 1.0) ** (1.0 / POLES)
COARSEST_STEP = 1e-3
STEP_TOLERANCE = 1e-6
JITTER = 1e-3

STROKES = tuple(f"leg[{leg}].main_strut.stroke" for leg in LEGS)
ACCELERATION = "body.top_axial_acceleration"
UNITS = {q.name: q.unit for q in OUTPUT_QUANTITIES}
COUNTED = frozenset(q.name for q in OUTPUT_QUANTITIES if q.kind != "real")


def through_sensors(history: History, phase: Phase = "zero") -> History:
    """A history as the tests' sensors would have recorded it.

    All columns are at 5 kHz, strokes smoothed, the acceleration low-passed. Samples finer than 0.2
    ms are decimated behind a zero-phase anti-aliasing filter. Coarser ones, down to 1 kHz (a
    log's), are interpolated by monotone cubics, which add no peaks but cannot bring back what lies
    above half their rate.

    Raises:
        LandingError: A value is not finite, samples are missing, uneven, coarser than 1 ms or fewer
            than 31 at 5 kHz; or the phase is unknown.
    """
    if phase not in ("zero", "forward"):
        raise unknown("phase", phase, ("zero", "forward"))
    sampled = resample(history)
    if len(sampled) < STROKE_WINDOW:
        raise LandingError(
            f"the history has {len(sampled)} samples at {SAMPLING:g} Hz, "
            f"the smoothing of strokes needs {STROKE_WINDOW}; run it longer"
        )
    data = sampled.data.copy()
    for i, name in enumerate(sampled.names):
        if name in STROKES:
            data[:, i] = smooth_stroke(data[:, i])
        elif name == ACCELERATION:
            data[:, i] = low_pass(data[:, i], phase)
    return History(sampled.time, sampled.names, data, history.parameters)


def smooth_stroke(stroke: NDArray[np.float64]) -> NDArray[np.float64]:
    """Savitzky-Golay smoothing (order 2, window 31) of a stroke sampled at 5 kHz.

    The ends follow the last window's parabola. [paper]
    """
    return np.asarray(
        scipy.signal.savgol_filter(stroke, STROKE_WINDOW, STROKE_ORDER, mode="interp")
    )


def low_pass(acceleration: NDArray[np.float64], phase: Phase = "zero") -> NDArray[np.float64]:
    """Low-pass of samples at 5 kHz: Butterworth, four poles, 3 dB at 100 Hz.

    It starts from rest at the first sample. [paper: cut-off; closure: filter]
    """
    if phase == "zero":
        # each pass in the bilinear transform's own frequencies, so that 100 Hz has 3 dB exactly
        single = atan(tan(pi * CUTOFF / SAMPLING) / BOTH_PASSES) * SAMPLING / pi
        sections = scipy.signal.butter(POLES // 2, single, fs=SAMPLING, output="sos")
        return np.asarray(
            scipy.signal.sosfiltfilt(sections, acceleration, padlen=min(len(acceleration) - 1, 250))
        )
    sections = scipy.signal.butter(POLES, CUTOFF, fs=SAMPLING, output="sos")
    start = scipy.signal.sosfilt_zi(sections) * acceleration[0]
    return np.asarray(scipy.signal.sosfilt(sections, acceleration, zi=start)[0])


def resample(history: History, rate: float = SAMPLING) -> History:
    """`history` at `rate` [Hz], from its first to its last time.

    Raises:
        LandingError: As `through_sensors`.
    """
    step = even_step(history)
    if step > COARSEST_STEP * (1.0 + STEP_TOLERANCE):
        raise LandingError(
            f"the history's samples are {step:g} s apart, "
            f"the sensor chain needs {COARSEST_STEP:g} s or less; run or record it finer"
        )
    ratio = step * rate
    start = history.time[0]
    time = (
        start + np.arange(int((history.time[-1] - start) * rate * (1.0 + 1e-12) + 1e-6) + 1) / rate
    )
    if abs(ratio - 1.0) <= STEP_TOLERANCE:
        return History(history.time, history.names, history.data, history.parameters)
    counted = np.array([name in COUNTED for name in history.names], dtype=bool)
    if ratio > 1.0:
        data = scipy.interpolate.PchipInterpolator(
            history.time, history.data, axis=0, extrapolate=True
        )(time)
    else:
        share = Fraction(ratio).limit_denominator(1000)
        if abs(float(share) / ratio - 1.0) > STEP_TOLERANCE:
            raise LandingError(
                f"the history's samples are {step:.9g} s apart, which no ratio of small numbers "
                f"brings to {rate:g} Hz; run it with --every 2e-5"
            )
        data = scipy.signal.resample_poly(
            history.data, share.numerator, share.denominator, axis=0, padtype="line"
        )[: len(time)]
    nearest = np.clip(np.rint((time - start) / step).astype(int), 0, len(history) - 1)
    data[:, counted] = history.data[nearest][:, counted]
    return History(time, history.names, data, history.parameters)


def even_step(history: History) -> float:
    """The time between samples [s], even to 0.1 % (times that were rounded).

    Raises:
        LandingError: A value is not finite, or times are uneven, go back or have a gap; the message
            names time and value.
    """
    time = history.time
    if len(time) < 2:
        raise LandingError(
            f"the history has {len(time)} samples; the sensor chain needs at least two"
        )
    wrong = np.argwhere(~np.isfinite(time))
    if len(wrong):
        raise LandingError(
            f"time of sample {wrong[0][0]} = {time[wrong[0][0]]:g} s is not finite; "
            "remove that sample's row and resample"
        )
    steps = np.diff(time)
    step = float(np.median(steps))
    allowed = JITTER * step if 0.0 < step < inf else -1.0
    uneven = np.flatnonzero(~(np.abs(steps - step) <= allowed))
    if len(uneven):
        i = int(uneven[0])
        what = (
            "goes back by"
            if steps[i] < 0.0
            else "stands still for"
            if steps[i] == 0.0
            else "goes on by"
        )
        raise LandingError(
            f"time {what} {abs(steps[i]):g} s at t = {time[i]:g} s "
            f"where samples are {step:g} s apart; the sensor chain needs even sampling "
            "without gaps: cut the history there, or resample it"
        )
    missing = np.argwhere(~np.isfinite(history.data))
    if len(missing):
        row, column = missing[0]
        name = history.names[column]
        value = f"{history.data[row, column]:g} {UNITS.get(name, '')}".rstrip()
        raise LandingError(
            f"{name} = {value} at t = {time[row]:g} s; the sensor chain needs finite values: "
            "cut the history there, or fill it"
        )
    return float(time[-1] - time[0]) / (len(time) - 1)
