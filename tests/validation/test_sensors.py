"""The sensor chain beside closed forms: gain, delay, and the input that it refuses."""

from __future__ import annotations

from math import pi, sqrt, tan

import numpy as np
import pytest
from pytest import approx
from scipy import signal

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.history import History
from rlv_landing.validation.sensors import (
    ACCELERATION,
    SAMPLING,
    STROKES,
    low_pass,
    resample,
    smooth_stroke,
    through_sensors,
)
from rlv_ros_bridge.messages.columns import COLUMN_NAMES

STROKE, FORCE = STROKES[0], "leg[1].main_strut.force"


def made(time: np.ndarray, **columns: np.ndarray) -> History:
    """A history of the columns named by `stroke`, `force`, `acceleration`, `active`."""
    names = {
        "stroke": STROKE,
        "force": FORCE,
        "acceleration": ACCELERATION,
        "active": "leg[1].contact.active",
    }
    return History(time, [names[n] for n in columns], np.column_stack(list(columns.values())))


def amplitude(t: np.ndarray, values: np.ndarray, frequency: float) -> float:
    """Amplitude of the sine at `frequency` in the middle half, by least squares."""
    middle = slice(len(t) // 4, 3 * len(t) // 4)
    basis = np.column_stack(
        [np.sin(2 * pi * frequency * t), np.cos(2 * pi * frequency * t), np.ones_like(t)]
    )[middle]
    return float(np.hypot(*np.linalg.lstsq(basis, values[middle], rcond=None)[0][:2]))


def butterworth(frequency: float) -> float:
    """Gain of a fourth-order digital Butterworth filter of 100 Hz at 5 kHz, in closed form.

    It is bilinear and pre-warped.
    """
    return float((1.0 + (tan(pi * frequency / 5000.0) / tan(pi * 100.0 / 5000.0)) ** 8) ** -0.5)


def two_passes(frequency: float) -> float:
    """Gain of two passes of order 2 that together have 3 dB at 100 Hz, in closed form."""
    ratio = tan(pi * frequency / 5000.0) / tan(pi * 100.0 / 5000.0)
    return 1.0 / (1.0 + (sqrt(2.0) - 1.0) * ratio**4)


@pytest.mark.parametrize("coefficients", [(3.0,), (-0.4, 2.0), (7.0, -0.3, 0.01)])
def test_polynomials_up_to_order_2_pass_the_stroke_smoothing_unchanged_ends_included(coefficients):
    stroke = np.polyval(coefficients, np.arange(200) / 50.0)
    assert smooth_stroke(stroke) == approx(stroke, abs=1e-11)


def test_the_stroke_smoothing_has_the_closed_form_weights_of_savitzky_and_golay():
    """w_i = 3 (3 m^2 + 3 m - 1 - 5 i^2)/((2 m + 3)(2 m + 1)(2 m - 1)) with order 2, m = 15."""
    impulse = np.zeros(101)
    impulse[50] = 1.0
    i = np.arange(-15, 16)
    weights = (
        3.0 * (3 * 15**2 + 3 * 15 - 1 - 5 * i**2) / ((2 * 15 + 3) * (2 * 15 + 1) * (2 * 15 - 1))
    )
    assert smooth_stroke(impulse)[35:66] == approx(weights, abs=1e-12)


@pytest.mark.parametrize("frequency", [20.0, 60.0, 100.0, 150.0, 300.0])
def test_the_low_pass_damps_as_butterworth_with_four_poles_in_one_pass_or_in_two(frequency):
    t = np.arange(5000) / SAMPLING
    sine = np.sin(2 * pi * frequency * t)
    assert amplitude(t, low_pass(sine, "forward"), frequency) == approx(
        butterworth(frequency), rel=1e-6
    )
    assert amplitude(t, low_pass(sine, "zero"), frequency) == approx(
        two_passes(frequency), rel=1e-6
    )


@pytest.mark.parametrize("phase", ["zero", "forward"])
def test_a_sine_at_the_papers_cut_off_of_100_hz_loses_3_db(phase):
    t = np.arange(5000) / SAMPLING
    kept = amplitude(t, low_pass(np.sin(2 * pi * 100.0 * t), phase), 100.0)
    assert 20 * np.log10(kept) == approx(-3.0103, abs=1e-4)


def test_the_zero_phase_low_pass_is_channel_class_60_of_impact_tests():
    """SAE J211: two passes of order 2 with the pole frequency 2.0775 times the class number."""
    t = np.arange(-2000, 2001) / SAMPLING
    pulse = np.exp(-((t / 0.003) ** 2))
    warped = tan(pi * 60.0 * 2.0775 / SAMPLING)
    a0 = warped**2 / (1.0 + sqrt(2.0) * warped + warped**2)
    b1 = -2.0 * (warped**2 - 1.0) / (1.0 + sqrt(2.0) * warped + warped**2)
    b2 = (-1.0 + sqrt(2.0) * warped - warped**2) / (1.0 + sqrt(2.0) * warped + warped**2)
    kept = pulse
    for _ in range(2):
        kept = signal.lfilter([a0, 2.0 * a0, a0], [1.0, -b1, -b2], kept)[::-1]
    # the standard rounds its factor to five digits, and takes the sampling's warping at the poles
    assert low_pass(pulse, "zero") == approx(kept, abs=1e-3)


def test_zero_phase_keeps_a_pulses_time_and_symmetry_and_forward_delays_a_ramp_by_4_2_ms():
    """Group delay at rest of the bilinear Butterworth filter.

    It is 2.6131 (sum of its sections' 1/Q) T/2 / tan(pi fc T).
    """
    t = np.arange(-1000, 1001) / SAMPLING
    pulse = np.exp(-((t / 0.004) ** 2))
    kept = low_pass(pulse, "zero")
    assert t[kept.argmax()] == 0.0
    assert kept == approx(kept[::-1], abs=1e-9)
    late = low_pass(t, "forward")
    delay = 2.613125929752753 * 0.5 / SAMPLING / tan(pi * 100.0 / SAMPLING)
    assert delay == approx(4.2e-3, abs=0.1e-3)
    assert late[-500:] == approx(t[-500:] - delay, abs=1e-9)


def test_the_chain_leaves_forces_at_5_khz_raw_to_the_digit():
    history = Landing(load_preset("yue2022-figures")).run(0.3, 1.0 / SAMPLING)
    sensed = through_sensors(history)
    changed = {name for name in history.names if not np.array_equal(history[name], sensed[name])}
    assert changed == {*STROKES, ACCELERATION}
    assert np.array_equal(sensed.time, history.time)


@pytest.mark.parametrize("rate", [20000.0, 50000.0, 12000.0])
def test_finer_samples_are_decimated_without_aliases(rate):
    """4 kHz would fold to 1 kHz at 5 kHz; it is removed, while 50 Hz and flags stay."""
    t = np.arange(int(0.4 * rate)) / rate
    active = (t > 0.2).astype(float)
    history = made(t, force=np.sin(2 * pi * 50.0 * t) + np.sin(2 * pi * 4000.0 * t), active=active)
    sampled = resample(history)
    assert np.diff(sampled.time) == approx(1.0 / SAMPLING)
    assert amplitude(sampled.time, sampled[FORCE], 50.0) == approx(1.0, abs=2e-3)
    assert amplitude(sampled.time, sampled[FORCE], 1000.0) < 1e-2
    assert set(np.unique(sampled["leg[1].contact.active"])) == {0.0, 1.0}


def test_a_logs_1_khz_is_interpolated_without_peaks_of_its_own():
    t = np.arange(401) * 1e-3
    history = made(
        t, stroke=1e-2 * np.sin(2 * pi * 5.0 * t), force=-1e3 * np.abs(np.sin(2 * pi * 5.0 * t))
    )
    sampled = resample(history)
    assert len(sampled) == 2001
    assert sampled[STROKE] == approx(1e-2 * np.sin(2 * pi * 5.0 * sampled.time), abs=1e-5)
    assert sampled[FORCE].min() >= history[FORCE].min()
    assert sampled[FORCE].max() <= history[FORCE].max()


def test_the_columns_of_a_log_go_through_the_chain():
    landing = Landing(load_preset("yue2022-figures")).run(0.4, 1e-3)
    log = History(
        landing.time, COLUMN_NAMES, np.column_stack([landing[name] for name in COLUMN_NAMES])
    )
    sensed = through_sensors(log, "forward")
    assert sensed.names == tuple(COLUMN_NAMES)
    assert len(sensed) == 2001
    assert sensed[STROKE].max() == approx(landing[STROKE].max(), rel=1e-3)


def broken(what: str) -> History:
    t = np.arange(500) / SAMPLING
    stroke = 1e-2 * np.sin(20.0 * t)
    if what == "nan":
        stroke[100] = np.nan
    elif what == "inf":
        stroke[100] = np.inf
    elif what == "gap":
        t[250:] += 0.01
    elif what == "back":
        t[250] = t[248]
    elif what == "twice":
        t[250] = t[249]
    elif what == "uneven":
        t[250] += 0.5 / SAMPLING
    elif what == "nan time":
        t[250] = np.nan
    elif what == "coarse":
        t *= 10.0
    elif what == "short":
        t, stroke = t[:20], stroke[:20]
    elif what == "one":
        t, stroke = t[:1], stroke[:1]
    return made(t, stroke=stroke)


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("nan", r"leg\[1\]\.main_strut\.stroke = nan m at t = 0\.02 s; .* cut the history there"),
        ("inf", r"stroke = inf m at t = 0\.02 s"),
        (
            "gap",
            (
                r"time goes on by 0\.0102 s at t = 0\.0498 s "
                r"where samples are 0\.0002 s apart; .* resample"
            ),
        ),
        ("back", r"time goes back by 0\.0002 s at t = 0\.0498 s"),
        ("twice", r"time stands still for 0 s at t = 0\.0498 s"),
        ("uneven", r"time goes on by 0\.0003 s at t = 0\.0498 s"),
        ("nan time", r"time of sample 250 = nan s is not finite"),
        (
            "coarse",
            r"0\.002 s apart, the sensor chain needs 0\.001 s or less; run or record it finer",
        ),
        ("short", r"20 samples at 5000 Hz, .* needs 31; run it longer"),
        ("one", r"1 samples; .* at least two"),
    ],
)
def test_gaps_nan_and_uneven_sampling_are_refused_with_place_value_and_remedy(what, message):
    with pytest.raises(LandingError, match=message) as e:
        through_sensors(broken(what))
    assert "\n" not in str(e.value)


def test_an_unknown_phase_is_refused():
    with pytest.raises(LandingError, match="unknown phase 'linear'; known are zero, forward"):
        through_sensors(broken(""), "linear")
