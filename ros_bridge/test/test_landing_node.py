"""What `colcon test` runs of the installed package; the project's own suite has the rest.

Needs the model, FMPy and the MCAP library: pip install "rlv-landing[fmu,mcap]".
"""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from rlv_ros_bridge.fmu.installed import installed_fmu

ENTRY = "import sys; from rlv_ros_bridge.node.start import main; sys.exit(main())"
LAUNCH = Path(__file__).resolve().parents[1] / "launch" / "landing.launch.py"
TIMEOUT = 60.0

needs_fmu = pytest.mark.skipif(
    not installed_fmu().is_file(),
    reason=f"{installed_fmu()} is missing: run ./build_fmu.sh before colcon build",
)


@needs_fmu
def test_the_node_lands_and_writes_its_log(tmp_path: Path) -> None:
    """As `ros2 run` starts it, as fast as possible."""
    given = ("realtime_factor:=0.0", f"log_root:={tmp_path}/logs")
    ros = [text for pair in given for text in ("-p", pair)]
    done = subprocess.run(
        [sys.executable, "-c", ENTRY, "--ros-args", *ros],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    (log,) = (tmp_path / "logs").iterdir()
    assert (log / "metadata.yaml").is_file()
    assert f"log: {log}" in done.stdout


@needs_fmu
@pytest.mark.skipif(
    find_spec("launch_ros") is None,
    reason="launch_ros is not installed: the launch file is not run",
)
def test_the_launch_file_ends_cleanly(tmp_path: Path) -> None:
    """With a folder whose name is no Python text."""
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    from launch import LaunchDescription, LaunchService

    given = [("realtime_factor", "0"), ("log_root", f"{tmp_path}/it's")]
    service = LaunchService()
    source = AnyLaunchDescriptionSource(str(LAUNCH))
    service.include_launch_description(
        LaunchDescription([IncludeLaunchDescription(source, launch_arguments=given)])
    )
    assert service.run() == 0
    (log,) = (tmp_path / "it's").iterdir()
    assert (log / "metadata.yaml").is_file()
