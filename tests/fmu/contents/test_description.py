"""The FMU's description, read by FMPy: variables, units, types, bounds, capabilities.

Its units are compared with pint's.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from zipfile import ZipFile

import fmpy
import numpy as np
import pint
import pytest
from lxml import etree

from rlv_landing import Landing, __version__, load_preset
from rlv_landing.quantities import INPUT_QUANTITIES, MODES, OUTPUT_QUANTITIES

FIGURES = "yue2022-figures"


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
        ("needsExecutionTool", False),
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
            assert v.causality == ("local" if v.name.startswith(("solver.", "peak.")) else "output")
            assert v.variability == ("continuous" if v.type == "Real" else "discrete")
        assert v.type != "Real" or v.causality == "parameter" or float(v.nominal) > 0.0


def test_inputs_state_no_initial(fmu):
    root = etree.fromstring(ZipFile(fmu).read("modelDescription.xml"))
    assert root.xpath("//ScalarVariable[@causality='input']/@name") == [
        q.name for q in INPUT_QUANTITIES
    ]
    assert root.xpath("//ScalarVariable[@causality='input']/@initial") == []


def test_outputs_keep_their_bounds_and_are_of_their_nominal_order(variables):
    """Outputs stay within their bounds, and their nominal values have the right order.

    The energies are terms of one balance and have one scale, which the smallest do not reach.
    """
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
