"""Fixtures of the logs' tests: those of the bridge's."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "ros"))

from bridge_tools import log, one_log  # noqa: F401
