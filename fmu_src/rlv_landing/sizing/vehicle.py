"""All parameters of a vehicle that was sized, each with the rule that it comes from."""

from __future__ import annotations

from math import pi, sqrt

from ..parameters import PARAMETER_QUANTITIES, Parameters
from .damper import AMBIENT, BULK_MODULUS, BULK_SLOPE, CHARGE, DENSITY, Damper, size_damper
from .leg_geometry import LegGeometry, leg_geometry
from .needs import Needs

USER = "user"


def size_vehicle(needs: Needs) -> Parameters:
    """The vehicle that the `needs` ask for: every parameter, with its rule as source.

    Raises:
        LandingError: No legs of this kind do what is asked for.
    """
    leg = leg_geometry(needs)
    damper = size_damper(needs, leg)
    rules = {
        **_vehicle(needs),
        **_main_strut(needs, leg, damper),
        **_auxiliary_strut(needs, leg),
        **_ground(needs),
        **_drop(needs),
        **_sea(),
    }
    values = {name: value for name, (value, _) in rules.items()}
    sources = {name: source for name, (_, source) in rules.items()}
    return Parameters().with_values(values, sources)


Rules = dict[str, tuple[float | str, str]]


def _vehicle(needs: Needs) -> Rules:
    r, length = needs.body_radius, needs.body_length
    return {
        "vehicle.mass": (needs.mass, USER),
        "vehicle.inertia": (
            needs.mass * (3.0 * r**2 + length**2) / 12.0,
            "derived: uniform cylinder of the body's length and radius",
        ),
        "vehicle.footpad_mass": (needs.footpad_mass, USER),
        "vehicle.top_height": (
            needs.clearance + length - needs.cg_height,
            "derived: the body's upper end",
        ),
        "vehicle.transverse_load_at": ("footpad", "closure: conserves energy"),
        "vehicle.legs": (4.0, "closure: four legs"),
        "leg.kind": ("radial", "closure: two struts in a plane"),
        "vehicle.leg_azimuth": (pi, "closure: leg 1 behind"),
        "vehicle.leg_overrides": ("", "closure: legs that are alike"),
        "vehicle.body_points": ("", "closure: none"),
        "vehicle.leg_azimuths": ("", "closure: evenly"),
        "vehicle.inertia_roll": (0.0, "derived: that about z"),
        "vehicle.inertia_yaw": (
            needs.mass * r**2 / 2.0,
            "derived: uniform cylinder of the body's radius",
        ),
        **{
            f"vehicle.{name}": (0.0, "closure: symmetric body")
            for name in ("inertia_xy", "inertia_xz", "inertia_yz", "cg_offset_x", "cg_offset_z")
        },
    }


def _main_strut(needs: Needs, leg: LegGeometry, damper: Damper) -> Rules:
    speed = leg.stroke_ratio * needs.sink_speed
    oil = "closure: hydraulic oil"
    sized = "derived: sized for sink speed and load factor"
    layout = "derived: footpad, span and clearance"
    return {
        "main_strut.kind": ("liquid-spring", "closure: the damper that is sized"),
        "main_strut.joint_radius": (leg.joint_radius, layout),
        "main_strut.joint_depth": (leg.main_depth, layout),
        "main_strut.length": (leg.main_length, layout),
        "main_strut.area_upper": (damper.area_upper, sized),
        "main_strut.area_lower": (damper.area_lower, sized),
        "main_strut.volume_upper": (damper.volume, sized),
        "main_strut.volume_lower": (damper.volume, sized),
        "main_strut.charge_pressure": (CHARGE, "closure: no cavity in rebound"),
        "main_strut.ambient_pressure": (AMBIENT, "closure: standard atmosphere"),
        "main_strut.fluid_density": (DENSITY, oil),
        "main_strut.air_fraction": (1e-4, oil),
        "main_strut.air_exponent": (1.2, oil),
        "main_strut.bulk_modulus": (BULK_MODULUS, oil),
        "main_strut.bulk_modulus_slope": (BULK_SLOPE, oil),
        "main_strut.orifice_area_compression": (damper.orifice_compression, sized),
        "main_strut.orifice_area_rebound": (damper.orifice_rebound, sized),
        "main_strut.laminar_pressure": (5e4, "closure: 0.1 % of the pressures"),
        "main_strut.seal_coulomb": (0.01 * damper.force, "closure: 1 % of the allowed force"),
        "main_strut.seal_pressure": (0.0, "closure: none"),
        "main_strut.seal_stribeck": (0.01 * damper.force, "closure: 1 % of the allowed force"),
        "main_strut.seal_stribeck_speed": (
            0.1 * speed,
            "closure: 10 % of the first stroke's speed",
        ),
        "main_strut.seal_smoothing_speed": (
            0.02 * speed,
            "closure: 2 % of the first stroke's speed",
        ),
        "main_strut.stroke_max": (damper.stroke_max, sized),
        "main_strut.stop_stiffness": (
            damper.force / (0.02 * damper.stroke_max),
            "closure: the allowed force at 2 % of the stroke",
        ),
        "main_strut.stop_damping": (0.5 / speed, "closure: half more at the first stroke's speed"),
        "main_strut.stiffness": (0.0, "closure: not of a liquid spring"),
        "main_strut.damping": (0.0, "closure: not of a liquid spring"),
    }


