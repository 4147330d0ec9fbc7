"""The build of the FMU: `build_fmu.sh` as a user calls it, and the front in C."""

import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import fmpy
import pytest

ROOT = Path(__file__).resolve().parents[3]


def test_build_script_writes_the_named_file_and_prints_what_it_checked(tmp_path):
    target = tmp_path / "sub folder" / "mine.fmu"
    done = subprocess.run(
        ["./build_fmu.sh", str(target)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
        env={"PYTHON": sys.executable, "PATH": "/usr/bin:/bin"},
    )
    assert done.returncode == 0, done.stderr
    assert "valid; trial landing" in done.stdout
    assert [p.name for p in target.parent.iterdir()] == ["mine.fmu"]
    assert fmpy.read_model_description(str(target)).modelName == "RlvLanding"


def test_build_script_prints_help_and_builds_nothing(tmp_path):
    environment = {"PYTHON": sys.executable, "PATH": "/usr/bin:/bin"}
    for option in ("--help", "-h"):
        done = subprocess.run(
            ["./build_fmu.sh", option], cwd=ROOT, capture_output=True, text=True, env=environment
        )
        assert done.returncode == 0, done.stderr
        usage = done.stdout.partition("\n\n")[0].split()
        assert usage[:2] == ["usage:", "build_fmu.sh"]
        assert {"[--fmi", "[--pure]", "[--platforms", "[file]"} <= set(usage)


@pytest.fixture(scope="module")
def sources(tmp_path_factory) -> Path:
    """A copy of the sources without a compiled core."""
    root = tmp_path_factory.mktemp("sources")
    for name in ("LICENSE", "CHANGELOG.md", "build_fmu.sh", "setup.py"):
        shutil.copy(ROOT / name, root)
    ignored = shutil.ignore_patterns("__pycache__", "*.so")
    shutil.copytree(ROOT / "fmu_src", root / "fmu_src", ignore=ignored)
    return root


def build(root: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["./build_fmu.sh", *arguments],
        cwd=root,
        capture_output=True,
        text=True,
        timeout=300,
        env={"PYTHON": sys.executable, "PATH": "/usr/bin:/bin", **environment},
    )


def test_build_without_a_compiled_core_is_an_error_unless_pure_asks_for_it(sources, tmp_path):
    """The compiler fails here."""
    target = tmp_path / "mine.fmu"
    done = build(sources, str(target), CC="/bin/false")
    assert done.returncode == 1
    assert "error: there is no compiled core of the present kernels" in done.stderr
    assert not target.exists()
    done = build(sources, "--pure", str(target))
    assert done.returncode == 0, done.stderr
    assert "core: not compiled, as --pure asks for" in done.stdout
    with zipfile.ZipFile(target) as archive:
        assert not [name for name in archive.namelist() if "core/compiled" in name]


def test_the_front_compiles_without_a_warning_and_exports_fmi_functions_only(
    binary, header, monkeypatch
):
    monkeypatch.setattr(binary, "FLAGS", [*binary.FLAGS, "-Werror", "-Wpedantic"])
    binary.compile_front(header / "front.so", header, binary.for_linux())
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", header / "front.so"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    names = {line.split()[-1] for line in listed.splitlines()}
    declared = [
        name
        for fmi in ("fmi2", "fmi3")
        for name in re.findall(
            rf"#define ({fmi}\w+) +{fmi}FullName",
            (binary.HEADERS / f"{fmi}Functions.h").read_text(),
        )
    ]
    assert names == set(declared)


def test_the_fronts_declarations_of_python_are_those_of_its_limited_api(binary, tmp_path):
    """A compiler compares each with the header of this Python, as that of 3.10."""
    source = tmp_path / "compare.c"
    source.write_text(
        "#define Py_LIMITED_API 0x030A0000\n"
        "#include <Python.h>\n"
        '#include "python.h"\n'
        "#define COMPARE(result, name, arguments) \\\n"
        "    _Static_assert( \\\n"
        "        __builtin_types_compatible_p(__typeof__(py.name), __typeof__(&name)), #name);\n"
        "PYTHON_FUNCTIONS(COMPARE)\n"
    )
    command = ["gcc", "-std=c11", "-fsyntax-only", "-Werror", f"-I{binary.FRONT}"]
    includes = [f"-I{sysconfig.get_path('include')}", str(source)]
    done = subprocess.run([*command, *includes], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_make_builds_the_fmu_anew_when_a_file_that_it_is_made_of_changes():
    """The Makefile reads the lists of `fmu_build/sources.py`."""
    from fmu_build.sources import FOLDERS, MODULES, PACKAGE

    database = subprocess.run(
        ["make", "-pnq", "build/RlvLanding.fmu"], cwd=ROOT, capture_output=True, text=True
    ).stdout
    files = [PACKAGE / name for name in MODULES]
    files += [file for folder in FOLDERS for file in (PACKAGE / folder).rglob("*.py")]
    files += (ROOT / "fmu_src" / "fmu_front").glob("*.*")
    for fmu in ("RlvLanding.fmu", "RlvLanding3.fmu"):
        (needs,) = re.findall(rf"^build/{fmu}: (.*)$", database, re.M)
        assert {file.relative_to(ROOT).as_posix() for file in files} - set(needs.split()) == set()
