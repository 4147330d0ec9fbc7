"""Snippets, commands and links of the README, and snippets of docs/fmu.md, work as they stand."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from rlv_landing.cli import cli

ROOT = Path(__file__).resolve().parent.parent
# commands that are groups of commands
GROUPS = ("log", "fmu")
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = README + (ROOT / "docs" / "fmu.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"```python\n(.*?)```", PAGES, re.S)
COMMANDS = re.findall(r"\.venv/bin/rlv-landing ([^\n#]+)", README)


@pytest.mark.parametrize("snippet", SNIPPETS, ids=range(len(SNIPPETS)))
def test_python_snippets_run(snippet, fmu, fmu3):
    subprocess.run(
        [sys.executable, "-c", snippet], cwd=ROOT, check=True, capture_output=True, timeout=120
    )


@pytest.mark.parametrize("line", COMMANDS)
def test_every_command_and_option_that_is_shown_exists(line):
    words = line.split(">")[0].split()
    path = [w for w in words[:2] if re.fullmatch("[a-z]+", w)] if words[0] in GROUPS else words[:1]
    shown = CliRunner().invoke(cli, [*path, "--help"])
    assert shown.exit_code == 0, shown.output
    for option in (w.split("=")[0] for w in words if w.startswith("--")):
        assert option in shown.output, option


def test_readme_names_every_make_target_it_relies_on():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"`?make (\w+)", README):
        assert re.search(rf"^{target}:", makefile, re.M), target
