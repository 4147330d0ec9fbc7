"""Runs an importer in a process of its own, so that its libraries and its crashes stay there."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from jobs import Job

HOSTS = Path(__file__).resolve().parent / "hosts"
ROOT = HOSTS.parent.parent.parent
# Ecos needs libtbb, which the wheel `tbb` puts into the environment's lib; CoFmuPy is installed apart (see cofmupy.txt)
ENVIRONMENT = {
    **os.environ,
    "LD_LIBRARY_PATH": os.pathsep.join(filter(None, [str(Path(sys.prefix) / "lib"), os.environ.get("LD_LIBRARY_PATH")])),
}
COFMUPY = ROOT / "build" / "cofmupy"

Landed = Callable[[str, Job], np.ndarray]


@pytest.fixture
def landed_by(fmu: Path, tmp_path: Path) -> Landed:
    """`landed_by(host, job)`: the rows that `hosts/with_HOST.py` gives."""

    def run(name: str, job: Job) -> np.ndarray:
        (tmp_path / "job.json").write_text(json.dumps(job.told()), encoding="utf-8")
        environment = ENVIRONMENT
        if name == "cofmupy":
            assert COFMUPY.is_dir(), f"{COFMUPY} is missing: run make build/cofmupy/.packages"
            environment = {**ENVIRONMENT, "PYTHONPATH": str(COFMUPY)}
        command = [sys.executable, str(HOSTS / f"with_{name}.py"), str(fmu), "job.json", "result.npy"]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return np.load(tmp_path / "result.npy")

    return run
