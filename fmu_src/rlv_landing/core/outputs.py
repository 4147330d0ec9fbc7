"""What a user sees, from one state: body, leg groups, energies and status, in the order of `rlv_landing.quantities`.

Strut forces change sign here: the user's are negative in compression. Legs are given a group at a time; the mirror images are made
where the names are made.
"""

from math import fabs

from .energy import (
    auxiliary_energy,
    contact_energy,
    kinetic_energy,
    liquid_energy,
    potential_energy,
    stop_energy,
)
from .fluid import fluid
from .layout import (
    B_AY,
    B_PITCH_ACC,
    BODY,
    INTEGRALS,
    L_AUX,
    L_CONTACT_X,
    L_CONTACT_Y,
    L_CONTACT_Z,
    L_FOOT_X,
    L_FOOT_Y,
    L_FOOT_Z,
    L_MAIN,
    L_PENETRATION,
    L_STROKE,
    L_STROKE_AUX,
    L_STROKE_RATE,
    L_STROKE_RATE_AUX,
    LEG,
    LOADS,
    P1,
    P2,
    PITCH,
    PITCH_RATE,
    VX,
    VY,
    W_EXTERNAL,
    X,
    Y,
)
from .model import Model  # noqa: F401  (the compiled core needs the type)
from .vehicle import right_hand_side

BODY_OUTPUTS = 10
ENERGY_OUTPUTS = 17
STATUS_OUTPUTS = 2
LEG_OUTPUTS = 17

FALLING, CONTACT, SETTLED, TOPPLED = 0.0, 1.0, 2.0, 3.0
TURNED_OVER = 1.5707963267948966
REST_SPEED = 2e-3
REST_ACCELERATION = 0.05


def vehicle_x(y, p, w):
    """Coordinate x [m] of the whole vehicle's centre of gravity: body and footpads."""
    mass = p.m_u
    moment = p.m_u * y[X]
    for i in range(p.n_groups):
        footpads = p.count[i] * p.m_d
        mass += footpads
        moment += footpads * w[LOADS * i + L_FOOT_X]
    return moment / mass


def stability_margin(y, p, w):
    """Horizontal distance [m] from the whole vehicle's centre of gravity to the nearer of the outermost footpads in the symmetric plane;
    negative beyond it."""
    x = vehicle_x(y, p, w)
    low = w[L_FOOT_X]
    high = low
    for i in range(1, p.n_groups):
        foot = w[LOADS * i + L_FOOT_X]
        if foot < low:
            low = foot
        if foot > high:
            high = foot
    return min(x - low, high - x)


def phase(y, dy, p, w, margin):
    """0 falling, 1 contact, 2 settled, 3 toppled (the vehicle's CG is beyond the outermost footpad, or the body has turned over).

    Settled: a footpad touches, the kinetic energy is that of 2 mm/s at most, and the body's acceleration is below 0.05 m/s2.
    """
    if margin < 0.0 or fabs(y[PITCH]) > TURNED_OVER:
        return TOPPLED
    touching = FALLING
    for i in range(p.n_groups):
        if w[LOADS * i + L_PENETRATION] > 0.0:
            touching = CONTACT
    if touching == FALLING:
        return FALLING
    mass = p.m_u
    for i in range(p.n_groups):
        mass += p.count[i] * p.m_d
    if kinetic_energy(y, p) > 0.5 * mass * REST_SPEED * REST_SPEED:
        return CONTACT
    if fabs(dy[VX]) + fabs(dy[VY]) + fabs(dy[PITCH_RATE]) > REST_ACCELERATION:
        return CONTACT
    return SETTLED


def leg_outputs(y, p, w, i, out, o):
    """Write the outputs of leg group `i` to `out[o:]`."""
    k = BODY + LEG * i
    j = LOADS * i
    s = w[j + L_STROKE]
    v1, _, _ = fluid(y[k + P1], p.x_air, p.n_air, p.B0, p.kB, p.Pa)
    v2, _, _ = fluid(y[k + P2], p.x_air, p.n_air, p.B0, p.kB, p.Pa)
    out[o] = -w[j + L_MAIN]
    out[o + 1] = s
    out[o + 2] = w[j + L_STROKE_RATE]
    out[o + 3] = y[k + P1]
    out[o + 4] = y[k + P2]
    out[o + 5] = p.rho0 * ((p.V10 + p.A1 * s) / v1 + (p.V20 - p.A2 * s) / v2)
    out[o + 6] = -w[j + L_AUX]
    out[o + 7] = w[j + L_STROKE_AUX]
    out[o + 8] = w[j + L_STROKE_RATE_AUX]
    out[o + 9] = w[j + L_FOOT_X]
    out[o + 10] = w[j + L_FOOT_Y]
    out[o + 11] = w[j + L_FOOT_Z]
    out[o + 12] = w[j + L_CONTACT_X]
    out[o + 13] = w[j + L_CONTACT_Y]
    out[o + 14] = w[j + L_CONTACT_Z]
    out[o + 15] = w[j + L_PENETRATION]
    out[o + 16] = 1.0 if w[j + L_PENETRATION] > 0.0 else 0.0


def outputs(y, u, p, dy, w, E0, out, o):
    """Fill `out[o:]`: body, energies, status, then each leg group.

    `E0` [J] is the mechanical energy at the start; `dy`, `w` are overwritten.
    """
    right_hand_side(y, u, p, dy, w)
    j = LOADS * p.n_groups
    rate = y[PITCH_RATE]
    out[o] = y[X]
    out[o + 1] = y[Y]
    out[o + 2] = y[PITCH]
    out[o + 3] = y[VX]
    out[o + 4] = y[VY]
    out[o + 5] = rate
    out[o + 6] = dy[VX]
    out[o + 7] = dy[VY]
    out[o + 8] = w[j + B_PITCH_ACC]
    out[o + 9] = w[j + B_AY] - rate * rate * p.H

    o += BODY_OUTPUTS
    out[o] = kinetic_energy(y, p)
    out[o + 1] = potential_energy(y, p)
    out[o + 2] = liquid_energy(y, p, w)
    out[o + 3] = auxiliary_energy(p, w)
    out[o + 4] = contact_energy(p, w)
    out[o + 5] = stop_energy(p, w)
    q = BODY + LEG * p.n_groups
    for i in range(INTEGRALS):
        out[o + 6 + i] = y[q + i]
    held = out[o] + out[o + 1] + out[o + 2] + out[o + 3] + out[o + 4] + out[o + 5]
    dissipated = 0.0
    for i in range(W_EXTERNAL):
        dissipated += y[q + i]
    supplied = 0.0
    for i in range(W_EXTERNAL, INTEGRALS):
        supplied += y[q + i]
    out[o + 15] = dissipated
    out[o + 16] = held + dissipated - supplied - E0

    o += ENERGY_OUTPUTS
    margin = stability_margin(y, p, w)
    out[o] = phase(y, dy, p, w, margin)
    out[o + 1] = margin
    o += STATUS_OUTPUTS
    for i in range(p.n_groups):
        leg_outputs(y, p, w, i, out, o + LEG_OUTPUTS * i)
