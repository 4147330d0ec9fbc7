"""What `make` says of a machine that lacks something."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from fmu_build.installing import prerequisites

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("python", "packages"),
    [
        ("python3", "python3-venv python3-dev"),
        ("/usr/bin/python3.12", "python{v}-venv python{v}-dev"),
    ],
)
def test_what_is_missing_is_one_line_with_debians_packages(python, packages, monkeypatch, tmp_path):
    import sys

    monkeypatch.setattr(prerequisites, "find_spec", lambda name: None)
    monkeypatch.setattr(prerequisites.sysconfig, "get_paths", lambda: {"include": str(tmp_path)})
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    assert prerequisites.message(["venv", "headers"], python) == (
        "error: venv and Python.h are missing; on Debian and Ubuntu: "
        f"apt install {packages.format(v=version)}; then run make again"
    )


def test_a_compiler_is_asked_for_where_there_is_none_and_none_is_named(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    assert "a C compiler is missing" in prerequisites.message(["compiler"], "python3")
    compiler = tmp_path / "mycc"
    compiler.write_text("")
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", "mycc -m64")
    assert prerequisites.message(["compiler"], "python3") == ""


def test_make_without_python_says_what_to_install(tmp_path):
    folder = tmp_path / "mein Ordner ü"
    folder.mkdir()
    for file in ("Makefile", "pyproject.toml", "setup.py"):
        (folder / file).write_bytes((ROOT / file).read_bytes())
    done = subprocess.run(
        ["make", ".venv/.packages", "PYTHON=python3.0"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        # as if this test were not run by make
        env={k: v for k, v in os.environ.items() if k not in {"MAKELEVEL", "MAKEFLAGS", "MFLAGS"}},
    )
    first, second = [
        line for line in done.stderr.splitlines() if not line.startswith(("find", "sed"))
    ]
    assert first.startswith("error: there is no python3.0; on Debian and Ubuntu: apt install ")
    assert second.startswith("make: ***")