def _auxiliary_strut(needs: Needs, leg: LegGeometry) -> Rules:
    layout = "derived: footpad, span and clearance"
    force = needs.load_factor * needs.mass * needs.gravity / 4.0
    stiffness = force / (1e-3 * leg.auxiliary_length)
    return {
        "auxiliary_strut.joint_radius": (leg.joint_radius, layout),
        "auxiliary_strut.joint_depth": (leg.auxiliary_depth, layout),
        "auxiliary_strut.length": (leg.auxiliary_length, layout),
        "auxiliary_strut.joint_spread": (
            0.2 * leg.auxiliary_length,
            "closure: a fifth of the length, of tripods",
        ),
        "auxiliary_strut.stiffness": (stiffness, "closure: 0.1 % of the length at full load"),
        "auxiliary_strut.exponent": (1.0, "closure: linear"),
        "auxiliary_strut.damping": (
            0.6 * sqrt(stiffness * needs.footpad_mass),
            "closure: 30 % of critical with the footpad's mass",
        ),
        "auxiliary_strut.play_tension": (0.0, "closure: no play"),
        "auxiliary_strut.play_compression": (0.0, "closure: no play"),
        "auxiliary_strut.play_stiffness": (0.0, "closure: no play"),
        "auxiliary_strut.play_damping": (1.0, "closure: no play"),
    }


def _ground(needs: Needs) -> Rules:
    force = needs.load_factor * needs.mass * needs.gravity / 4.0
    sag = 1e-3 * needs.span
    stiffness = force / sag
    plain = "closure: firm ground"
    return {
        "ground.slope": (0.0, USER),
        "ground.slope_direction": (0.0, "closure: along x"),
        "ground.step": (0.0, "closure: none"),
        "ground.terrain": ("", "closure: a plane"),
        "ground.roughness": (0.0, "closure: none"),
        "ground.roughness_length": (needs.span, "closure: of a roughness, if one is given"),
        "ground.terrain_seed": (0.0, "closure: of a roughness, if one is given"),
        "ground.gravity": (needs.gravity, USER),
        "ground.stiffness": (stiffness, "closure: 0.1 % of the span at full load"),
        "ground.exponent": (1.0, plain),
        "ground.damping": (
            1.0 * sqrt(stiffness * needs.footpad_mass),
            "closure: half of critical with the footpad's mass",
        ),
        "ground.damping_depth": (0.1 * sag, plain),
        "ground.friction": (needs.friction, USER),
        "ground.friction_law": ("passive", "closure: never supplies energy"),
        "ground.stick_displacement": (0.5 * sag, plain),
        "ground.tangential_stiffness": (0.0, "closure: from weight and stick_displacement"),
        "ground.slip_zone": (0.07, plain),
        "ground.stribeck_gain": (0.0, "closure: sliding friction alone"),
        "ground.stribeck_speed": (0.05, plain),
        "ground.stick_damping": (
            0.2 * sqrt(needs.footpad_mass * needs.mass * needs.gravity / (0.5 * sag)),
            "closure: 10 % of critical with the footpad's mass",
        ),
        "ground.direction_speed": (0.005, plain),
        "ground.release_time": (0.002, plain),
    }


def _drop(needs: Needs) -> Rules:
    return {
        "drop.mode": ("2-2", USER),
        "drop.contact_time": (0.0, "closure: begins at the first contact"),
        "drop.tilt": (0.0, USER),
        "drop.pitch_rate": (0.0, USER),
        "drop.horizontal_velocity": (0.0, USER),
        "drop.vertical_velocity": (-needs.sink_speed, USER),
        **{
            f"drop.{name}": (0.0, "closure: a symmetric landing")
            for name in ("heading", "roll", "roll_rate", "yaw_rate", "lateral_velocity")
        },
    }


def _sea() -> Rules:
    return {
        name: (q.default, "closure: no sea")
        for name, q in PARAMETER_QUANTITIES.items()
        if name.startswith("sea.")
    }
