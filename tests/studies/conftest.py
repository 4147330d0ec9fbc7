"""What the studies' tests share: one validation, one audit, and the command line in this process."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import NamedTuple

import pytest

from rlv_landing import load_preset
from rlv_landing.cli import main
from rlv_landing.validation.audit import Audit, audit
from rlv_landing.validation.validate import Validation, validate

FIGURES = "yue2022-figures"


class Done(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str


@pytest.fixture
def command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Done]:
    """Run `rlv-landing` with the arguments given."""

    def run(*arguments: str) -> Done:
        monkeypatch.setattr(sys, "argv", ["rlv-landing", *arguments])
        with pytest.raises(SystemExit) as ended:
            main()
        captured = capsys.readouterr()
        return Done(int(ended.value.code or 0), captured.out, captured.err)

    return run


@pytest.fixture(scope="session")
def validation() -> Validation:
    return validate(load_preset(FIGURES))


@pytest.fixture(scope="session")
def every_audit() -> list[Audit]:
    return audit(load_preset(FIGURES).with_values({"vehicle.transverse_load_at": "footpad"}))


@pytest.fixture(scope="session")
def audits(every_audit: list[Audit]) -> dict[str, Audit]:
    """Of the vehicle as it is, by mode."""
    return {a.mode: a for a in every_audit if a.convergence is not None}
