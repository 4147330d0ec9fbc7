"""The FMU of FMI 3.0: what its files say, by FMPy, by the standard's schemas and by FMI 2.0's."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree
from zipfile import ZipFile

import fmpy
import pytest
from fmpy.validation import validate_fmu
from lxml import etree

from rlv_landing.quantities import flat_name
from rlv_ros_bridge.fmu.description import places

SCHEMAS = Path(fmpy.__file__).parent / "schema" / "fmi3"
TERMINALS = "terminalsAndIcons/terminalsAndIcons.xml"


@pytest.fixture(scope="module")
def archive(fmu3: Path) -> ZipFile:
    return ZipFile(fmu3)


@pytest.fixture(scope="module")
def terminals(archive):
    return etree.fromstring(archive.read(TERMINALS))


def whole(name: str) -> str:
    return re.sub(r"leg\[\d\]", "leg", name)


def test_fmpy_finds_no_problem_and_both_files_follow_the_schemas(fmu3, archive):
    assert validate_fmu(str(fmu3)) == []
    for file, schema in (
        ("modelDescription.xml", "fmi3ModelDescription.xsd"),
        (TERMINALS, "fmi3TerminalsAndIcons.xsd"),
    ):
        etree.XMLSchema(etree.parse(str(SCHEMAS / schema))).assertValid(
            etree.fromstring(archive.read(file))
        )


def test_flat_names_are_those_of_the_same_arrays(fmu, fmu3, tmp_path):
    from fmu_build.fmi3.description import describe3
    from fmu_build.terminals import terminals_and_icons
    from fmu_build.wanted import Wanted

    root = ElementTree.fromstring(ZipFile(fmu).read("modelDescription.xml"))
    root.set("variableNamingConvention", "flat")
    for variable in root.iter("ScalarVariable"):
        variable.set("name", flat_name(variable.attrib["name"]))
    made = describe3(root, Wanted())
    file = tmp_path / "modelDescription.xml"
    file.write_bytes(ElementTree.tostring(made))
    flat, structured = (fmpy.read_model_description(str(f)) for f in (file, fmu3))
    assert [v.name for v in flat.modelVariables] == [
        flat_name(v.name) for v in structured.modelVariables
    ]
    assert places(flat, file) == places(structured, fmu3)
    assert ElementTree.tostring(made.find("ModelStructure")) == ElementTree.tostring(
        describe3(ElementTree.fromstring(ZipFile(fmu).read("modelDescription.xml")), Wanted()).find(
            "ModelStructure"
        )
    )
    members = {m.get("variableName") for m in terminals_and_icons(made).iter()}
    assert {"leg_contact_force", "external_moment", "body_y"} <= members


def test_files_are_those_of_fmi_2_in_the_places_of_fmi_3(archive, fmu):
    names = set(archive.namelist())
    assert {
        "binaries/x86_64-linux/RlvLanding.so",
        "terminalsAndIcons/icon.png",
        "documentation/index.html",
        "documentation/licenses/LICENSE",
    } <= names
    assert not {name for name in names if name.startswith(("binaries/linux64", "model.png"))}
    assert archive.read("terminalsAndIcons/icon.png") == ZipFile(fmu).read("model.png")
    page = archive.read("documentation/index.html").decode()
    assert "FMI 3.0, co-simulation" in page
    assert "fmi2" not in page
    assert "leg.contact.force[4]" in page
    token = fmpy.read_model_description(archive.filename).instantiationToken
    assert token in page
    assert token != fmpy.read_model_description(str(fmu)).guid


def test_variables_are_those_of_fmi_2_the_legs_as_arrays(description, description3):
    """Each has the type, unit, bounds, causality, variability and start of its elements."""
    types = {"Real": "Float64", "Integer": "Int32", "Boolean": "Boolean", "String": "String"}
    made = {v.name: v for v in description3.modelVariables}
    assert made.pop("time").causality == "independent"
    elements: dict[str, list[int]] = {}
    for v in description.modelVariables:
        elements.setdefault(whole(v.name), []).append(v.valueReference)
        ours = made[whole(v.name)]
        assert ours.type == types[v.type]
        for attribute in ("unit", "displayUnit", "causality", "variability", "start", "nominal"):
            assert getattr(ours, attribute) == getattr(v, attribute), (v.name, attribute)
        for bound in ("min", "max"):
            assert getattr(ours, bound) == getattr(v, bound), (v.name, bound)
        assert "leg 1" not in ours.description
    assert set(made) == set(elements)
    for name, references in elements.items():
        size = [int(d.start) for d in made[name].dimensions]
        assert size == ([4] if len(references) == 4 else [])
        assert made[name].valueReference == references[0]


def test_dependencies_are_those_of_fmi_2(description, description3):
    def known(of, unknowns):
        return {
            whole(u.variable.name): sorted(d.name for d in u.dependencies)
            for u in getattr(of, unknowns)
        }

    for unknowns in ("outputs", "initialUnknowns"):
        assert known(description, unknowns) == known(description3, unknowns)


def test_only_continuous_inputs_and_outputs_are_for_intermediate_updates(archive):
    root = etree.fromstring(archive.read("modelDescription.xml"))
    for v in root.find("ModelVariables"):
        expected = v.tag == "Float64" and v.get("causality") in ("input", "output")
        assert (v.get("intermediateUpdate") == "true") == expected, v.get("name")


def test_units_have_their_base_units_and_types_their_units(archive, fmu):
    def table(file):
        root = etree.fromstring(ZipFile(file).read("modelDescription.xml"))
        units = etree.tostring(root.find("UnitDefinitions"), method="c14n")
        types = {t.get("name"): t for t in root.find("TypeDefinitions")}
        return units, types

    (units, types), (units2, types2) = table(archive.filename), table(fmu)
    assert units == units2
    assert set(types) == set(types2)
    for name, t in types.items():
        assert t.tag == "Float64Type"
        assert {"name": name, **types2[name][0].attrib} == dict(t.attrib)


def test_terminals_group_all_inputs_and_the_outputs_of_body_and_legs(terminals, description3):
    members = [m.get("variableName") for m in terminals.iter("TerminalMemberVariable")]
    assert len(set(members)) == len(members)
    connected = {
        v.name
        for v in description3.modelVariables
        if v.causality == "input"
        or (v.causality == "output" and v.name.startswith(("body.", "leg.")))
    }
    assert set(members) == connected
    for terminal in terminals.iter("Terminal"):
        names = [m.get("memberName") for m in terminal.findall("TerminalMemberVariable")]
        assert len(set(names)) == len(names)
    assert [t.get("name") for t in terminals.findall("Terminals/Terminal")] == [
        "external",
        "ground",
        "body",
        "legs",
    ]
    assert terminals.find("GraphicalRepresentation/Icon") is not None
