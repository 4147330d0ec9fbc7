"""Puts the front (`fmu_front/`), the binary that hosts load, into the FMU.

For this machine's platform, or for all that there is a compiler for: compiled, or one that the
installed package has. pythonfmu's own binaries are left out.
"""

from __future__ import annotations

import hashlib
import shlex
import shutil
import sysconfig
import tempfile
from collections.abc import Callable, Iterable
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

from .compilers import Compiler, for_linux, for_target, run
from .cross import universal
from .fronts import prebuilt
from .fronts.header import FRONT, front_identity, neutral_header, variables_header
from .targets import ALL, FMI2, OWN, TARGETS, of_platform, own_machine, own_platform

# FMI's C headers, which FMPy has; it takes long to import
_FMPY = find_spec("fmpy")
HEADERS = Path((_FMPY.origin if _FMPY else None) or "fmpy").parent / "c-code"
FLAGS = ["-std=c11", "-O2", "-fvisibility=hidden", "-Wall", "-Wextra", "-g0", "-s", "-shared"]
# of the sources, those that are for one system or two
SYSTEMS = {
    "posix.c": ("linux", "darwin"),
    "linux.c": ("linux",),
    "macos.c": ("darwin",),
    "windows.c": ("windows",),
}
SYSTEM_ARGS = {
    "linux": ["-fPIC", "-ldl", "-lm"],
    "darwin": ["-fPIC", "-install_name", "@rpath/front.dylib"],
    "windows": [],
}
SYSTEM_OF_SUFFIX = {".so": "linux", ".dylib": "darwin", ".dll": "windows"}


def compilers(platforms: str = OWN, fmi: str = "2") -> dict[str, list[Compiler]]:
    """The compilers for each of FMI's platforms that there are all for, one for each architecture.

    Args:
        platforms: This machine's or all.
        fmi: The version of FMI, whose names the platforms have.
    """
    found = {own_platform(fmi): [for_linux()]}
    names: Iterable[str] = FMI2 if fmi == "2" else TARGETS
    for platform in names if platforms == ALL else ():
        targets = of_platform(platform)
        chosen = [c for c in map(for_target, targets) if c]
        if len(chosen) == len(targets) and own_machine() not in {t.name for t in targets}:
            found.setdefault(platform, chosen)
    return found


def makers(root: ElementTree.Element, platforms: str = OWN) -> dict[str, str]:
    """What makes the front for each platform: the compiler with its options, or what it made.

    Args:
        root: Root of the FMU's modelDescription.xml.
        platforms: This machine's or all.
    """
    ready = prebuilt.fronts(made_of(root)) if platforms == OWN else []
    if ready:
        return {f.platform: hashlib.sha256(f.content).hexdigest() for f in ready}
    return {
        platform: repr([(c.name, c.command[1:], c.flags, FLAGS) for c in chosen])
        for platform, chosen in compilers(platforms).items()
    }


def front_sources() -> list[Path]:
    """All files that the front is made of."""
    return sorted(p for p in FRONT.iterdir() if p.suffix in (".c", ".h", ".py"))


def replace_binaries(
    files: Path,
    root: ElementTree.Element | None = None,
    platforms: str = OWN,
    fmi: str = "2",
) -> dict[str, str]:
    """Replace pythonfmu's binaries by the front.

    Args:
        files: Folder of the unpacked FMU.
        root: Root of its description in FMI 2.0; by default that of its modelDescription.xml.
        platforms: Which platforms it is for, this machine's or all.
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

    def place(platform: str) -> Path:
        folder = files / "binaries" / platform
        folder.mkdir(parents=True)
        return folder / f"{name}{suffix(platform)}"

    ready = prebuilt.fronts(made_of(root)) if platforms == OWN else []
    if not ready:
        return compile_fronts(variables_header(root, module), place, compilers(platforms, fmi))
    identity = front_identity(root, module)
    found = {own_platform(fmi): front for front in ready if front.platform == own_platform()}
    for platform, front in found.items():
        place(platform).write_bytes(prebuilt.identified(front.content, identity))
    return {platform: front.compiler for platform, front in found.items()}


def suffix(system: str) -> str:
    """The ending of a shared library of one of FMI's platforms."""
    targets = of_platform(system)
    return targets[0].library if targets else ".so"


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


def compile_fronts(
    header: str, place: Callable[[str], Path], wanted: dict[str, list[Compiler]]
) -> dict[str, str]:
    """Compile the front for each platform.

    Args:
        header: Text of `variables.h`.
        place: The library's file for a platform.
        wanted: The compilers for each platform, one for each architecture.

    Returns:
        The compiler for each platform.

    Raises:
        SystemExit: The front does not compile.
    """
    used = {}
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        (folder / "variables.h").write_text(header)
        for platform, chosen in wanted.items():
            made = folder / f"front{suffix(platform)}"
            libraries = []
            for compiler in chosen:
                compile_front(made, folder, compiler)
                libraries.append(made.read_bytes())
            one = libraries[0] if len(libraries) == 1 else universal.joined(libraries)
            place(platform).write_bytes(one)
            used[platform] = chosen[0].name
    return used


def compile_front(target: Path, include: Path, compiler: Compiler) -> None:
    """Compile the front to a shared library.

    Args:
        target: The library, for Windows if it is a `.dll`, for macOS if a `.dylib`.
        include: Folder that holds `variables.h`.
        compiler: A compiler for that system.

    Raises:
        SystemExit: The front does not compile; the message has the compiler's output.
    """
    system = SYSTEM_OF_SUFFIX[target.suffix]
    sources = [p for p in front_sources() if p.suffix == ".c"]
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
        *(str(p) for p in sources if system in SYSTEMS.get(p.name, (system,))),
        *SYSTEM_ARGS[system],
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
