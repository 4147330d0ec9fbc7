"""The liquid-spring damper of a main strut, sized for one sink speed and load factor."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ..errors import LandingError
from .leg_geometry import LegGeometry
from .needs import Needs

# work of a strut over that of its allowed force along the whole stroke, for a plain orifice
EFFICIENCY = 0.65
# parts of the allowed force: of the orifice at the sink speed, and of the liquid spring at the stop
ORIFICE_PART, SPRING_PART = 0.8, 0.85
# pressure of the liquid spring at the stop, over the ambient one [Pa]
SPRING_PRESSURE = 4e7
# most way of the footpads to the stop over the body's clearance
CLEARANCE_PART = 0.8
# area of the piston rod over that of the bore
ROD_PART = 0.2
# orifice in rebound over that in compression
REBOUND_PART = 0.6
AMBIENT, CHARGE = 101_325.0, 4e5
# hydraulic oil: density, bulk modulus at ambient pressure, and its growth with pressure
DENSITY, BULK_MODULUS, BULK_SLOPE = 870.0, 1.4e9, 10.0


class Damper(NamedTuple):
    """A sized damper.

    Attributes:
        travel: Way of the footpad upward that the energy asks for [m].
        stroke: Stroke of the main strut on it [m].
        stroke_max: Stroke to the stop [m].
        force: Allowed axial force, compression positive [N].
        area_upper: Piston area of the upper chamber, the annulus [m2].
        area_lower: Piston area of the lower chamber, the bore [m2].
        volume: Volume of each chamber, extended [m3].
        orifice_compression: Effective orifice area in compression [m2].
        orifice_rebound: Effective orifice area in rebound [m2].
    """

    travel: float
    stroke: float
    stroke_max: float
    force: float
    area_upper: float
    area_lower: float
    volume: float
    orifice_compression: float
    orifice_rebound: float


def size_damper(needs: Needs, leg: LegGeometry) -> Damper:
    """The damper that takes the sink speed V at the load factor n, all legs at once.

    [derived]

    - Energy: m V2/2 + m g h = eta n m g h gives the footpad's way h = V2/(2 g (eta n - 1)).
    - Virtual work: stroke s = k h and force F = n m g/(4 k), with the leg's stroke ratio k.
    - Stop: at `stroke_reserve` times s, for landings on fewer legs.
    - Liquid spring: rod area A_r = 0.85 F/dP for dP = 40 MPa at the stop's stroke s_max; the volume
      by the liquid's law dP = B0/kB [(1 - A_r s_max/V)^-kB - 1], half of it in each chamber.
    - Orifice: 0.8 F = A2 rho/2 (A2 k V/CdAo)2 at the sink speed.

    Raises:
        LandingError: The load factor is too small for any stroke, or the stroke is longer than the
            leg has room for.
    """
    surplus = EFFICIENCY * needs.load_factor - 1.0
    if surplus <= 0.1:
        raise LandingError(
            f"load_factor = {needs.load_factor:g} leaves a damper of efficiency {EFFICIENCY:g} "
            f"nothing beside the weight; allow {1.1 / EFFICIENCY:.2f} at least"
        )
    travel = needs.sink_speed**2 / (2.0 * needs.gravity * surplus)
    most = needs.stroke_reserve * travel
    if most > CLEARANCE_PART * needs.clearance:
        raise LandingError(
            f"sink_speed = {needs.sink_speed:g} m/s at load_factor = {needs.load_factor:g} takes "
            f"the footpads {most:.3g} m up to the stop, above {CLEARANCE_PART:g} clearance = "
            f"{CLEARANCE_PART * needs.clearance:.3g} m; allow a higher load factor, less "
            "stroke_reserve or more clearance"
        )
    k = leg.stroke_ratio
    stroke = k * travel
    force = needs.load_factor * needs.mass * needs.gravity / (4.0 * k)
    rod = SPRING_PART * force / SPRING_PRESSURE
    bore = rod / ROD_PART
    squeezed = 1.0 - (1.0 + BULK_SLOPE * SPRING_PRESSURE / BULK_MODULUS) ** (-1.0 / BULK_SLOPE)
    stroke_max = needs.stroke_reserve * stroke
    volume = rod * stroke_max / squeezed
    speed = k * needs.sink_speed
    orifice = bore * speed * sqrt(bore * DENSITY / (2.0 * ORIFICE_PART * force))
    return Damper(
        travel=travel,
        stroke=stroke,
        stroke_max=stroke_max,
        force=force,
        area_upper=bore - rod,
        area_lower=bore,
        volume=0.5 * volume,
        orifice_compression=orifice,
        orifice_rebound=REBOUND_PART * orifice,
    )
