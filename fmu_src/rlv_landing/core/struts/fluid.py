"""Liquid with entrapped air: one equation of state, and what follows from it (closure)."""

from __future__ import annotations

from math import exp, log

from ..records import FluidState

# where a chamber's state z ceases to be its pressure [Pa]: below, the pressure falls as exp(z), so
# that it stays above 0 wherever z goes
CAVITY_PRESSURE = 10.0
# the lowest power of e that is worked out: the air would fill 1e50 times its room
LEAST_EXPONENT = -150.0


def pressure_slope(z: float) -> float:
    """dP/dz at the state `z` [Pa] of a chamber, as in `fluid`."""
    if z < CAVITY_PRESSURE:
        return exp(max((z - CAVITY_PRESSURE) / CAVITY_PRESSURE, LEAST_EXPONENT))
    return 1.0


def fluid(z: float, x: float, n: float, B0: float, kB: float, Pa: float) -> FluidState:
    """The mixture at the state `z` [Pa] of a chamber.

    v = (1 - x) (1 + kB (P - Pa)/B0)^(-1/kB) + x (Pa/P)^(1/n) is the specific volume relative to
    that at `Pa`; `x` air's volume fraction at `Pa`, `n` its polytropic exponent, `B0`, `kB` the
    liquid's bulk modulus [Pa] and its slope. Density is rho0/v and the effective bulk modulus
    -v/(dv/dP), so that liquid mass is conserved by construction. h = integral of v dP from `Pa`
    [Pa] is the energy that a flow carries.

    P = z [Pa], absolute, from Pc = 10 Pa up; below, where the chamber is a cavity and the air makes
    all of its volume's change, P = Pc exp((z - Pc)/Pc). So any z is a state of the mixture, with P
    above 0.
    """
    base = max(z, CAVITY_PRESSURE)
    slope = pressure_slope(z)
    P = base * slope
    a = 1.0 + kB * (P - Pa) / B0
    liquid = (1.0 - x) * exp(-log(a) / kB)
    air = x * exp(log(Pa / P) / n)
    v = liquid + air
    dv = -liquid * slope / (a * B0) - air / (n * base)
    h = B0 / (kB - 1.0) * (a * liquid - (1.0 - x)) + n / (n - 1.0) * (P * air - x * Pa)
    return FluidState(P, slope, v, dv, h)


def pressure(z: float) -> float:
    """Absolute pressure [Pa] at the state `z` [Pa] of a chamber, as in `fluid`."""
    return max(z, CAVITY_PRESSURE) * pressure_slope(z)


def strain_energy(f: FluidState, density: float, V: float, Pa: float) -> float:
    """Energy stored in volume `V` [m3] of the mixture `f`, of `density` 1/v [J].

    V (h/v - (P - Pa)), zero at `Pa`.
    """
    return V * (f.h * density - (f.P - Pa))
