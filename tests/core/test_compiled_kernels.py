"""No code inside a step calls Python.

Every kernel is declared for C, and Cython's annotation finds no Python in it.
"""

import ast
import re
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "benchmarks"))
from annotate import ROOT, annotate, lines

CORE = ROOT / "fmu_src" / "rlv_landing" / "core"

# called from Python once a step of the caller's, or once at all; what they call is compiled
ENTRIES = {
    "inputs_at",
    "derivatives",
    "restart",
    "refresh",
    "advance",
    "interpolate",
    "outputs_at",
    "record",
}
SETTING_UP = {"__init__", "state_size", "output_size"}
KERNELS = [
    path for path in sorted(CORE.glob("*.py")) if path.stem not in ("__init__", "layout", "pointer")
]


def functions(path: Path) -> list[ast.FunctionDef]:
    return [
        node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)
    ]


@pytest.mark.parametrize("path", KERNELS, ids=lambda path: path.stem)
def test_every_kernel_is_declared_to_need_no_python(path):
    declared = path.with_suffix(".pxd").read_text()
    base = (CORE / "integrator.pxd").read_text()
    for function in functions(path):
        if function.name in SETTING_UP:
            continue
        wanted = r"cpdef .*noexcept$" if function.name in ENTRIES else r"cdef .*noexcept nogil$"
        found = re.findall(rf"^ *(.* {function.name}\(.*)$", declared + base, re.MULTILINE)
        assert found, f"{function.name} is not declared in {path.stem}.pxd"
        assert all(re.match(wanted, line) for line in found), found


def test_no_line_of_a_kernel_calls_python(tmp_path):
    html = annotate(tmp_path)
    where = {}
    for function in functions(html.with_suffix(".py")):
        for number in range(function.lineno, function.end_lineno + 1):
            where[number] = (function.name, number == function.lineno)
    inside = [
        line
        for line in lines(html)
        if line.number in where and where[line.number][0] not in SETTING_UP
    ]
    # once a call: one holds the model while it hands it on, one lets other threads run
    allowed = {"outputs_at": 2, "record": 14}
    assert len(inside) > 400
    for line in inside:
        name, is_head = where[line.number]
        if not (is_head and name in ENTRIES):
            assert line.score <= allowed.get(name, 0), line
