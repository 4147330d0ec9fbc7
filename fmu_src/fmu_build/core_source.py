"""Joins the kernels of `rlv_landing/core` to one Cython module, the source of the compiled core.

The kernels are plain Python and import each other and `math`. Compiled, they call each other and
libm directly. So this removes their imports and puts the files in the order of their imports. The
names of `layout.py` become C constants, and an array that one kernel passes to another becomes its
address. Nothing else of the text changes: compiled and pure core compute the same digits.
"""

from __future__ import annotations

import ast
import hashlib
from graphlib import TopologicalSorter
from pathlib import Path

CORE = Path(__file__).parent.parent / "rlv_landing" / "core"
MODULE = "compiled"
DIRECTIVES = {
    "language_level": 3,
    "cdivision": True,
    "boundscheck": False,
    "wraparound": False,
    "initializedcheck": False,
    "infer_types": True,
    "embedsignature": False,
}
# modules that become C: constants, and the address of an array
TRANSLATED = ("layout", "pointer")
POINTER = """cdef inline double* data(double[::1] numbers) noexcept nogil:
    return &numbers[0]
"""
# the first version whose limited API has buffers
LIMITED_API = "0x030B0000"
COMPILE_ARGS = ["-O3", "-ffp-contract=off", "-fno-math-errno", "-g0"]


def kernels(core: Path = CORE) -> list[Path]:
    """The kernel files, each after those that it imports."""
    imports: dict[str, list[str]] = {}
    for path in sorted(core.glob("*.py")):
        if path.stem in ("__init__", *TRANSLATED):
            continue
        nodes = [
            n
            for n in ast.parse(path.read_text()).body
            if isinstance(n, ast.ImportFrom) and n.level == 1
        ]
        imports[path.stem] = [n.module for n in nodes if n.module and n.module not in TRANSLATED]
    return [core / f"{name}.py" for name in TopologicalSorter(imports).static_order()]


def without_imports(text: str) -> str:
    """`text` with its top-level imports of siblings and of `math` blanked, line numbers kept."""
    lines = text.splitlines()
    for node in ast.parse(text).body:
        if isinstance(node, ast.ImportFrom) and (node.level == 1 or node.module == "math"):
            assert node.end_lineno is not None
            lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
    return "\n".join(lines) + "\n"


def layout_constants(core: Path = CORE) -> dict[str, int]:
    """The names of `layout.py` and their values."""
    names: dict[str, object] = {}
    exec(compile((core / "layout.py").read_text(), "layout.py", "exec"), {}, names)
    return {name: value for name, value in names.items() if isinstance(value, int)}


def digest(core: Path = CORE) -> str:
    """SHA-256 of the kernels' texts; the compiled core carries that of its own sources."""
    texts = [
        p.read_bytes()
        for p in sorted([*core.glob("*.py"), *core.glob("*.pxd")])
        if p.stem != "__init__"
    ]
    return hashlib.sha256(b"".join(texts)).hexdigest()


def package_name(core: Path = CORE) -> str:
    """The name of the package that the core is compiled in; the binary carries it."""
    return f"rlv_landing_core_{digest(core)[:12]}"


def write_source(folder: Path, core: Path = CORE) -> Path:
    """Write `compiled.py` and `compiled.pxd` below `folder` if they change.

    Their package is named after their digest. A compiled module enters itself in `sys.modules`
    under the name it was compiled with. Another version of the package in the same process must
    not find an FMU's core there.

    Returns:
        Path of `compiled.py`.
    """
    sources = kernels(core)
    enum = "".join(f"    {name} = {value}\n" for name, value in layout_constants(core).items())
    pxd = (
        "from libc.math cimport cos, exp, expm1, fabs, log, pow, sin, sqrt, tanh\n\ncdef enum:\n"
        + enum
    )
    pxd += POINTER + "".join(
        p.with_suffix(".pxd").read_text() for p in sources if p.with_suffix(".pxd").exists()
    )
    texts = "".join(f"# {p.name}\n{without_imports(p.read_text())}" for p in sources)
    python = f'from cython import nogil\n\n{texts}SOURCE_DIGEST = "{digest(core)}"\n'
    package = folder / package_name(core)
    package.mkdir(parents=True, exist_ok=True)
    (package / "__init__.py").touch()
    for name, text in ((f"{MODULE}.pxd", pxd), (f"{MODULE}.py", python)):
        target = package / name
        if not target.exists() or target.read_text() != text:
            target.write_text(text)
    return package / f"{MODULE}.py"
