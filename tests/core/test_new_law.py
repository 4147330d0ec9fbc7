"""A new law of the main strut is one file, and its name in one line of `struts/kinds.py`.

Shown in a copy of the core, pure and compiled.
"""

import importlib
import shutil
import sys
from array import array
from pathlib import Path

import numpy as np
import pytest
from Cython.Build import cythonize
from pytest import approx
from setuptools import Distribution, Extension
from setuptools.command.build_ext import build_ext

from rlv_landing import load_preset
from rlv_landing.assembly import body_model, leg_models, leg_places, planar_start, planar_system
from rlv_landing.quantities import LEG_QUANTITIES, SHARED_QUANTITIES

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "fmu_src"))
from fmu_build.core_source import CORE, DIRECTIVES, MODULE, write_source

LAW = '''\
"""A linear spring and damper."""

from __future__ import annotations

from ..records import LegModel, StrutForce, StrutStatus
from .laws import MAIN_STRUTS, MainStrutLaw

SPRING_RATE, DAMPING = 2e5, 3e3


def linear_spring(s: float, v: float, z1: float, z2: float, p: LegModel) -> StrutForce:
    """The strut at stroke `s` [m] and stroke rate `v` [m/s]."""
    damping = DAMPING * v
    held = 0.5 * SPRING_RATE * s * s
    force = SPRING_RATE * s + damping
    # no liquid, nothing stiff
    return StrutForce(
        force, 0.0, 0.0, damping * v, 0.0, 0.0, held, 0.0, 0.0, 0.0, 0.0, 0.0
    )


def linear_spring_status(s: float, z1: float, z2: float, p: LegModel) -> StrutStatus:
    """It has no end stops and no chambers."""
    return StrutStatus(0.0, 0.0, 0.0)


MAIN_STRUTS["linear-spring"] = MainStrutLaw(linear_spring, linear_spring_status)
'''
LINE = "from . import elastic, liquid_spring, play"
STROKE, RATE, FORCE = (
    [q.name for q in LEG_QUANTITIES].index(f"main_strut.{name}")
    for name in ("stroke", "stroke_rate", "force")
)


def extended(folder: Path) -> Path:
    """A copy of the core with the new law, as a package in `folder`."""
    core = folder / "core_with_spring"
    shutil.copytree(CORE, core, ignore=shutil.ignore_patterns("__pycache__", f"{MODULE}.*"))
    (core / "struts" / "linear_spring.py").write_text(LAW)
    kinds = core / "struts" / "kinds.py"
    text = kinds.read_text()
    assert text.count(LINE) == 1
    kinds.write_text(text.replace(LINE, f"{LINE}, linear_spring"))
    return core


def compiled(core: Path, folder: Path) -> Path:
    """Compile the `core` below `folder`; return the folder of the package.

    Unoptimised, which changes no digit and takes less time.
    """
    source = write_source(folder / "source", core)
    extension = Extension(
        f"{source.parent.name}.{MODULE}",
        [str(source)],
        extra_compile_args=["-O0", "-ffp-contract=off"],
    )
    command = build_ext(
        Distribution(
            {"ext_modules": cythonize([extension], compiler_directives=DIRECTIVES, quiet=True)}
        )
    )
    command.build_lib, command.build_temp = str(folder / "built"), str(folder / "temporary")
    command.ensure_finalized()
    command.run()
    return folder / "built" / source.parent.name


def land(planar, exponential) -> np.ndarray:
    """The outputs of a landing, a row every millisecond.

    The vehicle is mixed: its first leg group keeps the liquid spring. Numbers of laws are those of
    the copy: places in the order of the names.
    """
    parameters = load_preset("yue2022-figures", "2-2").with_values(
        {"vehicle.transverse_load_at": "footpad"}
    )
    like = planar_system(parameters)
    first, second = leg_models(parameters)
    linear, liquid = (
        float(sorted(["liquid-spring", "linear-spring"]).index(name))
        for name in ("linear-spring", "liquid-spring")
    )
    legs = [first._replace(main_kind=liquid), second._replace(main_kind=linear)]
    system = planar(
        body_model(parameters),
        legs,
        leg_places(parameters),
        array("d", like.scale),
        array("d", like.relative),
    )
    solver = exponential(system, 1e-6)
    for i, value in enumerate(planar_start(parameters)):
        solver.y[i] = value
    solver.restart(0.0)
    rows = np.zeros((301, system.row))
    assert solver.record(0.0, 1e-3, 0, len(rows), rows.reshape(-1)) == len(rows)
    return rows


@pytest.fixture(scope="module")
def core(tmp_path_factory):
    return extended(tmp_path_factory.mktemp("law"))


@pytest.fixture(scope="module")
def pure_rows(core):
    sys.path.insert(0, str(core.parent))
    try:
        planar = importlib.import_module(f"{core.name}.bodies.planar").Planar
        exponential = importlib.import_module(f"{core.name}.solvers.exponential").Exponential
    finally:
        sys.path.pop(0)
    return land(planar, exponential)


def test_a_leg_with_the_new_law_obeys_it_and_its_neighbour_keeps_its_own(pure_rows):
    shared = len(SHARED_QUANTITIES)
    old, new = (pure_rows[:, shared + len(LEG_QUANTITIES) * group :] for group in (0, 1))
    assert new[:, STROKE].max() > 1e-3
    assert -new[:, FORCE] == approx(2e5 * new[:, STROKE] + 3e3 * new[:, RATE], rel=1e-12, abs=1e-9)
    assert np.abs(-old[:, FORCE] - 2e5 * old[:, STROKE] - 3e3 * old[:, RATE]).max() > 100.0


def test_the_energy_balance_closes_with_the_new_law(pure_rows):
    names = [q.name for q in SHARED_QUANTITIES]
    balance = pure_rows[:, names.index("energy.balance")]
    assert np.ptp(balance) < 1e-4 * pure_rows[-1, names.index("energy.dissipated")]


def test_the_compiled_copy_gives_the_same_digits(core, pure_rows, tmp_path):
    package = compiled(core, tmp_path)
    sys.path.insert(0, str(package.parent))
    try:
        module = importlib.import_module(f"{package.name}.{MODULE}")
    finally:
        sys.path.pop(0)
    assert np.array_equal(land(module.Planar, module.Exponential), pure_rows)


def test_two_kernel_files_that_define_the_same_name_are_refused(tmp_path):
    core = extended(tmp_path)
    (core / "struts" / "another.py").write_text("DAMPING = 1.0\n")
    with pytest.raises(
        ValueError,
        match=r"DAMPING is defined in another\.py and in linear_spring\.py; "
        "give one of them another name",
    ):
        write_source(tmp_path / "source", core)
