"""The liquid-spring damper of the main strut: two chambers, an orifice, a seal, two end stops. Eq. (12)."""

from math import exp, fabs, sqrt, tanh

from .fluid import fluid
from .model import Model  # noqa: F401  (the compiled core needs the type)


def orifice_flow(dP, density_ratio, p):
    """Volume flow [m3/s] from the lower to the upper chamber under `dP` = P2 - P1 [Pa]. [closure]

    Cd Ao sqrt(2/rho) dP/(dP^2 + dP_lam^2)^(1/4): the square-root law with a laminar passage through zero.
    `density_ratio` is the mean of rho/rho0 in the two chambers. Compression and rebound have areas of their own.
    """
    area = p.CdAo_c if dP > 0.0 else p.CdAo_r
    return (
        area * sqrt(2.0 / (p.rho0 * density_ratio)) * dP / sqrt(sqrt(dP * dP + p.dP_lam * p.dP_lam))
    )


def seal_friction(v, P1, P2, p):
    """Seal friction [N] against the stroke rate `v` [m/s]: Coulomb + pressure-proportional + Stribeck, smoothed. [closure]"""
    ratio = v / p.v_str
    level = p.Fc + p.kp * 0.5 * (fabs(P1 - p.Pa) + fabs(P2 - p.Pa)) + p.Fs * exp(-ratio * ratio)
    return level * tanh(v / p.v_sm)


def stop_force(s, v, p):
    """Return (force, dissipated power) of the end stops, force [N] positive where it pushes the strut longer. [closure]

    One-sided K e (1 + c e') with overlap `e` beyond full extension (s < 0) or full compression (s > s_max), never pulling.
    """
    if s < 0.0:
        force = -p.K_stop * s * (1.0 - p.c_stop * v)
        if force < 0.0:
            force = 0.0
        return -force, -(force + p.K_stop * s) * v
    if s > p.s_max:
        e = s - p.s_max
        force = p.K_stop * e * (1.0 + p.c_stop * v)
        if force < 0.0:
            force = 0.0
        return force, (force - p.K_stop * e) * v
    return 0.0, 0.0


def orifice_slope(dP, density_ratio, p):
    """Derivative of `orifice_flow` by `dP` [m3/(s Pa)]."""
    area = p.CdAo_c if dP > 0.0 else p.CdAo_r
    square = dP * dP + p.dP_lam * p.dP_lam
    return (
        area
        * sqrt(2.0 / (p.rho0 * density_ratio))
        * (square - 0.5 * dP * dP)
        / (square * sqrt(sqrt(square)))
    )


def damper(s, v, P1, P2, p):
    """Return (force, P1', P2', orifice power, seal power, stop power, a1, a2) at stroke `s` [m] and stroke rate `v` [m/s].

    Force [N] is positive in compression. Chamber 1 is the upper annulus, chamber 2 the lower bore. Powers [W] are dissipated.
    The flow evens x = P2 - P1 out: a change of x changes the pressures' rates by a1 x and -a2 x, a1, a2 [1/s].
    """
    v1, dv1, h1 = fluid(P1, p.x_air, p.n_air, p.B0, p.kB, p.Pa)
    v2, dv2, h2 = fluid(P2, p.x_air, p.n_air, p.B0, p.kB, p.Pa)
    ratio = 0.5 * (1.0 / v1 + 1.0 / v2)
    Q = orifice_flow(P2 - P1, ratio, p)
    stiffness1 = -v1 / dv1 / (p.V10 + p.A1 * s)
    stiffness2 = -v2 / dv2 / (p.V20 - p.A2 * s)
    dP1 = stiffness1 * (ratio * v1 * Q - p.A1 * v)
    dP2 = stiffness2 * (p.A2 * v - ratio * v2 * Q)
    slope = ratio * orifice_slope(P2 - P1, ratio, p)
    F_seal = seal_friction(v, P1, P2, p)
    F_stop, stop_power = stop_force(s, v, p)
    force = (P2 - p.Pa) * p.A2 - (P1 - p.Pa) * p.A1 + F_seal + F_stop
    return (
        force,
        dP1,
        dP2,
        ratio * Q * (h2 - h1),
        F_seal * v,
        stop_power,
        stiffness1 * v1 * slope,
        stiffness2 * v2 * slope,
    )
