"""The FMU of FMI 3.0 lands in FMPy to the digits of FMI 2.0's, with events and without."""

from __future__ import annotations

import subprocess
import sys

import fmpy
import numpy as np
import pytest

EVENTS = {"use_event_mode": True, "early_return_allowed": True}


def landed(file, **wishes):
    return fmpy.simulate_fmu(str(file), stop_time=0.4, output_interval=1e-3, **wishes)


@pytest.fixture(scope="module")
def rows(fmu3):
    return landed(fmu3)


def test_all_outputs_have_the_very_digits_of_fmi_2(fmu, rows):
    of_fmi2 = landed(fmu)
    compared = 0
    for name in rows.dtype.names:
        columns = rows[name].T if rows[name].ndim == 2 else [rows[name]]
        for k, column in enumerate(columns, start=1):
            assert np.array_equal(column, of_fmi2[name.replace("leg.", f"leg[{k}].")]), name
            compared += 1
    assert compared == len(of_fmi2.dtype.names)


@pytest.mark.parametrize(
    "wishes", [EVENTS, {"use_event_mode": True}, {"early_return_allowed": True}]
)
def test_results_do_not_depend_on_whether_events_are_used(fmu3, rows, wishes):
    found = landed(fmu3, **wishes)
    last = [np.flatnonzero(np.abs(found["time"] - t) < 1e-12)[-1] for t in rows["time"]]
    for name in rows.dtype.names:
        assert np.allclose(found[name][last], rows[name], rtol=1e-9, atol=1e-9), name
    between = set(found["time"]) - set(rows["time"])
    assert bool(between) == ("early_return_allowed" in wishes)


def test_inputs_and_parameters_act_as_in_fmi_2(fmu, fmu3):
    signals = np.array(
        [(0.0, 0.0, 0.0), (0.1, 500.0, 0.0), (0.2, -300.0, 0.01), (0.4, 0.0, 0.0)],
        dtype=[("time", float), ("external.force_x", float), ("ground.heave", float)],
    )
    start = {"drop.mode": "1-2-1", "ground.friction": 0.35}
    of_fmi2, of_fmi3 = (landed(f, input=signals, start_values=start) for f in (fmu, fmu3))
    for name in ("body.x", "body.pitch", "energy.work_external"):
        assert np.array_equal(of_fmi2[name], of_fmi3[name])
    assert np.array_equal(of_fmi2["leg[3].contact.force"], of_fmi3["leg.contact.force"][:, 2])


def test_events_are_found_after_the_folder_of_the_first_instance_is_gone(fmu3):
    """In a process of its own, in which nothing has been imported from that folder before."""
    lands = "fmpy.simulate_fmu(sys.argv[1], stop_time=0.1, output_interval=1e-2"
    code = f"import fmpy, sys; {lands}); {lands}, early_return_allowed=True, use_event_mode=True)"
    done = subprocess.run(
        [sys.executable, "-c", code, str(fmu3)], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout + done.stderr
