"""The elastic auxiliary strut with play in its joints (closure).

It bears only where its elongation has taken up the play, g_t in tension or g_c in compression. The
faces come to bear over a part of the play, smoothly, so that forces have slopes everywhere. What
they would bear at elongation 0 is left out, so that a strut in free flight bears nothing.
"""

from __future__ import annotations

from math import pow, sqrt

from ..records import AuxiliaryForce, Bearing, LegModel
from .laws import AUXILIARY_STRUTS, AuxiliaryStrutLaw

# part of the whole play over which the faces come to bear
BEARING_PART = 0.03


def bearing(x: float, p: LegModel) -> Bearing:
    """The spring's elongation u where the joint has moved `x` [m] past one end of its play.

    u = (x + sqrt(x^2 + eps^2))/2, u' = u/sqrt(x^2 + eps^2): 0 well inside, x well past it.
    """
    eps = BEARING_PART * (p.g_t + p.g_c)
    root = sqrt(x * x + eps * eps)
    u = 0.5 * (x + root) if x > 0.0 else 0.5 * eps * eps / (root - x)
    return Bearing(u, u / root)


def elastic_with_play(s: float, v: float, p: LegModel) -> AuxiliaryForce:
    """The strut at stroke `s` [m] and stroke rate `v` [m/s].

    With the elongation e = -s, tension positive,
    F = T(e) - T(0) + k_play e + Ca e' [c_play + (1 - c_play) min(1, u+' + u-')],
    T(e) = Ka (u+^ek u+' - u-^ek u-'), u+ of e - g_t and u- of -e - g_c. The factor u' makes the
    spring's energy a closed form for every ek.
    """
    tension = bearing(-s - p.g_t, p)
    compression = bearing(s - p.g_c, p)
    pushes = pow(compression.u, p.ek)
    pulls = pow(tension.u, p.ek)
    faces = p.Ka * (pushes * compression.slope - pulls * tension.slope) - p.F_0
    work = p.Ka * (pushes * compression.u + pulls * tension.u)
    borne = min(1.0, tension.slope + compression.slope)
    damping = p.Ca * (p.c_play + (1.0 - p.c_play) * borne)
    return AuxiliaryForce(faces + p.k_play * s + damping * v, damping * v * v, work)


def elastic_with_play_energy(s: float, work: float, p: LegModel) -> float:
    """Energy that the spring holds at stroke `s` [m], where it gave `work`, in J.

    With the elongation e = -s,
    H(e) - H(0) - T(0) e + k_play e^2/2, H = Ka/(ek + 1) (u+^(ek + 1) + u-^(ek + 1)).
    H is convex and its slope is T, so that it is never negative; rounding near e = 0 is cut off.
    """
    faces = work / (p.ek + 1.0) - p.U_0 - p.F_0 * s
    return max(0.0, faces) + 0.5 * p.k_play * s * s


AUXILIARY_STRUTS["elastic-with-play"] = AuxiliaryStrutLaw(
    elastic_with_play, elastic_with_play_energy
)
