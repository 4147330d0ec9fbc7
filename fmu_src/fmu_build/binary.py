"""Compiles the FMU's front (`fmu_front/`) and puts pythonfmu's binary beside it.

The front for Windows is compiled if mingw-w64 is found (`x86_64-w64-mingw32-gcc`). Otherwise the
FMU has only pythonfmu's own DLL for Windows.
"""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
from pythonfmu import __version__ as pythonfmu_version

FRONT = Path(__file__).parent.parent / "fmu_front"
HEADERS = Path(fmpy.__file__).parent / "c-code"
CAUSALITIES = {"parameter": "p", "input": "i", "output": "o"}
FLAGS = ["-std=c11", "-O2", "-fvisibility=hidden", "-Wall", "-Wextra", "-g0", "-s", "-shared"]
MINGW = "x86_64-w64-mingw32-gcc"
# no DLL of mingw needed, C11's printf, the same bytes at any time and in any folder
WINDOWS_FLAGS = [
    "-D__USE_MINGW_ANSI_STDIO=1",
    "-static",
    "-Wl,--no-insert-timestamp,--disable-auto-image-base",
]
DT_FINI_ARRAY, DT_FINI_ARRAYSZ = 26, 28
SHT_DYNAMIC = 6


def replace_binaries(files: Path) -> None:
    """Replace pythonfmu's binary by the front, and put pythonfmu's beside it.

    Also records the building Python's library in `resources/libpython.txt`.

    Args:
        files: Folder of the unpacked FMU.

    Raises:
        SystemExit: The front does not compile; the message has the compiler's output.
    """
    root = ElementTree.parse(files / "modelDescription.xml").getroot()
    simulation = root.find("CoSimulation")
    assert simulation is not None
    binary = files / "binaries" / "linux64" / f"{simulation.attrib['modelIdentifier']}.so"
    put_front(binary, without_last_finaliser(binary.read_bytes()), root)
    dll = files / "binaries" / "win64" / f"{binary.stem}.dll"
    if shutil.which(MINGW):
        put_front(dll, dll.read_bytes(), root)
    library = libpython()
    if library:
        (files / "resources" / "libpython.txt").write_text(library + "\n")


def put_front(binary: Path, pythonfmu_binary: bytes, root: ElementTree.Element) -> None:
    """Compile the front to `binary`, and write pythonfmu's binary beside it.

    Args:
        binary: File that importers load, for Windows if it is a `.dll`.
        pythonfmu_binary: Content of pythonfmu's binary.
        root: Root of the FMU's modelDescription.xml.
    """
    beside = binary.with_name(f"pythonfmu-export-{pythonfmu_version}{binary.suffix}")
    beside.write_bytes(pythonfmu_binary)
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as folder:
        (Path(folder) / "variables.h").write_text(variables_header(root, beside.name))
        compile_front(binary, Path(folder))


def compile_front(target: Path, include: Path) -> None:
    """Compile the front to a shared library.

    Args:
        target: The library, for Windows if it is a `.dll`.
        include: Folder that holds `variables.h`.

    Raises:
        SystemExit: The front does not compile; the message has the compiler's output.
    """
    windows = target.suffix == ".dll"
    compiler = MINGW if windows else os.environ.get("CC", "gcc")
    sources = [
        str(p)
        for p in sorted(FRONT.glob("*.c"))
        if p.name != ("posix.c" if windows else "windows.c")
    ]
    own = WINDOWS_FLAGS if windows else ["-fPIC", "-ldl"]
    command = [
        compiler,
        *FLAGS,
        "-I",
        str(include),
        "-isystem",
        str(HEADERS),
        "-o",
        str(target),
        *sources,
        *own,
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(
            f"error: the FMU's front does not compile: {' '.join(command)}\n{done.stderr}"
        )


def variables_header(root: ElementTree.Element, pythonfmu_binary: str) -> str:
    """C header with the description's variables, log categories and GUID, for the front.

    Args:
        root: Root of the FMU's modelDescription.xml.
        pythonfmu_binary: Name of pythonfmu's binary, which lies beside the front.

    Raises:
        SystemExit: The value references are not 0, 1, 2, ... in order.
    """
    lines = [
        "/* Made by fmu_build/binary.py from modelDescription.xml. */",
        "struct variable { char type, causality; const char *name; };",
    ]
    lines.append("static const struct variable VARIABLES[] __attribute__((unused)) = {")
    for i, variable in enumerate(root.findall("ModelVariables/ScalarVariable")):
        if int(variable.attrib["valueReference"]) != i:
            raise SystemExit(
                f"error: value reference of {variable.attrib['name']} is not {i}; "
                "the front needs them in order"
            )
        causality = CAUSALITIES.get(variable.attrib["causality"], "-")
        lines.append(
            f"    {{'{variable[0].tag[0]}', '{causality}', {quoted(variable.attrib['name'])}}},"
        )
    lines += ["};", "enum { VARIABLE_COUNT = sizeof VARIABLES / sizeof *VARIABLES };"]
    lines += ["static const char *const CATEGORIES[] __attribute__((unused)) = {"]
    lines += [
        f"    {quoted(category.attrib['name'])},"
        for category in root.findall("LogCategories/Category")
    ]
    lines += [
        "};",
        f"#define GUID {quoted(root.attrib['guid'])}",
        f"#define PYTHONFMU_BINARY {quoted(pythonfmu_binary)}",
    ]
    lines.append(f"#define BUILD_PYTHON_MINOR {sys.version_info.minor}")
    return "\n".join(lines) + "\n"


def quoted(text: str) -> str:
    """`text` as a C string."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def libpython() -> str:
    """Path of the shared library of the running Python; empty if it has none."""
    folder, name = sysconfig.get_config_var("LIBDIR"), sysconfig.get_config_var("INSTSONAME")
    path = Path(folder or "", name or "")
    return str(path) if path.is_file() and path.suffix != ".a" else ""


def without_last_finaliser(binary: bytes) -> bytes:
    """Copy of pythonfmu's binary without the last entry of its DT_FINI_ARRAY.

    That entry runs when the process ends. It resets a static object that `exit` has destroyed
    before, so it writes to freed memory: importers written in C may end with a corrupted heap.
    The object needs no reset, because the front never lets it finalise Python.

    Args:
        binary: Content of a 64-bit little-endian ELF file.

    Raises:
        SystemExit: The file is of another kind, or has not the two finalisers that are known.
    """
    edited = bytearray(binary)
    if edited[:6] != b"\x7fELF\x02\x01":
        raise SystemExit("error: pythonfmu's binary is no 64-bit little-endian ELF file")
    section_table = struct.unpack_from("<Q", edited, 0x28)[0]
    entry_size, count = struct.unpack_from("<HH", edited, 0x3A)
    for section in range(section_table, section_table + count * entry_size, entry_size):
        kind, offset, size = (
            struct.unpack_from("<I", edited, section + 4)[0],
            *struct.unpack_from("<QQ", edited, section + 0x18),
        )
        if kind != SHT_DYNAMIC:
            continue
        for at in range(offset, offset + size, 16):
            tag, value = struct.unpack_from("<QQ", edited, at)
            if tag == DT_FINI_ARRAYSZ:
                if value != 16:
                    raise SystemExit(
                        f"error: pythonfmu's binary has {value // 8} finalisers, not 2; "
                        "look what the others do before you change this check"
                    )
                struct.pack_into("<Q", edited, at + 8, value - 8)
                return bytes(edited)
    raise SystemExit("error: pythonfmu's binary has no DT_FINI_ARRAYSZ")
