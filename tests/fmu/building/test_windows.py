"""The FMU's Windows library, read by objdump. It is there if all platforms are asked for."""

import re
import subprocess
from pathlib import Path

import pytest

OF_WINDOWS = {"kernel32.dll", "advapi32.dll", "shell32.dll", "msvcrt.dll", "ucrtbase.dll"}


def tables(library: Path) -> tuple[set[str], set[str]]:
    """The names that a DLL exports, and the libraries that it needs."""
    text = subprocess.run(
        ["objdump", "-p", library], capture_output=True, text=True, check=True
    ).stdout
    imports, exports = text.split("[Ordinal/Name Pointer] Table", 1)
    return set(
        re.findall(r"^\s*\[ *\d+\] (?:\+base\[ *\d+\] +[0-9a-f]+ )?(\S+)$", exports, re.M)
    ), {name.lower() for name in re.findall(r"DLL Name: (\S+)", imports)}


def test_without_a_compiler_for_windows_the_fmu_has_no_binary_for_it(
    binary,
    unpacked,
    tmp_path,
    monkeypatch,
):
    """A stock DLL is never in it."""
    for folder in ("resources", "binaries/linux64", "binaries/win64"):
        (tmp_path / folder).mkdir(parents=True)
    for name in ("modelDescription.xml", "resources/slavemodule.txt"):
        (tmp_path / name).write_bytes((unpacked / name).read_bytes())
    (tmp_path / "binaries" / "win64" / "RlvLanding.dll").write_bytes(b"MZ: pythonfmu's")
    monkeypatch.setattr(binary, "for_target", lambda target: None)
    assert set(binary.replace_binaries(tmp_path, platforms="all")) == {"linux64"}
    assert [p.name for p in (tmp_path / "binaries").rglob("*.*")] == ["RlvLanding.so"]


def test_windows_library_compiles_without_a_warning_exports_what_linuxs_does_and_needs_windows_only(
    binary,
    header,
    unpacked,
    monkeypatch,
):
    from fmu_build.targets import TARGETS

    compiler = binary.for_target(TARGETS["x86_64-windows"])
    if compiler is None:
        pytest.skip("neither ziglang nor mingw-w64 is installed")
    monkeypatch.setattr(binary, "FLAGS", [*binary.FLAGS, "-Werror", "-Wpedantic"])
    binary.compile_front(header / "front.dll", header, compiler)
    exports, needs = tables(header / "front.dll")
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", unpacked / "binaries" / "linux64" / "RlvLanding.so"],
        capture_output=True,
        text=True,
        check=True,
    )
    of_linux = {line.split()[-1] for line in listed.stdout.splitlines()}
    assert {"fmi2DoStep", "fmi3DoStep"} < of_linux
    assert exports == of_linux
    assert {name for name in needs if not name.startswith("api-ms-win-crt-")} <= OF_WINDOWS
