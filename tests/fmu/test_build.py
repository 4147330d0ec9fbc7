"""`build_fmu.sh` as a user calls it."""

import subprocess
import sys
from pathlib import Path

import fmpy

ROOT = Path(__file__).resolve().parent.parent.parent


def test_build_script_writes_where_it_is_told_and_says_what_it_checked(tmp_path):
    target = tmp_path / "sub folder" / "mine.fmu"
    done = subprocess.run(
        ["./build_fmu.sh", str(target)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
        env={"PYTHON": sys.executable, "PATH": "/usr/bin:/bin"},
    )
    assert done.returncode == 0, done.stderr
    assert "valid; trial landing" in done.stdout
    assert [p.name for p in target.parent.iterdir()] == ["mine.fmu"]
    assert fmpy.read_model_description(str(target)).modelName == "RlvLanding"
