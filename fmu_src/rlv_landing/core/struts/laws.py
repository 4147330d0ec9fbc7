"""The tables of strut laws. Each law's file adds its law.

Sorted by name, a law's place in its table is its number in a `LegModel`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..records import AuxiliaryForce, LegModel, StrutForce, StrutStatus


class MainStrutLaw(NamedTuple):
    """A law of the main strut.

    It has what the strut gives at (stroke, rate, z1, z2), and what is read of it at (stroke, z1,
    z2).
    """

    force: Callable[[float, float, float, float, LegModel], StrutForce]
    status: Callable[[float, float, float, LegModel], StrutStatus]


class AuxiliaryStrutLaw(NamedTuple):
    """A law of the auxiliary strut.

    It has what the strut gives at (stroke, rate), and the energy [J] that it holds at (stroke, work
    given there).
    """

    force: Callable[[float, float, LegModel], AuxiliaryForce]
    energy: Callable[[float, float, LegModel], float]


MAIN_STRUTS: dict[str, MainStrutLaw] = {}
AUXILIARY_STRUTS: dict[str, AuxiliaryStrutLaw] = {}
