"""The FMU for all platforms: its cores read by lief, and run where an emulator or a Python is.

Also the front under valgrind and AddressSanitizer. Part of `make torture`: cores take minutes.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest
from binaries import front_library, needs_only_its_system, old_enough
from c_hosts import HEADERS, HOSTS
from foreign_python import libpython, unpacked_python

from rlv_landing import Landing
from rlv_landing.quantities import OUTPUT_NAMES

pytestmark = [
    pytest.mark.torture,
    pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="minutes of builds: make torture"),
]

ROOT = Path(__file__).resolve().parents[3]
PYTHON_DLL = "python3.dll"
STEPS, EVERY, COUNT = 400, 100, 10


@pytest.fixture(scope="module")
def release(tmp_path_factory) -> Path:
    """The unpacked FMU for all platforms."""
    pytest.importorskip("ziglang")
    folder = tmp_path_factory.mktemp("release")
    subprocess.run(
        [sys.executable, "-m", "fmu_build.build", "--platforms", "all", str(folder / "all.fmu")],
        cwd=ROOT / "fmu_src",
        check=True,
        timeout=3600,
    )
    return Path(fmpy.extract(str(folder / "all.fmu"), str(folder / "fmu")))


@pytest.fixture
def cores(release: Path) -> dict[str, Path]:
    """The compiled cores by FMI 3.0's names of their platforms."""
    folders = release.glob("resources/*/core/compiled_for/*")
    others = {folder.name: next(folder.iterdir()) for folder in folders}
    return {"x86_64-linux": next(release.glob("resources/*/core/compiled.*")), **others}


def test_a_core_for_each_platform_needs_of_python_what_the_one_for_linux_does(cores):
    """That one is run by all Pythons, so all these are in the limited API."""
    assert set(cores) == {
        *("x86_64-linux", "aarch64-linux", "x86_64-windows", "x86_64-darwin", "aarch64-darwin")
    }
    of_linux = {n for n in front_library(cores["x86_64-linux"]).lacks if "Py" in n[:3]}
    assert len(of_linux) > 50
    for name, path in cores.items():
        found = front_library(path)
        assert found.machine == name.split("-")[0]
        assert "PyInit_compiled" in found.functions
        of_python = {n for n in found.lacks if "Py" in n[:3]}
        assert of_python, name
        assert of_python <= of_linux, name
        assert needs_only_its_system(path, PYTHON_DLL), name
        assert old_enough(path), name


@pytest.mark.parametrize("folder", ["linux64", "aarch64-linux", "win64", "darwin64"])
def test_every_front_needs_its_system_only(release, folder):
    (front,) = (release / "binaries" / folder).iterdir()
    assert needs_only_its_system(front)
    assert old_enough(front)
    assert not {n for n in front_library(front).lacks if n.startswith("Py")}


def numbers(release: Path, steps: int = STEPS) -> list[str]:
    """The host's arguments behind the binary."""
    description = fmpy.read_model_description(str(release))
    first = {v.name: v.valueReference for v in description.modelVariables}["body.x"]
    every = str(min(steps, EVERY))
    uri = (release / "resources").as_uri()
    return [uri, description.guid, str(steps), every, str(first), str(COUNT)]


def assert_landed(done: subprocess.CompletedProcess[str]) -> None:
    """Like `Landing`, by a compiled core."""
    assert done.returncode == 0, done.stdout + done.stderr
    *lines, core = done.stdout.splitlines()
    assert core == "compiled core"
    landing = Landing()
    for line in lines:
        k, *values = line.split()[1:]
        landing.advance_to((int(k) - 1) * 1e-3 + 1e-3)
        for name, theirs, ours in zip(OUTPUT_NAMES, values, landing.values()):
            assert float.fromhex(theirs) == pytest.approx(ours, rel=1e-9, abs=1e-9), name


@pytest.fixture
def zig_host(tmp_path) -> Callable[[str, str], Path]:
    """Compiles a host of `host/` for another target."""

    def compiled(name: str, triple: str, *libraries: str) -> Path:
        program = tmp_path / name
        command = [sys.executable, "-m", "ziglang", "cc", "-target", triple, "-std=gnu11"]
        sources = ["-isystem", HEADERS, "-o", program, HOSTS / f"{name}.c"]
        subprocess.run([*command, *sources, *libraries], check=True)
        return program

    return compiled


