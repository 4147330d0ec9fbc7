"""Dependencies of the outputs of a landing in space: see `dependencies.py`.

Positions of the ground change no output at once: it moves to a new one from the next step on.
"""

from __future__ import annotations

from rlv_landing.parameters import parameters_of
from rlv_landing.quantities import SPACE, SPACE_INPUTS

LOADS = frozenset(q.name for q in SPACE_INPUTS if q.name.startswith("external."))
GROUND = frozenset(q.name for q in SPACE_INPUTS if q.name.startswith("ground."))
RATES = frozenset(name for name in GROUND if name.endswith("_rate"))

# what single legs have for themselves may be any of a leg's parameters
OVERRIDES = frozenset({"vehicle.leg_overrides"})
LEG = OVERRIDES | {
    f"{strut}.{what}"
    for strut in ("main_strut", "auxiliary_strut")
    for what in ("joint_radius", "joint_depth", "length")
}
# the rigid vehicle, which tumbles until its first contact; legs that differ count where they stand
MASSES = frozenset(
    f"vehicle.{what}"
    for what in (
        *("mass", "footpad_mass", "cg_offset_x", "cg_offset_z", "leg_azimuth", "leg_azimuths"),
        *(f"inertia{axes}" for axes in ("", "_roll", "_yaw", "_xy", "_xz", "_yz")),
    )
)
TURN = frozenset(
    f"drop.{what}"
    for what in ("heading", "roll", "tilt", "roll_rate", "yaw_rate", "pitch_rate", "contact_time")
)
MOTION = LEG | MASSES | TURN
VX = MOTION | {"drop.horizontal_velocity"}
VY = MOTION | {"drop.vertical_velocity", "ground.gravity"}
VZ = MOTION | {"drop.lateral_velocity"}
FEET = frozenset({"vehicle.leg_azimuth", "vehicle.leg_azimuths"})
# what moves the deck by itself
SEA = frozenset(name for name in parameters_of(SPACE) if name.startswith("sea."))
HEIGHT = (
    VY
    | FEET
    | SEA
    | {
        *("ground.slope", "ground.slope_direction", "ground.step", "ground.terrain"),
        *("ground.roughness", "ground.roughness_length", "ground.terrain_seed"),
        "vehicle.body_points",
    }
)
CHARGE = OVERRIDES | {
    f"main_strut.{what}"
    for what in ("kind", "charge_pressure", "ambient_pressure", "area_upper", "area_lower")
}
LOADED = MOTION | CHARGE | {"vehicle.transverse_load_at"}
PRESSURE = OVERRIDES | {"main_strut.kind", "main_strut.charge_pressure"}
LIQUID = PRESSURE | {
    f"main_strut.{what}"
    for what in (
        *("volume_upper", "volume_lower", "ambient_pressure", "air_fraction", "air_exponent"),
        *("bulk_modulus", "bulk_modulus_slope"),
    )
}
ACCELERATIONS = tuple(
    f"body.{kind}{axis}" for kind in ("a", "spin_acceleration_") for axis in "xyz"
)
ATTITUDE = ("q_w", "q_x", "q_y", "q_z", "pitch", "roll", "heading", "spin_x", "spin_y", "spin_z")

INPUTS: dict[str, frozenset[str]] = {
    **dict.fromkeys(ACCELERATIONS, LOADS | RATES),
    "body.top_axial_acceleration": LOADS | RATES,
    "status.phase": LOADS | RATES,
    **{f"body.strike_{what}_{axis}": RATES for what in ("force", "moment") for axis in "xyz"},
    "contact.force_x": RATES,
    "contact.force_y": RATES,
    "contact.force_z": RATES,
    "contact.force": RATES,
    "auxiliary_strut.transverse_force": LOADS | RATES,
}

START_INPUTS: dict[str, frozenset[str]] = {
    **dict.fromkeys(ACCELERATIONS, LOADS),
    "body.y": GROUND,
    "body.top_axial_acceleration": LOADS,
    "body.clearance": GROUND - {"ground.heave"},
    "energy.potential": GROUND,
    "auxiliary_strut.transverse_force": LOADS,
    "footpad.y": GROUND,
    "contact.penetration": GROUND - {"ground.heave"},
}

PARAMETERS: dict[str, frozenset[str]] = {
    **{f"body.{what}": MOTION for what in ATTITUDE},
    **dict.fromkeys(ACCELERATIONS, LOADED),
    "body.x": VX,
    "body.y": HEIGHT,
    "body.z": VZ,
    "body.clearance": VX | VZ | HEIGHT,
    "body.vx": VX,
    "body.vy": VY,
    "body.vz": VZ,
    "body.ay": LOADED | {"ground.gravity"},
    "body.top_axial_acceleration": LOADED | {"vehicle.top_height", "ground.gravity"},
    "energy.kinetic": VX | VY | VZ,
    "energy.potential": HEIGHT,
    "energy.liquid": LIQUID,
    "status.phase": MOTION | FEET,
    "status.stability_margin": MOTION | FEET,
    "main_strut.force": CHARGE,
    "main_strut.pressure_upper": PRESSURE,
    "main_strut.pressure_lower": PRESSURE,
    "main_strut.liquid_mass": LIQUID | {"main_strut.fluid_density"},
    "auxiliary_strut.transverse_force": LOADED | FEET,
    "footpad.x": VX | FEET,
    "footpad.y": HEIGHT,
    "footpad.z": VZ | FEET,
    "contact.penetration": VX | VZ | HEIGHT,
}

# on three struts a leg the joints' spread counts where the struts' length does, and no force across
# the leg's plane has a place
OF_TRIPODS: dict[str, frozenset[str]] = {
    name: (found | {"auxiliary_strut.joint_spread"}) - {"vehicle.transverse_load_at"}
    if "auxiliary_strut.length" in found
    else found
    for name, found in PARAMETERS.items()
}
