"""Hosts whose floating-point environment is not the default: traps, rounding, small numbers.

Fortran's and Delphi's programs trap invalid operations. A number that is not finite is refused
there, too, and no host's settings change a digit.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

from rlv_landing import Landing

STEPS_OF_FMI_3 = """
import ctypes
import math
import sys

import fmpy
from fmpy.fmi3 import FMU3Slave

description = fmpy.read_model_description(sys.argv[1])
slave = FMU3Slave(
    guid=description.guid,
    unzipDirectory=sys.argv[2],
    modelIdentifier=description.coSimulation.modelIdentifier,
    instanceName="floats",
)
slave.instantiate(eventModeUsed=True, earlyReturnAllowed=True)
slave.enterInitializationMode()
slave.exitInitializationMode()
slave.enterStepMode()
told, time = [ctypes.byref(ctypes.c_bool()) for _ in range(3)], ctypes.c_double()
assert ctypes.CDLL("libm.so.6").feenableexcept(1 | 4 | 8) >= 0  # invalid, division by 0, overflow
for start, step in (
    (math.nan, 1e-3), (0.0, math.nan), (0.0, math.inf), (1e308, 1e308), (0.0, -1.0), (0.0, 1e-3)
):
    times = map(ctypes.c_double, (start, step))
    instance = ctypes.c_void_p(slave.component)
    status = slave.dll.fmi3DoStep(instance, *times, True, *told, ctypes.byref(time))
    print(status, flush=True)
"""


def statuses(lines: list[str]) -> list[str]:
    """The lines that are numbers, without log messages."""
    return [line for line in lines if line.isdigit()]


@pytest.mark.parametrize("units", [[], ["sse"]], ids=["all", "sse"])
def test_traps_end_no_host_and_its_rounding_changes_no_digit(host, unpacked, description, units):
    references = {v.name: v.valueReference for v in description.modelVariables}
    done = subprocess.run(
        [
            host("floats"),
            unpacked / "binaries" / "linux64" / "RlvLanding.so",
            (unpacked / "resources").as_uri(),
            description.guid,
            str(references["external.force_x"]),
            str(references["body.x"]),
            *units,
        ],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    landing = Landing()
    for k in range(200):
        landing.advance_to(k / 1000 + 1 / 1000)
    lines = done.stdout.splitlines()
    assert statuses(lines) == ["2", "2"]
    value, kept = lines[-1].split()
    assert float.fromhex(value) == landing.get("body.x")
    assert kept == "1"


def test_traps_end_no_host_of_fmi_3_that_steps_to_no_time(unpacked3, fmu3):
    done = subprocess.run(
        [sys.executable, "-c", STEPS_OF_FMI_3, fmu3, unpacked3],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert statuses(done.stdout.splitlines()) == ["2"] * 5 + ["0"]
