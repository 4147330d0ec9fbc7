"""Studies for the tests of sweeps, and the command in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from pyarrow import parquet

# short landings: what these tests are about is what happens around them
STUDY = """
[study]
method = "lhs"
samples = {samples}
seed = 3
until = {until}
every = 2e-3
modes = ["2-2", "1-2-1"]

[set]
drop.contact_time = 0.0
ground.friction = 0.4

[[factor]]
name = "drop.tilt"
unit = "deg"
low = -6.0
high = 6.0

[[factor]]
name = "drop.vertical_velocity"
distribution = "normal"
mean = -1.4
deviation = 0.3
high = -0.2

[[factor]]
name = "external.force_x"
values = [0.0, "0.5 kN"]
"""


def write_study(folder: Path, samples: int = 20, until: float = 0.1, more: str = "") -> Path:
    """A study of `samples` samples in both modes."""
    path = folder / "study.toml"
    path.write_text(STUDY.format(samples=samples, until=until) + more)
    return path


def command(*arguments: object) -> list[str]:
    """`rlv-landing` in this Python."""
    return [sys.executable, "-c", "from rlv_landing.cli import main; main()", *map(str, arguments)]


def run(
    *arguments: object, cwd: Path, before: Callable[[], None] | None = None
) -> subprocess.CompletedProcess[str]:
    """The command, to its end; `before` is called in the process before it starts."""
    return subprocess.run(
        command(*arguments), capture_output=True, text=True, cwd=cwd, timeout=300, preexec_fn=before
    )


def start(*arguments: object, cwd: Path) -> subprocess.Popen[str]:
    """The command, running."""
    return subprocess.Popen(
        command(*arguments), cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def wait_for(process: subprocess.Popen[str], condition: Callable[[], bool]) -> None:
    """Wait until the condition is true; fail if the process ends before."""
    while not condition():
        with suppress(subprocess.TimeoutExpired):
            process.wait(0.02)
            raise AssertionError(process.communicate()[1])


def rows(path: Path) -> list[dict[str, Any]]:
    """All rows of a results file."""
    found: list[dict[str, Any]] = parquet.read_table(path).to_pylist()
    return found
