"""The FMU in FMPy: variables, numbers, states, and what it refuses."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import zipfile

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from rlv_landing import Landing, __version__, load_preset
from rlv_landing.parameters import parameters_of
from rlv_landing.quantities import (
    INPUT_QUANTITIES,
    OUTPUT_NAMES,
    OUTPUT_QUANTITIES,
    PEAK_QUANTITIES,
    STATISTIC_QUANTITIES,
)

FIGURES = "yue2022-figures"


def drop_values(mode: str) -> dict[str, float | str]:
    """The `drop.*` values that an importer sets for the drop test of `mode`."""
    return {
        name: value
        for name, value in load_preset(FIGURES, mode).items()
        if name.startswith("drop.") and name in parameters_of(mode)
    }


def test_fmpy_validate_reports_nothing(fmu):
    assert validate_fmu(str(fmu)) == []


def test_every_quantity_is_a_variable_with_its_unit_causality_and_start(description):
    variables = {v.name: v for v in description.modelVariables}
    calculated = (*OUTPUT_QUANTITIES, *STATISTIC_QUANTITIES, *PEAK_QUANTITIES)
    others = [q.name for q in (*INPUT_QUANTITIES, *calculated)]
    table = parameters_of("2-2")
    assert list(variables) == [*table, *others]
    assert not [name for name in variables if "roll" in name or "legs" in name]
    units = {u.name for u in description.unitDefinitions}
    for causality, quantities in (
        ("parameter", table.values()),
        ("input", INPUT_QUANTITIES),
        ("output", OUTPUT_QUANTITIES),
        ("local", (*STATISTIC_QUANTITIES, *PEAK_QUANTITIES)),
    ):
        for q in quantities:
            v = variables[q.name]
            assert v.causality == causality
            assert v.description == q.meaning
            assert (
                v.type
                == {"real": "Real", "string": "String", "integer": "Integer", "boolean": "Boolean"}[
                    q.kind
                ]
            )
            assert v.unit == ((q.unit or "1") if q.kind == "real" else None)
            assert v.unit is None or v.unit in units
    preset = load_preset(FIGURES, "2-2")
    for name in table:
        start, value = variables[name].start, preset[name]
        assert (start if isinstance(value, str) else float(start)) == value
    assert all(variables[q.name].start == "0.0" for q in INPUT_QUANTITIES)


def test_names_in_the_fmu_carry_the_version_and_the_build(fmu):
    """So that no other FMU, package or pythonfmu in the process has them."""
    names = [n.split("/", 1)[1] for n in zipfile.ZipFile(fmu).namelist() if "resources/" in n]
    version = __version__.replace(".", "_")
    tops = {n.split("/")[0] for n in names} - {"slavemodule.txt", "libpython.txt"}
    tags = {
        re.fullmatch(rf"(rlv_landing|landing_fmu)_{version}_([0-9a-f]{{12}})(\.py)?", n)[2]
        for n in tops
    }
    assert len(tops) == 2
    assert len(tags) == 1
    package = f"rlv_landing_{version}_{tags.pop()}"
    assert f"{package}/landing.py" in names
    assert f"{package}/pythonfmu/fmi2slave.py" in names
    assert any(n.startswith(f"{package}/core/compiled.") for n in names)


@pytest.mark.parametrize("step", [1e-4, 3.7e-4, 1e-3, 7e-3, 1e-2])
def test_fmpy_simulate_gives_landings_numbers_at_any_communication_step(fmu, mode, step):
    """To 1e-9 of each quantity's largest value."""
    result = fmpy.simulate_fmu(
        str(fmu),
        stop_time=1.0,
        step_size=step,
        output_interval=step,
        start_values=drop_values(mode),
        output=list(OUTPUT_NAMES),
    )
    landing = Landing(load_preset(FIGURES), mode)
    rows = []
    for t in result["time"]:
        landing.advance_to(max(float(t), landing.time))
        rows.append(landing.values())
    ours = np.array(rows)
    assert result["time"][-1] >= 1.0 - step
    for i, name in enumerate(OUTPUT_NAMES):
        theirs = result[name].astype(float)
        assert np.abs(theirs - ours[:, i]).max() <= 1e-9 * max(1.0, np.abs(ours[:, i]).max()), name


