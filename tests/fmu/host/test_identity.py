"""Two builds of one version, which differ in one line of physics, in one process."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest
from fmu_instance import FOLDER

ROOT = Path(__file__).resolve().parents[3]
NAMES = ("body.x", "body.y", "leg[1].contact.force_y", "leg[1].main_strut.force")
LINE = "force = elastic + p.Cgmax * damping_ramp(d, p) * v"

BOTH = """
import sys, pathlib, fmpy
sys.path.insert(0, sys.argv[1])
from fmu_instance import Instance, ERROR
from ctypes import byref, c_void_p
from fmpy import fmi2
instances = []
for folder in map(pathlib.Path, sys.argv[2:4]):
    instances.append(Instance(fmpy.read_model_description(str(folder)), folder))
first, second = instances
for instance in instances:
    instance.start()
for k in range(300):
    for instance in instances:
        instance.slave.doStep(k * 1e-3, 1e-3)
for instance in instances:
    print(*(instance.get(name).hex() for name in sys.argv[4:]))
data = first.slave.serializeFMUstate(first.slave.getFMUState())
state, bytes_ = c_void_p(), (fmi2.fmi2Byte * len(data))(*data)
assert second.status("fmi2DeSerializeFMUstate", bytes_, len(data), byref(state)) == ERROR
assert "are a state of another build or version" in second.reason(), second.reason()
assert second.status("fmi2SetFMUstate", first.slave.getFMUState()) == ERROR
assert "is no state of this FMU" in second.reason(), second.reason()
"""

ALONE = """
import sys
from rlv_landing import Landing
landing = Landing()
landing.advance_to(299 * 1e-3 + 1e-3)
print(*(float(landing.get(name)).hex() for name in sys.argv[1:]))
"""


def run(script: str, *arguments: object, **environment: str) -> list[list[str]]:
    """The words of each line that a script prints in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=300,
        env={**os.environ, **environment},
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return [line.split() for line in done.stdout.splitlines()]


@pytest.fixture(scope="module")
def changed(tmp_path_factory) -> Path:
    """A copy of the sources in which the ground has half the damping."""
    root = tmp_path_factory.mktemp("changed")
    for name in ("LICENSE", "CHANGELOG.md"):
        shutil.copy(ROOT / name, root)
    ignored = shutil.ignore_patterns("__pycache__", "*.so")
    shutil.copytree(ROOT / "fmu_src", root / "fmu_src", ignore=ignored)
    file = root / "fmu_src" / "rlv_landing" / "core" / "ground" / "normal.py"
    text = file.read_text()
    assert text.count(LINE) == 1
    file.write_text(text.replace(LINE, LINE.replace("* v", "* v * 0.5")))
    return root / "fmu_src"


@pytest.fixture(scope="module")
def other(changed, tmp_path_factory) -> Path:
    """The unpacked FMU of the changed sources."""
    folder = tmp_path_factory.mktemp("other")
    command = [sys.executable, "-m", "fmu_build.build", "--pure", str(folder / "other.fmu")]
    environment = {**os.environ, "PYTHONPATH": str(changed)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return Path(fmpy.extract(str(folder / "other.fmu"), str(folder / "files")))


@pytest.mark.parametrize("turned", [False, True])
def test_each_build_computes_its_own_numbers_and_refuses_the_others_states(
    unpacked, changed, other, turned
):
    alone = [*run(ALONE, *NAMES), *run(ALONE, *NAMES, PYTHONPATH=str(changed))]
    assert alone[0] != alone[1]
    order = -1 if turned else 1
    folders = [unpacked, other][::order]
    assert run(BOTH, FOLDER, *folders, *NAMES)[::order] == alone


def test_guid_and_names_of_modules_differ(unpacked, other):
    identities = [
        (
            fmpy.read_model_description(str(folder)).guid,
            (folder / "resources" / "slavemodule.txt").read_text(),
        )
        for folder in (unpacked, other)
    ]
    assert identities[0][0] != identities[1][0]
    assert identities[0][1] != identities[1][1]
    modules = [
        {p.name for p in (folder / "resources").iterdir()} - {"slavemodule.txt", "libpython.txt"}
        for folder in (unpacked, other)
    ]
    assert not modules[0] & modules[1]


@pytest.mark.parametrize("first", ["host", "fmu"])
def test_another_pythonfmu_in_the_host_and_the_fmus_own_do_not_meet(unpacked, tmp_path, first):
    """As in a host that has loaded pythonfmu 0.6, or loads it afterwards for another FMU."""
    (tmp_path / "pythonfmu.py").write_text("VERSION = '0.6'\n")
    load = "import pythonfmu; assert pythonfmu.VERSION == '0.6'"
    land = (
        "from fmu_instance import Instance; import fmpy, pathlib\n"
        "folder = pathlib.Path(sys.argv[2])\n"
        "Instance(fmpy.read_model_description(str(folder)), folder).start()\n"
    )
    parts = [load, land] if first == "host" else [land, load]
    script = "\n".join(["import sys; sys.path.insert(0, sys.argv[1])", *parts, "print('well')"])
    path = os.pathsep.join(map(str, (tmp_path, ROOT / "fmu_src")))
    assert run(script, FOLDER, unpacked, PYTHONPATH=path) == [["well"]]
