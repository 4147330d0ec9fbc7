"""The library of an FMU for this machine, checked before the loader takes it.

The loader's messages about another platform's library mislead, and one that is cut short ends the
process.
"""

from __future__ import annotations

import re
import struct
import sys
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError

BUILD = "build it on this machine by `rlv-landing fmu build`"
# of an ELF file: class and byte order, processor; place, size and number of the segments
HEADER = struct.Struct("<4x2s12x2s12xQ14xHH4x")
# of a segment: its kind, place and size in the file
SEGMENT = struct.Struct("<I4xQ16xQ16x")
LOADED = 1


def check_library(description: Any, folder: Path, fmu: Path) -> None:
    """Check that the FMU has a library that this machine can load.

    Args:
        description: Its description.
        folder: Its unpacked files.
        fmu: The FMU, for messages.

    Raises:
        LandingError: It has not.
    """
    from fmpy import platform, platform_tuple, sharedLibraryExtension

    name = description.coSimulation.modelIdentifier
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name, re.ASCII):
        raise LandingError(f"{fmu}: modelIdentifier = {name!r} is no name of a library; {BUILD}")
    own = platform_tuple if description.fmiVersion == "3.0" else platform
    library = folder / "binaries" / own / f"{name}{sharedLibraryExtension}"
    if not library.is_file():
        others = sorted(p.name for p in (folder / "binaries").glob("*") if p.is_dir())
        raise LandingError(
            f"{fmu} has a library for {', '.join(others) or 'no platform'}, and not for {own}, "
            f"which this machine is; {BUILD}, or on another one with `--platforms all`"
        )
    fault = _fault(library) if sys.platform.startswith("linux") else ""
    if fault:
        raise LandingError(f"{fmu}: its library for {own} {fault}; {BUILD}")


def _fault(library: Path) -> str:
    """Why the loader of Linux cannot take a library; empty if nothing is known against it."""
    size = library.stat().st_size
    if size < HEADER.size:
        return f"has {size} bytes, which is no library"
    with Path("/proc/self/exe").open("rb") as own:
        kind, processor, *_ = HEADER.unpack(own.read(HEADER.size))
    with library.open("rb") as file:
        start = file.read(HEADER.size)
        its_kind, its_processor, at, each, count = HEADER.unpack(start)
        if not start.startswith(b"\x7fELF"):
            return "is no library of Linux"
        if (its_kind, its_processor) != (kind, processor):
            return "is for another processor"
        file.seek(at)
        segments = file.read(each * count)
    if each < SEGMENT.size or len(segments) < each * count:
        return "is cut short"
    for i in range(count):
        loaded, place, length = SEGMENT.unpack_from(segments, i * each)
        if loaded == LOADED and place + length > size:
            return "is cut short"
    return ""
