"""What pip installs where ROS 2 looks: package, launch file, layouts, and the node."""

from __future__ import annotations

import os
import runpy
import shutil
import sys
from pathlib import Path

import pytest
import setuptools

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "rlv_ros_bridge"


@pytest.fixture
def prefix(tmp_path, monkeypatch) -> Path:
    """An environment's folder with the files that setup.py declares for it."""
    declared: dict[str, object] = {}
    monkeypatch.setattr(setuptools, "setup", declared.update)
    # the core is not compiled for this
    monkeypatch.setitem(sys.modules, "Cython.Build", None)
    monkeypatch.chdir(ROOT)
    runpy.run_path(str(ROOT / "setup.py"))
    for folder, files in declared["data_files"]:
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        for file in files:
            shutil.copy(ROOT / file, tmp_path / folder)
    return tmp_path


def test_ros_finds_package_launch_file_and_node(prefix, monkeypatch):
    index = pytest.importorskip("ament_index_python")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    share = Path(index.get_package_share_directory(PACKAGE))
    assert share == prefix / "share" / PACKAGE
    for kind in ("launch", "config"):
        declared = {p.name for p in (ROOT / "ros_bridge" / kind).iterdir() if p.is_file()}
        assert {p.name for p in (share / kind).iterdir()} == declared
    node = Path(index.get_package_prefix(PACKAGE)) / "lib" / PACKAGE / "landing_node"
    assert os.access(node, os.X_OK)
