"""The footpad on the ground: normal force, and reset-integral friction with Stribeck effect. Eqs. (14)-(17)."""

from math import exp, fabs, pow, sqrt

from .model import Model  # noqa: F401  (the compiled core needs the type)


def damping_ramp(d, p):
    """0 to 1, smooth, as the penetration `d` [m] grows from 0 to d_ramp. [closure]"""
    q = d / p.d_ramp
    if q >= 1.0:
        return 1.0
    if q <= 0.0:
        return 0.0
    return q * q * (3.0 - 2.0 * q)


def normal_force(d, v, p):
    """Return (force, dissipated power) at penetration `d` [m] growing at `v` [m/s]; never pulls. Eqs. (14), (15)."""
    if d <= 0.0:
        return 0.0, 0.0
    elastic = p.Kg * pow(d, p.en)
    force = elastic + p.Cgmax * damping_ramp(d, p) * v
    if force < 0.0:
        force = 0.0
    return force, (force - elastic) * v


def friction(d, Fn, mu, v, s, p):
    """Return (force, s') along one direction of the ground, at slip speed `v` [m/s] and displacement `s` [m]. Eqs. (16), (17).

    Slip where `s` has reached s_r0 in the sense of `v`: s' = 0; else stick: s' = v. The stick damping Cr fades in with the
    contact and out towards slip. Out of contact `s` returns to 0 with time constant tau_sr. [closure]
    """
    if d <= 0.0:
        return 0.0, -s / p.tau_sr
    bounded = s
    if s > p.s_r0:
        bounded = p.s_r0
    elif s < -p.s_r0:
        bounded = -p.s_r0
    K = mu * Fn / p.s_r0
    if v * s > 0.0 and fabs(s) >= p.s_r0:
        return -K * (1.0 + p.ar * exp(-fabs(v) / p.b_strib)) * bounded, 0.0
    q = bounded / p.s_r0
    return -K * (1.0 + p.ar) * bounded - p.Cr * damping_ramp(d, p) * (1.0 - q * q) * v, v


def contact(d, v, vx, vz, sx, sz, share_x, p):
    """Return (Fn, Fx, Fz, sx', sz', normal power, friction power) of the ground on one footpad, in the ground's axes.

    `d`, `v` penetration and its rate, `vx`, `vz` slip velocity, `sx`, `sz` friction displacements. The friction coefficient is
    shared by the direction of slip, mu_x^2 + mu_z^2 = mu^2; `share_x` is x's part of mu^2 at rest (1/2; 1 where the leg lies
    in the symmetric plane). Friction power [W] is taken from the motion, part of it held by the friction displacement.
    """
    Fn, normal_power = normal_force(d, v, p)
    w = p.v_dir * p.v_dir
    speed = vx * vx + vz * vz + w
    Fx, dsx = friction(d, Fn, p.mu * sqrt((vx * vx + share_x * w) / speed), vx, sx, p)
    Fz, dsz = friction(d, Fn, p.mu * sqrt((vz * vz + (1.0 - share_x) * w) / speed), vz, sz, p)
    return Fn, Fx, Fz, dsx, dsz, normal_power, -(Fx * vx + Fz * vz)
