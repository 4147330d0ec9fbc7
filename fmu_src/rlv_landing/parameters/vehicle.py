"""The vehicle: its body and footpads, and the two kinds of struts of its legs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..quantities import LEAST_LEGS, MOST_LEGS
from .declaration import listed, real, text


@dataclass(frozen=True)
class Vehicle:
    """The body and its footpads."""

    mass: Annotated[float, "upper (elastic) mass", real("kg", 1.0, 1e6, "m_u", "paper")] = 178.0
    inertia: Annotated[
        float,
        "rotational inertia of the upper mass about z through its CG",
        real("kg.m2", 0.1, 1e9, "I_u", "identified"),
    ] = 116.2
    footpad_mass: Annotated[
        float,
        "lower (inelastic) mass of one leg, at its footpad",
        real("kg", 0.01, 1e4, "m_d", "paper"),
    ] = 4.2
    top_height: Annotated[
        float,
        "height of the top acceleration sensor above the CG",
        real("m", 0.0, 100.0, "H", "identified"),
    ] = 0.4582
    transverse_load_at: Annotated[
        str,
        "where the body feels the auxiliary struts' transverse force: footpad (consistent) or "
        "joint (the paper's assumption C; creates energy)",
        text("footpad", "joint", source="derived"),
    ] = "footpad"
    legs: Annotated[
        float,
        "number of legs, evenly round the body; 4 but in mode = space",
        real("", float(LEAST_LEGS), float(MOST_LEGS)),
    ] = 4.0
    leg_azimuth: Annotated[
        float,
        "azimuth of the first leg, from body x towards z; the others follow evenly; mode = space",
        real("rad", -3.2, 3.2, display_unit="deg"),
    ] = 3.141592653589793
    leg_azimuths: Annotated[
        str,
        "azimuths of all legs in rad, from body x towards z, with blanks between; without them the "
        "legs stand evenly from leg_azimuth on; mode = space",
        listed(),
    ] = ""
    inertia_roll: Annotated[
        float,
        "rotational inertia of the upper mass about body x through its CG; 0: that about z; "
        "mode = space",
        real("kg.m2", 0.0, 1e9),
    ] = 0.0
    inertia_yaw: Annotated[
        float,
        "rotational inertia of the upper mass about body y through its CG; 0: the upper mass times "
        "the square of the main struts' joint radius, a thin shell; mode = space",
        real("kg.m2", 0.0, 1e9),
    ] = 0.0
    inertia_xy: Annotated[
        float,
        "element xy of the inertia tensor about the CG, minus the integral of x y dm; mode = space",
        real("kg.m2", -1e9, 1e9),
    ] = 0.0
    inertia_xz: Annotated[
        float, "element xz of the inertia tensor; mode = space", real("kg.m2", -1e9, 1e9)
    ] = 0.0
    inertia_yz: Annotated[
        float, "element yz of the inertia tensor; mode = space", real("kg.m2", -1e9, 1e9)
    ] = 0.0
    cg_offset_x: Annotated[
        float, "CG off the legs' axis along body x; mode = space", real("m", -10.0, 10.0)
    ] = 0.0
    cg_offset_z: Annotated[
        float, "CG off the legs' axis along body z; mode = space", real("m", -10.0, 10.0)
    ] = 0.0
    leg_overrides: Annotated[
        str,
        "values in SI that single legs have for themselves: leg[2].ground.friction = 0.1; ...; "
        "files have tables for them; mode = space",
        listed(),
    ] = ""
    body_points: Annotated[
        str,
        "points of the body that meet the ground, x y z; x y z; ... in m from the CG's height on "
        "the legs' axis, body axes: a nozzle's rim, a base ring; mode = space",
        listed(),
    ] = ""


@dataclass(frozen=True)
class MainStrut:
    """The main strut: a liquid-spring damper, Eq. (12), or a linear spring and damper."""

    kind: Annotated[
        str,
        "liquid-spring: the damper of Eq. (12); spring-damper: stiffness and damping along the "
        "strut, in tension too, and the compression stop",
        text("liquid-spring", "spring-damper"),
    ] = "liquid-spring"

    joint_radius: Annotated[
        float, "CG to body joint, radially", real("m", 0.0, 50.0, "La", "paper")
    ] = 0.445
    joint_depth: Annotated[
        float, "CG to body joint, downward", real("m", -50.0, 50.0, "Lb", "paper")
    ] = 1.103
    length: Annotated[
        float,
        "length, fully extended",
        real("m", 0.05, 100.0, "Lm0", "paper"),
    ] = 1.426
    area_upper: Annotated[
        float,
        "piston area in the upper chamber (annulus)",
        real("m2", 1e-6, 1.0, "A1", "identified", "mm2"),
    ] = 0.0009243
    area_lower: Annotated[
        float,
        "piston area in the lower chamber (bore)",
        real("m2", 1e-6, 1.0, "A2", "identified", "mm2"),
    ] = 0.001145
    volume_upper: Annotated[
        float,
        "upper chamber's volume, fully extended",
        real("m3", 1e-7, 1.0, "V10", "identified", "cm3"),
    ] = 0.0001858
    volume_lower: Annotated[
        float,
        "lower chamber's volume, fully extended",
        real("m3", 1e-7, 1.0, "V20", "identified", "cm3"),
    ] = 0.0001629
    charge_pressure: Annotated[
        float,
        "absolute pressure in both chambers before touchdown",
        real("Pa", 1e3, 1e8, "P0", "identified", "MPa"),
    ] = 390084.4
    ambient_pressure: Annotated[
        float, "absolute pressure outside", real("Pa", 1e2, 1e7, "Pa", "closure", "MPa")
    ] = 101300.0
    fluid_density: Annotated[
        float,
        "density of the liquid with its air at ambient pressure",
        real("kg/m3", 100.0, 3000.0, "rho0", "closure"),
    ] = 960.0
    air_fraction: Annotated[
        float,
        "volume fraction of entrapped air at ambient pressure",
        real("", 1e-7, 0.2, "x_air", "identified"),
    ] = 2.613e-05
    air_exponent: Annotated[
        float,
        "polytropic exponent of the air (1.01: nearly isothermal)",
        real("", 1.01, 1.67, "n_air", "identified"),
    ] = 1.33
    bulk_modulus: Annotated[
        float,
        "bulk modulus of the liquid at ambient pressure",
        real("Pa", 1e7, 1e10, "B0", "identified", "MPa"),
    ] = 1244000000.0
    bulk_modulus_slope: Annotated[
        float, "growth of the bulk modulus with pressure", real("", 1.5, 30.0, "kB", "identified")
    ] = 12.73
    orifice_area_compression: Annotated[
        float,
        "effective orifice area Cd Ao in compression",
        real("m2", 1e-9, 1e-2, "CdAo_c", "identified", "mm2"),
    ] = 5.552e-06
    orifice_area_rebound: Annotated[
        float,
        "effective orifice area Cd Ao in rebound",
        real("m2", 1e-9, 1e-2, "CdAo_r", "identified", "mm2"),
    ] = 6.054e-06
    laminar_pressure: Annotated[
        float,
        "pressure drop below which the orifice flow turns laminar",
        real("Pa", 1e3, 1e7, "dP_lam", "identified", "MPa"),
    ] = 50602.75
    seal_coulomb: Annotated[
        float, "Coulomb part of the seal friction", real("N", 0.0, 1e6, "Fc", "identified")
    ] = 35.31
    seal_pressure: Annotated[
        float,
        "seal friction per mean gauge pressure of the chambers",
        real("N/Pa", 0.0, 1e-2, "kp", "identified"),
    ] = 2.157e-07
    seal_stribeck: Annotated[
        float,
        "Stribeck part of the seal friction, at low speed",
        real("N", 0.0, 1e6, "Fs", "identified"),
    ] = 162.0
    seal_stribeck_speed: Annotated[
        float,
        "speed at which the Stribeck part fades",
        real("m/s", 1e-4, 10.0, "v_str", "identified"),
    ] = 0.3791511
    seal_smoothing_speed: Annotated[
        float,
        "speed below which the seal friction is smoothed",
        real("m/s", 1e-5, 1.0, "v_sm", "identified"),
    ] = 0.03693
    stroke_max: Annotated[
        float,
        "stroke at which the damper meets its compression stop",
        real("m", 1e-3, 10.0, "s_max", "closure", "mm"),
    ] = 0.05
    stop_stiffness: Annotated[
        float, "stiffness of both end stops", real("N/m", 1e3, 1e11, "K_stop", "identified")
    ] = 48880000.0
    stop_damping: Annotated[
        float,
        "damping of both end stops: force is K e (1 + c e')",
        real("s/m", 0.0, 100.0, "c_stop", "identified"),
    ] = 0.01048
    stiffness: Annotated[
        float, "axial stiffness, kind = spring-damper", real("N/m", 0.0, 1e11, "Km", "closure")
    ] = 230000.0
    damping: Annotated[
        float, "axial damping, kind = spring-damper", real("N.s/m", 0.0, 1e9, "Cm", "closure")
    ] = 3000.0


@dataclass(frozen=True)
class AuxiliaryStrut:
    """The auxiliary strut: spring and damper along its axis, and play in its joints.

    The spring is nonlinear. Eq. (13).
    """

    joint_radius: Annotated[
        float, "CG to body joint, radially", real("m", 0.0, 50.0, "Lc", "paper")
    ] = 0.463
    joint_depth: Annotated[
        float, "CG to body joint, downward", real("m", -50.0, 50.0, "Ld", "paper")
    ] = 1.513
    length: Annotated[float, "length, unloaded", real("m", 0.05, 100.0, "Ls0", "paper")] = 1.145
    joint_spread: Annotated[
        float,
        "distance of the body joint from the leg's plane, one strut on each side; leg.kind = "
        "tripod, mode = space",
        real("m", 1e-3, 50.0, "Lt"),
    ] = 0.25
    stiffness: Annotated[
        float, "axial stiffness Ka (N/m^ek)", real("N/m", 1e3, 1e11, "Ka", "identified")
    ] = 4000000.0
    exponent: Annotated[
        float,
        "hardening exponent ek",
        real("", 1.0, 3.0, "ek", "identified"),
    ] = 1.074
    damping: Annotated[
        float,
        "axial damping Ca",
        real("N.s/m", 0.0, 1e7, "Ca", "identified"),
    ] = 8200.0
    play_tension: Annotated[
        float,
        "play of the joints in tension, before the strut bears; 0 on both sides: no play",
        real("m", 0.0, 0.1, "g_t", "identified", "mm"),
    ] = 0.0008819
    play_compression: Annotated[
        float,
        "play of the joints in compression, before the strut bears",
        real("m", 0.0, 0.1, "g_c", "identified", "mm"),
    ] = 0.001
    play_stiffness: Annotated[
        float,
        "axial stiffness within the play, and beside Ka beyond it",
        real("N/m", 0.0, 1e9, "k_play", "identified"),
    ] = 182200.0
    play_damping: Annotated[
        float,
        "part of the axial damping that acts within the play",
        real("", 0.0, 1.0, "c_play", "identified"),
    ] = 1.0
