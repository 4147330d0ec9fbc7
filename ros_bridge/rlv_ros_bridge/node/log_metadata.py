"""The metadata of a log: what is needed to repeat its run."""

from __future__ import annotations

import platform
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version

from rlv_landing import __version__

from ..fmu.builds import build_metadata
from ..fmu.runner import FmuRunner
from .settings import Settings


def log_metadata(settings: Settings, namespace: str, fmu: FmuRunner) -> dict[str, str]:
    """Texts by name: mode, preset, times [s], the FMU's identity, versions.

    Args:
        settings: the landing's settings.
        namespace: namespace of the node and its topics.
        fmu: the FMU that computes the landing.
    """
    metadata = {
        "mode": settings.mode,
        "preset": settings.preset,
        "step_size": repr(settings.step_size),
        "stop_time": repr(settings.stop_time),
        "realtime_factor": repr(settings.realtime_factor),
        "namespace": namespace,
        "recorded": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "fmu_guid": fmu.guid,
        "fmu_version": fmu.version,
        "fmu_made_by": fmu.made_by,
        "fmu_core": "compiled" if fmu.is_compiled() else "not compiled",
        "version_rlv_landing": __version__,
        "version_python": platform.python_version(),
        **build_metadata(settings.fmu),
    }
    for package in ("fmpy", "pythonfmu"):
        try:
            metadata[f"version_{package}"] = version(package)
        except PackageNotFoundError:
            continue
    return metadata
