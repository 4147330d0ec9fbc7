"""Completes pythonfmu's modelDescription.xml from the table of quantities.

Adds units, types, bounds, nominal values and exact start values of the variables, dependencies of
the outputs, and attributes of the model.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement

from rlv_landing import __version__
from rlv_landing.quantities import BASE_UNITS, DISPLAY_UNITS, Quantity, flat_name

from .dependencies import dependencies_of
from .wanted import Wanted

DIMENSIONLESS = "1"
IN_SPACE = "Touchdown of a vertical-landing rocket stage in space: six degrees of freedom, any legs"
# SI unit -> physical kind, FMI's `quantity`
PHYSICAL_KINDS = {
    "m": "Length",
    "m2": "Area",
    "m3": "Volume",
    "s": "Time",
    "kg": "Mass",
    "rad": "Angle",
    "rad/s": "AngularVelocity",
    "rad/s2": "AngularAcceleration",
    "m/s": "Velocity",
    "m/s2": "Acceleration",
    "s/m": "TimePerLength",
    "1/s": "Rate",
    "N": "Force",
    "N.m": "Torque",
    "N/m": "TranslationalSpringConstant",
    "N.s/m": "TranslationalDampingConstant",
    "N/Pa": "ForcePerPressure",
    "J": "Energy",
    "Pa": "Pressure",
    "kg/m3": "Density",
    "kg.m2": "MomentOfInertia",
    DIMENSIONLESS: "Dimensionless",
}
CAPABILITIES = {
    "needsExecutionTool": False,  # a library in the process is no external tool
    "canHandleVariableCommunicationStepSize": True,
    "canInterpolateInputs": True,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canGetAndSetFMUstate": True,
    "canSerializeFMUstate": True,
}


def describe(root: Element, date: str, wanted: Wanted) -> None:
    """Complete pythonfmu's description in place.

    Args:
        root: Root of modelDescription.xml.
        date: Value of `generationDateAndTime`, ISO 8601 in UTC.
        wanted: Vehicle, and names of model and variables.
    """
    root.set("generationTool", f"rlv-landing {__version__} with {root.get('generationTool')}")
    root.set("generationDateAndTime", date)
    simulation, experiment, variables, structure = (
        root.find(name)
        for name in ("CoSimulation", "DefaultExperiment", "ModelVariables", "ModelStructure")
    )
    assert simulation is not None
    assert experiment is not None
    assert variables is not None
    assert structure is not None
    for capability, can in CAPABILITIES.items():
        simulation.set(capability, str(can).lower())
    root.insert(1, unit_definitions())
    quantities = wanted.quantities
    root.insert(2, type_definitions(quantities.values()))
    names = [v.attrib["name"] for v in variables]
    for name, variable in zip(names, variables):
        complete(variable, quantities[name], wanted.values.get(name))
        if wanted.flat_names:
            variable.set("name", flat_name(name))
    structure.clear()
    structure.extend(unknowns(names, wanted))
    if wanted.interface.in_space:
        root.set("description", IN_SPACE)
    root.set("modelName", wanted.name)
    simulation.set("modelIdentifier", wanted.name)
    experiment.set("stopTime", str(wanted.stop_time))
    if wanted.values:
        source = f" ({wanted.source})" if wanted.source else ""
        root.set("description", f"{root.get('description')}: {wanted.vehicle}{source}")
    if wanted.flat_names:
        root.set("variableNamingConvention", "flat")


def type_name(q: Quantity) -> str:
    """Name of a real quantity's type: its physical kind, and its display unit if it has one."""
    kind = PHYSICAL_KINDS[q.unit or DIMENSIONLESS]
    return f"{kind}_{q.display_unit.replace('/', '_per_')}" if q.display_unit else kind


def unit_definitions() -> Element:
    """Every SI unit of the table in base units, with its display units."""
    node = Element("UnitDefinitions")
    for unit, exponents in {**BASE_UNITS, DIMENSIONLESS: {}}.items():
        element = SubElement(node, "Unit", name=unit)
        SubElement(element, "BaseUnit", {base: str(e) for base, e in exponents.items()})
        for display, (si, factor) in DISPLAY_UNITS.items():
            if si == unit:
                SubElement(element, "DisplayUnit", name=display, factor=repr(1.0 / factor))
    return node


def type_definitions(quantities: Iterable[Quantity]) -> Element:
    """A type for each physical kind and display unit of the `quantities`."""
    node = Element("TypeDefinitions")
    types = {type_name(q): q for q in quantities if q.kind == "real"}
    for name in sorted(types):
        q = types[name]
        of_kind = SubElement(SubElement(node, "SimpleType", name=name), "Real")
        of_kind.set("quantity", PHYSICAL_KINDS[q.unit or DIMENSIONLESS])
        _set_units(of_kind, q)
    return node


def complete(variable: Element, q: Quantity, start: float | str | None = None) -> None:
    """Set type, unit, bounds, nominal value and start of the `variable` of the quantity `q`.

    The unit is set here as well as in the type, for importers that read no types. Start values
    have all digits.

    Args:
        variable: The variable.
        q: The quantity.
        start: The start value; None: the quantity's default.
    """
    typed = variable[0]
    if q.kind == "real":
        typed.set("declaredType", type_name(q))
        _set_units(typed, q)
        if "start" in typed.attrib:
            typed.set("start", repr(float(q.default if start is None else start)))
        if variable.get("causality") != "parameter":
            typed.set("nominal", repr(q.nominal))
    if q.kind in ("real", "integer"):
        for attribute, bound in (("min", q.lo), ("max", q.hi)):
            if math.isfinite(bound):
                typed.set(attribute, repr(float(bound)) if q.kind == "real" else str(int(bound)))


def _set_units(typed: Element, q: Quantity) -> None:
    typed.set("unit", q.unit or DIMENSIONLESS)
    if q.display_unit:
        typed.set("displayUnit", q.display_unit)


def unknowns(names: list[str], wanted: Wanted) -> list[Element]:
    """The elements Outputs and InitialUnknowns of ModelStructure, with their dependencies.

    Args:
        names: All variables, in the order of the description.
        wanted: The FMU.
    """
    known_of = dependencies_of(wanted.interface)
    index = {name: i for i, name in enumerate(names, start=1)}
    outputs, initial = Element("Outputs"), Element("InitialUnknowns")
    for name in wanted.interface.output_names:
        for node, known in ((outputs, known_of.inputs(name)), (initial, known_of.at_start(name))):
            numbers = sorted(index[cause] for cause in known)
            SubElement(
                node, "Unknown", index=str(index[name]), dependencies=" ".join(map(str, numbers))
            )
    return [outputs, initial]
