"""How the core is loaded.

What is missing or interrupted there is an error; absence or age of the compiled core is reported.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rlv_landing import core

ROOT = Path(__file__).resolve().parent.parent.parent

WITHOUT_INSPECT = "import sys; sys.modules['inspect'] = None; import rlv_landing.core"
INTERRUPTED = """
import sys
class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == "inspect":
            raise KeyboardInterrupt
sys.modules.pop("inspect", None)
sys.meta_path.insert(0, Interrupt())
import rlv_landing.core
"""
MAIN = "from rlv_landing.cli import main; main()"


def run(script: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", script, *arguments],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, "PYTHONPATH": str(ROOT / "fmu_src"), **environment},
    )


@pytest.fixture(scope="module")
def uncompiled(tmp_path_factory) -> str:
    """A folder with the package as it is where no compiler was."""
    folder = tmp_path_factory.mktemp("uncompiled")
    ignored = shutil.ignore_patterns("__pycache__", "*.so", "*.pyd")
    shutil.copytree(ROOT / "fmu_src" / "rlv_landing", folder / "rlv_landing", ignore=ignored)
    return str(folder)


@pytest.mark.parametrize(
    ("script", "error"),
    [(WITHOUT_INSPECT, "ModuleNotFoundError"), (INTERRUPTED, "KeyboardInterrupt")],
)
def test_a_missing_module_or_ctrl_c_while_the_compiled_core_loads_is_an_error_not_a_crash(
    script, error
):
    done = run(script)
    assert done.returncode in (1, 130, -2), done.stderr
    assert error in done.stderr.splitlines()[-1]


def test_the_command_line_tells_in_one_line_that_the_core_is_not_compiled(uncompiled):
    done = run(MAIN, "--version", PYTHONPATH=uncompiled)
    assert done.returncode == 0, done.stderr
    assert done.stdout.rstrip().endswith(", uncompiled core")
    (line,) = done.stderr.splitlines()
    assert line.startswith("the core is not compiled (No module named 'rlv_landing.core.compiled")


@pytest.mark.parametrize(("pure", "core"), [("0", "compiled"), ("1", "uncompiled")])
def test_what_is_there_or_asked_for_is_told_by_the_version_only(pure, core):
    done = run(MAIN, "--version", RLV_LANDING_PURE=pure)
    assert done.stdout.rstrip().endswith(f", {core} core")
    assert done.stderr == ""


CHANGED = "from rlv_landing import core; print(core.COMPILED, core.Planar.__module__)"


@pytest.mark.skipif(not core.COMPILED, reason="there is no compiled core")
@pytest.mark.parametrize(
    ("script", "arguments", "said"),
    [
        (CHANGED, (), "False rlv_landing.core.bodies.planar"),
        (MAIN, ("--version",), ", uncompiled core"),
        ("from fmu_build.build import main; main()", ("made.fmu",), ""),
    ],
    ids=["import", "command", "build of an FMU"],
)
def test_a_compiled_core_of_other_files_is_told_in_one_line_and_does_not_run(
    script, arguments, said, tmp_path
):
    ignored = shutil.ignore_patterns("__pycache__")
    for package in ("rlv_landing", "fmu_build"):
        shutil.copytree(ROOT / "fmu_src" / package, tmp_path / package, ignore=ignored)
    with (tmp_path / "rlv_landing" / "core" / "leg.py").open("a") as file:
        file.write("# changed\n")
    done = run(script, *arguments, PYTHONPATH=str(tmp_path), RLV_LANDING_PURE="")
    first, *others = done.stderr.splitlines()
    assert ": RuntimeWarning: the core was compiled before leg.py changed: the present " in first
    # a copy without setup.py is compiled by an installation
    assert "gcc and Python.h" in first
    assert first.endswith("--no-deps with the same source or wheel compiles them")
    if said:
        assert (done.returncode, others) == (0, [])
        assert done.stdout.rstrip().endswith(said)
    else:
        assert done.returncode == 1
        (refusal,) = others
        assert refusal.startswith("error: there is no compiled core of the present kernels: ")
        assert not (tmp_path / arguments[0]).exists()
