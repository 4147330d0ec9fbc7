"""The main strut as a linear spring and damper, which bear in tension, too (closure).

It has the compression stop; at full extension its own spring holds it.
"""

from __future__ import annotations

from ..records import LegModel, StrutForce, StrutStatus
from .end_stops import stop_energy, stop_force
from .laws import MAIN_STRUTS, MainStrutLaw


def spring_damper(s: float, v: float, z1: float, z2: float, p: LegModel) -> StrutForce:
    """The strut at stroke `s` [m] and stroke rate `v` [m/s]: F = Km s + Cm v."""
    stop = stop_force(max(s, 0.0), v, p)
    return StrutForce(
        force=p.Km * s + p.Cm * v + stop.force,
        dz1=0.0,
        dz2=0.0,
        orifice=p.Cm * v * v,
        seal=0.0,
        stop=stop.dissipated,
        held=0.5 * p.Km * s * s,
        liquid_mass=0.0,
        a1=0.0,
        a2=0.0,
        mass_1=0.0,
        mass_2=0.0,
    )


def spring_damper_status(s: float, z1: float, z2: float, p: LegModel) -> StrutStatus:
    """The energy that the stop holds at stroke `s` [m]; there are no chambers."""
    return StrutStatus(stop_energy(max(s, 0.0), p), 0.0, 0.0)


MAIN_STRUTS["spring-damper"] = MainStrutLaw(spring_damper, spring_damper_status)
