"""Joins the kernels of `rlv_landing/core` to one Cython module, the source of the compiled core.

The kernels are plain Python and import each other and `math`. Compiled, they call each other and
libm directly. So this removes their imports and tables of laws, puts the files in the order of
their imports, and lets a function that chooses a law branch on its number. Nothing else of the text
changes: compiled and pure core compute the same digits. `core_declarations` says what is C in it.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

from .core_declarations import declarations, defined_names, is_law, is_record, is_translated

# for each table of laws, of each law in the order of names: its functions by the member's name
Laws = dict[str, list[dict[str, str]]]

CORE = Path(__file__).parent.parent / "rlv_landing" / "core"
MODULE = "compiled"
# what loads the core, and decides no digit
LOADING = ("__init__.py", "freshness.py")
DIRECTIVES = {
    "language_level": 3,
    "cdivision": True,
    "boundscheck": False,
    "wraparound": False,
    "initializedcheck": False,
    "infer_types": True,
    "embedsignature": False,
    # the declarations say what annotations are in C
    "annotation_typing": False,
}
# what `memory.py` gives to constructors: records in an array of doubles, and room for such
MEMORY = """\
def stored(records):
    return array("d", [float(value) for record in records for value in record])


def room(count, size):
    return array("d", bytes(8 * size * max(count, 1)))
"""
# the first version whose limited API has buffers
LIMITED_API = "0x030B0000"
# nothing reads the processor's flags of floating-point faults, and no index is near the largest
# integer: loops take several numbers at once, with the same digits. Python's own -fwrapv forbids it
COMPILE_ARGS = [
    "-O3",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-fno-wrapv",
    "-Wno-unused-function",
    "-g0",
]
# records go from function to function by value: the compiler puts one function into the other, so
# that no copy is left
GCC_ARGS = ["-finline-limit=1000"]
ZIG_ARGS = ["-mllvm", "-inline-threshold=5000", "-mllvm", "-inlinecold-threshold=5000"]


def files(core: Path = CORE) -> list[Path]:
    """All files of the core that decide its digits, in the order of their names."""
    return sorted(path for path in core.rglob("*.py") if path.name not in LOADING)


def kernels(core: Path = CORE) -> list[Path]:
    """The kernel files, each after those that it imports."""
    own = [path for path in files(core) if not is_translated(path, core)]
    imports = {path: set(_siblings(path, core)) for path in own}
    return list(
        TopologicalSorter({path: sorted(needed) for path, needed in imports.items()}).static_order()
    )


def _siblings(path: Path, core: Path) -> Iterator[Path]:
    """The kernel files of the `core` that `path` imports."""
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = path.parents[node.level - 1]
            modules = [node.module] if node.module else [alias.name for alias in node.names]
            for module in modules:
                found = folder.joinpath(*module.split(".")).with_suffix(".py")
                if not is_translated(found, core):
                    yield found


def translated(text: str, laws: Laws) -> str:
    """`text` without its imports and laws' tables; a choice of a law branches on its number."""
    lines = text.splitlines()
    # from the end, so that line numbers hold
    for node in reversed(ast.parse(text).body):
        if isinstance(node, (ast.ImportFrom, ast.AnnAssign)) or is_record(node) or is_law(node):
            lines[node.lineno - 1 : node.end_lineno] = [""]
        elif isinstance(node, ast.FunctionDef) and (branches := _branches(node, laws)):
            last = node.body[-1]
            lines[last.lineno - 1 : last.end_lineno] = branches
    return "\n".join(lines) + "\n"


def tables(sources: list[Path]) -> Laws:
    """The tables of laws in `sources`, each sorted by the laws' names."""
    nodes = [node for path in sources for node in ast.parse(path.read_text()).body]
    members = {
        node.name: [
            field.target.id
            for field in node.body
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        ]
        for node in nodes
        if isinstance(node, ast.ClassDef)
    }
    found: dict[str, dict[str, dict[str, str]]] = {}
    for node in nodes:
        if (
            isinstance(node, ast.Assign)
            and isinstance(node.targets[0], ast.Subscript)
            and isinstance(node.value, ast.Call)
        ):
            table, name = node.targets[0].value, ast.literal_eval(node.targets[0].slice)
            law = dict(
                zip(members[ast.unparse(node.value.func)], map(ast.unparse, node.value.args))
            )
            found.setdefault(ast.unparse(table), {})[name] = law
    return {table: [laws[name] for name in sorted(laws)] for table, laws in found.items()}


def _branches(function: ast.FunctionDef, laws: Laws) -> list[str]:
    """The lines that replace `return chosen(TABLE, kind).member(arguments)`.

    Returns:
        One branch a law; no lines for a function that chooses no law.
    """
    last = function.body[-1]
    if not (
        isinstance(last, ast.Return)
        and isinstance(last.value, ast.Call)
        and isinstance(last.value.func, ast.Attribute)
    ):
        return []
    choice = last.value.func.value
    if not (isinstance(choice, ast.Call) and ast.unparse(choice.func) == "chosen"):
        return []
    table, kind = map(ast.unparse, choice.args)
    arguments = ", ".join(map(ast.unparse, last.value.args))
    calls = [f"return {law[last.value.func.attr]}({arguments})" for law in laws[table]]
    branched = [
        line
        for i, call in enumerate(calls[:-1])
        for line in (f"    if {kind} == {i}.0:", f"        {call}")
    ]
    return [*branched, f"    {calls[-1]}"]


def check_names(sources: list[Path]) -> None:
    """Check that no two kernel files define the same name: joined, they share one module.

    Raises:
        ValueError: Two files do.
    """
    owners: dict[str, Path] = {}
    for path in sources:
        for name in defined_names(ast.parse(path.read_text())):
            if owners.setdefault(name, path) != path:
                raise ValueError(
                    f"{name} is defined in {owners[name].name} and in {path.name}; "
                    "give one of them another name"
                )


def source_hashes(core: Path = CORE) -> dict[str, str]:
    """The SHA-256 of each kernel's text by its path; the compiled core carries those of its own."""
    return {
        path.relative_to(core).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files(core)
    }


def digest(core: Path = CORE) -> str:
    """The SHA-256 of all kernels: of `source_hashes`."""
    return hashlib.sha256(repr(source_hashes(core)).encode()).hexdigest()


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

    Raises:
        ValueError: Two kernel files use the same name.
    """
    paths = kernels(core)
    check_names(paths)
    laws = tables(paths)
    texts = "".join(
        f"# {p.relative_to(core).as_posix()}\n{translated(p.read_text(), laws)}" for p in paths
    )
    imports = "from array import array\n\nfrom cython import nogil\n\n"
    python = f"{imports}{MEMORY}\n{texts}SOURCES = {source_hashes(core)!r}\n"
    package = folder / package_name(core)
    package.mkdir(parents=True, exist_ok=True)
    (package / "__init__.py").touch()
    for name, text in ((f"{MODULE}.pxd", declarations(core, paths)), (f"{MODULE}.py", python)):
        target = package / name
        if not target.exists() or target.read_text() != text:
            target.write_text(text)
    return package / f"{MODULE}.py"
