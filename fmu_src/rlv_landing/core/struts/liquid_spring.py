"""The liquid-spring damper of the main strut: two chambers, an orifice, a seal, two end stops.

Eq. (12).

Its states z1, z2 are the absolute pressures P1, P2 [Pa] in the upper annulus (chamber 1) and the
lower bore (chamber 2).
"""

from __future__ import annotations

from math import exp, fabs, sqrt, tanh

from ..records import LegModel, StrutForce, StrutStatus
from .end_stops import stop_energy, stop_force
from .fluid import fluid, strain_energy
from .laws import MAIN_STRUTS, MainStrutLaw


def orifice_flow(dP: float, density_ratio: float, p: LegModel) -> float:
    """Volume flow [m3/s] from the lower to the upper chamber under `dP` = P2 - P1 [Pa]. [closure]

    Cd Ao sqrt(2/rho) dP/(dP^2 + dP_lam^2)^(1/4): the square-root law with a laminar passage through
    zero. `density_ratio` is the mean of rho/rho0 in the two chambers. Compression and rebound have
    areas of their own.
    """
    area = p.CdAo_c if dP > 0.0 else p.CdAo_r
    return (
        area * sqrt(2.0 / (p.rho0 * density_ratio)) * dP / sqrt(sqrt(dP * dP + p.dP_lam * p.dP_lam))
    )


def orifice_slope(dP: float, density_ratio: float, p: LegModel) -> float:
    """Derivative of `orifice_flow` by `dP` [m3/(s Pa)]."""
    area = p.CdAo_c if dP > 0.0 else p.CdAo_r
    square = dP * dP + p.dP_lam * p.dP_lam
    return (
        area
        * sqrt(2.0 / (p.rho0 * density_ratio))
        * (square - 0.5 * dP * dP)
        / (square * sqrt(sqrt(square)))
    )


def seal_friction(v: float, P1: float, P2: float, p: LegModel) -> float:
    """Seal friction [N] against the stroke rate `v` [m/s]: Coulomb + pressure-proportional +
    Stribeck, smoothed. [closure]
    """
    ratio = v / p.v_str
    level = p.Fc + p.kp * 0.5 * (fabs(P1 - p.Pa) + fabs(P2 - p.Pa)) + p.Fs * exp(-ratio * ratio)
    return level * tanh(v / p.v_sm)


def liquid_spring(s: float, v: float, P1: float, P2: float, p: LegModel) -> StrutForce:
    """The damper at stroke `s` [m] and stroke rate `v` [m/s]. Eq. (12).

    The flow evens x = P2 - P1 out: a change of x changes the pressures' rates by a1 x and -a2 x.
    """
    f1 = fluid(P1, p.x_air, p.n_air, p.B0, p.kB, p.Pa)
    f2 = fluid(P2, p.x_air, p.n_air, p.B0, p.kB, p.Pa)
    density1 = 1.0 / f1.v
    density2 = 1.0 / f2.v
    ratio = 0.5 * (density1 + density2)
    Q = orifice_flow(P2 - P1, ratio, p)
    V1 = p.V10 + p.A1 * s
    V2 = p.V20 - p.A2 * s
    stiffness1 = -f1.v / f1.dv / V1
    stiffness2 = -f2.v / f2.dv / V2
    dP1 = stiffness1 * (ratio * f1.v * Q - p.A1 * v)
    dP2 = stiffness2 * (p.A2 * v - ratio * f2.v * Q)
    slope = ratio * orifice_slope(P2 - P1, ratio, p)
    F_seal = seal_friction(v, P1, P2, p)
    stop = stop_force(s, v, p)
    force = (P2 - p.Pa) * p.A2 - (P1 - p.Pa) * p.A1 + F_seal + stop.force
    held1 = strain_energy(f1, density1, P1, V1, p.Pa)
    held2 = strain_energy(f2, density2, P2, V2, p.Pa)
    return StrutForce(
        force=force,
        dz1=dP1,
        dz2=dP2,
        orifice=ratio * Q * (f2.h - f1.h),
        seal=F_seal * v,
        stop=stop.dissipated,
        held=held1 + held2,
        liquid_mass=p.rho0 * (V1 * density1 + V2 * density2),
        a1=stiffness1 * f1.v * slope,
        a2=stiffness2 * f2.v * slope,
    )


def liquid_spring_status(s: float, P1: float, P2: float, p: LegModel) -> StrutStatus:
    """What the end stops hold at stroke `s` [m], and the pressures."""
    return StrutStatus(stop_energy(s, p), P1, P2)


MAIN_STRUTS["liquid-spring"] = MainStrutLaw(liquid_spring, liquid_spring_status)
