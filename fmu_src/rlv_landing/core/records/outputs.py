"""The outputs that a user sees, in the order of `rlv_landing.quantities`.

Strut forces are negative in compression here.
"""

from typing import NamedTuple


class BodyOutputs(NamedTuple):
    """The quantities `body.*`."""

    x: float
    y: float
    pitch: float
    vx: float
    vy: float
    pitch_rate: float
    ax: float
    ay: float
    pitch_acceleration: float
    top_axial_acceleration: float


class EnergyOutputs(NamedTuple):
    """The quantities `energy.*` [J]."""

    kinetic: float
    potential: float
    liquid: float
    auxiliary: float
    contact: float
    friction: float
    stop: float
    dissipated_orifice: float
    dissipated_seal: float
    dissipated_stop: float
    dissipated_auxiliary: float
    dissipated_contact: float
    dissipated_friction: float
    work_external: float
    work_ground: float
    work_transverse: float
    dissipated: float
    balance: float


class StatusOutputs(NamedTuple):
    """The quantities `status.*`."""

    phase: float
    stability_margin: float


class LegOutputs(NamedTuple):
    """The quantities of one leg."""

    main_strut_force: float
    main_strut_stroke: float
    main_strut_stroke_rate: float
    main_strut_pressure_upper: float
    main_strut_pressure_lower: float
    main_strut_liquid_mass: float
    auxiliary_strut_force: float
    auxiliary_strut_stroke: float
    auxiliary_strut_stroke_rate: float
    footpad_x: float
    footpad_y: float
    footpad_z: float
    contact_force_x: float
    contact_force_y: float
    contact_force_z: float
    contact_force: float
    contact_penetration: float
    contact_active: float
