"""Temporary folders go with their process, also where something is written into them at the end."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from rlv_ros_bridge.fmu.folder import LOCK, ProcessFolder, remove_stale

PREFIX = "rlv-landing-test-"


@pytest.fixture(autouse=True)
def own_temporary_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def dead_process() -> int:
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait(60)
    return child.pid


def test_a_folder_that_could_not_be_emptied_keeps_its_lock_and_goes_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = ProcessFolder(PREFIX)
    remove = Path.rmdir

    def write_meanwhile(path: Path) -> None:
        (path / "late").write_text("")
        remove(path)

    with monkeypatch.context() as late:
        late.setattr(Path, "rmdir", write_meanwhile)
        folder.remove()
    assert {p.name for p in folder.path.iterdir()} == {"late", LOCK}
    remove_stale(PREFIX)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("old", "alive", "stays"), [(1, 0, 0), (0, 0, 1), (1, 1, 1)])
def test_a_folder_without_a_lock_goes_when_it_is_old_and_its_process_dead(
    old: bool, alive: bool, stays: bool, tmp_path: Path
) -> None:
    folder = tmp_path / f"{PREFIX}{os.getpid() if alive else dead_process()}-abc"
    (folder / "rerun").mkdir(parents=True)
    if old:
        os.utime(folder, (1e9, 1e9))
    remove_stale(PREFIX)
    assert folder.exists() == stays
