"""The paper's friction: a reset integral with Stribeck effect. Eqs. (16), (17).

It acts along each of the ground's directions by itself. Its states q1, q2 are the friction
displacements [m] along 1 and 2. The law is not passive: where the normal force or the direction of
slip changes under a displacement, it may supply energy. So nothing is called held, and what is
called dissipated is all that the law takes, which may be less than 0.
"""

from __future__ import annotations

from math import exp, fabs, sqrt

from ..records import FootMotion, Friction, FrictionBound, FrictionForce, LegModel
from .laws import FRICTION_LAWS, FrictionLaw
from .normal import damping_ramp


def friction_along(d: float, Fn: float, mu: float, v: float, s: float, p: LegModel) -> Friction:
    """Friction along one direction, at slip speed `v` [m/s] and displacement `s` [m].

    Eqs. (16), (17).

    Slip where `s` has reached s_r0 in the sense of `v`: s' = 0; else stick: s' = v. The stick
    damping Cr fades in with the contact and out towards slip. Out of contact `s` returns to 0 with
    time constant tau_sr. [closure]
    """
    if d <= 0.0:
        return Friction(0.0, -s / p.tau_sr)
    bounded = s
    if s > p.s_r0:
        bounded = p.s_r0
    elif s < -p.s_r0:
        bounded = -p.s_r0
    K = mu * Fn / p.s_r0
    if v * s > 0.0 and fabs(s) >= p.s_r0:
        return Friction(-K * (1.0 + p.ar * exp(-fabs(v) / p.b_strib)) * bounded, 0.0)
    q = bounded / p.s_r0
    return Friction(-K * (1.0 + p.ar) * bounded - p.Cr * damping_ramp(d, p) * (1.0 - q * q) * v, v)


def paper_friction(foot: FootMotion, Fn: float, q1: float, q2: float, p: LegModel) -> FrictionForce:
    """Friction on a footpad under the normal force `Fn` [N].

    The friction coefficient is shared by the direction of slip, mu_1^2 + mu_2^2 = mu^2; at rest
    `share_1` is 1's part of mu^2.
    """
    w = p.v_dir * p.v_dir
    v1 = foot.slip_1
    v2 = foot.slip_2
    speed = v1 * v1 + v2 * v2 + w
    along1 = friction_along(
        foot.depth, Fn, p.mu * sqrt((v1 * v1 + p.share_1 * w) / speed), v1, q1, p
    )
    along2 = friction_along(
        foot.depth, Fn, p.mu * sqrt((v2 * v2 + (1.0 - p.share_1) * w) / speed), v2, q2, p
    )
    taken = -(along1.force * v1 + along2.force * v2)
    return FrictionForce(along1.force, along2.force, along1.rate, along2.rate, taken)


def paper_friction_bound(q1: float, q2: float, p: LegModel) -> FrictionBound:
    """The displacements within the slip limit.

    What a step gathers beyond it after sticking has turned to slip is taken off.
    """
    return FrictionBound(min(max(q1, -p.s_r0), p.s_r0), min(max(q2, -p.s_r0), p.s_r0))


def paper_friction_energy(q1: float, q2: float, p: LegModel) -> float:
    """Nothing is called held."""
    return 0.0


def paper_friction_only_takes(p: LegModel) -> bool:
    """It may give."""
    return False


FRICTION_LAWS["paper"] = FrictionLaw(
    paper_friction, paper_friction_bound, paper_friction_energy, paper_friction_only_takes
)
