"""Fronts and Python's headers for other platforms, read by lief; they are not run here."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from itertools import chain
from pathlib import Path

import lief
import pytest
from binaries import OF_MACOS_LINKER, front_library, needs_only_its_system, old_enough


@pytest.fixture(scope="module")
def zig():
    from fmu_build import compilers

    if not compilers.has_zig():
        pytest.skip("ziglang is not installed")
    return compilers


def test_each_version_of_fmi_has_the_same_targets_by_its_own_names(zig, binary):
    from fmu_build.targets import FMI2, TARGETS, of_platform

    two, three = (binary.compilers("all", fmi) for fmi in ("2", "3"))
    assert set(two) == {"linux64", "win64", "darwin64", "aarch64-linux"} == set(FMI2)
    assert set(three) == set(TARGETS)
    assert {t.name for folder in FMI2 for t in of_platform(folder)} == set(TARGETS)
    assert set(chain(*two.values())) == set(chain(*three.values()))


@pytest.mark.parametrize(("missing", "tool"), [("Cython", "Cython"), ("ziglang", "Zig's compiler")])
def test_a_tool_that_cores_for_other_platforms_lack_is_named_with_its_remedy(
    missing, tool, zig, monkeypatch, tmp_path
):
    from fmu_build.cross.cores import compile_cores
    from fmu_build.targets import TARGETS

    monkeypatch.delenv("CC", raising=False)
    # as where it is not installed: find_spec says None
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(SystemExit) as refused:
        compile_cores([TARGETS["aarch64-linux"]], tmp_path)
    text = str(refused.value)
    assert tool in text
    assert text.endswith('pip install "rlv-landing[build]"')
    assert "\n" not in text
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["aarch64-linux", "x86_64-windows", "x86_64-darwin"])
def test_the_front_compiles_without_a_warning_for_each_system_and_exports_what_linuxs_does(
    name, zig, binary, header, unpacked, monkeypatch
):
    from fmu_build.targets import TARGETS

    monkeypatch.setattr(binary, "FLAGS", [*binary.FLAGS, "-Werror", "-Wpedantic"])
    target = TARGETS[name]
    made = header / f"front{target.library}"
    binary.compile_front(made, header, zig.for_target(target))
    of_linux = front_library(unpacked / "binaries" / "linux64" / "RlvLanding.so")
    found = front_library(made)
    assert found.functions == of_linux.functions
    assert len(found.functions) > 40
    assert found.machine == name.split("-")[0]
    assert needs_only_its_system(made)
    assert old_enough(made)


def test_a_library_for_two_architectures_has_both(zig, binary, header):
    from fmu_build.cross.universal import PAGE_EXPONENT, joined
    from fmu_build.targets import of_platform

    slices = []
    for target in of_platform("darwin64"):
        text = header / "one.c"
        text.write_text("int one(void) { return 1; }\n")
        made = header / "one.dylib"
        compiler = zig.for_target(target)
        command = [*compiler.command, *compiler.flags, "-shared", "-install_name", "one"]
        subprocess.run([*command, "-o", made, text], check=True)
        slices.append(made.read_bytes())
    whole = joined(slices)
    parsed = lief.MachO.parse(list(whole))
    assert [b.header.cpu_type.name for b in parsed] == ["X86_64", "ARM64"]
    for one, content in zip(parsed, slices):
        assert one.fat_offset % (1 << PAGE_EXPONENT) == 0
        assert whole[one.fat_offset : one.fat_offset + len(content)] == content
        assert {s.name for s in one.exported_symbols} - OF_MACOS_LINKER == {"_one"}
    with pytest.raises(ValueError, match="begins with 0x464c457f"):
        joined([Path("/bin/true").read_bytes()])


USES_PYTHON = """
#include <Python.h>
PyObject *raised(void) { return PyErr_SetString(PyExc_ValueError, "no"), PyLong_FromLong(1); }
"""


@pytest.mark.parametrize("wrong", [{}, {"long_size": 16}, {"wchar_size": 1}])
@pytest.mark.parametrize("name", ["x86_64-windows", "aarch64-darwin", "aarch64-linux"])
def test_a_size_that_is_not_the_targets_does_not_compile(name, wrong, zig, tmp_path):
    """And where all are right, the symbols that a module for Windows needs are read from it."""
    from fmu_build.cross.import_library import of_python, undefined
    from fmu_build.cross.python_headers import write_python_headers
    from fmu_build.targets import TARGETS

    target = TARGETS[name]
    write_python_headers(tmp_path / "headers", replace(target, **wrong))
    (tmp_path / "uses.c").write_text(USES_PYTHON)
    command = [*zig.for_target(target).command, "-DPy_LIMITED_API=0x030B0000", "-Iheaders"]
    done = subprocess.run(
        [*command, "-c", "uses.c", "-o", "uses.o"], cwd=tmp_path, capture_output=True, text=True
    )
    if wrong:
        assert done.returncode != 0
        assert "static assertion failed" in done.stderr
        return
    assert done.returncode == 0, done.stderr
    if target.system == "windows":
        needed = undefined((tmp_path / "uses.o").read_bytes())
        ours = ["PyErr_SetString", "PyExc_ValueError", "PyLong_FromLong"]
        assert of_python(needed) == ours
        coff = lief.COFF.parse(str(tmp_path / "uses.o"))
        assert needed == {
            s.name for s in coff.symbols if s.is_undefined and s.storage_class.name == "EXTERNAL"
        }


def test_the_sizes_of_this_machine_are_those_of_its_own_headers():
    import sysconfig

    from fmu_build.cross.python_headers import NAMES, SIZES
    from fmu_build.targets import TARGETS, own_machine

    if own_machine() not in TARGETS:
        pytest.skip("this machine is no target")
    target = TARGETS[own_machine()]
    for kind, size in {**SIZES, "long": target.long_size, "wchar_t": target.wchar_size}.items():
        name = f"SIZEOF_{NAMES.get(kind, kind.upper())}"
        assert sysconfig.get_config_var(name) in (size, None), name
