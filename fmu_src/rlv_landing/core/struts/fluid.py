"""Liquid with entrapped air: one equation of state, and what follows from it. [closure]"""

from __future__ import annotations

from math import exp, log

from ..records import FluidState

# the air has given by then [Pa]
P_FLOOR = 1.0


def fluid(P: float, x: float, n: float, B0: float, kB: float, Pa: float) -> FluidState:
    """The mixture at absolute pressure `P` [Pa], with v the specific volume relative to that at
    `Pa`.

    v = (1 - x) (1 + kB (P - Pa)/B0)^(-1/kB) + x (Pa/P)^(1/n); `x` air's volume fraction at `Pa`,
    `n` its polytropic exponent, `B0`, `kB` the liquid's bulk modulus [Pa] and its slope. Density is
    rho0/v and the effective bulk modulus -v/(dv/dP), so that liquid mass is conserved by
    construction. h = integral of v dP from `Pa` [Pa] is the energy that a flow carries. Pressures
    below 1 Pa count as 1 Pa.
    """
    if P < P_FLOOR:
        P = P_FLOOR
    a = 1.0 + kB * (P - Pa) / B0
    liquid = (1.0 - x) * exp(-log(a) / kB)
    air = x * exp(log(Pa / P) / n)
    v = liquid + air
    dv = -liquid / (a * B0) - air / (n * P)
    h = B0 / (kB - 1.0) * (a * liquid - (1.0 - x)) + n / (n - 1.0) * (P * air - x * Pa)
    return FluidState(v, dv, h)


def strain_energy(f: FluidState, density: float, P: float, V: float, Pa: float) -> float:
    """Energy [J] stored in volume `V` [m3] of the mixture `f`, of `density` 1/v, at pressure `P`
    [Pa]: V (h/v - (P - Pa)), zero at `Pa`.
    """
    return V * (f.h * density - (P - Pa))
