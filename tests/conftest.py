"""What all tests share: the FMU that was built, and one run of each drop test."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from rlv_landing import Landing, load_preset
from rlv_landing.history import History

ROOT = Path(__file__).resolve().parent.parent
# the example's modules, as its `run.py` finds them
sys.path.insert(0, str(ROOT / "examples" / "ship_deck"))
MODES = ("2-2", "1-2-1")


@pytest.fixture(scope="session")
def fmu() -> Path:
    """The built FMU. Tests fail without it: `make test` builds it."""
    path = Path(os.environ.get("RLV_FMU", ROOT / "build" / "RlvLanding.fmu"))
    assert path.is_file(), f"{path} is missing: run ./build_fmu.sh"
    return path


@pytest.fixture(scope="session", params=MODES)
def mode(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="session")
def drop_test(mode: str) -> History:
    """The drop test of `mode` with the preset yue2022-figures, 1 s at 0.2 ms."""
    return Landing(load_preset("yue2022-figures"), mode).run(1.0, 2e-4)
