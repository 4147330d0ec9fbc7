"""Where the energy is: kinetic, potential, and held by liquid, auxiliary struts, contacts and end stops."""

from math import cos, fabs, pow, sin

from .fluid import strain_energy
from .layout import (
    BODY,
    L_PENETRATION,
    L_STROKE,
    L_STROKE_AUX,
    LEG,
    LOADS,
    P1,
    P2,
    PITCH,
    PITCH_RATE,
    VH,
    VR,
    VX,
    VY,
    H,
    R,
    Y,
)
from .model import Model  # noqa: F401  (the compiled core needs the type)


def kinetic_energy(y, p):
    """Kinetic energy [J] of body and footpads."""
    sin_p = sin(y[PITCH])
    cos_p = cos(y[PITCH])
    rate = y[PITCH_RATE]
    vx = y[VX] * cos_p - y[VY] * sin_p
    vy = y[VX] * sin_p + y[VY] * cos_p
    total = p.m_u * (y[VX] * y[VX] + y[VY] * y[VY]) + p.I_u * rate * rate
    for i in range(p.n_groups):
        k = BODY + LEG * i
        fx = vx + y[k + VR] * p.cos_g[i] + rate * y[k + H]
        fy = vy + y[k + VH] - rate * y[k + R] * p.cos_g[i]
        fz = y[k + VR] * p.sin_g[i]
        total += p.count[i] * p.m_d * (fx * fx + fy * fy + fz * fz)
    return 0.5 * total


def potential_energy(y, p):
    """Potential energy [J] of body and footpads above the inertial origin."""
    sin_p = sin(y[PITCH])
    cos_p = cos(y[PITCH])
    total = p.m_u * y[Y]
    for i in range(p.n_groups):
        k = BODY + LEG * i
        total += p.count[i] * p.m_d * (y[Y] - y[k + R] * p.cos_g[i] * sin_p + y[k + H] * cos_p)
    return p.g * total


def liquid_energy(y, p, w):
    """Energy [J] that the dampers' liquid holds."""
    total = 0.0
    for i in range(p.n_groups):
        k = BODY + LEG * i
        s = w[LOADS * i + L_STROKE]
        upper = strain_energy(y[k + P1], p.V10 + p.A1 * s, p.x_air, p.n_air, p.B0, p.kB, p.Pa)
        lower = strain_energy(y[k + P2], p.V20 - p.A2 * s, p.x_air, p.n_air, p.B0, p.kB, p.Pa)
        total += p.count[i] * (upper + lower)
    return total


def auxiliary_energy(p, w):
    """Energy [J] that the auxiliary struts' springs hold."""
    total = 0.0
    for i in range(p.n_groups):
        total += (
            p.count[i] * p.Ka * pow(fabs(w[LOADS * i + L_STROKE_AUX]), p.ek + 1.0) / (p.ek + 1.0)
        )
    return total


def contact_energy(p, w):
    """Energy [J] that the ground's normal elasticity holds."""
    total = 0.0
    for i in range(p.n_groups):
        d = w[LOADS * i + L_PENETRATION]
        if d > 0.0:
            total += p.count[i] * p.Kg * pow(d, p.en + 1.0) / (p.en + 1.0)
    return total


def stop_energy(p, w):
    """Energy [J] that the end stops hold."""
    total = 0.0
    for i in range(p.n_groups):
        s = w[LOADS * i + L_STROKE]
        if s < 0.0:
            total += p.count[i] * 0.5 * p.K_stop * s * s
        elif s > p.s_max:
            total += p.count[i] * 0.5 * p.K_stop * (s - p.s_max) * (s - p.s_max)
    return total
