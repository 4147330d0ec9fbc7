"""The FMU in importers that share no code: each gives the trajectory of `Landing`.

Parameters and inputs are set.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import ssp
from jobs import JOBS, SLIPPERY, Job, assert_same

from rlv_landing.quantities import OUTPUT_NAMES, OUTPUT_QUANTITIES

needs_python_3_11 = pytest.mark.skipif(
    sys.version_info < (3, 11), reason="fmuloader needs Python 3.11"
)
SCENARIO_NAMESPACE = "http://github.com/Ecos-platform/libecos/resources/schema/ScenarioConfig"


def fmutool(*options: str) -> str:
    """Output of `fmutool`, which must succeed."""
    done = subprocess.run(
        [str(Path(sys.executable).parent / "fmutool"), *options],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout
    assert "ERROR" not in done.stdout, done.stdout
    return done.stdout


@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
@pytest.mark.parametrize("importer", ["fmpy", "libcosimpy", "ecos"])
def test_importer_gives_landings_trajectory(landed_by, importer, job):
    assert_same(landed_by(importer, job), job)


@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
def test_fmpy_gives_landings_trajectory_by_fmi_3(landed_by, fmu3, job):
    assert_same(landed_by("fmpy", job, file=fmu3), job)


@needs_python_3_11
@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
def test_fmuloader_gives_landings_trajectory(landed_by, job):
    assert_same(landed_by("fmuloader", job), job)


@needs_python_3_11
def test_fmuloader_that_handles_every_event_gives_landings_trajectory_by_fmi_3(landed_by, fmu3):
    """It reads no arrays, and so no legs."""
    outputs = tuple(name for name in OUTPUT_NAMES if not name.startswith("leg["))
    assert_same(landed_by("fmuloader", SLIPPERY, outputs, fmu3), SLIPPERY, outputs)


@pytest.mark.parametrize("importer", ["cofmupy", "pathsim", "fmugym", "sofirpy"])
def test_importer_that_sets_no_strings_gives_landings_trajectory(landed_by, importer):
    """All but sofirpy read every output as a Real, Integers and Booleans too."""
    assert_same(landed_by(importer, SLIPPERY), SLIPPERY)


@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
def test_ecos_command_line_a_cpp_program_gives_landings_trajectory(
    simulated_by_ecos, fmu, tmp_path, job
):
    """Parameters from an SSP file, inputs by a scenario; the program writes six decimals."""
    ssp.write(tmp_path / "one.ssp", {"landing": fmu}, {}, {"landing": job.parameters}, until=1.0)
    settings = "".join(
        f'<ecos:variable id="landing::{name}"><ecos:real value="{value!r}"/></ecos:variable>'
        for name, value in job.inputs.items()
    )
    (tmp_path / "inputs.xml").write_text(
        f'<ecos:Scenario xmlns:ecos="{SCENARIO_NAMESPACE}">'
        f'<ecos:action t="{job.inputs_after * job.step!r}" eps="1e-6">{settings}</ecos:action>'
        "</ecos:Scenario>",
        encoding="utf-8",
    )
    options = (
        "--stopTime",
        "1.0005",
        "--parameterSet",
        ssp.PARAMETER_SET,
        "--scenarioConfig",
        "inputs.xml",
    )
    table = simulated_by_ecos(tmp_path / "one.ssp", *options)[1:]
    kinds = {"real": "REAL", "integer": "INT", "boolean": "BOOL"}
    columns = [f"landing::{q.name}[{kinds[q.kind]}]" for q in OUTPUT_QUANTITIES]
    rows = np.array(
        [np.cumsum(np.full(len(table), job.step)), *(table[column] for column in columns)]
    ).T
    assert np.abs(table["time"] - rows[:, 0]).max() < 1e-6
    assert_same(rows, job, rounding=5.01e-7)


@pytest.mark.parametrize("job", JOBS.values(), ids=list(JOBS))
def test_two_landings_in_one_fmucontainer_do_not_mix(landed_by, job):
    """One process, two instances, different parameters: each lands as it would alone."""
    rows = landed_by("fmucontainer", job)
    outputs = (rows.shape[1] - 1) // 2
    assert_same(rows[:, : 1 + outputs], job)
    assert_same(rows[:, [0, *range(1 + outputs, 1 + 2 * outputs)]], Job())


@pytest.mark.parametrize("version", [2, 3])
def test_fmutool_check_finds_nothing(fmu, fmu3, version):
    output = fmutool("-input", str(fmu3 if version == 3 else fmu), "-check")
    assert f"This FMU seems to be compliant with FMI-{version}.0" in output
    assert f"No semantic error against the FMI-{version} standard" in output
