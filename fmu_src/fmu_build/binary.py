"""Compiles the FMU's front (`fmu_front/`), the binary that hosts load.

For Linux, and for Windows if there is a compiler for it. pythonfmu's own binaries are left out.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy

from .compilers import Compiler, environment, for_linux, for_windows

FRONT = Path(__file__).parent.parent / "fmu_front"
HEADERS = Path(fmpy.__file__).parent / "c-code"
CAUSALITIES = {"parameter": "p", "input": "i", "output": "o"}
FLAGS = ["-std=c11", "-O2", "-fvisibility=hidden", "-Wall", "-Wextra", "-g0", "-s", "-shared"]


def compilers() -> dict[str, Compiler]:
    """The compiler for each of FMI's platforms that there is one for."""
    windows = for_windows()
    return {"linux64": for_linux(), **({"win64": windows} if windows else {})}


def front_sources() -> list[Path]:
    """All files that the front is made of."""
    return sorted(p for p in FRONT.iterdir() if p.suffix in (".c", ".h", ".py"))


def replace_binaries(files: Path) -> dict[str, str]:
    """Replace pythonfmu's binaries by the front.

    Args:
        files: Folder of the unpacked FMU.

    Returns:
        The compiler for each platform.

    Raises:
        SystemExit: The front does not compile; the message has the compiler's output.
    """
    root = ElementTree.parse(files / "modelDescription.xml").getroot()
    simulation = root.find("CoSimulation")
    assert simulation is not None
    module = (files / "resources" / "slavemodule.txt").read_text().strip()
    shutil.rmtree(files / "binaries")
    used = {}
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        (folder / "variables.h").write_text(variables_header(root, module))
        for platform, compiler in compilers().items():
            suffix = ".dll" if platform == "win64" else ".so"
            target = (
                files / "binaries" / platform / f"{simulation.attrib['modelIdentifier']}{suffix}"
            )
            target.parent.mkdir(parents=True)
            compile_front(folder / target.name, folder, compiler)
            shutil.copy(folder / target.name, target)
            used[platform] = compiler.name
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

    The description's variables, log categories and GUID, the slave's script, and the Python text
    that makes the slave.

    Args:
        root: Root of the FMU's modelDescription.xml.
        module: Name of the slave's script, without `.py`.

    Raises:
        SystemExit: The value references are not 0, 1, 2, ... in order.
    """
    lines = [
        "/* Made by fmu_build/binary.py from modelDescription.xml. */",
        "struct variable { char kind, causality; const char *name; };",
        "static const struct variable VARIABLES[] __attribute__((unused)) = {",
    ]
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
