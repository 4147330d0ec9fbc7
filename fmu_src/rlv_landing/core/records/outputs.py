"""The outputs of a landing, in the order of `rlv_landing.quantities`.

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


class SpatialOutputs(NamedTuple):
    """The quantities `body.*` of a landing in space."""

    x: float
    y: float
    z: float
    q_w: float
    q_x: float
    q_y: float
    q_z: float
    pitch: float
    roll: float
    heading: float
    vx: float
    vy: float
    vz: float
    spin_x: float
    spin_y: float
    spin_z: float
    ax: float
    ay: float
    az: float
    spin_acceleration_x: float
    spin_acceleration_y: float
    spin_acceleration_z: float
    top_axial_acceleration: float
    clearance: float
    strike_force_x: float
    strike_force_y: float
    strike_force_z: float
    strike_moment_x: float
    strike_moment_y: float
    strike_moment_z: float


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
    main_strut_work: float
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


class LegLoadOutputs(NamedTuple):
    """The quantities of one leg that follow those of `LegOutputs` in a landing in space."""

    transverse_force: float


class SecondStrutOutputs(NamedTuple):
    """The quantities of a leg on three struts that follow those of `LegOutputs`."""

    force: float
    stroke: float
    stroke_rate: float
