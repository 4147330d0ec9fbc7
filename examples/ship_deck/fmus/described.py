"""Variables with units, which pythonfmu's own lack. Both FMUs of this example carry this file."""

from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

BASE_UNITS = {
    "s": {"s": "1"},
    "m": {"m": "1"},
    "m/s": {"m": "1", "s": "-1"},
    "rad": {"rad": "1"},
    "rad/s": {"rad": "1", "s": "-1"},
    "N": {"kg": "1", "m": "1", "s": "-2"},
    "N.m": {"kg": "1", "m": "2", "s": "-2"},
}


class RealWithUnit(Real):
    """A real variable with its unit in the model description."""

    def __init__(self, name: str, unit: str, **attributes):
        super().__init__(name, **attributes)
        self.unit = unit

    def to_xml(self) -> Element:
        """The variable's element, with its unit."""
        element = super().to_xml()
        element[0].set("unit", self.unit)
        return element


class DescribedSlave(Fmi2Slave):
    """A slave whose variables have units: parameters with a start value, and outputs."""

    def parameter(self, name: str, unit: str, start: float, meaning: str) -> None:
        """Register a parameter with its start value."""
        setattr(self, name, start)
        fixed = {
            "causality": Fmi2Causality.parameter,
            "variability": Fmi2Variability.fixed,
            "initial": Fmi2Initial.exact,
        }
        self.register_variable(RealWithUnit(name, unit, description=meaning, **fixed))

    def output(self, name: str, unit: str, meaning: str) -> None:
        """Register an output."""
        setattr(self, name, 0.0)
        calculated = {"causality": Fmi2Causality.output, "initial": Fmi2Initial.calculated}
        self.register_variable(RealWithUnit(name, unit, description=meaning, **calculated))

    def to_xml(self, model_options=None) -> Element:
        """The model description, with unit definitions and initial unknowns."""
        root = super().to_xml(model_options or {})
        definitions = Element("UnitDefinitions")
        for unit, exponents in BASE_UNITS.items():
            SubElement(SubElement(definitions, "Unit", name=unit), "BaseUnit", exponents)
        root.insert(1, definitions)
        structure = root.find("ModelStructure")
        unknowns = SubElement(structure, "InitialUnknowns")
        for unknown in structure.find("Outputs"):
            SubElement(unknowns, "Unknown", index=unknown.get("index"))
        return root
