"""Runs an importer in a process of its own, so that its libraries and its crashes stay there."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from jobs import Job

from rlv_landing.quantities import OUTPUT_NAMES

HOSTS = Path(__file__).resolve().parent / "hosts"
ROOT = HOSTS.parent.parent.parent
# Ecos needs libtbb, which the wheel `tbb` puts into the environment's lib; CoFmuPy is installed apart (see cofmupy.txt)
ENVIRONMENT = {
    **os.environ,
    "LD_LIBRARY_PATH": os.pathsep.join(filter(None, [str(Path(sys.prefix) / "lib"), os.environ.get("LD_LIBRARY_PATH")])),
}
COFMUPY = ROOT / "build" / "cofmupy"

Landed = Callable[..., np.ndarray]


@pytest.fixture
def landed_by(fmu: Path, tmp_path: Path) -> Landed:
    """`landed_by(host, job, outputs, file)`: the rows that `hosts/with_HOST.py` gives of the FMU `file`, by default the built one."""

    def run(name: str, job: Job, outputs: Sequence[str] = OUTPUT_NAMES, file: Path = fmu) -> np.ndarray:
        (tmp_path / "job.json").write_text(json.dumps(job.told(outputs)), encoding="utf-8")
        environment = ENVIRONMENT
        if name == "cofmupy":
            assert COFMUPY.is_dir(), f"{COFMUPY} is missing: run make build/cofmupy/.packages"
            environment = {**ENVIRONMENT, "PYTHONPATH": str(COFMUPY)}
        command = [sys.executable, str(HOSTS / f"with_{name}.py"), str(file), "job.json", "result.npy"]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return np.load(tmp_path / "result.npy")

    return run


@pytest.fixture(scope="session")
def ecos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ecos' program. Its wheel does not mark it executable, so this is a copy."""
    program = tmp_path_factory.mktemp("ecos") / "ecos"
    shutil.copy(Path(str(find_spec("ecospy").submodule_search_locations[0])) / "binaries" / "ecos", program)
    program.chmod(0o755)
    return program


@pytest.fixture
def simulated_by_ecos(ecos: Path, tmp_path: Path) -> Callable[..., np.ndarray]:
    """`simulated_by_ecos(path, *options)`: the table that `ecos simulate`, a C++ program without Python, writes of an FMU or SSP file."""

    def run(path: Path, *options: str) -> np.ndarray:
        environment = {name: value for name, value in ENVIRONMENT.items() if not name.startswith("PYTHON")}
        command = [str(ecos), "simulate", "--path", str(path), "--stepSize", "0.001", *options]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return np.genfromtxt(tmp_path / f"{path.stem}.csv", delimiter=", ", names=True, deletechars="", replace_space=" ")

    return run
