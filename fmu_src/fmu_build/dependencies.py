"""What each output depends on: the inputs at the same instant, and the parameters at the start.

For the FMU's ModelStructure.

Written down from the equations; `tests/fmu/test_description.py` finds the same sets by moving every
input and parameter of the model. Outputs that are not named here are states or follow from states
alone: no input changes them at once.
"""

from __future__ import annotations

import re

LOADS = frozenset({"external.force_x", "external.force_y", "external.moment"})
PLACE = frozenset({"ground.heave", "ground.tilt"})
GROUND = PLACE | {"ground.heave_rate", "ground.tilt_rate"}

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
FOOT = VX | HEIGHT
PENALTY = FOOT | {"ground.stiffness", "ground.exponent"}
# friction starts from rest: only its damping acts at once
CONTACT = PENALTY | {"ground.damping", "ground.damping_depth", "ground.stick_damping"}
CHARGE = frozenset(
    f"main_strut.{what}"
    for what in ("charge_pressure", "ambient_pressure", "area_upper", "area_lower")
)
# a play that is not the same on both sides bears a little on one of them
PRELOAD = frozenset(
    f"auxiliary_strut.{what}"
    for what in ("play_tension", "play_compression", "stiffness", "exponent")
)
PUSH = CHARGE | PRELOAD
VOLUMES = frozenset(
    f"main_strut.{what}"
    for what in ("volume_upper", "volume_lower", "charge_pressure", "ambient_pressure")
)
LIQUID = VOLUMES | {
    f"main_strut.{what}"
    for what in ("air_fraction", "air_exponent", "bulk_modulus", "bulk_modulus_slope")
}
# the pushes of all legs' struts are equal at the start, so that they do not turn the body
TURN = CONTACT | {"vehicle.inertia", "vehicle.transverse_load_at"}
MARGIN = PITCH | LEG | {"vehicle.mass", "vehicle.footpad_mass", "drop.mode"}

INPUTS: dict[str, frozenset[str]] = {
    "body.ax": LOADS | GROUND,
    "body.ay": LOADS | GROUND,
    "body.pitch_acceleration": LOADS | GROUND,
    "body.top_axial_acceleration": frozenset({"external.force_x", "external.force_y"}),
    "energy.contact": PLACE,
    "energy.work_ground": PLACE,
    "status.phase": LOADS | GROUND,
    "contact.force_x": GROUND,
    "contact.force_y": GROUND,
    "contact.force_z": GROUND,
    "contact.penetration": PLACE,
    "contact.active": PLACE,
}

PARAMETERS: dict[str, frozenset[str]] = {
    "body.x": VX,
    "body.y": HEIGHT,
    "body.pitch": PITCH,
    "body.vx": VX,
    "body.vy": VY,
    "body.pitch_rate": frozenset({"drop.pitch_rate"}),
    "body.ax": TURN | PUSH,
    "body.ay": TURN | PUSH,
    "body.pitch_acceleration": TURN,
    "body.top_axial_acceleration": PITCH
    | LEG
    | PUSH
    | {"vehicle.mass", "vehicle.top_height", "ground.gravity"},
    "energy.kinetic": VX | VY | {"vehicle.inertia"},
    "energy.potential": HEIGHT,
    "energy.liquid": LIQUID,
    "energy.auxiliary": PRELOAD,
    "energy.contact": PENALTY,
    "energy.work_ground": PENALTY,
    "status.phase": TURN | PUSH,
    "status.stability_margin": MARGIN,
    "auxiliary_strut.force": PRELOAD,
    "main_strut.force": CHARGE,
    "main_strut.pressure_upper": frozenset({"main_strut.charge_pressure"}),
    "main_strut.pressure_lower": frozenset({"main_strut.charge_pressure"}),
    "main_strut.liquid_mass": LIQUID | {"main_strut.fluid_density"},
    "footpad.x": VX | {"drop.mode"},
    "footpad.y": HEIGHT,
    "footpad.z": LEG | {"drop.mode"},
    "contact.force_x": CONTACT,
    "contact.force_y": CONTACT,
    "contact.penetration": FOOT,
    "contact.active": FOOT,
}


def _of_any_leg(output: str) -> str:
    return re.sub(r"^leg\[\d+\]\.", "", output)


def inputs_of(output: str) -> frozenset[str]:
    """The inputs that change `output` at the instant at which they change."""
    return INPUTS.get(_of_any_leg(output), frozenset())


def known_at_start(output: str) -> frozenset[str]:
    """The inputs and parameters that `output` depends on at the start.

    The footpads do not slide sideways then, whatever is set.
    """
    name = _of_any_leg(output)
    return (
        frozenset()
        if name == "contact.force_z"
        else inputs_of(output) | PARAMETERS.get(name, frozenset())
    )