def test_inputs_act_as_they_do_on_landing(instance, mode):
    landing = Landing(load_preset(FIGURES))
    instance.start()
    for k in range(250):
        if k == 100:
            instance.set("external.force_x", 400.0)
            instance.set("ground.heave_rate", 0.05)
            landing.set_inputs({"external.force_x": 400.0, "ground.heave_rate": 0.05})
        instance.slave.doStep(k * 1e-3, 1e-3)
        landing.advance_to(k * 1e-3 + 1e-3)
    for name in ("body.x", "body.pitch", "energy.work_external", "leg[1].main_strut.force"):
        assert instance.get(name) == landing.get(name)


def test_state_goes_back_and_forth_serialised_too(instance):
    instance.start()
    instance.steps(0, 100)
    instance.set("external.force_x", 50.0)
    instance.steps(100, 150)
    saved = instance.slave.getFMUState()
    data = instance.slave.serializeFMUstate(saved)
    instance.steps(150, 400)
    expected = [
        instance.get(n) for n in ("body.x", "body.y", "leg[3].main_strut.stroke", "energy.balance")
    ]
    for state in (saved, instance.slave.deSerializeFMUstate(data)):
        instance.slave.setFMUState(state)
        instance.steps(150, 400)
        assert [
            instance.get(n)
            for n in ("body.x", "body.y", "leg[3].main_strut.stroke", "energy.balance")
        ] == expected
    instance.slave.freeFMUState(saved)


def test_reset_starts_again(instance):
    instance.start()
    first = instance.get("body.y")
    instance.steps(0, 50)
    instance.slave.reset()
    instance.start()
    assert instance.get("body.y") == first


def test_bad_parameter_is_an_error_at_the_end_of_initialisation_and_its_reason_is_logged(instance):
    with pytest.raises(FMICallException, match="error"):
        instance.start(**{"ground.friction": -1.0})
    assert (3, "ground.friction = -1 is outside [0, 3]") in instance.log


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e9])
def test_bad_input_is_refused_with_a_reason_and_the_landing_goes_on_after(instance, value):
    instance.start()
    instance.steps(0, 10)
    instance.set("external.force_x", value)
    with pytest.raises(FMICallException, match="discard"):
        instance.slave.doStep(10e-3, 1e-3)
    assert any(
        "external.force_x" in message and "[-1e+07, 1e+07] N" in message
        for _, message in instance.log
    )
    instance.set("external.force_x", 0.0)
    instance.steps(10, 20)
    landing = Landing()
    landing.advance_to(19 * 1e-3 + 1e-3)
    assert instance.get("body.y") == landing.get("body.y")


@pytest.mark.parametrize(
    ("time", "step"),
    [(10e-3, 0.0), (10e-3, -1e-3), (10e-3, float("nan")), (5e-3, 1e-3), (0.5, 1e-3)],
)
def test_bad_steps_are_refused_with_a_reason_and_the_landing_goes_on_after(instance, time, step):
    instance.start()
    instance.steps(0, 10)
    with pytest.raises(FMICallException, match="discard"):
        instance.slave.doStep(time, step)
    assert instance.log
    instance.steps(10, 12)


HOST = """
import sys
sys.path.insert(0, sys.argv[1])
import importlib
module = importlib.import_module(open(sys.argv[1] + "/slavemodule.txt").read())
slave = module.RlvLanding(instance_name="bare", resources=sys.argv[1])
slave.setup_experiment(0.0, None, None)
slave.exit_initialization_mode()
for k in range(130):
    assert slave.do_step(k * 1e-3, 1e-3)
packages = ("numpy", "scipy", "click", "pint", "rlv_landing", "pythonfmu")
third_party = sorted(m for m in sys.modules if m.split(".")[0] in packages)
print(third_party, " ".join(v.hex() for v in slave.get_outputs()))
"""


@pytest.mark.parametrize("pure", ["0", "1"])
def test_the_fmu_needs_no_package_of_the_host_and_falls_back_to_the_pure_core(fmu, tmp_path, pure):
    """A Python without site-packages runs the slave.

    Compiled and pure core give `Landing`'s digits.
    """
    fmpy.extract(str(fmu), str(tmp_path))
    environment = {**os.environ, "RLV_LANDING_PURE": pure}
    done = subprocess.run(
        [sys.executable, "-S", "-c", HOST, str(tmp_path / "resources")],
        capture_output=True,
        text=True,
        env=environment,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    landing = Landing()
    landing.advance_to(129 * 1e-3 + 1e-3)
    assert done.stdout.strip() == "[] " + " ".join(float(v).hex() for v in landing.values())
