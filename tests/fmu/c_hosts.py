"""Where the hosts that are written in C stand, and FMI's headers for them."""

from __future__ import annotations

from pathlib import Path

import fmpy

HOSTS = Path(__file__).parent / "host"
HEADERS = Path(fmpy.__file__).parent / "c-code"
