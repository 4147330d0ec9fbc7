"""The FMU's description, read by FMPy, against pint's units and against what the model itself does
when it is moved.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from itertools import pairwise, product
from pathlib import Path
from zipfile import ZipFile

import fmpy
import numpy as np
import pint
import pytest
from lxml import etree

from rlv_landing import Landing, Parameters, __version__, load_preset
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import INPUT_QUANTITIES, LEGS, MODES, OUTPUT_NAMES, OUTPUT_QUANTITIES

FIGURES = "yue2022-figures"
SCALE = {q.name: q.nominal if q.kind == "real" else 1.0 for q in OUTPUT_QUANTITIES}
# far enough that footpads leave the ground, or touch it, and that a vehicle at rest is not at rest
# any more
STEPS = dict(zip((q.name for q in INPUT_QUANTITIES), (1e4, 1e4, 1e3, 0.05, 1.0, 0.05, 1.0)))
# pressed-up struts, a deep damping layer, and a flight in which every parameter of it counts
MOVED = {
    "drop.tilt": 0.1,
    "drop.pitch_rate": 0.5,
    "drop.contact_time": 0.05,
    "ground.slope": 0.09,
    "ground.damping_depth": 0.05,
    "ground.stick_damping": 100.0,
    "main_strut.charge_pressure": 2e6,
    "auxiliary_strut.play_tension": 5e-3,
}
LOADS = {
    "external.force_x": 500.0,
    "external.force_y": -300.0,
    "external.moment": 50.0,
    "ground.heave_rate": 0.3,
    "ground.tilt_rate": 0.05,
}
# standing on the ground at less than 2 mm/s
STANDING = {
    **MOVED,
    "drop.contact_time": 1e-4,
    "drop.pitch_rate": 1e-4,
    "drop.vertical_velocity": -1e-3,
    "drop.horizontal_velocity": 5e-4,
}


@pytest.fixture(scope="module")
def description(fmu: Path):
    return fmpy.read_model_description(
        str(fmu), validate=True, validate_variable_names=True, validate_model_structure=True
    )


@pytest.fixture(scope="module")
def variables(description):
    return {v.name: v for v in description.modelVariables}


def test_model_is_described(description):
    assert description.fmiVersion == "2.0"
    assert description.version == __version__
    assert description.license == "Apache-2.0"
    assert "rlv-landing authors" in description.author
    assert "rlv-landing authors" in description.copyright
    assert description.generationTool == f"rlv-landing {__version__} with PythonFMU 0.7.0"
    experiment = description.defaultExperiment
    assert [
        float(getattr(experiment, n)) for n in ("startTime", "stopTime", "stepSize", "tolerance")
    ] == [0.0, 1.0, 1e-3, 1e-5]


@pytest.mark.parametrize(
    ("capability", "has"),
    [
        ("needsExecutionTool", True),
        ("canHandleVariableCommunicationStepSize", True),
        ("canInterpolateInputs", True),
        ("canBeInstantiatedOnlyOncePerProcess", False),
        ("canGetAndSetFMUstate", True),
        ("canSerializeFMUstate", True),
    ],
)
def test_capabilities_are_stated(description, capability, has):
    assert getattr(description.coSimulation, capability) is has


def test_units_and_display_units_are_pints(description):
    registry = pint.UnitRegistry()

    def one(name: str) -> pint.Quantity:
        return registry.Quantity(1.0, re.sub(r"([a-z])([23])", r"\1**\2", name.replace(".", "*")))

    for defined in description.unitDefinitions:
        base = defined.baseUnit
        if defined.name == "1":
            assert all(
                getattr(base, exponent) == 0
                for exponent in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
            )
            continue
        powers = {n: getattr(base, n) for n in ("kg", "m", "s", "rad") if getattr(base, n)}
        written = "*".join(f"{n}**{e}" for n, e in powers.items())
        assert one(defined.name).to(written).magnitude == pytest.approx(1.0, rel=1e-15), (
            defined.name
        )
        for shown in defined.displayUnits:
            factor = one(defined.name).to(one(shown.name).units).magnitude
            assert float(shown.factor) == pytest.approx(factor, rel=1e-14), shown.name


def test_every_real_variable_has_a_type_of_its_unit_and_display_unit(description, variables):
    reals = [v for v in variables.values() if v.type == "Real"]
    kinds: dict[str, set[str]] = {}
    for v in reals:
        assert v.declaredType is not None, v.name
        assert (v.declaredType.unit, v.declaredType.displayUnit) == (v.unit, v.displayUnit), v.name
        assert v.unit, v.name
        kinds.setdefault(v.unit, set()).add(v.declaredType.quantity)
    assert all(len(kind) == 1 for kind in kinds.values()), kinds
    assert {t.name for t in description.typeDefinitions} == {v.declaredType.name for v in reals}


def test_variables_have_the_attributes_that_their_causality_asks_for(variables):
    for v in variables.values():
        assert v.description, v.name
        if v.causality == "parameter":
            assert (v.variability, v.initial) == ("fixed", "exact")
            assert v.start is not None
            assert v.type == "String" or float(v.min) <= float(v.start) <= float(v.max)
        elif v.causality == "input":
            assert v.variability == "continuous"
            assert float(v.start) == 0.0
            assert float(v.min) < 0.0 < float(v.max)
        else:
            assert (v.initial, v.start) == ("calculated", None)
            assert v.causality == ("local" if v.name.startswith("solver.") else "output")
            assert v.variability == ("continuous" if v.type == "Real" else "discrete")
        assert v.type != "Real" or v.causality == "parameter" or float(v.nominal) > 0.0


def test_inputs_state_no_initial(fmu):
    root = etree.fromstring(ZipFile(fmu).read("modelDescription.xml"))
    assert root.xpath("//ScalarVariable[@causality='input']/@name") == [
        q.name for q in INPUT_QUANTITIES
    ]
    assert root.xpath("//ScalarVariable[@causality='input']/@initial") == []


def test_outputs_keep_their_bounds_and_are_of_their_nominal_order(variables):
    """The energies are one balance and so have one scale, which the smallest of them do not reach."""
    histories = []
    for mode in MODES:
        landing = Landing(load_preset(FIGURES, mode))
        landing.set_inputs({"external.force_x": 300.0, "ground.heave_rate": 0.02})
        histories.append(landing.run(1.0, 1e-3))
    for q in OUTPUT_QUANTITIES:
        v = variables[q.name]
        curve = np.concatenate([h[q.name] for h in histories])
        assert curve.min() >= (float(v.min) if v.min is not None else -math.inf), q.name
        assert curve.max() <= (float(v.max) if v.max is not None else math.inf), q.name
        if v.type == "Real":
            largest = abs(curve).max() / float(v.nominal)
            assert largest < 100.0, q.name
            assert largest > 0.01 or q.name.startswith("energy."), q.name


def declared(unknowns) -> dict[str, set[str]]:
    """Names that each unknown depends on; a missing attribute would mean all of them."""
    assert all(u.dependencies is not None for u in unknowns)
    return {u.variable.name: {d.name for d in u.dependencies} for u in unknowns}


def changed(before: list[float], after: list[float]) -> set[str]:
    """Outputs that differ by more than rounding: a billionth of their nominal value."""
    return {
        name for name, a, b in zip(OUTPUT_NAMES, before, after) if abs(a - b) > 1e-9 * SCALE[name]
    }


def note(found: dict[str, set[str]], cause: str, outputs: Iterable[str]) -> None:
    for name in outputs:
        found[name].add(cause)


def observe_inputs(landing: Landing, found: dict[str, set[str]]) -> None:
    """Move each input by itself, now, without a step, and note which outputs change."""
    state, before = landing.state(), landing.values()
    for name, sign in product(STEPS, (1.0, -1.0)):
        landing.restore(state)
        landing.set_inputs({name: sign * STEPS[name]})
        note(found, name, changed(before, landing.values()))
    landing.restore(state)


def test_outputs_depend_at_once_on_the_inputs_that_are_declared_and_on_no_other(description):
    """From free flight to rest: a landing at rest is where a load changes the phase at once."""
    found: dict[str, set[str]] = {name: set() for name in OUTPUT_NAMES}
    for mode in MODES:
        landing = Landing(load_preset(FIGURES, mode))
        for time in (0.05, 0.12, 0.2, 0.35, 0.6, 3.0):
            landing.advance_to(time)
            observe_inputs(landing, found)
        assert landing.get("status.phase") == 2.0
    assert [u.variable.name for u in description.outputs] == list(OUTPUT_NAMES)
    assert declared(description.outputs) == found


def start(values: dict[str, float | str], inputs: dict[str, float]) -> list[float]:
    """The outputs at time 0."""
    landing = Landing(Parameters().with_values(values))
    landing.set_inputs(inputs)
    return landing.values()


def others(name: str, value: float | str) -> list[float | str]:
    """Values of a parameter near `value`, or its other choices."""
    q = PARAMETER_QUANTITIES[name]
    if isinstance(value, str):
        return [c for c in q.choices if c != value]
    near = [value * 1.01 + (1e-4 if value == 0.0 else 0.0), value * 0.99]
    return [v for v in near if q.lo <= v <= q.hi]


def observe_parameters(
    values: dict[str, float | str],
    inputs: dict[str, float],
    note_changes: Callable[[str, set[str]], None],
) -> None:
    """Move each parameter by itself and note which outputs change at time 0."""
    base, before = Parameters().with_values(values), start(values, inputs)
    for name in PARAMETER_QUANTITIES:
        for value in others(name, base[name]):
            note_changes(name, changed(before, start({**values, name: value}, inputs)))


def raised(values: dict[str, float | str], leg: int, depth: float) -> dict[str, float]:
    """The lift of the ground at which the footpad of `leg` is `depth` [m] in it at time 0."""
    landing = Landing(Parameters().with_values(values))
    slope = landing.parameters.ground.slope
    return {
        "ground.heave": (landing.get(f"leg[{leg}].contact.penetration") - depth) / -math.cos(slope)
    }


def deepest(values: dict[str, float | str]) -> dict[str, float]:
    """The lift at which every footpad is 5 mm in the ground, or deeper."""
    return {"ground.heave": max(raised(values, leg, 5e-3)["ground.heave"] for leg in LEGS)}


def on_the_verge(values: dict[str, float | str]) -> dict[str, float]:
    """Inputs at which the body's accelerations are a hair below the limit of a vehicle at rest
    (0.05 in sum, to 5e-11).
    """
    names = ("external.force_x", "external.force_y", "external.moment")
    lifted = deepest(values)

    def accelerations(loads: Iterable[float]) -> np.ndarray:
        out = dict(zip(OUTPUT_NAMES, start(values, {**lifted, **dict(zip(names, loads))})))
        return np.array([out["body.ax"], out["body.ay"], out["body.pitch_acceleration"]])

    target, loads = np.array([0.02, 0.02, 0.01 - 5e-11]), np.zeros(3)
    for _ in range(2):
        now = accelerations(loads)
        gains = np.array(
            [(accelerations(loads + 100.0 * row) - now) / 100.0 for row in np.eye(3)]
        ).T
        loads = loads + np.linalg.solve(gains, target - now)
    return {**lifted, **dict(zip(names, loads.tolist()))}


def test_initial_values_depend_on_the_parameters_and_inputs_that_are_declared_and_on_no_other(
    description,
):
    found: dict[str, set[str]] = {name: set() for name in OUTPUT_NAMES}
    for mode, where in product(MODES, PARAMETER_QUANTITIES["vehicle.transverse_load_at"].choices):
        choice: dict[str, float | str] = {"drop.mode": mode, "vehicle.transverse_load_at": where}
        values = {**MOVED, **choice}
        observe_parameters(
            values, {**LOADS, **deepest(values)}, lambda name, outputs: note(found, name, outputs)
        )
        standing = {**STANDING, **choice}
        verge = on_the_verge(standing)
        assert dict(zip(OUTPUT_NAMES, start(standing, verge)))["status.phase"] == 2.0
        observe_parameters(
            standing, verge, lambda name, outputs: note(found, name, outputs & {"status.phase"})
        )
        for leg in LEGS:
            active = f"leg[{leg}].contact.active"
            just = {**LOADS, **raised(values, leg, 1e-11)}
            observe_parameters(
                values,
                just,
                lambda name, outputs, active=active: note(found, name, outputs & {active}),
            )
        for begun, inputs in ((values, {}), (values, deepest(values)), (standing, verge)):
            landing = Landing(Parameters().with_values(begun))
            landing.set_inputs(inputs)
            observe_inputs(landing, found)
    assert [u.variable.name for u in description.initialUnknowns] == list(OUTPUT_NAMES)
    assert declared(description.initialUnknowns) == found


def test_dependencies_stand_in_ascending_order(fmu):
    for text in etree.fromstring(ZipFile(fmu).read("modelDescription.xml")).xpath(
        "//Unknown/@dependencies"
    ):
        assert all(a < b for a, b in pairwise(int(number) for number in text.split()))
