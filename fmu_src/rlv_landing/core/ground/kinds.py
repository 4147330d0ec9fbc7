"""The ground under a footpad: the normal law, and friction by the law that each leg has.

A new law is a file of its own, named in the first import below. Compiled, the functions that choose
a law branch on its number.
"""

from __future__ import annotations

from ..memory import chosen
from ..records import FootMotion, FrictionBound, FrictionForce, GroundForce, LegModel
from . import paper_friction, passive_friction  # noqa: F401  each adds its law to the table
from .laws import FRICTION_LAWS as FRICTION_LAWS
from .normal import normal_force


def friction(foot: FootMotion, Fn: float, q1: float, q2: float, p: LegModel) -> FrictionForce:
    """Friction on a footpad under the normal force `Fn` [N]."""
    return chosen(FRICTION_LAWS, p.friction_kind).force(foot, Fn, q1, q2, p)


def friction_bound(q1: float, q2: float, p: LegModel) -> FrictionBound:
    """The states that the friction law allows at the end of a step."""
    return chosen(FRICTION_LAWS, p.friction_kind).bound(q1, q2, p)


def friction_energy(q1: float, q2: float, p: LegModel) -> float:
    """Energy [J] that the friction law holds."""
    return chosen(FRICTION_LAWS, p.friction_kind).energy(q1, q2, p)


def friction_only_takes(p: LegModel) -> bool:
    """Whether the friction law's dissipated power is never below 0."""
    return chosen(FRICTION_LAWS, p.friction_kind).only_takes(p)


def ground_force(foot: FootMotion, q1: float, q2: float, p: LegModel) -> GroundForce:
    """The ground on a footpad, in the ground's axes."""
    return ground_force_on(foot, 1.0, q1, q2, p)


def ground_force_on(
    foot: FootMotion, steep: float, q1: float, q2: float, p: LegModel
) -> GroundForce:
    """As `ground_force`, on ground whose normal force is `steep` times that of the normal law."""
    n = normal_force(foot.depth, foot.depth_rate, p)
    normal = n.force * steep
    f = friction(foot, normal, q1, q2, p)
    return GroundForce(normal, f.f1, f.f2, f.dq1, f.dq2, n.dissipated, f.dissipated, n.work)
