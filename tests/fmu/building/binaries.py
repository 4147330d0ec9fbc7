"""What shared libraries of Linux, Windows and macOS export and need, read by lief."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import lief

MACHINES = {"X86_64": "x86_64", "AMD64": "x86_64", "AARCH64": "aarch64", "ARM64": "aarch64"}
OF_WINDOWS = {"kernel32.dll", "advapi32.dll", "shell32.dll", "msvcrt.dll", "ucrtbase.dll"}
OF_LINUX = {"libc.so.6", "libdl.so.2", "libm.so.6", "libpthread.so.0"}
# what the linker defines in every library for macOS
OF_MACOS_LINKER = {"__mh_dylib_header", "___dso_handle"}
# what the loader itself brings, by architecture
LOADER = re.compile(r"ld-linux-[a-z0-9-]+\.so\.\d")


class Library(NamedTuple):
    """Architecture of a library, the functions that it exports and the symbols that it lacks."""

    machine: str
    functions: set[str]
    lacks: set[str]


def parsed(path: Path) -> Any:
    """Lief's view of a library; of one for several architectures that of the first."""
    found = lief.parse(str(path))
    assert found is not None, path
    return found


def front_library(path: Path) -> Library:
    """Architecture, exports and missing symbols of a library."""
    found = parsed(path)
    if isinstance(found, lief.ELF.Binary):
        machine = found.header.machine_type.name
        exports = {s.name for s in found.exported_symbols}
        lacks = {s.name for s in found.dynamic_symbols if s.shndx == 0}
    elif isinstance(found, lief.PE.Binary):
        machine = found.header.machine.name
        exports = {e.name for e in found.get_export().entries}
        lacks = {e.name for i in found.imports for e in i.entries}
    else:
        machine = found.header.cpu_type.name
        exports = {
            s.name.removeprefix("_")
            for s in found.exported_symbols
            if s.name not in OF_MACOS_LINKER
        }
        lacks = {s.name.removeprefix("_") for s in found.imported_symbols}
    return Library(MACHINES[machine], exports, lacks)


def needed(path: Path) -> set[str]:
    """The libraries that a library is linked with."""
    found = parsed(path)
    return {str(getattr(one, "name", one)) for one in found.libraries} - {
        getattr(found, "id", "") or ""
    }


def needs_only_its_system(path: Path, *others: str) -> bool:
    """Whether a library needs libraries of its operating system only, and `others`."""
    rest = needed(path) - set(others)
    if path.suffix in (".dll", ".pyd"):
        rest = {n for n in rest if not n.lower().startswith("api-ms-win-crt-")}
        return {n.lower() for n in rest} <= OF_WINDOWS
    if isinstance(parsed(path), lief.MachO.Binary):
        own = {"@rpath/front.dylib", "compiled.abi3.so", "@rpath/compiled.abi3.so"}
        return rest - own <= {"/usr/lib/libSystem.B.dylib"}
    return {n for n in rest if not LOADER.fullmatch(n)} <= OF_LINUX


def old_enough(path: Path) -> bool:
    """Whether glibc 2.17 or macOS 11 will do; of Windows nothing is asked."""
    found = parsed(path)
    if isinstance(found, lief.ELF.Binary):
        versions = [
            a.name for r in found.symbols_version_requirement for a in r.get_auxiliary_symbols()
        ]
        numbers = [tuple(map(int, v[6:].split("."))) for v in versions if v.startswith("GLIBC_")]
        return bool(numbers) and max(numbers) <= (2, 17)
    if isinstance(found, lief.MachO.Binary):
        return tuple(found.build_version.minos[:2]) <= (11, 0)
    return True
