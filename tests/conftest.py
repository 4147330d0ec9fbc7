"""What all tests share: the FMU that was built, and one run of each drop test."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

from rlv_landing import Landing, load_preset
from rlv_landing.history import History

ROOT = Path(__file__).resolve().parent.parent
# How long one example takes says more of the machine than of us.
settings.register_profile("suite", deadline=None)
settings.load_profile("suite")
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


@pytest.fixture(scope="session")
def cycles() -> int:
    """How often a test of endurance goes round: 20 times, with RLV_TORTURE=1 a thousand times."""
    return 1000 if os.environ.get("RLV_TORTURE") == "1" else 20
