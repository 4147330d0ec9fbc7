"""The right-hand side: body and leg groups under their loads, without small angles. Eqs. (2)-(11), (29)-(37), as derived."""

from math import cos, sin

from .layout import (
    B_AX,
    B_AY,
    B_PITCH_ACC,
    BODY,
    E_AUXILIARY,
    E_CONTACT,
    E_FRICTION,
    E_ORIFICE,
    E_SEAL,
    E_STOP,
    FORCE_X,
    FORCE_Y,
    INTEGRALS,
    L_BODY_MOMENT,
    L_BODY_X,
    L_BODY_Y,
    L_DISSIPATED_AUX,
    L_DISSIPATED_CONTACT,
    L_DP1,
    L_DP2,
    L_DSX,
    L_DSZ,
    L_FRICTION,
    L_GROUND,
    L_ORIFICE,
    L_RADIAL,
    L_SEAL,
    L_STOP,
    L_TANGENTIAL,
    L_VERTICAL,
    LEG,
    LOADS,
    MOMENT,
    P1,
    P2,
    PITCH,
    PITCH_RATE,
    SX,
    SZ,
    TILT,
    VH,
    VR,
    VX,
    VY,
    W_EXTERNAL,
    W_GROUND,
    W_TRANSVERSE,
    H,
    R,
    X,
    Y,
)
from .leg import leg_loads
from .model import Model  # noqa: F401  (the compiled core needs the type)


def transverse_height(h, p):
    """Height [m] below the CG, body axes, where the auxiliary strut's transverse force acts on the body: footpad or joint."""
    return h + p.at_joint * (p.Ld - h)


def body_acceleration(y, u, p, w, sin_p, cos_p):
    """Write the body's acceleration along its own axes behind the legs' loads in `w`.

    Two coupled equations for a_x and the pitch acceleration, because the transverse force that keeps each footpad in its
    plane contains both; a_y stands alone. Clockwise pitch and moments are positive.
    """
    rate = y[PITCH_RATE]
    fx = u[FORCE_X]
    fy = u[FORCE_Y] - p.m_u * p.g
    force_x = fx * cos_p - fy * sin_p
    force_y = fx * sin_p + fy * cos_p
    moment = u[MOMENT]
    m11 = p.m_u
    m12 = 0.0
    m21 = 0.0
    m22 = p.I_u
    for i in range(p.n_groups):
        k = BODY + LEG * i
        j = LOADS * i
        n = p.count[i]
        s = p.sin_g[i]
        h = y[k + H]
        yn = transverse_height(h, p)
        mass = n * p.m_d * s * s
        m11 += mass
        m12 += mass * h
        m21 += mass * yn
        m22 += mass * yn * h
        bias = (
            n
            * s
            * (
                w[j + L_TANGENTIAL]
                + p.m_d * s * (2.0 * rate * y[k + VH] - rate * rate * y[k + R] * p.cos_g[i])
            )
        )
        force_x += n * w[j + L_BODY_X] - bias
        force_y += n * w[j + L_BODY_Y]
        moment += n * w[j + L_BODY_MOMENT] - bias * yn
    determinant = m11 * m22 - m12 * m21
    j = LOADS * p.n_groups
    w[j + B_AX] = (force_x * m22 - moment * m12) / determinant
    w[j + B_AY] = force_y / p.m_u
    w[j + B_PITCH_ACC] = (m11 * moment - m21 * force_x) / determinant


def leg_derivatives(y, p, w, dy, i, ax, ay, pitch_acc):
    """Write the derivatives of leg group `i`; return (work rate of the transverse force, transverse force on the footpad [N])."""
    k = BODY + LEG * i
    j = LOADS * i
    rate = y[PITCH_RATE]
    h = y[k + H]
    s = p.sin_g[i]
    bx = y[k + R] * p.cos_g[i]
    frame_x = ax + pitch_acc * h - rate * rate * bx + 2.0 * rate * y[k + VH]
    frame_y = ay - pitch_acc * bx - rate * rate * h - 2.0 * rate * y[k + VR] * p.cos_g[i]
    dy[k + R] = y[k + VR]
    dy[k + H] = y[k + VH]
    dy[k + VR] = w[j + L_RADIAL] / p.m_d - frame_x * p.cos_g[i]
    dy[k + VH] = w[j + L_VERTICAL] / p.m_d - frame_y
    dy[k + P1] = w[j + L_DP1]
    dy[k + P2] = w[j + L_DP2]
    dy[k + SX] = w[j + L_DSX]
    dy[k + SZ] = w[j + L_DSZ]
    N = -p.m_d * s * frame_x - w[j + L_TANGENTIAL]
    return -N * s * rate * (h - transverse_height(h, p)), N


def right_hand_side(y, u, p, dy, w):
    """Write dy/dt into `dy` and every load on the way into `w`, from the state `y`, the inputs `u` and the model `p`."""
    sin_p = sin(y[PITCH])
    cos_p = cos(y[PITCH])
    sin_a = sin(p.alpha + u[TILT])
    cos_a = cos(p.alpha + u[TILT])
    for i in range(p.n_groups):
        k = BODY + LEG * i
        leg_loads(
            y,
            k,
            p.sin_g[i],
            p.cos_g[i],
            p.share_x[i],
            sin_p,
            cos_p,
            sin_a,
            cos_a,
            u,
            p,
            w,
            LOADS * i,
        )
    body_acceleration(y, u, p, w, sin_p, cos_p)
    j = LOADS * p.n_groups
    ax = w[j + B_AX]
    ay = w[j + B_AY]
    pitch_acc = w[j + B_PITCH_ACC]
    dy[X] = y[VX]
    dy[Y] = y[VY]
    dy[PITCH] = y[PITCH_RATE]
    dy[VX] = ax * cos_p + ay * sin_p
    dy[VY] = ay * cos_p - ax * sin_p
    dy[PITCH_RATE] = pitch_acc

    q = BODY + LEG * p.n_groups
    for i in range(INTEGRALS):
        dy[q + i] = 0.0
    dy[q + W_EXTERNAL] = u[FORCE_X] * y[VX] + u[FORCE_Y] * y[VY] + u[MOMENT] * y[PITCH_RATE]
    for i in range(p.n_groups):
        j = LOADS * i
        n = p.count[i]
        work, _ = leg_derivatives(y, p, w, dy, i, ax, ay, pitch_acc)
        dy[q + W_TRANSVERSE] += n * work
        dy[q + E_ORIFICE] += n * w[j + L_ORIFICE]
        dy[q + E_SEAL] += n * w[j + L_SEAL]
        dy[q + E_STOP] += n * w[j + L_STOP]
        dy[q + E_AUXILIARY] += n * w[j + L_DISSIPATED_AUX]
        dy[q + E_CONTACT] += n * w[j + L_DISSIPATED_CONTACT]
        dy[q + E_FRICTION] += n * w[j + L_FRICTION]
        dy[q + W_GROUND] += n * w[j + L_GROUND]
