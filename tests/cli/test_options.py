"""Options are declared once, and groups of commands name the nearest command."""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from pathlib import Path

import pytest
from click.testing import CliRunner

from rlv_landing.cli import cli
from rlv_landing.errors import LandingError

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (ROOT / "fmu_src" / "rlv_landing", ROOT / "ros_bridge" / "rlv_ros_bridge")
# reading logs needs these; help does not
READERS = ("mcap", "mcap_ros2", "rosbags")


def test_no_option_is_declared_twice():
    declared = defaultdict(list)
    for folder in FOLDERS:
        for path in folder.rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call) and ast.unparse(node.func) == "click.option":
                    name = next(a.value for a in node.args if a.value.startswith("--"))
                    text = next(ast.unparse(k.value) for k in node.keywords if k.arg == "help")
                    declared[name, text].append(f"{path.name}:{node.lineno}")
    assert len(declared) > 50
    assert {option: places for option, places in declared.items() if len(places) > 1} == {}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["simulte"], "'simulte'; did you mean simulate?; `rlv-landing --help` lists them"),
        (["log", "verfy"], "'verfy'; did you mean verify?; `rlv-landing log --help` lists them"),
        (["fmu", "biuld"], "'biuld'; did you mean build?; `rlv-landing fmu --help` lists them"),
        (["log", "qqq"], "'qqq'; `rlv-landing log --help` lists them"),
    ],
)
def test_a_command_that_is_not_there_is_refused_with_the_nearest(arguments, said):
    found = CliRunner().invoke(cli, arguments)
    assert isinstance(found.exception, LandingError)
    assert str(found.exception) == f"there is no command {said}"


@pytest.mark.parametrize("name", ["info", "verify", "recover", "export"])
def test_help_on_logs_needs_no_library_and_the_command_names_it(name, tmp_path, monkeypatch):
    for library in READERS:
        for module in [m for m in sys.modules if m.split(".")[0] == library]:
            monkeypatch.delitem(sys.modules, module)
        (tmp_path / f"{library}.py").write_text(f"raise ImportError('no {library}')\n")
    monkeypatch.syspath_prepend(tmp_path)
    shown = CliRunner().invoke(cli, ["log", name, "--help"])
    assert shown.exit_code == 0, shown.output
    assert "Exit codes: 0 " in shown.output
    outputs = [str(tmp_path / "landing.csv")] if name == "export" else []
    refused = CliRunner().invoke(cli, ["log", name, str(tmp_path), *outputs])
    assert isinstance(refused.exception, LandingError)
    assert str(refused.exception).startswith("reading logs needs mcap and rosbags (no mcap); ")
