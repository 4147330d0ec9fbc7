"""The summary measures beside loops of known area and the model's own energies."""

from __future__ import annotations

import numpy as np
import pytest
from pytest import approx

from rlv_landing import LandingError
from rlv_landing.quantities import LEGS
from rlv_landing.validation.measures import (
    buffering_efficiency,
    damper_work,
    energy_discrepancy,
    leg_work,
    onset,
    rrms,
)
from rlv_landing.validation.strut_work import smooth_work, work_of

FMAX, SMAX = 5000.0, 0.025


def test_a_closed_ellipse_dissipates_its_area():
    """Force k s + b cos over stroke a sin: pi a b is dissipated; the spring gives all back.

    Compression is negative force.
    """
    angle = np.linspace(0.0, 2 * np.pi, 2001)
    stroke = SMAX * (1.0 + np.sin(angle))
    force = -(2e5 * stroke + 800.0 * np.cos(angle))
    assert work_of(force, stroke)[-1] == approx(np.pi * SMAX * 800.0, rel=1e-5)
    assert work_of(force[::-1], stroke[::-1])[-1] == approx(-np.pi * SMAX * 800.0, rel=1e-5)


def triangle(back: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, force and stroke along a triangle.

    It goes up a straight line to (SMAX, FMAX), and back along one that starts at `back` FMAX.
    """
    stroke = np.concatenate([np.linspace(0.0, SMAX, 101), np.linspace(SMAX, 0.0, 101)])
    force = -FMAX / SMAX * stroke
    force[101:] *= back
    time = np.concatenate([np.linspace(0.1, 0.2, 101), np.linspace(0.2, 0.3, 101)])
    return time, force, stroke


@pytest.mark.parametrize("back", [0.0, 0.3, 1.0])
def test_a_triangle_absorbs_half_the_rectangle_and_dissipates_what_does_not_come_back(back):
    found = damper_work(*triangle(back), start=0.1)
    assert found.absorbed == approx(0.5 * FMAX * SMAX)
    assert found.efficiency == approx(0.5)
    assert found.dissipated == approx(0.5 * FMAX * SMAX * (1.0 - back), abs=1e-9)
    assert (found.force_max, found.stroke_max, found.top, found.end) == approx(
        (FMAX, SMAX, 0.2, 0.3)
    )


def test_a_constant_force_has_efficiency_1():
    stroke = SMAX * np.sin(np.linspace(0.0, np.pi, 51))
    found = damper_work(np.linspace(0.0, 0.1, 51), np.full(51, -FMAX), stroke, 0.0)
    assert found.efficiency == approx(1.0)
    assert found.dissipated == approx(0.0, abs=1e-9)


def test_the_dampers_work_is_what_the_model_says_they_hold_and_have_dissipated(validation):
    """The work int -F ds is the change of liquid and stop energy plus the dissipation.

    Dissipation is in orifice, seal and stop; the sums are over the whole landing and all legs. The
    model's own works are that to the integrator's error. What is summed up from samples of 0.2 ms
    misses a little of the contacts' blows, less by cubics than by trapezoids.
    """
    for history in validation.histories.values():
        terms = ("liquid", "stop", "dissipated_orifice", "dissipated_seal", "dissipated_stop")
        kept = sum(history[f"energy.{t}"][-1] - history[f"energy.{t}"][0] for t in terms)
        ways = {"model": 0.0, "cubics": 0.0, "trapezoids": 0.0}
        for leg in LEGS:
            name = f"leg[{leg}].main_strut"
            force, stroke, rate, work = (
                history[f"{name}.{what}"] for what in ("force", "stroke", "stroke_rate", "work")
            )
            ways["model"] += work[-1]
            ways["cubics"] += smooth_work(history.time, force, stroke, rate)[-1]
            ways["trapezoids"] += work_of(force, stroke)[-1]
        assert ways["model"] == approx(kept, rel=2e-5)
        assert ways["cubics"] == approx(kept, rel=4e-4)
        assert ways["trapezoids"] == approx(kept, rel=2e-3)


def test_every_leg_has_its_work_and_mirror_images_the_same(validation):
    for mode, pair in (("2-2", (1, 2)), ("1-2-1", (2, 4))):
        work = leg_work(validation.histories[mode])
        assert sorted(work) == [1, 2, 3, 4]
        assert work[pair[0]] == work[pair[1]]
        for w in work.values():
            assert 0.0 < w.dissipated < w.absorbed < w.force_max * w.stroke_max
            assert w.start < w.top < w.end


def test_measured_strokes_start_where_they_leave_2_per_cent():
    time = np.linspace(0.0, 1.0, 1001)
    stroke = np.clip(time - 0.3, 0.0, 0.1)
    assert onset(time, stroke) == approx(0.302, abs=1.1e-3)


def test_rrms_of_a_scaled_curve_is_the_scales_distance_from_1():
    time = np.linspace(0.0, 1.0, 501)
    curve = np.sin(9.0 * time)
    assert rrms(time, 1.2 * curve, time, curve) == approx(0.2)
    assert rrms(time, curve, time, curve) == 0.0
    assert rrms(time, -curve, time, curve) == approx(2.0)


def test_rrms_is_taken_at_the_tests_times_inside_the_landing():
    time = np.linspace(0.0, 1.0, 1001)
    test_time = np.linspace(-0.5, 0.5, 37)
    assert rrms(time, 3.0 * time, test_time, 2.0 * test_time) == approx(0.5)


def test_energy_discrepancy_is_in_per_cent_of_the_measured():
    assert energy_discrepancy(120.0, 100.0) == approx(20.0)
    assert energy_discrepancy(80.0, 100.0) == approx(20.0)


def test_measures_that_cannot_be_taken_say_why():
    time = np.linspace(0.0, 1.0, 11)
    with pytest.raises(
        LandingError, match=r"force_max = 0 N and stroke_max = 0\.01 m must be above 0"
    ):
        buffering_efficiency(1.0, 0.0, 0.01)
    with pytest.raises(LandingError, match="contact at 2 s is after the last sample at 1 s"):
        damper_work(time, time, np.zeros(11), 2.0)
    with pytest.raises(LandingError, match="measured energy = 0 J"):
        energy_discrepancy(1.0, 0.0)
    with pytest.raises(LandingError, match="do not overlap; shift the measured times"):
        rrms(time, time, time + 2.0, time)
    with pytest.raises(LandingError, match="0 throughout"):
        rrms(time, time, time, np.zeros(11))
