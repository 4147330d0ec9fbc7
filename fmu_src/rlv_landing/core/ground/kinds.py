"""The ground under a footpad: the normal law, and the laws of friction.

A new law is a file of its own, and its import and its line here.

A law's place in the table is its number in a `LegModel`. Compiled, the functions that choose a law
branch on that number.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..memory import chosen
from ..records import FootMotion, FrictionBound, FrictionForce, GroundForce, LegModel
from .normal import normal_force
from .paper_friction import paper_friction, paper_friction_bound, paper_friction_energy
from .passive_friction import passive_friction, passive_friction_bound, passive_friction_energy


class FrictionLaw(NamedTuple):
    """A law of friction: what it gives at (motion, normal force, q1, q2), where it lets (q1, q2) be
    at the end of a step, and the energy [J] that it holds there.
    """

    force: Callable[[FootMotion, float, float, float, LegModel], FrictionForce]
    bound: Callable[[float, float, LegModel], FrictionBound]
    energy: Callable[[float, float, LegModel], float]


FRICTION_LAWS: dict[str, FrictionLaw] = {
    "passive": FrictionLaw(passive_friction, passive_friction_bound, passive_friction_energy),
    "paper": FrictionLaw(paper_friction, paper_friction_bound, paper_friction_energy),
}


def friction(foot: FootMotion, Fn: float, q1: float, q2: float, p: LegModel) -> FrictionForce:
    """Friction on a footpad under the normal force `Fn` [N]."""
    return chosen(FRICTION_LAWS, p.friction_kind).force(foot, Fn, q1, q2, p)


def friction_bound(q1: float, q2: float, p: LegModel) -> FrictionBound:
    """Where the friction law lets its states be at the end of a step."""
    return chosen(FRICTION_LAWS, p.friction_kind).bound(q1, q2, p)


def friction_energy(q1: float, q2: float, p: LegModel) -> float:
    """Energy [J] that the friction law holds."""
    return chosen(FRICTION_LAWS, p.friction_kind).energy(q1, q2, p)


def ground_force(foot: FootMotion, q1: float, q2: float, p: LegModel) -> GroundForce:
    """The ground on a footpad, in the ground's axes."""
    n = normal_force(foot.depth, foot.depth_rate, p)
    f = friction(foot, n.force, q1, q2, p)
    return GroundForce(n.force, f.f1, f.f2, f.dq1, f.dq2, n.dissipated, f.dissipated)
