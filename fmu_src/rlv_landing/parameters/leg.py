"""The kind of the legs, and what a leg on three struts needs of its geometry."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Annotated

from ..errors import LandingError
from ..quantities import RADIAL, TRIPOD
from .declaration import text
from .vehicle import AuxiliaryStrut, MainStrut, Vehicle

# least sine of the angle at the footpad between two of a tripod's struts and the third, or between
# an auxiliary strut and the leg's plane: with less, nothing holds the footpad along one direction
LEAST_SINE = 0.02


@dataclass(frozen=True)
class Leg:
    """What all legs have alike."""

    kind: Annotated[
        str,
        "radial: main and auxiliary strut in a plane fixed in the body, which keeps the footpad; "
        "tripod: a main (primary) strut between two auxiliary (secondary) struts, and a footpad "
        "free in three directions; tripod needs mode = space",
        text(RADIAL, TRIPOD),
    ] = RADIAL


def in_plane_length(a: AuxiliaryStrut, kind: str) -> float:
    """Length [m] of an unloaded auxiliary strut as seen along e_t, across its leg's plane.

    Of a tripod whose footpad is in the plane.
    """
    if kind != TRIPOD:
        return a.length
    return sqrt(a.length**2 - a.joint_spread**2)


def check_tripod(v: Vehicle, m: MainStrut, a: AuxiliaryStrut) -> None:
    """Check that the struts of a tripod hold its footpad along three directions.

    Raises:
        LandingError: They do not, or the vehicle has what no tripod has.
    """
    if v.transverse_load_at != "footpad":
        raise LandingError(
            f"vehicle.transverse_load_at = {v.transverse_load_at} needs leg.kind = {RADIAL}; a "
            f"{TRIPOD} has no transverse force: leave it at footpad"
        )
    if not LEAST_SINE <= a.joint_spread / a.length < 1.0:
        raise LandingError(
            f"auxiliary_strut.joint_spread = {a.joint_spread:g} m is outside "
            f"[{LEAST_SINE * a.length:g}, {a.length:g}) m, {LEAST_SINE:g} to 1 times "
            f"auxiliary_strut.length = {a.length:g} m: the struts of a {TRIPOD} must meet at a "
            "footpad and hold it across the leg's plane; spread the joints less or more"
        )


def check_triangle(m: MainStrut, a: AuxiliaryStrut, kind: str) -> None:
    """Check that the struts of a leg meet at a footpad, and a tripod's in no common plane.

    Raises:
        LandingError: They do not.
    """
    length = in_plane_length(a, kind)
    apart = ((m.joint_radius - a.joint_radius) ** 2 + (m.joint_depth - a.joint_depth) ** 2) ** 0.5
    across = spread = ""
    if kind == TRIPOD:
        across, spread = f" ({length:g} m in the leg's plane)", ", and auxiliary_strut.joint_spread"
    if not abs(m.length - length) < apart < m.length + length:
        raise LandingError(
            f"main_strut.length = {m.length:g} m and auxiliary_strut.length = {a.length:g} m"
            f"{across} do not meet at a footpad: their joints are {apart:g} m apart; "
            f"check lengths, joint radii and depths{spread}"
        )
    if kind != TRIPOD:
        return
    cosine = (m.length**2 + length**2 - apart**2) / (2.0 * m.length * length)
    sine = sqrt(max(0.0, 1.0 - cosine * cosine))
    if sine < LEAST_SINE:
        raise LandingError(
            f"the struts of a {TRIPOD} are in one plane at the footpad: the sine of the angle "
            f"between main_strut and the auxiliary struts' plane is {sine:.3g}, the least is "
            f"{LEAST_SINE:g}; move their joints apart"
        )
