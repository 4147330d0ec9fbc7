"""Builds that cannot be: bad names and compilers, a full disk, an end from outside."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import subprocess
import sys

import pytest

from rlv_landing import LandingError


@pytest.mark.parametrize("name", ["int", "static", "CON", "Lpt1", "nul"])
def test_a_name_that_no_binary_can_have_is_refused(binary, name):
    from fmu_build.wanted import Wanted

    with pytest.raises(LandingError, match=f"model name '{name}' is a word of C or a device"):
        Wanted(name=name)
    assert Wanted(name=f"{name}1x").name == f"{name}1x"


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ("gcc '", "is no command"),
        ("/bin/false", "exit code 1"),
        ("/bin/true", "it has made no library"),
    ],
)
def test_a_wrong_compiler_is_named_in_one_line(binary, header, monkeypatch, command, reason):
    monkeypatch.setenv("CC", command)
    with pytest.raises(SystemExit) as refused:
        binary.compile_front(header / "front.so", header, binary.for_linux())
    message = str(refused.value)
    assert message.startswith("error: ")
    assert "\n" not in message
    assert reason in message
    assert command in message
    assert "by CC" in message


def test_a_full_disk_where_it_builds_is_told_as_such(binary, monkeypatch, tmp_path):
    from fmu_build.build import _temporary_folder

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "core/leg.py")
    # what shutil.copytree raises
    for error in (full, shutil.Error([("leg.py", "to/leg.py", str(full))])):
        with (
            pytest.raises(LandingError, match="No space left on device; make room, or name") as e,
            _temporary_folder(),
        ):
            raise error
        assert str(e.value).startswith(f"{tmp_path} cannot be written")
    other = OSError(errno.EACCES, os.strerror(errno.EACCES), "core/leg.py")
    with pytest.raises(PermissionError), _temporary_folder():
        raise other
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("module", ["rlv_ros_bridge", "fmu_build.build"])
def test_a_build_that_is_ended_leaves_nothing(module, tmp_path):
    """Its compiler ends it, so it ends amid the build."""
    compiler = tmp_path / "cc"
    compiler.write_text("#!/bin/sh\nkill -TERM $PPID\nsleep 60\n")
    compiler.chmod(0o755)
    room = tmp_path / "room"
    room.mkdir()
    command = ["--pure"] if module == "fmu_build.build" else ["fmu", "build", "--pure", "-o"]
    done = subprocess.run(
        [sys.executable, "-m", module, *command, "mine.fmu"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "CC": str(compiler), "TMPDIR": str(room)},
    )
    assert done.returncode == 128 + signal.SIGTERM, done.stderr
    assert done.stderr.split() == ["interrupted"]
    assert not list(room.iterdir())
    assert sorted(p.name for p in tmp_path.iterdir()) == ["cc", "room"]
