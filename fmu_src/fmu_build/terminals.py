"""The file terminalsAndIcons.xml of FMI 3.0: variables that belong together, and the icon.

A terminal names variables, not elements of arrays, so the legs are one terminal with one for each
of their parts. An importer connects the inputs of `ground` and `external` as a whole.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement
from zipfile import ZipFile

import fmpy
from lxml import etree

from rlv_landing.quantities import flat_name

FOLDER = "terminalsAndIcons"
SCHEMA = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"
# half the width of the icon in its own coordinates, and how many mm one of them is
HALF, SCALE = 100, 0.1
# terminal of scalars -> (prefix of its variables, matching rule, meaning)
TERMINALS = {
    "external": (
        "external.",
        "plug",
        "wrench on the body at its CG: forces and moments, inertial axes",
    ),
    "ground": ("ground.", "plug", "motion of the ground, and its rates"),
    "body": ("body.", "bus", "motion of the body"),
}
PARTS = {
    "main_strut": "axial force, stroke and pressures of the main struts",
    "auxiliary_strut": "axial force and stroke of the auxiliary struts",
    "auxiliary_strut_2": "axial force and stroke of the second auxiliary struts",
    "footpad": "positions of the footpads",
    "contact": "forces of the ground on the footpads",
}


def write_terminals(files: Path, description: Element) -> None:
    """Write terminalsAndIcons.xml, and move the icon beside it.

    Args:
        files: Folder of the unpacked FMU, with the icon as FMI 2.0 has it.
        description: Root of its description in FMI 3.0.
    """
    folder = files / FOLDER
    folder.mkdir()
    (files / "model.png").rename(folder / "icon.png")
    tree = ElementTree.ElementTree(terminals_and_icons(description))
    ElementTree.indent(tree, "\t")
    tree.write(folder / f"{FOLDER}.xml", encoding="UTF-8", xml_declaration=True)


def terminals_and_icons(description: Element) -> Element:
    """Root of the file, for a description of FMI 3.0."""
    root = Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    picture = SubElement(root, "GraphicalRepresentation")
    corners = {"x1": str(-HALF), "y1": str(-HALF), "x2": str(HALF), "y2": str(HALF)}
    SubElement(picture, "CoordinateSystem", corners, suggestedScalingFactorTo_mm=str(SCALE))
    SubElement(picture, "Icon", corners)
    terminals = SubElement(root, "Terminals")
    connected = [
        v.attrib["name"]
        for v in description.findall("ModelVariables/*")
        if v.get("causality") in ("input", "output")
    ]
    named = flat_name if description.get("variableNamingConvention") == "flat" else str
    for name, (prefix, rule, meaning) in TERMINALS.items():
        _terminal(terminals, name, rule, meaning, named(prefix), connected)
    legs = _terminal(terminals, "legs", "bus", "the legs; element k is leg k", "", [])
    for part, meaning in PARTS.items():
        prefix = named(f"leg.{part}.")
        # where names are flat, those of another part may begin alike
        longer = [p for p in map(named, (f"leg.{p}." for p in PARTS)) if len(p) > len(prefix)]
        own = [v for v in connected if v.startswith(prefix) and not any(map(v.startswith, longer))]
        if own:
            _terminal(legs, part, "bus", meaning, prefix, own)
    return root


def _terminal(
    parent: Element, name: str, rule: str, meaning: str, prefix: str, variables: list[str]
) -> Element:
    node = SubElement(parent, "Terminal", name=name, matchingRule=rule, description=meaning)
    for variable in variables:
        if variable.startswith(prefix):
            SubElement(
                node,
                "TerminalMemberVariable",
                variableName=variable,
                memberName=variable.removeprefix(prefix),
                variableKind="signal",
            )
    return node


def faults(fmu: Path) -> list[str]:
    """What is wrong with the file in an FMU, by the schema of FMI 3.0."""
    with ZipFile(fmu) as archive:
        root = etree.fromstring(archive.read(f"{FOLDER}/{FOLDER}.xml"))
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    schema.validate(root)
    return [str(error) for error in schema.error_log]
