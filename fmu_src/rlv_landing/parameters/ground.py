"""The ground and its contact with a footpad."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from .declaration import listed, real, text


@dataclass(frozen=True)
class Ground:
    """The ground and its contact with a footpad. Eqs. (14)-(17)."""

    slope: Annotated[
        float,
        "slope of the ground at rest, clockwise positive (falling towards +x)",
        real("rad", -0.7, 0.7, "alpha", "paper", "deg"),
    ] = 0.0
    slope_direction: Annotated[
        float,
        "direction in which the slope falls, from +x towards +z; mode = space",
        real("rad", -3.2, 3.2, display_unit="deg"),
    ] = 0.0
    step: Annotated[
        float,
        "height of the ground below a footpad above its plane, along its normal: a stone, or a "
        "hole; of one leg by leg[i].ground.step; mode = space",
        real("m", -5.0, 5.0, "step", display_unit="mm"),
    ] = 0.0
    terrain: Annotated[
        str,
        "height field above the ground's plane on a regular grid; files and --set name a table, "
        "x along its head, z in its first column, heights in m; mode = space",
        listed(),
    ] = ""
    roughness: Annotated[
        float,
        "root mean square height of rough ground about the ground's plane, made of terrain_seed; "
        "0: none; mode = space",
        real("m", 0.0, 100.0, display_unit="mm"),
    ] = 0.0
    roughness_length: Annotated[
        float,
        "length of rough ground: heights so far apart are correlated by 1/e, and no wave of it is "
        "shorter; mode = space",
        real("m", 1e-3, 1e3),
    ] = 1.0
    terrain_seed: Annotated[
        float, "whole number that rough ground is made of; mode = space", real("", 0.0, 2.0**31 - 1)
    ] = 0.0
    gravity: Annotated[
        float, "gravitational acceleration", real("m/s2", 0.0, 50.0, "g", "closure")
    ] = 9.81
    stiffness: Annotated[
        float, "normal stiffness Kg (N/m^en)", real("N/m", 1e3, 1e13, "Kg", "identified")
    ] = 42000000.0
    exponent: Annotated[
        float, "exponent en of the normal stiffness", real("", 1.0, 3.0, "en", "identified")
    ] = 1.419
    damping: Annotated[
        float, "normal damping Cgmax at full depth", real("N.s/m", 0.0, 1e8, "Cgmax", "identified")
    ] = 3168.0
    damping_depth: Annotated[
        float,
        "penetration at which the normal damping is full",
        real("m", 1e-7, 0.1, "d_ramp", "identified", "mm"),
    ] = 2.165829e-05
    friction: Annotated[
        float,
        "friction coefficient mu; below 1e-7 it counts as 0",
        real("", 0.0, 3.0, "mu", "identified"),
    ] = 0.2801
    friction_law: Annotated[
        str,
        "passive: an elastic displacement of constant stiffness and a slider, which never supplies "
        "energy; paper: Eqs. (16), (17), which may",
        text("passive", "paper"),
    ] = "passive"
    stick_displacement: Annotated[
        float,
        "displacement s_r0 of a sticking footpad: where friction_law = paper starts to slip; "
        "of which tangential_stiffness = 0 and slip_zone are made",
        real("m", 1e-6, 0.1, "s_r0", "identified", "mm"),
    ] = 0.0009128
    tangential_stiffness: Annotated[
        float,
        "stiffness K of a sticking footpad along the ground, friction_law = passive; 0: the whole "
        "vehicle's mass times 9.80665 m/s2 over stick_displacement",
        real("N/m", 0.0, 1e12, "K_t", "closure"),
    ] = 0.0
    slip_zone: Annotated[
        float,
        "part of stick_displacement over which a footpad passes from sticking to slipping, "
        "friction_law = passive",
        real("", 1e-3, 1.0, source="closure"),
    ] = 0.07
    stribeck_gain: Annotated[
        float,
        "excess ar of the sticking over the sliding friction",
        real("", 0.0, 2.0, "ar", "identified"),
    ] = 0.005419
    stribeck_speed: Annotated[
        float,
        "slip speed b_strib at which that excess fades",
        real("m/s", 1e-4, 10.0, "b_strib", "identified"),
    ] = 0.02604
    stick_damping: Annotated[
        float, "damping Cr of a sticking footpad", real("N.s/m", 0.0, 1e6, "Cr", "identified")
    ] = 19.19
    direction_speed: Annotated[
        float,
        "slip speed below which friction is shared evenly between x and z, friction_law = paper",
        real("m/s", 1e-5, 0.1, "v_dir", "closure"),
    ] = 0.005
    release_time: Annotated[
        float,
        "time constant at which the friction displacement returns to 0 out of contact",
        real("s", 1e-5, 1.0, "tau_sr", "closure"),
    ] = 0.002
