"""One audit of the preset yue2022-figures, for all tests of validation."""

from __future__ import annotations

import pytest

from rlv_landing import load_preset
from rlv_landing.validation.audit import Audit, audit


@pytest.fixture(scope="session")
def audits() -> dict[str, Audit]:
    """The audit of each drop test."""
    return {a.mode: a for a in audit(load_preset("yue2022-figures"))}
