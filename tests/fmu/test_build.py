"""The build of the FMU: `build_fmu.sh` as a user calls it, and the front in C."""

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import pytest

ROOT = Path(__file__).resolve().parent.parent.parent

OF_MODEL_EXCHANGE = re.compile("Event|Continuous|Integrator|NewDiscrete|SetTime|GetDerivatives")


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


def test_the_front_compiles_without_a_warning_and_exports_fmi_functions_only(
    unpacked, tmp_path, monkeypatch
):
    monkeypatch.syspath_prepend(ROOT / "fmu_src")
    from fmu_build import binary

    root = ElementTree.parse(unpacked / "modelDescription.xml").getroot()
    (tmp_path / "variables.h").write_text(binary.variables_header(root, "pythonfmu.so"))
    monkeypatch.setattr(binary, "FLAGS", [*binary.FLAGS, "-Werror", "-Wpedantic"])
    binary.compile_front(tmp_path / "front.so", tmp_path)
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", tmp_path / "front.so"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    names = {line.split()[-1] for line in listed.splitlines()}
    declared = re.findall(
        r"#define (fmi2\w+) +fmi2FullName", (binary.HEADERS / "fmi2Functions.h").read_text()
    )
    assert names == {name for name in declared if not OF_MODEL_EXCHANGE.search(name)}


def test_an_unknown_binary_of_pythonfmus_stops_the_build(monkeypatch, unpacked):
    """A binary with other finalisers than the known two needs a person to look at it."""
    monkeypatch.syspath_prepend(ROOT / "fmu_src")
    from fmu_build import binary

    edited = next((unpacked / "binaries" / "linux64").glob("pythonfmu-export-*.so")).read_bytes()
    with pytest.raises(SystemExit, match="has 1 finalisers, not 2"):
        binary.without_last_finaliser(edited)
    with pytest.raises(SystemExit, match="no 64-bit little-endian ELF file"):
        binary.without_last_finaliser(b"MZ" + edited)
