"""One audit of the preset yue2022-figures, for all tests of the audit."""

from __future__ import annotations

import pytest

from rlv_landing import load_preset
from rlv_landing.audit.audit import Audit, audit


@pytest.fixture(scope="session")
def every_audit() -> list[Audit]:
    """The audits of all cases of both drop tests, with a consistent transverse load."""
    return audit(
        load_preset("yue2022-figures").with_values({"vehicle.transverse_load_at": "footpad"})
    )


@pytest.fixture(scope="session")
def audits(every_audit: list[Audit]) -> dict[str, Audit]:
    """The audit of the vehicle as it is, by mode."""
    return {a.mode: a for a in every_audit if a.convergence is not None}
