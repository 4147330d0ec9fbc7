"""What each output depends on: the inputs at the same instant, and at the start the parameters and
inputs that place the vehicle.

For the FMU's ModelStructure.

Written down from the equations; `tests/fmu/test_description.py` finds the same sets by moving every
input and parameter of the model. Outputs that are not named here are states or follow from states
alone: no input changes them at once. Nor do heave and tilt of the ground: it moves to where it was
told to be within the next step. At the start they place the vehicle, and no footpad is in the
ground yet.
"""

from __future__ import annotations

import re

LOADS = frozenset({"external.force_x", "external.force_y", "external.moment"})
RATES = frozenset({"ground.heave_rate", "ground.tilt_rate"})
GROUND = RATES | {"ground.heave", "ground.tilt"}

# parameters: the footpads' place on the body, and what the free flight before the first contact is
# made of
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
    for what in ("charge_pressure", "ambient_pressure", "area_upper", "area_lower")
)
VOLUMES = frozenset(
    f"main_strut.{what}"
    for what in ("volume_upper", "volume_lower", "charge_pressure", "ambient_pressure")
)
LIQUID = VOLUMES | {
    f"main_strut.{what}"
    for what in ("air_fraction", "air_exponent", "bulk_modulus", "bulk_modulus_slope")
}
# the pushes of all legs' struts are equal at the start, so that they do not turn the body
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
    "main_strut.pressure_upper": frozenset({"main_strut.charge_pressure"}),
    "main_strut.pressure_lower": frozenset({"main_strut.charge_pressure"}),
    "main_strut.liquid_mass": LIQUID | {"main_strut.fluid_density"},
    "footpad.x": VX | {"drop.mode"},
    "footpad.y": HEIGHT,
    "footpad.z": LEG | {"drop.mode"},
    "contact.penetration": VX | HEIGHT,
}


def _of_any_leg(output: str) -> str:
    return re.sub(r"^leg\[\d+\]\.", "", output)


def inputs_of(output: str) -> frozenset[str]:
    """The inputs that change `output` at the instant at which they change."""
    return INPUTS.get(_of_any_leg(output), frozenset())


def known_at_start(output: str) -> frozenset[str]:
    """The inputs and parameters that `output` depends on at the start."""
    name = _of_any_leg(output)
    return START_INPUTS.get(name, frozenset()) | PARAMETERS.get(name, frozenset())
