"""The description of an FMU, and what is ours in it."""

from __future__ import annotations

import json
import re
import zipfile
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rlv_landing.errors import LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES, Parameters
from rlv_landing.quantities import (
    INPUT_NAMES,
    OUTPUT_NAMES,
    PEAK_QUANTITIES,
    STATISTIC_QUANTITIES,
    flat_name,
    whole_name,
)

MODEL_NAME = "RlvLanding"
# how the description of an FMU that our build has made says so
MADE_BY = "rlv-landing "
# the start values of a vehicle that is not the default one
VEHICLE = re.compile(r"resources/[^/]+/vehicle\.json")
BUILD = "build ours by `rlv-landing fmu build`"
FMI_VERSIONS = ("2.0", "3.0")
NAMES = (
    *OUTPUT_NAMES,
    *INPUT_NAMES,
    *PARAMETER_QUANTITIES,
    *(q.name for q in (*STATISTIC_QUANTITIES, *PEAK_QUANTITIES)),
)


class Place(NamedTuple):
    """Where a value is in an FMU: its variable, and the element of that, from 0, of `size`."""

    reference: int
    element: int = 0
    size: int = 1


def open_description(path: Path) -> Any:
    """FMPy's description of any FMU at `path`.

    Raises:
        LandingError: no such file, not an FMU, or FMPy is missing.
    """
    try:
        found = path.is_file()
    except OSError as e:
        raise LandingError(f"FMU {path} cannot be read: {e.strerror or e}") from None
    if not found:
        raise LandingError(
            f"there is no FMU {path}; build it by `rlv-landing fmu build`, or name another"
        )
    try:
        from fmpy import read_model_description
    except ImportError:
        raise LandingError(
            'FMPy is missing; install it with pip install "rlv-landing[fmu]"'
        ) from None
    try:
        return read_model_description(str(path))
    except (zipfile.BadZipFile, KeyError):
        raise LandingError(
            f"{path} is not an FMU: it is no zip archive with a modelDescription.xml in it"
        ) from None
    except Exception as e:
        raise LandingError(
            f"{path} is not an FMU that can be read: {' '.join(str(e).split())}"
        ) from None


def is_ours(description: Any) -> bool:
    """Whether an FMU is of this model, whatever its name, vehicle and version."""
    made_by = description.generationTool or ""
    return description.modelName == MODEL_NAME or made_by.startswith(MADE_BY)


def read_description(path: Path) -> Any:
    """FMPy's description of our FMU at `path`.

    Raises:
        LandingError: no such file, not an FMU, another model, or FMPy is missing.
    """
    description = open_description(path)
    if not is_ours(description):
        raise LandingError(
            f"{path} holds the model {description.modelName!r}, which is not of rlv-landing; "
            f"{BUILD}"
        )
    if description.fmiVersion not in FMI_VERSIONS or description.coSimulation is None:
        raise LandingError(
            f"{path} is not an FMU for co-simulation in FMI {' or '.join(FMI_VERSIONS)}; {BUILD}"
        )
    return description


def places(description: Any, path: Path) -> dict[str, Place]:
    """Where our FMU has each quantity, by our names, also where its own are flat or arrays.

    Raises:
        LandingError: It lacks a variable: it is of another version.
    """
    known = {v.name: v.valueReference for v in description.modelVariables}
    arrays = description.fmiVersion == "3.0"
    found: dict[str, Place] = {}
    sizes = Counter(whole_name(name) for name in NAMES) if arrays else Counter()
    seen: Counter[str] = Counter()
    for name in NAMES:
        own = whole_name(name) if arrays else name if name in known else flat_name(name)
        if own not in known:
            raise LandingError(
                f"{path} (version {description.version or 'unknown'}) has no variable {name!r}; "
                "build it again by `rlv-landing fmu build`"
            )
        found[name] = Place(known[own], seen[own], sizes[own] if arrays else 1)
        seen[own] += 1
    return found


def start_values(description: Any) -> dict[str, float | str]:
    """The parameters' start values of our FMU by our names [SI]."""
    starts = {v.name: v.start for v in description.modelVariables}
    return {
        name: text if q.choices else float(text)
        for name, q in PARAMETER_QUANTITIES.items()
        if (text := starts.get(name, starts.get(flat_name(name)))) is not None
    }


def own_vehicle(path: Path) -> Parameters | None:
    """The vehicle that an FMU was built for; None for the default one, and for what is no FMU.

    It is quick: the description is not read.

    Raises:
        LandingError: A value is not one of this version's.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            files = [name for name in archive.namelist() if VEHICLE.fullmatch(name)]
            values = json.loads(archive.read(files[0])) if files else None
    except (OSError, ValueError, zipfile.BadZipFile):
        return None
    try:
        return Parameters().with_values(values) if values else None
    except LandingError as e:
        raise LandingError(f"the vehicle of {path}: {e}") from None


def vehicle_of(description: Any, values: Mapping[str, float | str] | None = None) -> Parameters:
    """The vehicle that our FMU lands.

    Args:
        description: Its description.
        values: Parameters that are set in it, by name [SI].

    Raises:
        LandingError: A value is not one of this version's.
    """
    return Parameters().with_values({**start_values(description), **(values or {})})
