"""Makes the declarations that Cython reads for the compiled core from the kernels' annotations.

A record becomes a struct, an annotated function a C function. A method is for C alone where its
name begins with `_`, or where it takes or gives an address or a record; the others can be called
from Python, too.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import cast

# these become C: records, and how arrays and records are accessed
RECORDS = "records"
TRANSLATED = (RECORDS, "access", "memory")
MATH = (
    "from cython cimport final\n"
    "from libc.math cimport INFINITY as inf, acos, asin, atan2, cos, exp, expm1, fabs, floor\n"
    "from libc.math cimport log, pow, sin, sqrt, tanh\n"
    "from libc.string cimport memcpy\n"
)
DATA = """
cdef inline double* data(double[::1] numbers) noexcept nogil:
    return &numbers[0]

cdef inline void copy(double* source, double* target, int count) noexcept nogil:
    memcpy(target, source, count * sizeof(double))
"""
TYPES = {
    "float": "double",
    "int": "int",
    "bool": "bint",
    "None": "void",
    "Doubles": "double*",
    "Buffer": "double[::1]",
}


def declarations(core: Path, sources: list[Path]) -> str:
    """The `.pxd` of the joined kernels `sources` of the `core`."""
    records = _joined(sorted((core / RECORDS).glob("*.py")))
    access = ast.parse((core / "access.py").read_text())
    names = {
        node.name for node in records.body if isinstance(node, ast.ClassDef) and is_record(node)
    }
    modules = [ast.parse(path.read_text()) for path in sources]
    types = Types(names, _accessed(access), _overridden(modules))
    parts = [
        MATH,
        *_records(records, types),
        DATA,
        *_constants(records, access),
        *_access(access, types),
    ]
    for module in modules:
        parts += types.module(module)
    return "".join(parts)


def is_translated(path: Path, core: Path) -> bool:
    """Whether a file of the `core` becomes C, and is no kernel."""
    return Path(path.relative_to(core).parts[0]).stem in TRANSLATED


def is_record(node: ast.stmt) -> bool:
    """Whether `node` is the class of a record."""
    return isinstance(node, ast.ClassDef) and "NamedTuple" in map(ast.unparse, node.bases)


def is_law(node: ast.stmt) -> bool:
    """Whether `node` adds a law to its table: `TABLE["name"] = Law(...)`."""
    return isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript)


def defined_names(tree: ast.Module) -> Iterator[str]:
    """The names that a module defines."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, ast.Assign) and not is_law(node):
            yield from _targets(node)
        elif isinstance(node, ast.AnnAssign):
            yield ast.unparse(node.target)


def _joined(paths: list[Path]) -> ast.Module:
    """The statements of several files, one after the other."""
    return ast.Module([node for path in paths for node in ast.parse(path.read_text()).body], [])


def _accessed(access: ast.Module) -> set[str]:
    """The records that `access.py` reads from arrays."""
    return {
        ast.unparse(node.returns)
        for node in access.body
        if isinstance(node, ast.FunctionDef) and node.returns
    }


def _overridden(modules: list[ast.Module]) -> set[str]:
    """The names of methods that more than one class has."""
    owners = [node for module in modules for node in module.body if isinstance(node, ast.ClassDef)]
    counted = Counter(
        node.name for owner in owners for node in owner.body if isinstance(node, ast.FunctionDef)
    )
    return {name for name, count in counted.items() if count > 1}


class Types:
    """C's names for the kernels' annotations.

    Args:
        records: Names of the records.
        accessed: Names of the records that stand in arrays.
        overridden: Names of the methods that a subclass may replace.
    """

    def __init__(self, records: set[str], accessed: set[str], overridden: set[str]) -> None:
        self.records = records
        self.accessed = accessed
        self.overridden = overridden

    def name(self, annotation: ast.expr | None) -> str:
        """C's name of the type that `annotation` means.

        Raises ValueError where there is no annotation.
        """
        if annotation is None:
            raise ValueError("a kernel's parameter or result has no annotation; give it one")
        text = ast.unparse(annotation)
        if isinstance(annotation, ast.Subscript):
            if text.startswith("Records["):
                return TYPES["Buffer"]
            elements = (
                annotation.slice.elts
                if isinstance(annotation.slice, ast.Tuple)
                else [annotation.slice]
            )
            return f"({', '.join(map(self.name, elements))})"
        return TYPES.get(text, text)

    def parameter(self, annotation: ast.expr | None) -> str:
        """C's name of a parameter's type: as `name`, or the address of a record in an array."""
        found = self.name(annotation)
        return f"{found}*" if found in self.accessed & self.records else found

    def signature(self, function: ast.FunctionDef) -> str:
        """C's result, name and parameters of a function or method."""
        parameters = [
            a.arg if a.arg == "self" else f"{self.parameter(a.annotation)} {a.arg}"
            for a in function.args.args
        ]
        return f"{self.name(function.returns)} {function.name}({', '.join(parameters)})"

    def is_for_c(self, method: ast.FunctionDef) -> bool:
        """Whether a method cannot be called from Python."""
        hints = [method.returns, *(a.annotation for a in method.args.args)]
        names = {ast.unparse(hint) for hint in hints if hint is not None}
        return method.name.startswith("_") or bool(names & {"Doubles", *self.records})

    def module(self, tree: ast.Module) -> Iterator[str]:
        """The declarations of one kernel file's constants, functions and classes."""
        for node in tree.body:
            if isinstance(node, ast.Assign) and not is_law(node):
                yield f"cdef {_kind(node.value)} {', '.join(_targets(node))}\n"
            elif isinstance(node, ast.FunctionDef):
                yield f"cdef {self.signature(node)} noexcept nogil\n"
            elif isinstance(node, ast.ClassDef) and not is_record(node):
                yield from self.declared_class(node)

    def declared_class(self, owner: ast.ClassDef) -> Iterator[str]:
        """The declarations of a class, its attributes and its methods but the constructor."""
        bases = f"({', '.join(map(ast.unparse, owner.bases))})" if owner.bases else ""
        yield f"cdef class {owner.name}{bases}:\n"
        for node in owner.body:
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                public = "" if node.target.id.startswith("_") else "public "
                yield f"    cdef {public}{self.name(node.annotation)} {node.target.id}\n"
            elif isinstance(node, ast.FunctionDef) and node.name != "__init__":
                how = ("cdef", "noexcept nogil") if self.is_for_c(node) else ("cpdef", "noexcept")
                if how[0] == "cdef" and node.name not in self.overridden:
                    yield "    @final\n"
                yield f"    {how[0]} {self.signature(node)} {how[1]}\n"


