"""The FMU's binaries: compiles the front in `fmu_front/` and lays pythonfmu's own binary beside it.

Runs at build time only.

Windows' front is compiled where mingw-w64 is found (`x86_64-w64-mingw32-gcc`); else the FMU has
pythonfmu's own DLL there.
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
# no library of mingw's own beside the DLL, C's printf, the same bytes at any time and in any folder
FOR_WINDOWS = [
    "-D__USE_MINGW_ANSI_STDIO=1",
    "-static",
    "-Wl,--no-insert-timestamp,--disable-auto-image-base",
]
DT_FINI_ARRAY, DT_FINI_ARRAYSZ = 26, 28
SHT_DYNAMIC = 6


def replace_binaries(files: Path) -> None:
    """Put the front in the place of pythonfmu's binary in the FMU's unpacked `files`, and the
    latter beside it.

    Raises SystemExit with the compiler's words where the front cannot be compiled.
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


def put_front(binary: Path, stock: bytes, root: ElementTree.Element) -> None:
    """Put the front in the place of `binary`, and `stock`, pythonfmu's, beside it; `root` is the
    FMU's description.
    """
    beside = binary.with_name(f"pythonfmu-export-{pythonfmu_version}{binary.suffix}")
    beside.write_bytes(stock)
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as folder:
        (Path(folder) / "variables.h").write_text(variables_header(root, beside.name))
        compile_front(binary, Path(folder))


def compile_front(target: Path, include: Path) -> None:
    """Compile the front to the shared library `target`, for Windows if it is a `.dll`; `include`
    holds `variables.h`.
    """
    windows = target.suffix == ".dll"
    compiler = MINGW if windows else os.environ.get("CC", "gcc")
    sources = [
        str(p)
        for p in sorted(FRONT.glob("*.c"))
        if p.name != ("posix.c" if windows else "windows.c")
    ]
    own = FOR_WINDOWS if windows else ["-fPIC", "-ldl"]
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


def variables_header(root: ElementTree.Element, stock: str) -> str:
    """The C header that tells the front what the FMU's description says: variables, log categories,
    GUID.
    """
    lines = [
        "/* Made by fmu_build/binary.py from modelDescription.xml. */",
        "struct variable { char type, causality; const char *name; };",
    ]
    lines.append("static const struct variable VARIABLES[] __attribute__((unused)) = {")
    for i, variable in enumerate(root.findall("ModelVariables/ScalarVariable")):
        if int(variable.attrib["valueReference"]) != i:
            raise SystemExit(
                f"error: value reference of {variable.attrib['name']} is not {i}; the front counts on them being in order"
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
        f"#define STOCK_BINARY {quoted(stock)}",
    ]
    lines.append(f"#define BUILD_PYTHON_MINOR {sys.version_info.minor}")
    return "\n".join(lines) + "\n"


def quoted(text: str) -> str:
    """`text` as a C string."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def libpython() -> str:
    """Path of the shared library of the Python that runs this; empty where it has none."""
    folder, name = sysconfig.get_config_var("LIBDIR"), sysconfig.get_config_var("INSTSONAME")
    path = Path(folder or "", name or "")
    return str(path) if path.is_file() and path.suffix != ".a" else ""


def without_last_finaliser(binary: bytes) -> bytes:
    """pythonfmu's binary (64-bit ELF) with the last entry of its DT_FINI_ARRAY dropped.

    That entry runs when the process ends and resets a static object that `exit` has destroyed
    before: it changes memory that is freed, and hosts written in C may end in a heap corruption.
    The object needs no reset, since our front never lets it finalise Python.
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
                        f"error: pythonfmu's binary has {value // 8} finalisers, 2 are known: look at it before going on"
                    )
                struct.pack_into("<Q", edited, at + 8, value - 8)
                return bytes(edited)
    raise SystemExit("error: pythonfmu's binary has no DT_FINI_ARRAYSZ")
