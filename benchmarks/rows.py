"""Rows of measurements: where they were taken, whether they are kept, and the file with them."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import time
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
FMU = HERE.parent / "build" / "RlvLanding.fmu"
CORES = os.cpu_count() or 1
# the load per core below which a machine is idle, and how long a benchmark waits for it [s]
IDLE, WAIT = 0.5, 180.0
# what benchmarks and `docs/claims` write themselves
WRITTEN = ("docs/*.md", "docs/*.png", "README.md", "benchmarks/results.jsonl")


@dataclass(frozen=True)
class Start:
    """The state in which a benchmark started.

    Attributes:
        changed: Files that differ from the commit.
        load: The machine's load.
    """

    changed: tuple[str, ...]
    load: float

    @property
    def unfit(self) -> list[str]:
        """Why what is measured is not kept; empty where it is.

        Numbers are kept of a commit that can be checked out, on a machine without other work.
        """
        reasons = []
        if self.changed:
            reasons.append(
                f"{len(self.changed)} files differ from the commit ({self.changed[0]}); commit them"
            )
        if self.load > IDLE * CORES:
            reasons.append(
                f"the load was {self.load:.1f} on {CORES} cores, {IDLE * CORES:.1f} at most is "
                "idle; wait for other work to end"
            )
        return reasons


@lru_cache
def start() -> Start:
    """The state at the first call, after a wait until the machine is idle, 180 s at most.

    Call it before measuring: the last benchmark's load fades in the wait.
    """
    end = time.monotonic() + WAIT
    while load() > IDLE * CORES and time.monotonic() < end:
        time.sleep(5.0)
    return Start(_changed(), load())


def _changed() -> tuple[str, ...]:
    excluded = [f":(top,exclude){name}" for name in WRITTEN]
    listed = subprocess.run(
        ["git", "status", "--porcelain", "--", ":/", *excluded],
        capture_output=True,
        text=True,
        cwd=HERE,
        check=True,
    ).stdout
    return tuple(line[3:] for line in listed.splitlines())


def provenance() -> dict[str, str]:
    """Commit, processor and Python."""
    commit = subprocess.run(
        ["git", "describe", "--always"], capture_output=True, text=True, cwd=HERE
    ).stdout.strip()
    names = [
        line.split(":")[1].strip()
        for line in Path("/proc/cpuinfo").read_text().splitlines()
        if line.startswith("model name")
    ]
    return {
        "commit": commit + ("-dirty" if start().changed else ""),
        "cpu": names[0] if names else platform.processor(),
        "python": platform.python_version(),
    }


def load() -> float:
    """The machine's load over the last minute."""
    return os.getloadavg()[0]


def append_rows(rows: list[dict[str, Any]]) -> None:
    """Append the rows, with their provenance, to `results.jsonl`, if they are fit to be kept."""
    if start().unfit:
        print(f"not kept in results.jsonl: {'; '.join(start().unfit)}", file=sys.stderr)
        return
    stamp = {**provenance(), "load_before": start().load}
    with (HERE / "results.jsonl").open("a", encoding="utf-8") as f:
        for row in rows:
            f.write(json.dumps({**stamp, **row}) + "\n")
