"""The modelDescription.xml of FMI 3.0, made from the complete one of FMI 2.0."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

from rlv_landing.quantities import Quantity

from ..dependencies import dependencies_of
from ..description import DIMENSIONLESS, type_name
from ..wanted import Wanted
from .arrays import TIME, Variable, variables, whole_meaning

TYPES = {"real": "Float64", "integer": "Int32", "boolean": "Boolean", "string": "String"}
CAPABILITIES = {
    "needsExecutionTool": False,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canGetAndSetFMUState": True,
    "canSerializeFMUState": True,
    "canHandleVariableCommunicationStepSize": True,
    "providesIntermediateUpdate": True,
    "mightReturnEarlyFromDoStep": True,
    "canReturnEarlyAfterIntermediateUpdate": True,
    "hasEventMode": True,
}
# attributes of the root that are the same in both versions
SAME = (
    "modelName",
    "description",
    "author",
    "version",
    "copyright",
    "license",
    "generationTool",
    "generationDateAndTime",
    "variableNamingConvention",
)


def describe3(root: Element, wanted: Wanted) -> Element:
    """The description of FMI 3.0.

    Args:
        root: Root of the complete description of FMI 2.0.
        wanted: The FMU.
    """
    made = Element("fmiModelDescription", fmiVersion="3.0")
    made.set("instantiationToken", root.attrib["guid"])
    for name in SAME:
        made.set(name, root.attrib[name])
    simulation = SubElement(made, "CoSimulation")
    simulation.set("modelIdentifier", _child(root, "CoSimulation").attrib["modelIdentifier"])
    for capability, can in CAPABILITIES.items():
        simulation.set(capability, str(can).lower())
    made.append(_child(root, "UnitDefinitions"))
    made.append(_types(_child(root, "TypeDefinitions")))
    made.append(_child(root, "LogCategories"))
    made.append(_child(root, "DefaultExperiment"))
    scalars = list(_child(root, "ModelVariables"))
    whole = variables([v.attrib["name"] for v in scalars])
    made.append(_model_variables(whole, scalars, wanted.quantities))
    made.append(_structure(whole, wanted))
    return made


def _child(root: Element, name: str) -> Element:
    found = root.find(name)
    assert found is not None, name
    return found


def _types(of_fmi2: Element) -> Element:
    node = Element("TypeDefinitions")
    for simple in of_fmi2:
        SubElement(node, "Float64Type", {"name": simple.attrib["name"], **simple[0].attrib})
    return node


def _model_variables(
    whole: list[Variable], scalars: list[Element], quantities: dict[str, Quantity]
) -> Element:
    node = Element("ModelVariables")
    SubElement(
        node,
        TYPES["real"],
        name=TIME,
        valueReference=str(len(scalars)),
        causality="independent",
        variability="continuous",
        description="Simulation time",
        unit="s",
    )
    for variable in whole:
        q = quantities[variable.elements[0]]
        node.append(_variable(variable, scalars[variable.reference], q))
    return node


def _variable(variable: Variable, scalar: Element, q: Quantity) -> Element:
    """The element of a variable.

    Args:
        variable: The variable.
        scalar: Its first element in the description of FMI 2.0.
        q: What that is.
    """
    node = Element(TYPES[q.kind], name=variable.name, valueReference=str(variable.reference))
    node.set("causality", scalar.attrib["causality"])
    node.set("variability", scalar.attrib["variability"])
    if scalar.get("initial"):
        node.set("initial", scalar.attrib["initial"])
    meaning = whole_meaning(q.meaning) if len(variable.elements) > 1 else q.meaning
    node.set("description", meaning)
    typed = scalar[0]
    if q.kind == "real":
        node.set("declaredType", type_name(q))
        node.set("unit", q.unit or DIMENSIONLESS)
    for attribute in ("displayUnit", "min", "max", "nominal"):
        if attribute in typed.attrib:
            node.set(attribute, typed.attrib[attribute])
    if scalar.attrib["causality"] in ("input", "output") and q.kind == "real":
        node.set("intermediateUpdate", "true")
    start = typed.get("start")
    if start is not None and q.kind == "string":
        SubElement(node, "Start", value=start)
    elif start is not None:
        node.set("start", start)
    if len(variable.elements) > 1:
        SubElement(node, "Dimension", start=str(len(variable.elements)))
    return node


def _structure(whole: list[Variable], wanted: Wanted) -> Element:
    """ModelStructure: outputs and initial unknowns with what they depend on."""
    dependencies, names = dependencies_of(wanted.interface), set(wanted.interface.output_names)
    references = {element: v.reference for v in whole for element in v.elements}
    outputs = [v for v in whole if v.elements[0] in names]
    node = Element("ModelStructure")
    for tag, known in (("Output", dependencies.inputs), ("InitialUnknown", dependencies.at_start)):
        for v in outputs:
            numbers = sorted({references[name] for e in v.elements for name in known(e)})
            found = " ".join(map(str, numbers))
            SubElement(node, tag, valueReference=str(v.reference), dependencies=found)
    return node
