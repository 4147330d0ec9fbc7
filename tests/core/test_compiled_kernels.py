"""No code inside a step calls Python.

Every kernel is declared for C, and Cython's annotation finds no Python in it.
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "benchmarks"))
from annotate import ROOT, annotate, lines

sys.path.insert(0, str(ROOT / "fmu_src"))
from fmu_build.core_declarations import declarations
from fmu_build.core_source import CORE, kernels

# called from Python once a step of the caller's, or once at all; what they call is compiled
ENTRIES = {
    "inputs_at",
    "derivatives",
    "start",
    "cut",
    "restart",
    "extremes",
    "open_span",
    "extremes_of_span",
    "close_span",
    "recompute_derived",
    "advance",
    "advance_some",
    "interpolate",
    "outputs_at",
    "record",
    "record_some",
    "places",
}
SETTING_UP = {"__init__"}
KERNELS = kernels()


def functions(text: str) -> Iterator[ast.FunctionDef]:
    return (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef))


@pytest.mark.parametrize("path", KERNELS, ids=lambda path: path.relative_to(CORE).as_posix())
def test_every_kernel_is_declared_to_need_no_python(path):
    declared = declarations(CORE, KERNELS)
    for function in functions(path.read_text()):
        if function.name in SETTING_UP:
            continue
        wanted = r"cpdef .*noexcept$" if function.name in ENTRIES else r"cdef .*noexcept nogil$"
        found = re.findall(rf"^ *(.* {function.name}\(.*)$", declared, re.MULTILINE)
        assert found, f"{function.name} of {path.stem}.py is not declared"
        assert all(re.match(wanted, line) for line in found), found


def test_no_line_of_a_kernel_calls_python(tmp_path):
    html = annotate(tmp_path)
    where = {}
    for function in functions(html.with_suffix(".py").read_text()):
        for number in range(function.lineno, function.end_lineno + 1):
            where[number] = (function.name, number == function.lineno)
    ours = SETTING_UP | {"stored", "room"}
    inside = [
        line for line in lines(html) if line.number in where and where[line.number][0] not in ours
    ]
    # once a call: one lets other threads run
    allowed = {"record": 14, "record_some": 14}
    assert len(inside) > 400
    for line in inside:
        name, is_head = where[line.number]
        if not (is_head and name in ENTRIES):
            assert line.score <= allowed.get(name, 0), line