def test_the_fmu_lands_on_arm_in_an_emulator(release, zig_host):
    emulator = shutil.which("qemu-aarch64-static") or shutil.which("qemu-aarch64")
    if emulator is None:
        pytest.skip("qemu-aarch64 is not installed (Debian: qemu-user-static)")
    root = unpacked_python("arm64", "bookworm", 11)
    host = zig_host("land", "aarch64-linux-gnu.2.17", "-ldl", "-lpthread")
    front = release / "binaries" / "aarch64-linux" / "RlvLanding.so"
    library = f"RLV_LANDING_LIBPYTHON={libpython(root, 11)}"
    assert_landed(
        run([emulator, "-L", str(root), "-E", library, str(host), str(front), *numbers(release)])
    )


def test_the_fmu_lands_by_python_3_14(release, zig_host):
    root = unpacked_python("amd64", "sid", 14)
    host = zig_host("land", "x86_64-linux-gnu.2.17", "-ldl", "-lpthread")
    front = release / "binaries" / "linux64" / "RlvLanding.so"
    library = libpython(root, 14)
    loader = [str(library.parent / "ld-linux-x86-64.so.2"), "--library-path", str(library.parent)]
    assert_landed(
        run(
            [*loader, str(host), str(front), *numbers(release)],
            RLV_LANDING_LIBPYTHON=str(library),
        )
    )


def test_valgrind_finds_no_wrong_access(unpacked, host):
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not installed")
    front = unpacked / "binaries" / "linux64" / "RlvLanding.so"
    valgrind = ["valgrind", "-q", "--error-exitcode=99", "--leak-check=no"]
    done = run([*valgrind, str(host("land")), str(front), *numbers(unpacked, 150)])
    assert "==" not in done.stderr
    assert_landed(done)


def test_the_front_under_address_sanitizer_lands_without_a_report(
    unpacked, binary, header, tmp_path
):
    """Without the leaks of Python, which is never finalised."""
    from fmu_build.compilers import Compiler

    fmu, flags = tmp_path / "fmu", ("-fsanitize=address,undefined", "-fno-sanitize-recover")
    shutil.copytree(unpacked, fmu)
    front = fmu / "binaries" / "linux64" / "RlvLanding.so"
    binary.compile_front(front, header, Compiler(("gcc",), (*flags, "-g")))
    program = tmp_path / "land"
    sources = ["-std=gnu11", "-isystem", HEADERS, "-o", program, HOSTS / "land.c"]
    subprocess.run(["gcc", *flags, *sources, "-ldl", "-lm", "-lpthread"], check=True)
    done = run([str(program), str(front), *numbers(fmu)], ASAN_OPTIONS="detect_leaks=0")
    assert done.stderr == ""
    assert_landed(done)


def test_the_windows_front_loads_in_wine_and_tells_where_it_looked_for_python(
    release, zig_host, tmp_path
):
    wine = shutil.which("wine64") or shutil.which("wine", path="/usr/lib/wine:/usr/bin")
    wine = wine or next(map(str, Path("/usr/lib/wine").glob("wine64")), None)
    if wine is None:
        pytest.skip("wine is not installed (Debian: wine64)")
    host = zig_host("instantiate_windows", "x86_64-windows-gnu")
    front = release / "binaries" / "win64" / "RlvLanding.dll"
    uri, guid = numbers(release)[:2]
    done = run(
        [wine, str(host), f"Z:{front}", uri.replace("file:///", "file:///Z:/"), guid],
        WINEPREFIX=str(tmp_path / "wine"),
        WINEDEBUG="-all",
        HOME=str(tmp_path),
    )
    assert done.returncode == 1, done.stdout + done.stderr
    assert "version 2.0" in done.stdout
    assert "no Python library (libpython) of 3.10 to 3.14 was found" in done.stdout
    assert all(f"the loader's python3{minor}.dll: cannot" in done.stdout for minor in range(10, 15))
    assert "registry (PythonCore): none that names its library" in done.stdout


def run(command: list[str], **environment: str) -> subprocess.CompletedProcess[str]:
    """A command without this environment's variables."""
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=600,
        env={"PATH": "/usr/bin:/bin", **environment},
    )
