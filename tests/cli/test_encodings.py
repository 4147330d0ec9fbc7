"""Every command prints on every terminal, and says what it cannot use, whatever the encoding."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

STUDY = """[study]
method = "lhs"
samples = 2
until = 0.02
[[factor]]
name = "drop.tilt"
low = -0.1
high = 0.1
"""
COMMANDS = {
    "simulate": ("simulate", "--until", "0.2"),
    "compare": ("simulate", "--compare"),
    "parameters": ("parameters",),
    "toml": ("parameters", "--toml", "--parameters", "m\u00fc.toml"),
    "outputs": ("parameters", "--outputs"),
    "source": ("parameters", "--parameters", "m\u00fc.toml"),
    "validate": ("validate", "--mode", "2-2"),
    "priors": ("identify", "--priors"),
    "dry run": ("sweep", "s.toml", "--dry-run"),
    "sweep": ("sweep", "s.toml"),
    "help": ("--help",),
}
ENVIRONMENTS = {
    "cp1252": {"PYTHONIOENCODING": "cp1252"},
    "cp437": {"PYTHONIOENCODING": "cp437"},
    "ascii": {"PYTHONIOENCODING": "ascii"},
    "C": {"LC_ALL": "C"},
    "C without UTF-8": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


def run(folder: Path, environment: str, *arguments: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-c", "from rlv_landing.cli import main; main()", *arguments],
        capture_output=True,
        cwd=folder,
        timeout=120,
        env={**os.environ, **ENVIRONMENTS[environment]},
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "s.toml").write_text(STUDY)
    (tmp_path / "m\u00fc.toml").write_text(
        '[vehicle]\nmass = { value = 178.0, source = "M\u00fcller \u03a9 \U0001f680" }\n',
        encoding="utf-8",
    )
    return tmp_path


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_prints_on_a_legacy_terminal(folder, name):
    done = run(folder, "cp1252", *COMMANDS[name])
    assert done.returncode == 0, done.stderr
    text = done.stdout.decode("cp1252")
    if name in ("simulate", "compare", "parameters"):
        assert "|" in text
        assert "+-" in text
    if name == "source":
        # a cell may take several lines
        assert all(word in text for word in ("M\u00fcller", "\\u03a9", "\\U0001f680"))


@pytest.mark.parametrize("environment", ENVIRONMENTS)
def test_tables_parameter_files_and_errors_in_every_environment(folder, environment):
    assert run(folder, environment, "simulate", "--until", "0.2").returncode == 0
    toml = run(folder, environment, *COMMANDS["toml"])
    assert toml.stdout.isascii()
    (folder / "again.toml").write_bytes(toml.stdout)
    again = run(folder, environment, "parameters", "--toml", "--parameters", "again.toml")
    assert again.stdout == toml.stdout
    wrong = run(folder, environment, "simulate", "--set", "vehicle.mass=1 \u03a9\n")
    assert wrong.returncode == 2
    assert wrong.stderr.startswith(b"error: vehicle.mass = '1 ")
    assert wrong.stderr.count(b"\n") == 1


def test_names_of_files_that_are_not_utf8_are_named_in_one_line(folder):
    name = os.fsdecode(b"m\xfc\n.toml")
    done = run(folder, "C", "simulate", "--parameters", name)
    assert done.returncode == 2
    assert done.stderr.startswith(b"error: there is no parameter file m\\udcfc\\n.toml")
    assert done.stderr.count(b"\n") == 1
