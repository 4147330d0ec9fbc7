"""What all tests share: the FMU that was built, and one run of each drop test."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from rlv_landing import Landing, load_preset
from rlv_landing.history import History

ROOT = Path(__file__).resolve().parent.parent
MODES = ("2-2", "1-2-1")


@pytest.fixture(scope="session")
def many() -> Callable[[int], int]:
    """How many cases a random test tries: those of `make test`, times RLV_TORTURE in the environment."""
    return lambda count: round(count * float(os.environ.get("RLV_TORTURE", "1")))


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
