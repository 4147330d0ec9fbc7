"""The tutorials, from their first line to the last, in an empty folder.

The FMU that one builds is another test's: here it is the built one, unless RLV_TORTURE is set.
"""

from __future__ import annotations

import os
import shlex
import shutil
from pathlib import Path

import pytest
from bridge_tools import run
from page_snippets import TUTORIALS, blocks

REAL = "RLV_TORTURE" in os.environ


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_each_line_of_a_tutorial_works(page, fmu, command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = 0
    for block in blocks(page):
        if block.file:
            Path(block.file).write_text(block.text)
        elif block.language == "python":
            exec(compile(block.text, page.name, "exec"), {"__name__": "__main__"})
        elif block.language == "sh":
            for line in block.text.splitlines():
                do(shlex.split(line), command, fmu, monkeypatch)
                ran += 1
    assert ran >= 4


def do(words, command, fmu, monkeypatch) -> None:
    """Run a line; it must succeed and say nothing on standard error but what a node logs."""
    program, *arguments = words
    if program == "cd":
        monkeypatch.chdir(arguments[0])
        return
    assert program == "rlv-landing"
    if arguments[0] == "node":
        done = run(*arguments, "--fmu", fmu, cwd=Path.cwd())
        assert done.returncode == 0, done.stderr
        return
    if arguments[:2] == ["fmu", "build"] and not REAL:
        shutil.copyfile(fmu, f"{arguments[arguments.index('--name') + 1]}.fmu")
        return
    done = command(*arguments)
    assert done.code == 0, (words, done.err)
