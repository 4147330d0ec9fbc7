"""The liquid-spring damper of the main strut: two chambers, an orifice, a seal, two end stops.

Eq. (12).

Its states z1, z2 [Pa] are those of the upper annulus (chamber 1) and the lower bore (chamber 2):
their absolute pressures P1, P2 except in a cavity, see `fluid`.
"""

from __future__ import annotations

from math import exp, fabs, sqrt, tanh

from ..records import Chamber, FluidState, LegModel, StrutForce, StrutStatus
from .end_stops import stop_energy, stop_force
from .fluid import fluid, pressure, strain_energy
from .laws import MAIN_STRUTS, MainStrutLaw

# parts of a chamber's volume at full extension: below which the piston displaces less and less, and
# which it never displaces
LAST_PART, DEAD_PART = 0.05, 0.025


def chamber(V0: float, area: float, travel: float) -> Chamber:
    """A chamber of `V0` [m3] whose piston has moved away by `travel` [m] (closure).

    V0 + area travel, down to 5 % of V0. Below, V falls as exp(travel) towards 2.5 % of V0, with the
    same slope to begin with, so that however far a soft stop lets the piston go, a chamber is left.
    The area that the pressure acts on is dV/dtravel throughout.
    """
    V = V0 + area * travel
    past = V - LAST_PART * V0
    if past >= 0.0:
        return Chamber(V, area)
    dead = DEAD_PART * V0
    displaced = LAST_PART * V0 - dead
    part = exp(past / displaced)
    return Chamber(dead + displaced * part, area * part)


def mixture(z: float, p: LegModel) -> FluidState:
    """The mixture in a chamber of state `z` [Pa]."""
    return fluid(z, p.x_air, p.n_air, p.B0, p.kB, p.Pa)


def orifice_flow(dP: float, density_ratio: float, p: LegModel) -> float:
    """Volume flow [m3/s] from the lower to the upper chamber under `dP` = P2 - P1 [Pa] (closure).

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
    """Seal friction against the stroke rate `v` [m/s], in N (closure).

    Coulomb + pressure-proportional + Stribeck, smoothed.
    """
    ratio = v / p.v_str
    level = p.Fc + p.kp * 0.5 * (fabs(P1 - p.Pa) + fabs(P2 - p.Pa)) + p.Fs * exp(-ratio * ratio)
    return level * tanh(v / p.v_sm)


def liquid_spring(s: float, v: float, z1: float, z2: float, p: LegModel) -> StrutForce:
    """The damper at stroke `s` [m] and stroke rate `v` [m/s]. Eq. (12).

    The flow evens x = z2 - z1 out: a change of x changes the states' rates by a1 x and -a2 x.
    """
    f1 = mixture(z1, p)
    f2 = mixture(z2, p)
    upper = chamber(p.V10, p.A1, s)
    lower = chamber(p.V20, p.A2, -s)
    density1 = 1.0 / f1.v
    density2 = 1.0 / f2.v
    ratio = 0.5 * (density1 + density2)
    dP = f2.P - f1.P
    Q = orifice_flow(dP, ratio, p)
    stiffness1 = -f1.v / f1.dv / upper.V
    stiffness2 = -f2.v / f2.dv / lower.V
    slope = ratio * orifice_slope(dP, ratio, p) * max(f1.slope, f2.slope)
    F_seal = seal_friction(v, f1.P, f2.P, p)
    stop = stop_force(s, v, p)
    held1 = strain_energy(f1, density1, upper.V, p.Pa)
    held2 = strain_energy(f2, density2, lower.V, p.Pa)
    # the chambers' masses over rho0
    m1 = upper.V * density1
    m2 = lower.V * density2
    return StrutForce(
        force=(f2.P - p.Pa) * lower.area - (f1.P - p.Pa) * upper.area + F_seal + stop.force,
        dz1=stiffness1 * (ratio * f1.v * Q - upper.area * v),
        dz2=stiffness2 * (lower.area * v - ratio * f2.v * Q),
        orifice=ratio * Q * (f2.h - f1.h),
        seal=F_seal * v,
        stop=stop.dissipated,
        held=held1 + held2,
        liquid_mass=p.rho0 * (m1 + m2),
        a1=stiffness1 * f1.v * slope,
        a2=stiffness2 * f2.v * slope,
        mass_1=-p.rho0 * m1 * density1 * f1.dv,
        mass_2=-p.rho0 * m2 * density2 * f2.dv,
    )


def liquid_spring_status(s: float, z1: float, z2: float, p: LegModel) -> StrutStatus:
    """The energy that the end stops hold at stroke `s` [m], and the pressures."""
    return StrutStatus(stop_energy(s, p), pressure(z1), pressure(z2))


MAIN_STRUTS["liquid-spring"] = MainStrutLaw(liquid_spring, liquid_spring_status)
