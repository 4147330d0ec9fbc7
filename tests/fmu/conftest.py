"""Fixtures of the FMU's tests: description, unpacked files, instances, hosts written in C."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import fmpy
import pytest
from c_hosts import HEADERS, HOSTS
from fmi3_instance import Instance3
from fmu_instance import Instance

ROOT = Path(__file__).resolve().parent.parent.parent


@pytest.fixture(scope="session")
def description(fmu: Path):
    return fmpy.read_model_description(str(fmu))


@pytest.fixture(scope="session")
def unpacked(fmu: Path, tmp_path_factory) -> Path:
    """The FMU's unpacked files."""
    return Path(fmpy.extract(str(fmu), str(tmp_path_factory.mktemp("fmu"))))


@pytest.fixture
def make(description, unpacked: Path) -> Iterator[Callable[[], Instance]]:
    """Makes instances, which are freed after the test."""
    made: list[Instance] = []

    def instance() -> Instance:
        made.append(Instance(description, unpacked))
        return made[-1]

    yield instance
    for one in made:
        one.free()


@pytest.fixture
def instance(make) -> Instance:
    return make()


@pytest.fixture(scope="session")
def host(tmp_path_factory) -> Callable[[str], Path]:
    """Compiles a host of the folder `host/` by its name; returns the program."""
    folder = tmp_path_factory.mktemp("hosts")

    def compiled(name: str) -> Path:
        program = folder / name
        if not program.exists():
            command = [
                "gcc",
                "-std=gnu11",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-isystem",
                str(HEADERS),
                "-o",
                str(program),
            ]
            subprocess.run(
                [*command, str(HOSTS / f"{name}.c"), "-ldl", "-lm", "-lpthread"], check=True
            )
        return program

    return compiled


@pytest.fixture
def binary(monkeypatch):
    """The module that compiles the front."""
    monkeypatch.syspath_prepend(ROOT / "fmu_src")
    from fmu_build import binary

    return binary


@pytest.fixture
def header(binary, unpacked, tmp_path) -> Path:
    """A folder with the header that the front of the FMU includes."""
    root = ElementTree.parse(unpacked / "modelDescription.xml").getroot()
    module = (unpacked / "resources" / "slavemodule.txt").read_text()
    (tmp_path / "variables.h").write_text(binary.variables_header(root, module))
    return tmp_path


@pytest.fixture(scope="session")
def description3(fmu3: Path):
    return fmpy.read_model_description(str(fmu3))


@pytest.fixture(scope="session")
def unpacked3(fmu3: Path, tmp_path_factory) -> Path:
    """The unpacked files of the FMU of FMI 3.0."""
    return Path(fmpy.extract(str(fmu3), str(tmp_path_factory.mktemp("fmu3"))))


@pytest.fixture
def make3(description3, unpacked3: Path) -> Iterator[Callable[..., Instance3]]:
    """Makes instances of FMI 3.0, which are freed after the test."""
    made: list[Instance3] = []

    def instance(**wishes: Any) -> Instance3:
        made.append(Instance3(description3, unpacked3, **wishes))
        return made[-1]

    yield instance
    for one in made:
        one.free()
