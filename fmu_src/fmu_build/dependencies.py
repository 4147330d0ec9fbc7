"""Dependencies of each output for the FMU's ModelStructure: on inputs and on parameters.

An output depends on an input if the input changes it at the same instant. Its initial value depends
on the parameters that change it, and on the inputs that do: these place the vehicle at the start.
The sets are derived from the equations. `tests/fmu/contents/test_dependencies.py` finds the same
ones by changing every input and parameter. Outputs that are not named here are states, or follow
from states alone: no input changes them at once. Heave and tilt of the ground change no output at
once either: the ground moves to a new position from the next step on.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from rlv_landing.quantities import TRIPOD, Interface

from . import in_space

LOADS = frozenset({"external.force_x", "external.force_y", "external.moment"})
RATES = frozenset({"ground.heave_rate", "ground.tilt_rate"})
GROUND = RATES | {"ground.heave", "ground.tilt"}

# parameters that set the footpads' place on the body, and those of the free flight before contact
LEG = frozenset(
    f"{strut}.{what}"
    for strut in ("main_strut", "auxiliary_strut")
    for what in ("joint_radius", "joint_depth", "length")
)
PITCH = frozenset({"drop.tilt", "drop.pitch_rate", "drop.contact_time"})
FLIGHT = PITCH | LEG | {"vehicle.mass", "vehicle.footpad_mass"}
VX = FLIGHT | {"drop.horizontal_velocity"}
VY = FLIGHT | {"drop.vertical_velocity", "ground.gravity"}
HEIGHT = VY | {"ground.slope", "drop.mode"}
CHARGE = frozenset(
    f"main_strut.{what}"
    for what in ("kind", "charge_pressure", "ambient_pressure", "area_upper", "area_lower")
)
PRESSURE = frozenset({"main_strut.kind", "main_strut.charge_pressure"})
VOLUMES = frozenset(
    f"main_strut.{what}"
    for what in ("kind", "volume_upper", "volume_lower", "charge_pressure", "ambient_pressure")
)
LIQUID = VOLUMES | {
    f"main_strut.{what}"
    for what in ("air_fraction", "air_exponent", "bulk_modulus", "bulk_modulus_slope")
}
# the forces of all legs' struts are equal at the start, so they give the body no moment
TURN = FLIGHT | {"vehicle.inertia", "vehicle.transverse_load_at"}
MARGIN = PITCH | LEG | {"vehicle.mass", "vehicle.footpad_mass", "drop.mode"}

INPUTS: dict[str, frozenset[str]] = {
    "body.ax": LOADS | RATES,
    "body.ay": LOADS | RATES,
    "body.pitch_acceleration": LOADS | RATES,
    "body.top_axial_acceleration": frozenset({"external.force_x", "external.force_y"}),
    "status.phase": LOADS | RATES,
    "contact.force_x": RATES,
    "contact.force_y": RATES,
    "contact.force_z": RATES,
    "contact.force": RATES,
}

START_INPUTS: dict[str, frozenset[str]] = {
    "body.y": GROUND,
    "body.ax": LOADS,
    "body.ay": LOADS,
    "body.pitch_acceleration": LOADS,
    "body.top_axial_acceleration": INPUTS["body.top_axial_acceleration"],
    "energy.potential": GROUND,
    "footpad.y": GROUND,
    "contact.penetration": GROUND - {"ground.heave"},
}

PARAMETERS: dict[str, frozenset[str]] = {
    "body.x": VX,
    "body.y": HEIGHT,
    "body.pitch": PITCH,
    "body.vx": VX,
    "body.vy": VY,
    "body.pitch_rate": frozenset({"drop.pitch_rate"}),
    "body.ax": TURN | CHARGE,
    "body.ay": TURN | CHARGE | {"ground.gravity"},
    "body.pitch_acceleration": TURN,
    "body.top_axial_acceleration": PITCH
    | LEG
    | CHARGE
    | {"vehicle.mass", "vehicle.top_height", "ground.gravity"},
    "energy.kinetic": VX | VY | {"vehicle.inertia"},
    "energy.potential": HEIGHT,
    "energy.liquid": LIQUID,
    "status.phase": MARGIN,
    "status.stability_margin": MARGIN,
    "main_strut.force": CHARGE,
    "main_strut.pressure_upper": PRESSURE,
    "main_strut.pressure_lower": PRESSURE,
    "main_strut.liquid_mass": LIQUID | {"main_strut.fluid_density"},
    "footpad.x": VX | {"drop.mode"},
    "footpad.y": HEIGHT,
    "footpad.z": LEG | {"drop.mode"},
    "contact.penetration": VX | HEIGHT,
}


@dataclass(frozen=True)
class Dependencies:
    """What the outputs depend on, those of all legs alike.

    Attributes:
        inputs_of: The inputs that change an output at once.
        start_inputs_of: The inputs that its initial value depends on.
        parameters_of: The parameters that its initial value depends on.
    """

    inputs_of: Mapping[str, frozenset[str]]
    start_inputs_of: Mapping[str, frozenset[str]]
    parameters_of: Mapping[str, frozenset[str]]

    def inputs(self, output: str) -> frozenset[str]:
        """The inputs that change `output` at the instant at which they change themselves."""
        return self.inputs_of.get(_of_any_leg(output), frozenset())

    def at_start(self, output: str) -> frozenset[str]:
        """The inputs and parameters that the initial value of `output` depends on.

        No footpad is in the ground at the start, so contact forces depend on none.
        """
        name = _of_any_leg(output)
        return self.start_inputs_of.get(name, frozenset()) | self.parameters_of.get(
            name, frozenset()
        )


IN_A_PLANE = Dependencies(INPUTS, START_INPUTS, PARAMETERS)
IN_SPACE = Dependencies(in_space.INPUTS, in_space.START_INPUTS, in_space.PARAMETERS)
ON_TRIPODS = Dependencies(in_space.INPUTS, in_space.START_INPUTS, in_space.OF_TRIPODS)


def dependencies_of(interface: Interface) -> Dependencies:
    """What the outputs of an interface depend on."""
    if not interface.in_space:
        return IN_A_PLANE
    return ON_TRIPODS if interface.leg_kind == TRIPOD else IN_SPACE


def _of_any_leg(output: str) -> str:
    return re.sub(r"^leg\[\d+\]\.", "", output)
