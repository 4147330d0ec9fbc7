"""What only a landing in space has, and which inertia a body may have."""

from __future__ import annotations

from dataclasses import fields

from ..errors import LandingError
from ..quantities import SPACE
from .drop import Drop
from .ground import Ground
from .leg import Leg
from .sea import Sea
from .surroundings import check_azimuths
from .vehicle import Vehicle

# a symmetric landing cannot have them otherwise than by default
ONLY_IN_SPACE = {
    Vehicle: (
        *("legs", "leg_azimuths", "leg_overrides", "body_points", "cg_offset_x", "cg_offset_z"),
        *("inertia_xy", "inertia_xz", "inertia_yz"),
    ),
    Leg: ("kind",),
    Drop: ("heading", "roll", "roll_rate", "yaw_rate", "lateral_velocity"),
    Ground: ("slope_direction", "step", "terrain", "roughness", "terrain_seed"),
    Sea: tuple(f.name for f in fields(Sea)),
}
# the parameters that are whole numbers
WHOLE_NUMBERS = ("vehicle.legs", "ground.terrain_seed")
# roughness in parts of its length: slopes of 16 deg, root mean square along a line
STEEPEST_ROUGHNESS = 0.2
# a symmetric landing may have them, and does not depend on them
NO_EFFECT_IN_A_PLANE = (
    *("vehicle.leg_azimuth", "vehicle.inertia_roll", "vehicle.inertia_yaw"),
    "auxiliary_strut.joint_spread",
    "ground.roughness_length",
)


def check_space(vehicle: Vehicle, leg: Leg, drop: Drop, ground: Ground, sea: Sea) -> None:
    """Check what belongs together in a landing in space, and that no other landing has it.

    Raises:
        LandingError: The number of legs is broken; a symmetric landing has what only a landing in
            space has; or no body has such an inertia.
    """
    if not float(vehicle.legs).is_integer():
        raise LandingError(f"vehicle.legs = {vehicle.legs:g} is not a whole number from 3 to 8")
    if drop.mode == SPACE:
        check_azimuths(vehicle.leg_azimuths, int(vehicle.legs))
        _check_inertia(vehicle)
        _check_roughness(ground)
        return
    groups: dict[str, Vehicle | Leg | Drop | Ground | Sea] = {
        "vehicle": vehicle,
        "leg": leg,
        "drop": drop,
        "ground": ground,
        "sea": sea,
    }
    for name, group in groups.items():
        defaults = {f.name: f.default for f in fields(group)}
        for what in ONLY_IN_SPACE[type(group)]:
            value, default = getattr(group, what), defaults[what]
            if value != default:
                told = value if isinstance(value, str) else f"{value:g}"
                usual = default if isinstance(default, str) else f"{default:g}"
                raise LandingError(
                    f"{name}.{what} = {told} needs drop.mode = {SPACE}; drop.mode = {drop.mode} "
                    f"is a symmetric landing, which has {usual or 'none'}"
                )


def _check_roughness(ground: Ground) -> None:
    """Check that rough ground has a whole seed, no steep sides, and no other height field."""
    if not ground.terrain_seed.is_integer():
        raise LandingError(f"ground.terrain_seed = {ground.terrain_seed:g} is not a whole number")
    if ground.roughness == 0.0:
        return
    if ground.terrain:
        raise LandingError(
            f"ground.roughness = {ground.roughness:g} m and ground.terrain both say how high the "
            "ground is; leave one out"
        )
    if ground.roughness > STEEPEST_ROUGHNESS * ground.roughness_length:
        raise LandingError(
            f"ground.roughness = {ground.roughness:g} m is above {STEEPEST_ROUGHNESS:g} of "
            f"ground.roughness_length = {ground.roughness_length:g} m, too steep to land on; give "
            "a longer one"
        )


def _check_inertia(v: Vehicle) -> None:
    """Check that the inertia tensor is that of a body: see `assembly.spatial` for what 0 means."""
    if v.inertia_yaw == 0.0 or v.inertia_roll == 0.0:
        products = max(abs(v.inertia_xy), abs(v.inertia_xz), abs(v.inertia_yz))
        if products > 0.0:
            raise LandingError(
                f"an inertia tensor with products, {products:g} kg.m2, needs vehicle.inertia_roll "
                "and vehicle.inertia_yaw above 0"
            )
        return
    # the second moments of mass: half the trace less each moment on the diagonal
    half = 0.5 * (v.inertia_roll + v.inertia_yaw + v.inertia)
    xx, yy, zz = half - v.inertia_roll, half - v.inertia_yaw, half - v.inertia
    xy, xz, yz = -v.inertia_xy, -v.inertia_xz, -v.inertia_yz
    minors = (
        (xx, yy, zz),
        (xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz),
        (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz),),
    )
    for order, values in enumerate(minors, 1):
        if min(values) < -1e-12 * half**order:
            raise LandingError(
                f"vehicle.inertia_roll, inertia_yaw, inertia = {v.inertia_roll:g}, "
                f"{v.inertia_yaw:g}, {v.inertia:g} kg.m2 with products {v.inertia_xy:g}, "
                f"{v.inertia_xz:g}, {v.inertia_yz:g} kg.m2 are those of no body: "
                "no moment may be above the sum of the other two"
            )
