"""One leg: main strut, auxiliary strut and footpad in a plane fixed in the body. It knows its azimuth, not the landing mode."""

from math import sqrt

from .auxiliary_strut import auxiliary
from .contact import contact
from .damper import damper
from .layout import (
    HEAVE,
    HEAVE_RATE,
    L_AUX,
    L_BODY_MOMENT,
    L_BODY_X,
    L_BODY_Y,
    L_CONTACT_X,
    L_CONTACT_Y,
    L_CONTACT_Z,
    L_DECAY1,
    L_DECAY2,
    L_DISSIPATED_AUX,
    L_DISSIPATED_CONTACT,
    L_DP1,
    L_DP2,
    L_DSX,
    L_DSZ,
    L_FOOT_X,
    L_FOOT_Y,
    L_FOOT_Z,
    L_FRICTION,
    L_GROUND,
    L_MAIN,
    L_ORIFICE,
    L_PENETRATION,
    L_RADIAL,
    L_SEAL,
    L_STOP,
    L_STROKE,
    L_STROKE_AUX,
    L_STROKE_RATE,
    L_STROKE_RATE_AUX,
    L_TANGENTIAL,
    L_VERTICAL,
    P1,
    P2,
    PITCH_RATE,
    SX,
    SZ,
    TILT_RATE,
    VH,
    VR,
    VX,
    VY,
    H,
    R,
    X,
    Y,
)
from .model import Model  # noqa: F401  (the compiled core needs the type)


def strut(r, h, vr, vh, joint_r, joint_h, length):
    """Return (stroke, stroke rate, e_r, e_h) of a strut from its joint on the body to the footpad; `e` points to the footpad.

    Stroke [m] is positive in compression, Eqs. (19), (25), seen in the body's frame, where the joint rests.
    """
    dr = r - joint_r
    dh = h - joint_h
    now = sqrt(dr * dr + dh * dh)
    er = dr / now
    eh = dh / now
    return length - now, -(vr * er + vh * eh), er, eh


def ground_frame(x, y, z_rate, vx, vy, sin_a, cos_a, u):
    """Return (penetration, its rate, slip x, slip z, ground velocity x, y) of an inertial point on the moving, sloped ground.

    The ground turns clockwise by `alpha` about the inertial origin and is lifted by the heave.
    """
    yo = y - u[HEAVE]
    gx = u[TILT_RATE] * yo
    gy = u[HEAVE_RATE] - u[TILT_RATE] * x
    rx = vx - gx
    ry = vy - gy
    return (
        -(x * sin_a + yo * cos_a),
        -(rx * sin_a + ry * cos_a),
        rx * cos_a - ry * sin_a,
        z_rate,
        gx,
        gy,
    )


def leg_loads(y, k, sin_g, cos_g, share_x, sin_p, cos_p, sin_a, cos_a, u, p, w, j):
    """Fill the loads `w[j:]` of the leg whose state is `y[k:]`; `sin_p`, `cos_p` of the pitch, `sin_a`, `cos_a` of the slope."""
    r = y[k + R]
    h = y[k + H]
    vr = y[k + VR]
    vh = y[k + VH]
    rate = y[PITCH_RATE]

    s, v, er, eh = strut(r, h, vr, vh, p.La, p.Lb, p.Lm0)
    sa, va, ar, ah = strut(r, h, vr, vh, p.Lc, p.Ld, p.Ls0)
    Fh, dP1, dP2, orifice_power, seal_power, stop_power, decay1, decay2 = damper(
        s, v, y[k + P1], y[k + P2], p
    )
    Fa, auxiliary_power = auxiliary(sa, va, p)

    bx = r * cos_g
    vbx = vr * cos_g + rate * h
    vby = vh - rate * bx
    foot_x = y[X] + bx * cos_p + h * sin_p
    foot_y = y[Y] - bx * sin_p + h * cos_p
    foot_vx = y[VX] + vbx * cos_p + vby * sin_p
    foot_vy = y[VY] - vbx * sin_p + vby * cos_p
    d, dv, slip_x, slip_z, gx, gy = ground_frame(
        foot_x, foot_y, vr * sin_g, foot_vx, foot_vy, sin_a, cos_a, u
    )
    Fn, Fx, Fz, dsx, dsz, contact_power, friction_power = contact(
        d, dv, slip_x, slip_z, y[k + SX], y[k + SZ], share_x, p
    )

    Cx = Fx * cos_a + Fn * sin_a
    Cy = Fn * cos_a - Fx * sin_a
    weight = p.m_d * p.g
    body_x = Cx * cos_p - (Cy - weight) * sin_p
    body_y = Cx * sin_p + (Cy - weight) * cos_p
    main_r = Fh * er
    main_h = Fh * eh
    aux_r = Fa * ar
    aux_h = Fa * ah

    w[j + L_STROKE] = s
    w[j + L_STROKE_RATE] = v
    w[j + L_MAIN] = Fh
    w[j + L_STROKE_AUX] = sa
    w[j + L_STROKE_RATE_AUX] = va
    w[j + L_AUX] = Fa
    w[j + L_FOOT_X] = foot_x
    w[j + L_FOOT_Y] = foot_y
    w[j + L_FOOT_Z] = r * sin_g
    w[j + L_PENETRATION] = d
    w[j + L_CONTACT_X] = Cx
    w[j + L_CONTACT_Y] = Cy
    w[j + L_CONTACT_Z] = Fz
    w[j + L_RADIAL] = body_x * cos_g + Fz * sin_g + main_r + aux_r
    w[j + L_VERTICAL] = body_y + main_h + aux_h
    w[j + L_TANGENTIAL] = Fz * cos_g - body_x * sin_g
    w[j + L_BODY_X] = -(main_r + aux_r) * cos_g
    w[j + L_BODY_Y] = -(main_h + aux_h)
    w[j + L_BODY_MOMENT] = cos_g * (p.La * main_h - p.Lb * main_r + p.Lc * aux_h - p.Ld * aux_r)
    w[j + L_DP1] = dP1
    w[j + L_DP2] = dP2
    w[j + L_DSX] = dsx
    w[j + L_DSZ] = dsz
    w[j + L_DECAY1] = decay1
    w[j + L_DECAY2] = decay2
    w[j + L_ORIFICE] = orifice_power
    w[j + L_SEAL] = seal_power
    w[j + L_STOP] = stop_power
    w[j + L_DISSIPATED_AUX] = auxiliary_power
    w[j + L_DISSIPATED_CONTACT] = contact_power
    w[j + L_FRICTION] = friction_power
    w[j + L_GROUND] = Cx * gx + Cy * gy
