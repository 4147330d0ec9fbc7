"""The FMU that belongs to this installation of the bridge, wherever it is called from."""

from __future__ import annotations

from pathlib import Path

PACKAGE = "rlv_ros_bridge"
NAME = "RlvLanding.fmu"


def installed_fmu(package: Path | None = None) -> Path:
    """The FMU of a checkout is in its `build`, that of an installation in the package's share.

    Args:
        package: the package's folder; None: that of this file.

    Returns:
        Its path, whether it exists or not.
    """
    package = package or Path(__file__).resolve().parents[1]
    if package.parent.name in ("site-packages", "dist-packages"):
        # PREFIX/lib/python3.N/site-packages
        return package.parents[3] / "share" / PACKAGE / "fmu" / NAME
    return package.parents[1] / "build" / NAME


def fmu_path(name: str) -> Path:
    """The FMU of this name; an empty name is the installation's."""
    return Path(name) if name else installed_fmu()