def _targets(node: ast.Assign) -> list[str]:
    return [
        name.id
        for target in node.targets
        for name in ast.walk(target)
        if isinstance(name, ast.Name)
    ]


def _kind(value: ast.expr) -> str:
    """The C type of a constant, or of each of several."""
    first = value.elts[0] if isinstance(value, ast.Tuple) else value
    return "int" if isinstance(first, ast.Constant) and isinstance(first.value, int) else "double"


def _fields(owner: ast.ClassDef) -> list[tuple[str, ast.expr]]:
    return [
        (n.target.id, n.annotation)
        for n in owner.body
        if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)
    ]


def _records(tree: ast.Module, types: Types) -> Iterator[str]:
    """An enum or a struct for each class."""
    for owner in tree.body:
        if isinstance(owner, ast.ClassDef) and owner.name in types.records:
            yield f"cdef struct {owner.name}:\n" + "".join(
                f"    {types.name(hint)} {name}\n" for name, hint in _fields(owner)
            )
        elif isinstance(owner, ast.ClassDef):
            yield f"cdef enum {owner.name}:\n"
            yield "".join(
                f"    {ast.unparse(node)}\n" for node in owner.body if isinstance(node, ast.Assign)
            )


def _constants(records: ast.Module, access: ast.Module) -> Iterator[str]:
    """An enum of the numbers that `access.py` works out from the records' fields."""
    fields = {
        n.name: [name for name, _ in _fields(n)]
        for n in records.body
        if isinstance(n, ast.ClassDef)
    }
    yield "cdef enum:\n"
    for node in access.body:
        if isinstance(node, ast.Assign):
            text = ast.unparse(node.value)
            owner = text.removeprefix("len(").split(".")[0]
            value = (
                len(fields[owner])
                if text.startswith("len(")
                else fields[owner].index(ast.literal_eval(cast(ast.Call, node.value).args[0]))
            )
            yield f"    {_targets(node)[0]} = {value}\n"


def _access(tree: ast.Module, types: Types) -> Iterator[str]:
    """The functions of `access.py`: for records at `y[at:]`, and for the i-th of kept records."""
    written = ", ".join
    yield "ctypedef fused AnyRecord:\n" + "".join(
        f"    {name}\n" for name in sorted(_used(tree, types.records))
    )
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef):
            continue
        record = ast.unparse(node.returns) if node.returns else ""
        first, *_, last = (a.arg for a in node.args.args)
        kept = any(
            a.annotation and ast.unparse(a.annotation).startswith("Records") for a in node.args.args
        )
        array = next(
            a.arg
            for a in node.args.args
            if a.annotation and ast.unparse(a.annotation).startswith(("Records", "Doubles"))
        )
        kind = "AnyRecord" if record == "None" else record
        place = f"(<{kind}*>&{array}[0]) + {last}" if kept else f"<{kind}*>({array} + {last})"
        buffer = "double[::1]" if kept else "double*"
        if record == "None":
            parameters = written((f"AnyRecord {first}", f"{buffer} {array}", f"int {last}"))
            yield f"cdef inline void {node.name}({parameters}) noexcept nogil:\n"
            yield f"    ({place})[0] = {first}\n"
        else:
            result, parameters = types.parameter(node.returns), f"{buffer} {array}, int {last}"
            yield f"cdef inline {result} {node.name}({parameters}) noexcept nogil:\n"
            yield f"    return {place}\n"


def _used(tree: ast.Module, records: set[str]) -> set[str]:
    """The records that `access.py` names."""
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)} & records
