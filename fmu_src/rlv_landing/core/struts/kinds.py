"""The laws of struts. A new law is a file of its own, and its import and its line in a table here.

A law's place in its table is its number in a `LegModel`. Compiled, the functions below branch on
that number.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..memory import chosen
from ..records import AxialForce, LegModel, StrutForce, StrutStatus
from .elastic import elastic, elastic_energy
from .liquid_spring import liquid_spring, liquid_spring_status
from .play import elastic_with_play, elastic_with_play_energy


class MainStrutLaw(NamedTuple):
    """A law of the main strut: what it gives at (stroke, rate, z1, z2), and what is read of it at
    (stroke, z1, z2).
    """

    force: Callable[[float, float, float, float, LegModel], StrutForce]
    status: Callable[[float, float, float, LegModel], StrutStatus]


class AuxiliaryStrutLaw(NamedTuple):
    """A law of the auxiliary strut: what it gives at (stroke, rate), and the energy [J] that it
    holds at a stroke.
    """

    force: Callable[[float, float, LegModel], AxialForce]
    energy: Callable[[float, LegModel], float]


MAIN_STRUTS: dict[str, MainStrutLaw] = {
    "liquid-spring": MainStrutLaw(liquid_spring, liquid_spring_status),
}

AUXILIARY_STRUTS: dict[str, AuxiliaryStrutLaw] = {
    "elastic": AuxiliaryStrutLaw(elastic, elastic_energy),
    "elastic-with-play": AuxiliaryStrutLaw(elastic_with_play, elastic_with_play_energy),
}


def main_strut(s: float, v: float, z1: float, z2: float, p: LegModel) -> StrutForce:
    """The main strut at stroke `s` [m], stroke rate `v` [m/s] and its law's states."""
    return chosen(MAIN_STRUTS, p.main_kind).force(s, v, z1, z2, p)


def main_strut_status(s: float, z1: float, z2: float, p: LegModel) -> StrutStatus:
    """What else is read of the main strut at stroke `s` [m] and its law's states."""
    return chosen(MAIN_STRUTS, p.main_kind).status(s, z1, z2, p)


def auxiliary_strut(s: float, v: float, p: LegModel) -> AxialForce:
    """The auxiliary strut at stroke `s` [m] and stroke rate `v` [m/s]."""
    return chosen(AUXILIARY_STRUTS, p.auxiliary_kind).force(s, v, p)


def auxiliary_strut_energy(s: float, p: LegModel) -> float:
    """Energy [J] that the auxiliary strut holds at stroke `s` [m]."""
    return chosen(AUXILIARY_STRUTS, p.auxiliary_kind).energy(s, p)
