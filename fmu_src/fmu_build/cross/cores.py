"""Compiles the core for other platforms by Zig's compiler, from the same C as for this one.

Such a core serves Python 3.11 and later of its platform (limited API).
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path
from subprocess import CompletedProcess

from ..compilers import for_target, run
from ..core_source import COMPILE_ARGS, DIRECTIVES, LIMITED_API, MODULE, ZIG_ARGS, write_source
from ..targets import Target
from .import_library import of_python, undefined, write_import_library
from .python_headers import write_python_headers

# how the libraries leave Python's symbols to the process that loads them
LINK_ARGS = {"linux": (), "darwin": ("-undefined", "dynamic_lookup"), "windows": ()}


def compile_cores(targets: Sequence[Target], folder: Path) -> list[Path]:
    """Compile the core for each target.

    Args:
        targets: The targets.
        folder: A folder is made in it for each target, by its name.

    Returns:
        The libraries.

    Raises:
        SystemExit: This Python's headers have no limited API with buffers, Cython or Zig is not
            installed, or the core does not compile.
    """
    if not targets:
        return []
    _check_tools(targets)
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        source = _translated(Path(name))
        # each compiles alone, so as many at a time as there are processors
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            jobs = [pool.submit(_compile, source, target, Path(name)) for target in targets]
            made = [job.result() for job in jobs]
        libraries = []
        for target, content in zip(targets, made):
            library = folder / target.name / target.core
            library.parent.mkdir(parents=True)
            library.write_bytes(content)
            libraries.append(library)
    return libraries


def _check_tools(targets: Sequence[Target]) -> None:
    """Check that Python's headers, Cython and Zig's compiler are there."""
    if sys.version_info < (3, 11):
        raise SystemExit(
            "error: cores for other platforms need the headers of Python 3.11 or newer; "
            "run the build by one"
        )
    missing = [] if find_spec("Cython") else ["Cython"]
    if not all((c := for_target(t)) is not None and c.is_zig for t in targets):
        missing.append("Zig's compiler")
    if missing:
        raise SystemExit(
            f"error: cores for other platforms need {' and '.join(missing)}; "
            'install what is missing with pip install "rlv-landing[build]"'
        )


def _translated(folder: Path) -> Path:
    """The core in C, below `folder`; its texts name no path of this machine."""
    python = write_source(folder / "core")
    directives = [text for name, value in DIRECTIVES.items() for text in ("-X", f"{name}={value}")]
    done = run(
        [sys.executable, "-m", "cython", *directives, f"{python.parent.name}/{python.name}"],
        folder / "core",
    )
    if done.returncode != 0:
        raise SystemExit(f"error: Cython does not translate the core:\n{done.stderr}")
    return python.with_suffix(".c")


def _compile(source: Path, target: Target, work: Path) -> bytes:
    """The core's library for a target."""
    compiler = for_target(target)
    assert compiler is not None
    headers, made = work / f"{target.name}.headers", work / target.name
    made.mkdir()
    write_python_headers(headers, target)
    command = [*compiler.command, *compiler.flags, *COMPILE_ARGS]
    options = [*ZIG_ARGS, f"-DPy_LIMITED_API={LIMITED_API}", "-fvisibility=hidden", "-Werror"]
    text, thing = str(source.relative_to(work / "core")), str(made / f"{MODULE}.o")
    _check_compiled(
        run([*command, *options, "-I", str(headers), "-c", text, "-o", thing], work / "core"),
        target,
    )
    libraries = []
    if target.system == "windows":
        libraries = [str(made / "python3.lib")]
        write_import_library(Path(libraries[0]), of_python(undefined(Path(thing).read_bytes())))
    link = [*command, "-shared", "-s", *LINK_ARGS[target.system], thing, *libraries]
    _check_compiled(run([*link, "-o", target.core], made), target)
    return (made / target.core).read_bytes()


def _check_compiled(done: CompletedProcess[str], target: Target) -> None:
    """Check that a compiler has done its work."""
    if done.returncode != 0:
        raise SystemExit(f"error: the core does not compile for {target.name}:\n{done.stderr}")
