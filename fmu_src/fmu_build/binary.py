"""Compiles the FMU's front (`fmu_front/`), the binary that hosts load.

For Linux, and for Windows if there is a compiler for it. pythonfmu's own binaries are left out.
"""

from __future__ import annotations

import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy

from .arrays import variables
from .compilers import Compiler, environment, for_linux, for_windows

FRONT = Path(__file__).parent.parent / "fmu_front"
HEADERS = Path(fmpy.__file__).parent / "c-code"
CAUSALITIES = {"parameter": "p", "input": "i", "output": "o"}
# the folder of a platform's binary in FMI 3.0, by that in FMI 2.0
FOLDERS_OF_FMI3 = {"linux64": f"{platform.machine()}-linux", "win64": "x86_64-windows"}
FLAGS = ["-std=c11", "-O2", "-fvisibility=hidden", "-Wall", "-Wextra", "-g0", "-s", "-shared"]


def compilers() -> dict[str, Compiler]:
    """The compiler for each of FMI's platforms that there is one for."""
    windows = for_windows()
    return {"linux64": for_linux(), **({"win64": windows} if windows else {})}


def front_sources() -> list[Path]:
    """All files that the front is made of."""
    return sorted(p for p in FRONT.iterdir() if p.suffix in (".c", ".h", ".py"))


def replace_binaries(
    files: Path, root: ElementTree.Element | None = None, fmi: int = 2
) -> dict[str, str]:
    """Replace pythonfmu's binaries by the front.

    Args:
        files: Folder of the unpacked FMU.
        root: Root of its description in FMI 2.0; by default that of its modelDescription.xml.
        fmi: The FMU's version of FMI, 2 or 3. The front has the functions of both.

    Returns:
        The compiler for each platform.

    Raises:
        SystemExit: The front does not compile; the message has the compiler's output.
    """
    if root is None:
        root = ElementTree.parse(files / "modelDescription.xml").getroot()
    simulation = root.find("CoSimulation")
    assert simulation is not None
    module = (files / "resources" / "slavemodule.txt").read_text().strip()
    shutil.rmtree(files / "binaries")
    used = {}
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        (folder / "variables.h").write_text(variables_header(root, module))
        for system, compiler in compilers().items():
            place = files / "binaries" / (FOLDERS_OF_FMI3[system] if fmi == 3 else system)
            place.mkdir(parents=True)
            suffix = ".dll" if system == "win64" else ".so"
            library = simulation.attrib["modelIdentifier"] + suffix
            compile_front(folder / library, folder, compiler)
            shutil.copy(folder / library, place)
            used[place.name] = compiler.name
    return used


def compile_front(target: Path, include: Path, compiler: Compiler) -> None:
    """Compile the front to a shared library.

    Args:
        target: The library, for Windows if it is a `.dll`.
        include: Folder that holds `variables.h`.
        compiler: A compiler for that system.

    Raises:
        SystemExit: The front does not compile; the message has the compiler's output.
    """
    windows = target.suffix == ".dll"
    other_system = "posix.c" if windows else "windows.c"
    command = [
        *compiler.command,
        *FLAGS,
        *compiler.flags,
        "-I",
        str(include),
        "-isystem",
        str(HEADERS),
        "-o",
        str(target),
        *(str(p) for p in front_sources() if p.suffix == ".c" and p.name != other_system),
        *([] if windows else ["-fPIC", "-ldl"]),
    ]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, check=False, env=environment(), cwd=include
        )
    except FileNotFoundError:
        raise SystemExit(
            f"error: there is no C compiler {compiler.command[0]} for the FMU's front; "
            "pip install ziglang, or name one by CC"
        ) from None
    if done.returncode != 0:
        raise SystemExit(
            f"error: the FMU's front does not compile: {' '.join(command)}\n{done.stderr}"
        )


def variables_header(root: ElementTree.Element, module: str) -> str:
    """C header with what the front knows of its FMU.

    The variables of the slave and of FMI 3.0, log categories and GUID, the slave's script, and the
    Python text that makes the slave.

    Args:
        root: Root of the FMU's description in FMI 2.0.
        module: Name of the slave's script, without `.py`.

    Raises:
        SystemExit: The value references are not 0, 1, 2, ... in order.
    """
    lines = [
        "/* Made by fmu_build/binary.py from the FMU's description. */",
        "/* In FMI 3.0 it is the first of `count` elements of `whole`, `stride` apart. */",
        "struct variable {",
        "    char kind, causality;",
        "    const char *name, *whole;",
        "    unsigned count, stride; /* count 0: no variable of its own */",
        "};",
        "static const struct variable VARIABLES[] __attribute__((unused)) = {",
    ]
    scalars = root.findall("ModelVariables/ScalarVariable")
    first = {v.reference: v for v in variables([s.attrib["name"] for s in scalars])}
    for i, variable in enumerate(scalars):
        if int(variable.attrib["valueReference"]) != i:
            raise SystemExit(
                f"error: value reference of {variable.attrib['name']} is not {i}; "
                "the front needs them in order"
            )
        causality = CAUSALITIES.get(variable.attrib["causality"], "-")
        name = quoted(variable.attrib["name"])
        whole = first.get(i)
        array = (
            f"{quoted(whole.name)}, {len(whole.elements)}, {whole.stride}"
            if whole
            else "NULL, 0, 0"
        )
        lines.append(f"    {{'{variable[0].tag[0]}', '{causality}', {name}, {array}}},")
    lines += ["};", "enum { VARIABLE_COUNT = sizeof VARIABLES / sizeof *VARIABLES };"]
    lines += ["static const char *const CATEGORIES[] __attribute__((unused)) = {"]
    lines += [
        f"    {quoted(category.attrib['name'])},"
        for category in root.findall("LogCategories/Category")
    ]
    text = (FRONT / "create_slave.py").read_text()
    lines += [
        "};",
        f"#define GUID {quoted(root.attrib['guid'])}",
        f"#define SLAVE_MODULE {quoted(module)}",
        f"#define BUILD_PYTHON_MINOR {sys.version_info.minor}",
        "#define CREATE_SLAVE \\",
        *(f"    {quoted(line + chr(10))} \\" for line in text.splitlines()),
        '    ""',
    ]
    return "\n".join(lines) + "\n"


def quoted(text: str) -> str:
    """`text` as a C string."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def record_libpython(files: Path) -> None:
    """Record the running Python's library, if it has one, in `resources/libpython.txt`.

    Args:
        files: Folder of the unpacked FMU.
    """
    library = libpython()
    if library:
        (files / "resources" / "libpython.txt").write_text(library + "\n")


def libpython() -> str:
    """Path of the shared library of the running Python; empty if it has none."""
    folder, name = sysconfig.get_config_var("LIBDIR"), sysconfig.get_config_var("INSTSONAME")
    path = Path(folder or "", name or "")
    return str(path) if path.is_file() and path.suffix != ".a" else ""
