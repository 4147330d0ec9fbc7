"""Reads the description of the landing's FMU, and refuses other files."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError

MODEL_NAME = "RlvLanding"


def read_description(path: Path) -> Any:
    """FMPy's description of the FMU at `path`.

    Raises:
        LandingError: no such file, not an FMU, another model, or FMPy is missing.
    """
    try:
        found = path.is_file()
    except OSError as e:
        raise LandingError(f"FMU {path} cannot be read: {e.strerror or e}") from None
    if not found:
        raise LandingError(
            f"there is no FMU {path}; build it with ./build_fmu.sh or name one by --fmu"
        )
    try:
        from fmpy import read_model_description
    except ImportError:
        raise LandingError(
            'FMPy is missing; install it with pip install "rlv-landing[ros]"'
        ) from None
    try:
        description = read_model_description(str(path))
    except (zipfile.BadZipFile, KeyError):
        raise LandingError(
            f"{path} is not an FMU: it is no zip archive with a modelDescription.xml in it"
        ) from None
    except Exception as e:
        raise LandingError(
            f"{path} is not an FMU that can be read: {' '.join(str(e).split())}"
        ) from None
    if description.modelName != MODEL_NAME:
        raise LandingError(
            f"{path} holds the model {description.modelName!r}, not {MODEL_NAME!r}; "
            "build ours with ./build_fmu.sh"
        )
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise LandingError(
            f"{path} is not an FMU for FMI 2.0 co-simulation; build ours with ./build_fmu.sh"
        )
    return description
