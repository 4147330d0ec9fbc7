"""Fixtures of the bridge's tests."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from bridge_tools import domain, log, one_log, processes  # noqa: F401
