"""Hostile logs, which would fill memory, take for ever or send control sequences to a terminal."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import bombs
import pytest
from bridge_tools import environment, run
from log_tools import rewrite
from mcap.records import Message, Metadata

from rlv_ros_bridge.messages.qos import TELEMETRY, parse_qos, read_yaml

# of memory beside the file, and of processor time
MOST_BYTES, MOST_SECONDS = 256 * 1024 * 1024, 5.0


def took(lines: list[list[str]], largest: int) -> None:
    """Run commands in one process: within memory and time, legible, and without a traceback."""
    done = subprocess.run(
        [sys.executable, bombs.__file__],
        input=json.dumps(lines),
        env=environment(),
        capture_output=True,
        text=True,
        timeout=60.0 * len(lines),
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found: list[Any] = [json.loads(line) for line in done.stdout.splitlines() if line[:1] == "["]
    *commands, (_, _, memory) = found
    assert len(commands) == len(lines)
    for line, (_, code, seconds) in zip(lines, commands):
        assert code in (0, 1, 2, 3), (line, code)
        assert seconds < MOST_SECONDS, line
    assert memory < MOST_BYTES + largest
    for text in (done.stdout + done.stderr).splitlines():
        assert text.isprintable(), text
    assert "Traceback" not in done.stderr


def test_every_command_takes_or_refuses_every_hostile_log_in_bounded_memory_and_time(
    tmp_path: Path,
) -> None:
    lines, largest = [], 0
    for bomb in bombs.BOMBS:
        folder = tmp_path / bomb.__name__
        folder.mkdir()
        log = bomb(folder / "log.mcap")
        largest = max(largest, log.stat().st_size)
        lines += bombs.commands(log, folder)
    took(lines, largest)


@pytest.mark.torture
@pytest.mark.parametrize("bomb", bombs.BOMBS, ids=lambda bomb: bomb.__name__)
def test_each_command_takes_or_refuses_each_hostile_log_alone(
    bomb: Callable[[Path], Path], tmp_path: Path
) -> None:
    log = bomb(tmp_path / "log.mcap")
    for line in bombs.commands(log, tmp_path):
        took([line], log.stat().st_size)


def test_peaks_that_hold_for_years_are_not_landed(one_log: Path, tmp_path: Path) -> None:
    (whole,) = one_log.glob("*.mcap")

    def change(record: Any) -> Any:
        if isinstance(record, tuple):
            m: Message = record[1]
            return record if m.log_time <= 20_000_000 else None
        if isinstance(record, Metadata) and record.name == "rlv_landing":
            return replace(record, metadata={**record.metadata, "stop_time": "1e8"})
        if isinstance(record, Metadata) and record.name == "rlv_landing_peaks":
            return replace(record, metadata={**record.metadata, "until": "1e8"})
        return record

    done = run("log", "verify", rewrite(whole, tmp_path / "log", change))
    assert done.returncode == 1, done.stderr
    assert "differs   first in the record of peaks" in done.stdout
    assert "until: '100000000.0 s' in the log" in done.stdout


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("- &a 1\n- *a\n", "aliases"),
        ("[" * 17 + "]" * 17, "deeper than 16"),
        ("[" * 50_000, "nest"),
        ("a" * 2000, "more than 1000"),
        ("{a: [}", "flow"),
        ("!!python/object:os.system x", "tag"),
    ],
)
def test_yaml_that_grows_or_runs_is_refused(text: str, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        read_yaml(text, 1000 if told == "more than 1000" else 10**6)


@pytest.mark.parametrize("depth", [".inf", ".nan", "-5", "1e400", "many", str(10**30)])
def test_a_profile_of_any_depth_is_one_that_can_be_offered(depth: str) -> None:
    text = f"[{{reliability: reliable, durability: volatile, history: keep_last, depth: {depth}}}]"
    found = parse_qos(text)
    assert found == TELEMETRY or 1 <= found.depth <= 100_000
