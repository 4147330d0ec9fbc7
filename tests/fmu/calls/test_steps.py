"""Communication steps of any length, and the status functions."""

from __future__ import annotations

from ctypes import byref, c_char_p, c_double, c_int

import numpy as np
import pytest
from fmpy import fmi2, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmu_instance import DISCARD, ERROR, OK, assert_lands_like_landing

from rlv_landing import Landing
from rlv_landing.quantities import OUTPUT_NAMES


def test_status_functions_answer_what_they_can_and_discard_the_rest(instance):
    status, time, flag, number, text = c_int(9), c_double(), c_int(9), c_int(), c_char_p()
    instance.start()
    instance.steps(0, 3)
    assert instance.status("fmi2GetStatus", fmi2.fmi2DoStepStatus, byref(status)) == OK
    assert status.value == OK
    assert instance.step(3e-3, -1.0) == DISCARD
    assert instance.status("fmi2GetStatus", fmi2.fmi2DoStepStatus, byref(status)) == OK
    assert status.value == DISCARD
    assert instance.status("fmi2GetRealStatus", fmi2.fmi2LastSuccessfulTime, byref(time)) == OK
    assert time.value == pytest.approx(3e-3, abs=1e-15)
    assert instance.status("fmi2GetBooleanStatus", fmi2.fmi2Terminated, byref(flag)) == OK
    assert flag.value == 0
    assert instance.status("fmi2GetStringStatus", fmi2.fmi2PendingStatus, byref(text)) == OK
    assert text.value == b""
    for function, kind, place in (
        ("fmi2GetStatus", fmi2.fmi2Terminated, status),
        ("fmi2GetRealStatus", fmi2.fmi2Terminated, time),
        ("fmi2GetBooleanStatus", fmi2.fmi2LastSuccessfulTime, flag),
        ("fmi2GetIntegerStatus", fmi2.fmi2LastSuccessfulTime, number),
        ("fmi2GetStringStatus", fmi2.fmi2Terminated, text),
    ):
        assert instance.status(function, kind, byref(place)) == DISCARD
        assert f"{function}: this function does not answer status kind {kind}" in instance.reason()
    assert_lands_like_landing(instance, 3)


def test_results_are_the_same_for_steps_from_10_us_to_100_ms_in_any_order(make):
    """At common times, every 0.1 s, to 1e-9 of each quantity's largest value."""
    generator = np.random.default_rng(20240501)
    reals = [n for n in OUTPUT_NAMES if n != "status.phase" and not n.endswith("contact.active")]
    landing, rows = Landing(), []
    for k in range(1, 11):
        landing.advance_to(k * 0.1)
        rows.append([landing.get(n) for n in reals])
    expected = np.array(rows)
    for longest in (1e-5, 1e-3, 1e-2, 1e-1):
        instance = make()
        instance.start()
        vrs, time, found = [instance.vr[n] for n in reals], 0.0, []
        for k in range(1, 11):
            if longest == 1e-5:
                times = [
                    *(k * 0.1 - 0.1 + 1e-5 * generator.uniform(1.0, 2.0, 200).cumsum()),
                    k * 0.1,
                ]
            else:
                cuts = generator.uniform(k * 0.1 - 0.1, k * 0.1, int(0.1 / longest))
                times = [*np.unique(cuts), k * 0.1]
            for goal in times:
                if goal > time:
                    instance.slave.doStep(time, goal - time)
                    time = goal
            found.append(instance.slave.getReal(vrs))
        assert np.all(
            np.abs(np.array(found) - expected)
            <= 1e-9 * np.maximum(1.0, np.abs(expected).max(axis=0))
        )


def test_the_tenth_refusal_in_a_row_is_an_error_and_the_landing_goes_on_after(instance):
    instance.start()
    instance.steps(0, 3)
    instance.set("external.force_x", float("nan"))
    assert [instance.step(3e-3, 1e-3) for _ in range(11)] == [DISCARD] * 9 + [ERROR] * 2
    assert "external.force_x" in instance.reason()
    assert "refusal 11 in a row" in instance.reason()
    instance.set("external.force_x", 0.0)
    assert instance.step(3e-3, 1e-3) == OK
    assert_lands_like_landing(instance, 4)
    assert instance.step(0.0, 1e-3) == DISCARD


def test_an_importer_that_repeats_refused_steps_ends_with_the_reason(fmu, capfd):
    """FMPy's loop repeats a discarded step as it was."""
    pulse = np.array(
        [(0.0, 0.0), (0.01, np.nan), (0.1, 0.0)],
        dtype=[("time", float), ("external.force_x", float)],
    )
    with pytest.raises(FMICallException, match="error"):
        simulate_fmu(str(fmu), stop_time=0.1, output_interval=1e-3, input=pulse)
    assert "external.force_x" in capfd.readouterr().err


@pytest.mark.parametrize("start", [1e11, -1e11, 1e308])
def test_a_start_time_that_rounds_away_steps_is_an_error(instance, start):
    assert (
        instance.status("fmi2SetupExperiment", 0, c_double(0.0), c_double(start), 0, c_double())
        == ERROR
    )
    assert f"start time = {start:g} s is outside [-1e+10, 1e+10] s" in instance.reason()
    instance.start()
    assert instance.step(0.0, 1e-3) == OK


def test_a_step_beyond_the_longest_landing_is_refused(instance):
    """The instance stays usable, and the landing continues."""
    instance.start()
    for step in (1e9 + 1.0, 1e300):
        assert instance.step(0.0, step) == DISCARD
        assert "beyond 1e+09 s; make a shorter step" in instance.reason()
    assert_lands_like_landing(instance)
