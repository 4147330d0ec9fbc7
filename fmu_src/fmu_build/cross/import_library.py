"""The import library of `python3.dll`, for an extension module of the limited API.

Windows' linker asks where each symbol of another library comes from. `python3.dll` is part of every
Python for Windows, and has all symbols of the limited API. Only those that the module needs are
named, as its object file lists them.
"""

from __future__ import annotations

import struct
from pathlib import Path

from ..compilers import ZIG, run

DLL = "python3.dll"
# of a COFF object: machine, sections, date, where the symbols are and how many; a symbol's name,
# value, section, type, storage class and count of the entries that follow it
HEADER, SYMBOL = struct.Struct("<HHIII"), struct.Struct("<8sIhHBB")
EXTERNAL = 2
IMPORTED = "__imp_"


def undefined(content: bytes) -> set[str]:
    """The symbols that a COFF object file needs and does not have."""
    _, _, _, start, count = HEADER.unpack_from(content)
    texts = start + count * SYMBOL.size
    found, i = set(), 0
    while i < count:
        name, value, section, _, storage, more = SYMBOL.unpack_from(
            content, start + i * SYMBOL.size
        )
        if storage == EXTERNAL and section == 0 and value == 0:
            if name[:4] == bytes(4):
                # a long name stands among the texts behind the symbols
                at = texts + int.from_bytes(name[4:], "little")
                name = content[at : content.index(b"\0", at)]
            found.add(name.rstrip(b"\0").decode())
        i += 1 + more
    return found


def of_python(symbols: set[str]) -> list[str]:
    """Python's symbols among those that an object file needs, by their names in the DLL."""
    plain = {name.removeprefix(IMPORTED) for name in symbols}
    return sorted(name for name in plain if name.startswith(("Py", "_Py")))


def write_import_library(target: Path, needed: list[str]) -> None:
    """Write the import library of `python3.dll` with the symbols `needed`.

    Raises:
        SystemExit: Zig's dlltool fails.
    """
    definition = target.with_suffix(".def")
    names = "".join(f"    {name}\n" for name in needed)
    definition.write_text(f"LIBRARY {DLL}\nEXPORTS\n{names}")
    command = [*ZIG, "dlltool", "-m", "i386:x86-64", "-d", str(definition), "-l", str(target)]
    done = run(command)
    if done.returncode != 0:
        raise SystemExit(f"error: no import library of {DLL}: {' '.join(command)}\n{done.stderr}")
