"""The example's FMUs, and one run of its command."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import system

EXAMPLE = Path(__file__).resolve().parent.parent.parent / "examples" / "ship_deck"


@pytest.fixture(scope="session")
def example() -> Path:
    return EXAMPLE


@pytest.fixture(scope="session")
def ran(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The folder that `run.py` wrote to, and its output."""
    out = tmp_path_factory.mktemp("ship_deck")
    command = [sys.executable, str(EXAMPLE / "run.py"), "--out", str(out), "--until", "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return out, done.stdout


@pytest.fixture(scope="session")
def fmus(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The system's FMUs."""
    return system.build(tmp_path_factory.mktemp("fmus"), fmu)
