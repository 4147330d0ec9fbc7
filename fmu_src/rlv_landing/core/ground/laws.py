"""The table of friction laws. Each law's file adds its law.

Sorted by name, a law's place in the table is its number in a `LegModel`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..records import FootMotion, FrictionBound, FrictionForce, LegModel


class FrictionLaw(NamedTuple):
    """A law of friction.

    It has what the ground gives at (motion, normal force, q1, q2), where it lets (q1, q2) be at the
    end of a step, the energy [J] that it holds there, and whether what it calls dissipated is never
    below 0.
    """

    force: Callable[[FootMotion, float, float, float, LegModel], FrictionForce]
    bound: Callable[[float, float, LegModel], FrictionBound]
    energy: Callable[[float, float, LegModel], float]
    only_takes: Callable[[LegModel], bool]


FRICTION_LAWS: dict[str, FrictionLaw] = {}
