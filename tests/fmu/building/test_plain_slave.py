"""The slave is a plain one of pythonfmu: its own binary lands it to the same digits."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np

from rlv_landing.quantities import OUTPUT_NAMES

FMU_SRC = Path(__file__).resolve().parents[3] / "fmu_src"

LAND = """
import sys, fmpy, numpy
outputs = sys.argv[3:]
for _ in range(2):
    result = fmpy.simulate_fmu(sys.argv[1], stop_time=0.4, output_interval=1e-3, output=outputs)
import rlv_landing
print(rlv_landing.__file__)
numpy.save(sys.argv[2], numpy.array([[row[n] for n in outputs] for row in result], dtype=float))
"""


def landed(file: Path, result: Path, *options: str) -> tuple[str, np.ndarray]:
    """The rows of two landings in a process of their own, and what it printed."""
    command = [sys.executable, *options, "-c", LAND, str(file), str(result), *OUTPUT_NAMES]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout, np.load(result)


def test_pythonfmu_builds_an_fmu_of_the_slave_that_lands_to_the_same_digits(fmu, tmp_path):
    command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(FMU_SRC / "landing_fmu.py")]
    done = subprocess.run(
        [*command, "-d", str(tmp_path), str(FMU_SRC / "rlv_landing")],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    where, rows = landed(tmp_path / "RlvLanding.fmu", tmp_path / "plain.npy")
    assert "resources" in where
    _, ours = landed(fmu, tmp_path / "ours.npy")
    assert np.array_equal(rows, ours)
    assert len(rows) == 401
