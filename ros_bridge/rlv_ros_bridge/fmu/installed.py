"""The FMU that belongs to this installation of the bridge, wherever it is called from."""

from __future__ import annotations

import os
import platform
from pathlib import Path

from rlv_landing import __version__
from rlv_landing.core import COMPILED

from .builds import installed_model

PACKAGE = "rlv_ros_bridge"
NAME = "RlvLanding.fmu"


def installed_fmu(package: Path | None = None) -> Path:
    """The FMU of a checkout is in its `build`, that of a workspace in the package's share.

    An installation by pip has none: its FMU is built when it is first needed, into the user's
    cache, one for each version of the model.

    Args:
        package: the package's folder; None: that of this file.

    Returns:
        Its path, whether it exists or not.
    """
    package = package or Path(__file__).resolve().parents[1]
    if package.parent.name not in ("site-packages", "dist-packages"):
        return package.parents[1] / "build" / NAME
    # PREFIX/lib/python3.N/site-packages
    shared = package.parents[3] / "share" / PACKAGE / "fmu" / NAME
    return shared if shared.is_file() or not is_by_pip(package) else cached_fmu()


def is_by_pip(package: Path) -> bool:
    """Whether the package is installed beside what builds its FMU."""
    return (package.parent / "fmu_build").is_dir()


def cached_fmu() -> Path:
    """The FMU of the installed model in the user's cache, whether it exists or not."""
    cache = os.environ.get("XDG_CACHE_HOME", "")
    root = Path(cache) if Path(cache).is_absolute() else Path.home() / ".cache"
    core = platform.machine() if COMPILED else "uncompiled"
    return root / "rlv-landing" / f"{__version__}-{installed_model()}-{core}" / NAME


def fmu_path(name: str) -> Path:
    """The FMU of this name; an empty name is the installation's."""
    return Path(name) if name else installed_fmu()
