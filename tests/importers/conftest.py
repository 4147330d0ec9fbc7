"""Runs an importer in a process of its own, so that its libraries and its crashes stay there."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from jobs import Job

from rlv_landing.quantities import OUTPUT_NAMES

HOSTS = Path(__file__).resolve().parent / "hosts"
ROOT = HOSTS.parent.parent.parent
# what is installed apart, and where (see cofmupy.txt and others.txt)
APART = {
    "cofmupy": "cofmupy",
    **dict.fromkeys(("fmuloader", "pathsim", "fmugym", "sofirpy"), "importers"),
}

Landed = Callable[..., np.ndarray]


@pytest.fixture
def landed_by(fmu: Path, ecos_environment: dict[str, str], tmp_path: Path) -> Landed:
    """Land the FMU in an importer; return the rows of `hosts/with_HOST.py`.

    Call it as `landed_by(host, job, outputs, file)`; `file` is the built FMU by default.
    """

    def run(
        name: str, job: Job, outputs: Sequence[str] = OUTPUT_NAMES, file: Path = fmu
    ) -> np.ndarray:
        (tmp_path / "job.json").write_text(json.dumps(job.as_json(outputs)), encoding="utf-8")
        environment = ecos_environment
        if name in APART:
            folder = ROOT / "build" / APART[name]
            assert folder.is_dir(), f"{folder} is missing: run make build/{folder.name}/.packages"
            environment = {**ecos_environment, "PYTHONPATH": str(folder)}
        command = [
            sys.executable,
            str(HOSTS / f"with_{name}.py"),
            str(file),
            "job.json",
            "result.npy",
        ]
        done = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300
        )
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return np.load(tmp_path / "result.npy")

    return run
