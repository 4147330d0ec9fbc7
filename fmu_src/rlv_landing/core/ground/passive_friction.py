"""Friction that never supplies energy: a spring and a slider in the ground's plane (closure).

The spring has a constant stiffness, and a slider of Coulomb's kind carries its other end. The
states q1, q2 are the spring's displacement s [m] along 1 and 2. Up to |s| = s_lim the footpad
sticks and nothing is lost; from there on the slider comes into motion within `zone`, smoothly. Of
what friction takes from the motion, K |s|^2/2 is held, and the rest, which is never below 0, is
dissipated: -F.v = held' + dissipated' whatever the normal force does (derived).
"""

from __future__ import annotations

from math import exp, sqrt

from ..records import FootMotion, FrictionBound, FrictionForce, LegModel
from .laws import FRICTION_LAWS, FrictionLaw
from .normal import damping_ramp


def stick_limit(foot: FootMotion, Fn: float, p: LegModel) -> float:
    """Displacement at which a footpad under the normal force `Fn` [N] starts to slip [m].

    It is that of Coulomb's limit with the Stribeck excess.
    """
    speed = sqrt(foot.slip_1 * foot.slip_1 + foot.slip_2 * foot.slip_2)
    return p.mu * Fn * (1.0 + p.ar * exp(-speed / p.b_strib)) / p.K_t


def slider_share(past: float, p: LegModel) -> float:
    """0 to 1, smooth: the slider's share in the motion, `past` [m] beyond the limit."""
    q = past / p.zone
    if q >= 1.0:
        return 1.0
    if q <= 0.0:
        return 0.0
    return q * q * (3.0 - 2.0 * q)


def sticking(foot: FootMotion, q1: float, q2: float, part: float, p: LegModel) -> FrictionForce:
    """Friction below the limit, of which |s| is a `part`: s' = v, and the stick damping.

    The damping Cr fades in with the contact and out towards the limit.
    """
    v1 = foot.slip_1
    v2 = foot.slip_2
    damping = p.Cr * damping_ramp(foot.depth, p) * (1.0 - part * part)
    return FrictionForce(
        -p.K_t * q1 - damping * v1,
        -p.K_t * q2 - damping * v2,
        v1,
        v2,
        damping * (v1 * v1 + v2 * v2),
    )


def slipping(
    foot: FootMotion, q1: float, q2: float, limit: float, size: float, p: LegModel
) -> FrictionForce:
    """At and beyond the `limit` [m], with |s| = `size` [m], both measured along n = s/|s|.

    F = -K limit n. Where s grows, s' = v - n [vn - (1 - f) limit/|s| vn] with the slider's share f;
    where it shrinks, s' = v. What is beyond the zone returns with time constant tau_sr.
    """
    n1 = q1 / size
    n2 = q2 / size
    vn = foot.slip_1 * n1 + foot.slip_2 * n2
    past = size - limit
    back = 0.0
    if past > p.zone:
        back = (past - p.zone) / p.tau_sr
    lost = p.K_t * size * back
    if vn > 0.0:
        share = slider_share(past, p)
        lost += p.K_t * limit * vn * share
        back += vn * (1.0 - (1.0 - share) * limit / size)
    else:
        lost -= p.K_t * past * vn
    force = p.K_t * limit
    return FrictionForce(
        -force * n1, -force * n2, foot.slip_1 - n1 * back, foot.slip_2 - n2 * back, lost
    )


def passive_friction(
    foot: FootMotion, Fn: float, q1: float, q2: float, p: LegModel
) -> FrictionForce:
    """Friction on a footpad under the normal force `Fn` [N].

    F = -K s min(1, s_lim/|s|), and the stick damping. Out of contact s returns to 0 with time
    constant tau_sr. Where there is neither a displacement nor a limit, as with mu = 0, s stays 0.
    """
    square = q1 * q1 + q2 * q2
    if foot.depth <= 0.0:
        return FrictionForce(0.0, 0.0, -q1 / p.tau_sr, -q2 / p.tau_sr, p.K_t * square / p.tau_sr)
    limit = stick_limit(foot, Fn, p)
    size = sqrt(square)
    if size < limit:
        return sticking(foot, q1, q2, size / limit, p)
    if size <= 0.0:
        return FrictionForce(0.0, 0.0, 0.0, 0.0, 0.0)
    return slipping(foot, q1, q2, limit, size, p)


def passive_friction_bound(q1: float, q2: float, p: LegModel) -> FrictionBound:
    """The displacement wherever it is: the law itself brings it back."""
    return FrictionBound(q1, q2)


def passive_friction_energy(q1: float, q2: float, p: LegModel) -> float:
    """Energy [J] that the spring holds."""
    return 0.5 * p.K_t * (q1 * q1 + q2 * q2)


def passive_friction_only_takes(p: LegModel) -> bool:
    """It never gives."""
    return True


FRICTION_LAWS["passive"] = FrictionLaw(
    passive_friction, passive_friction_bound, passive_friction_energy, passive_friction_only_takes
)
