"""Front and compiled core by Zig's compiler and by gcc: what they need, and their digits."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rlv_landing import Landing
from rlv_landing.core import compiled
from rlv_landing.quantities import OUTPUT_NAMES

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[3]

LAND = """
from rlv_landing import Landing
from rlv_landing.core import compiled
landing = Landing()
landing.advance_to(0.4)
print(compiled.__file__, *(value.hex() for value in map(float, landing.values())))
"""


@pytest.fixture(params=["zig", "gcc"])
def compiler(request, binary, monkeypatch):
    """A compiler for Linux, as the build chooses it: Zig's unless CC names another."""
    from fmu_build import compilers

    if request.param == "gcc":
        monkeypatch.setenv("CC", "gcc")
    elif not compilers.has_zig():
        pytest.skip("ziglang is not installed")
    else:
        monkeypatch.delenv("CC", raising=False)
    chosen = binary.for_linux()
    assert chosen.is_zig == (request.param == "zig")
    return chosen


def needs(library: Path) -> tuple[set[str], tuple[int, int]]:
    """The libraries that it is linked with, and the newest glibc that it needs."""
    listed = [
        subprocess.run(["objdump", option, library], capture_output=True, text=True, check=True)
        for option in ("-p", "-T")
    ]
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", listed[1].stdout)
    return set(re.findall(r"NEEDED +(\S+)", listed[0].stdout)), max(
        (int(major), int(minor)) for major, minor in versions
    )


def assert_old_systems_have_what_it_needs(library: Path, compiler) -> None:
    """Zig's need glibc 2.17 or older; gcc's what this machine has."""
    libraries, glibc = needs(library)
    assert libraries <= {"libc.so.6", "libdl.so.2", "libm.so.6", "libpthread.so.0"}
    if compiler.is_zig:
        assert glibc <= (2, 17)


def test_the_front_is_linked_with_the_c_library_only_and_lands(
    compiler, binary, header, unpacked, host, description, tmp_path
):
    fmu = tmp_path / "fmu"
    shutil.copytree(unpacked, fmu)
    front = fmu / "binaries" / "linux64" / "RlvLanding.so"
    binary.compile_front(front, header, compiler)
    assert_old_systems_have_what_it_needs(front, compiler)
    first = {v.name: v.valueReference for v in description.modelVariables}["body.x"]
    numbers = [description.guid, "100", "100", str(first), "1"]
    done = subprocess.run(
        [host("land"), front, (fmu / "resources").as_uri(), *numbers],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    landing = Landing()
    landing.advance_to(99e-3 + 1e-3)
    assert float.fromhex(done.stdout.split()[2]) == pytest.approx(landing.get("body.x"), rel=1e-9)


def core_by(compiler, package: Path) -> Path:
    """A copy of the package with a core by this compiler; its folder.

    A minute of Zig's work is spared where the present core is its.
    """
    own = Path(compiled.__file__)
    by_zig = compiler.is_zig and b"clang version" in own.read_bytes()
    ignored = shutil.ignore_patterns("__pycache__", *([] if by_zig else ["*.so"]))
    shutil.copytree(ROOT / "fmu_src" / "rlv_landing", package, ignore=ignored)
    if not by_zig:
        build = ["setup.py", "-q", "build_ext", "--build-lib", str(package.parent)]
        subprocess.run(
            [sys.executable, *build, "--build-temp", str(package.parent / "objects")],
            cwd=ROOT,
            check=True,
            capture_output=True,
            timeout=600,
        )
    return package / "core" / own.name


def landed(**environment: str) -> list[str]:
    """What `LAND` prints in a process with this environment: the core's file, then the outputs."""
    done = subprocess.run(
        [sys.executable, "-c", LAND],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, **environment},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_the_compiled_core_needs_nothing_new_and_gives_the_same_digits(compiler, tmp_path):
    core = core_by(compiler, tmp_path / "rlv_landing")
    assert_old_systems_have_what_it_needs(core, compiler)
    file, *values = landed(PYTHONPATH=str(tmp_path))
    assert Path(file) == core
    landing = Landing()
    landing.advance_to(0.4)
    assert values == [float(value).hex() for value in landing.values()]


def test_other_last_bits_of_the_c_librarys_functions_move_a_landing_within_its_tolerance(tmp_path):
    """So do those of another system: its C library rounds other results in the other direction."""
    library = tmp_path / "last_bits.so"
    source = Path(__file__).with_name("last_bits.c")
    command = ["gcc", "-O2", "-fno-builtin", "-shared", "-fPIC", "-o", library, source]
    subprocess.run([*command, "-ldl", "-lm"], check=True)
    values = dict(zip(OUTPUT_NAMES, map(float.fromhex, landed(LD_PRELOAD=str(library))[1:])))
    landing = Landing()
    landing.advance_to(0.4)
    assert list(values.values()) != landing.values()
    for name in ("body.x", "body.y", "body.pitch"):
        assert values[name] == pytest.approx(landing.get(name), rel=0, abs=1e-5), name


def test_the_built_fmu_needs_no_libstdcpp_and_with_zig_no_new_glibc(unpacked, binary):
    from fmu_build import compilers

    for library in unpacked.rglob("*.so"):
        libraries, glibc = needs(library)
        assert not {name for name in libraries if "stdc++" in name or "gcc" in name}
        if compilers.has_zig():
            assert glibc <= (2, 17), library


def test_an_isolated_build_of_the_package_has_what_compiles_its_front():
    """FMI's headers come with FMPy, and pythonfmu describes the variables."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    needed = [
        requirement
        for requirement in project["project"]["optional-dependencies"]["fmu"]
        if requirement.startswith(("fmpy", "pythonfmu"))
    ]
    assert len(needed) == 2
    assert set(needed) <= set(project["build-system"]["requires"])
