"""The description of an FMU, and what is ours in it."""

from __future__ import annotations

import json
import re
import zipfile
from collections import Counter
from collections.abc import Container, Mapping
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

from rlv_landing import MODEL_NAME
from rlv_landing.errors import LandingError, reason_of
from rlv_landing.parameters import PARAMETER_QUANTITIES, Parameters, parameters_of
from rlv_landing.quantities import (
    LEGS,
    MODES,
    RADIAL,
    SPACE,
    STATISTIC_QUANTITIES,
    Interface,
    flat_name,
    interface_of,
    whole_name,
)

# how the description of an FMU that our build has made says so
MADE_BY = "rlv-landing "
# the start values of a vehicle that is not the default one
VEHICLE = re.compile(r"resources/[^/]+/vehicle\.json")
# what an FMU may need on a disk, and its description in memory [bytes]: an archive of a few kB can
# hold what fills either
LARGEST, LARGEST_DESCRIPTION = 1_000_000_000, 200_000_000
DESCRIPTION = "modelDescription.xml"
BUILD = "build ours by `rlv-landing fmu build`"
FMI_VERSIONS = ("2.0", "3.0")
# an output that an FMU of landings in space has, and no other
OF_SPACE = "body.q_w"


class Place(NamedTuple):
    """Where a value is in an FMU: its variable, and the element of that, from 0, of `size`."""

    reference: int
    element: int = 0
    size: int = 1


def open_description(path: Path) -> Any:
    """FMPy's description of any FMU at `path`.

    Raises:
        LandingError: no such file, not an FMU, a description that is too large, or FMPy is
            missing.
    """
    try:
        found = path.is_file()
    except OSError as e:
        raise LandingError(f"FMU {path} cannot be read: {reason_of(e)}") from None
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
        with zipfile.ZipFile(path) as archive:
            size = archive.getinfo(DESCRIPTION).file_size
    except (zipfile.BadZipFile, KeyError):
        raise LandingError(
            f"{path} is not an FMU: it is no zip archive with a modelDescription.xml in it"
        ) from None
    except OSError as e:
        raise LandingError(f"FMU {path} cannot be read: {e.strerror or e}") from None
    try:
        if size > LARGEST_DESCRIPTION:
            raise LandingError(
                f"{path}: its {DESCRIPTION} has {size / 1e6:.0f} MB, at most "
                f"{LARGEST_DESCRIPTION / 1e6:.0f} MB are read"
            )
        return read_model_description(str(path))
    except LandingError:
        raise
    except KeyError as e:  # of a unit, type or variable
        raise LandingError(
            f"{path} is not an FMU that can be read: its modelDescription.xml refers to {e}, "
            "which is not in it"
        ) from None
    except Exception as e:
        raise LandingError(f"{path} is not an FMU that can be read: {reason_of(e)}") from None


def check_size(path: Path) -> None:
    """Check that the FMU at `path`, unpacked, is not so large that it would fill the disk.

    Raises:
        LandingError: It is.
        OSError, zipfile.BadZipFile: It cannot be read.
    """
    with zipfile.ZipFile(path) as archive:
        size = sum(entry.file_size for entry in archive.infolist())
    if size > LARGEST:
        raise LandingError(
            f"{path} has {size / 1e6:.0f} MB unpacked, at most {LARGEST / 1e6:.0f} MB are "
            f"unpacked; {BUILD}"
        )


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
            f"{path} is an FMU of FMI {description.fmiVersion}"
            f"{'' if description.coSimulation else ' without co-simulation'}; FMI "
            f"{' or '.join(FMI_VERSIONS)} for co-simulation is what runs here; {BUILD}"
        )
    return description


def interface_in(description: Any) -> Interface:
    """The inputs and outputs of our FMU."""
    names = {v.name for v in description.modelVariables}
    if OF_SPACE not in names and flat_name(OF_SPACE) not in names:
        return interface_of(min(MODES))
    values = start_values(description)
    return interface_of(
        SPACE, int(values.get("vehicle.legs", len(LEGS))), str(values.get("leg.kind", RADIAL))
    )


def names_of(interface: Interface) -> tuple[str, ...]:
    """The quantities that an FMU with this interface has."""
    return (
        *interface.output_names,
        *interface.input_names,
        *parameters_of(SPACE if interface.in_space else min(MODES)),
        *(q.name for q in (*STATISTIC_QUANTITIES, *interface.peak_quantities)),
    )


def places(description: Any, path: Path, needed: Container[str] | None = None) -> dict[str, Place]:
    """Where our FMU has each quantity, by our names, also where its own are flat or arrays.

    Args:
        description: Its description.
        path: Its file, for the error.
        needed: The quantities that it must have; None: all. Those of other versions may lack
            others.

    Raises:
        LandingError: It lacks a needed variable: it is of another version.
    """
    known = {v.name: v for v in description.modelVariables}
    found: dict[str, Place] = {}
    arrays = description.fmiVersion == "3.0"
    names = names_of(interface_in(description))
    own_names = [_own_name(name, known, arrays=arrays) for name in names]
    sizes, seen = Counter(own_names), Counter[str]()
    for name, own in zip(names, own_names):
        if own in known and _size(known[own]) == sizes[own]:
            found[name] = Place(known[own].valueReference, seen[own], sizes[own])
            seen[own] += 1
        elif needed is None or name in needed:
            raise without(path, description.version, name)
    return found


def without(path: Path, version: str, name: str) -> LandingError:
    """The error of an FMU that lacks the quantity `name`."""
    return LandingError(
        f"{path} (version {version or 'unknown'}) has no variable {name!r}; "
        "build it again by `rlv-landing fmu build`"
    )


def _own_name(name: str, known: Container[str], *, arrays: bool) -> str:
    """An FMU's name of the variable that has a quantity."""
    if name in known:
        return name
    whole = whole_name(name) if arrays else name
    return whole if whole in known else flat_name(whole)


def _size(variable: Any) -> int:
    """The number of values of a variable; 0 where a parameter decides it, as in none of ours."""
    return prod(int(d.start or 0) for d in variable.dimensions or ())


def start_values(description: Any) -> dict[str, float | str]:
    """The parameters' start values of our FMU by our names [SI]."""
    starts = {v.name: v.start for v in description.modelVariables}
    return {
        name: text if q.kind == "string" else float(text)
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
