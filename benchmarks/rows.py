"""Rows of measurements: where they were taken, and the file that keeps them."""

from __future__ import annotations

import json
import os
import platform
import subprocess
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
FMU = HERE.parent / "build" / "RlvLanding.fmu"


def provenance() -> dict[str, str]:
    """Commit, processor and Python."""
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"], capture_output=True, text=True, cwd=HERE
    ).stdout.strip()
    names = [
        line.split(":")[1].strip()
        for line in Path("/proc/cpuinfo").read_text().splitlines()
        if line.startswith("model name")
    ]
    return {
        "commit": commit,
        "cpu": names[0] if names else platform.processor(),
        "python": platform.python_version(),
    }


def load() -> float:
    """The machine's load over the last minute."""
    return os.getloadavg()[0]


def append_rows(rows: list[dict[str, Any]]) -> None:
    """Append the rows, stamped with their provenance, to `results.jsonl`."""
    stamp = provenance()
    with (HERE / "results.jsonl").open("a", encoding="utf-8") as f:
        for row in rows:
            f.write(json.dumps({**stamp, **row}) + "\n")
