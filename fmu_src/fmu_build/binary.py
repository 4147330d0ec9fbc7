"""Puts the front (`fmu_front/`), the binary that hosts load, into the FMU.

For Linux, and for Windows if there is a compiler for it: compiled, or one that the installed
package has. pythonfmu's own binaries are left out.
"""

from __future__ import annotations

import hashlib
import platform
import shlex
import shutil
import sysconfig
import tempfile
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

from .compilers import Compiler, for_linux, for_windows, run
from .fronts import prebuilt
from .fronts.header import FRONT, front_identity, neutral_header, variables_header

# FMI's C headers, which FMPy has; it takes long to import
_FMPY = find_spec("fmpy")
HEADERS = Path((_FMPY.origin if _FMPY else None) or "fmpy").parent / "c-code"
# the folder of a platform's binary in FMI 3.0, by that in FMI 2.0
FOLDERS_OF_FMI3 = {"linux64": f"{platform.machine()}-linux", "win64": "x86_64-windows"}
FLAGS = ["-std=c11", "-O2", "-fvisibility=hidden", "-Wall", "-Wextra", "-g0", "-s", "-shared"]


def compilers() -> dict[str, Compiler]:
    """The compiler for each of FMI's platforms that there is one for."""
    windows = for_windows()
    return {"linux64": for_linux(), **({"win64": windows} if windows else {})}


def makers(root: ElementTree.Element) -> dict[str, str]:
    """What makes the front for each platform: the compiler with its options, or what it made.

    Args:
        root: Root of the FMU's modelDescription.xml.
    """
    ready = prebuilt.fronts(made_of(root))
    if ready:
        return {f.platform: hashlib.sha256(f.content).hexdigest() for f in ready}
    return {system: repr((c.name, c.flags, FLAGS)) for system, c in compilers().items()}


def front_sources() -> list[Path]:
    """All files that the front is made of."""
    return sorted(p for p in FRONT.iterdir() if p.suffix in (".c", ".h", ".py"))


def replace_binaries(
    files: Path, root: ElementTree.Element | None = None, fmi: str = "2"
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
    name = simulation.attrib["modelIdentifier"]
    module = (files / "resources" / "slavemodule.txt").read_text().strip()
    shutil.rmtree(files / "binaries")

    def place(system: str) -> Path:
        folder = files / "binaries" / (FOLDERS_OF_FMI3[system] if fmi == "3" else system)
        folder.mkdir(parents=True)
        return folder / f"{name}{suffix(system)}"

    ready = prebuilt.fronts(made_of(root))
    if not ready:
        return compile_fronts(variables_header(root, module), place)
    identity = front_identity(root, module)
    for front in ready:
        place(front.platform).write_bytes(prebuilt.identified(front.content, identity))
    return {front.platform: front.compiler for front in ready}


def suffix(system: str) -> str:
    """The ending of a shared library of one of FMI's platforms."""
    return ".dll" if system.startswith("win") else ".so"


def made_of(root: ElementTree.Element) -> bytes:
    """What a front without an identity is made of: all that must be equal for it to fit.

    Args:
        root: Root of the FMU's modelDescription.xml.
    """
    texts = {p.name: p.read_bytes() for p in front_sources()}
    texts["variables.h"] = neutral_header(root).encode()
    return b"".join(
        f"{name}\0{len(texts[name])}\0".encode() + texts[name] for name in sorted(texts)
    )


def compile_fronts(header: str, place: Callable[[str], Path]) -> dict[str, str]:
    """Compile the front for each platform that there is a compiler for.

    Args:
        header: Text of `variables.h`.
        place: The library's file for a platform.

    Returns:
        The compiler for each platform.

    Raises:
        SystemExit: The front does not compile.
    """
    used = {}
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        (folder / "variables.h").write_text(header)
        for system, compiler in compilers().items():
            made = folder / f"front{suffix(system)}"
            compile_front(made, folder, compiler)
            shutil.copy(made, place(system))
            used[system] = compiler.name
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
    if not (HEADERS / "fmi2Functions.h").is_file():
        raise SystemExit(
            "error: FMI's C headers are missing, which FMPy brings; "
            'install it with pip install "rlv-landing[fmu]"'
        )
    done = run(command, include)
    if done.returncode == 0 and target.is_file():
        return
    reason = f"exit code {done.returncode}" if done.returncode else "it has made no library"
    raise SystemExit(
        f"error: {shlex.join(compiler.command)} does not compile the FMU's front ({reason}); "
        f"install ziglang or gcc, or name another compiler by CC\n{done.stderr}".strip()
    )


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
