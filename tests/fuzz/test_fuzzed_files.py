"""Mutated files and options: a right value or one line, never a traceback, never a hang."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

WORKER = Path(__file__).with_name("fuzz_files.py")


@pytest.mark.torture
def test_mutated_files_and_options_are_taken_or_refused_in_one_line(
    tmp_path: Path, many: Callable[[int], int]
) -> None:
    count = many(260)
    line = [sys.executable, str(WORKER), str(count), "1", str(tmp_path)]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["cases"] == count
    # there were mutations after which a file is still good, and others
    assert count // 20 < report["taken"] < count // 2
