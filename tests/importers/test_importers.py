"""The FMU in importers that share no code with each other: the trajectory of `Landing` from each, parameters and inputs set."""

import subprocess
import sys
from pathlib import Path

import pytest
from jobs import JOBS, Job, assert_same

REALS_ONLY = [job for job in JOBS.values() if not any(isinstance(v, str) for v in job.parameters.values())]


@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
@pytest.mark.parametrize("importer", ["fmpy", "libcosimpy", "ecos"])
def test_importer_gives_landings_trajectory(landed_by, importer, job):
    assert_same(landed_by(importer, job), job)


@pytest.mark.parametrize("job", REALS_ONLY)
def test_cofmupy_that_sets_every_input_at_every_step_gives_landings_trajectory(landed_by, job):
    assert_same(landed_by("cofmupy", job), job)


@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
def test_two_landings_in_one_fmucontainer_do_not_mix(landed_by, job):
    """One process, two instances, different parameters: each lands as it would alone."""
    rows = landed_by("fmucontainer", job)
    outputs = (rows.shape[1] - 1) // 2
    assert_same(rows[:, : 1 + outputs], job)
    assert_same(rows[:, [0, *range(1 + outputs, 1 + 2 * outputs)]], Job())


def test_fmutool_check_finds_nothing(fmu):
    tool = Path(sys.executable).parent / "fmutool"
    done = subprocess.run([str(tool), "-input", str(fmu), "-check"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout
    assert "This FMU seems to be compliant with FMI-2.0" in done.stdout
    assert "No semantic error against the FMI-2 standard" in done.stdout
    assert "ERROR" not in done.stdout
