"""The struts of a leg, by the law that each has.

A new law is a file of its own, named in the first import below. Compiled, these functions branch on
the law's number.
"""

from __future__ import annotations

from ..memory import chosen
from ..records import AuxiliaryForce, LegModel, StrutForce, StrutStatus
from . import elastic, liquid_spring, play, spring_damper  # noqa: F401  each adds its law to its table
from .laws import AUXILIARY_STRUTS as AUXILIARY_STRUTS
from .laws import MAIN_STRUTS as MAIN_STRUTS


def main_strut(s: float, v: float, z1: float, z2: float, p: LegModel) -> StrutForce:
    """The main strut at stroke `s` [m], stroke rate `v` [m/s] and its law's states."""
    return chosen(MAIN_STRUTS, p.main_kind).force(s, v, z1, z2, p)


def main_strut_status(s: float, z1: float, z2: float, p: LegModel) -> StrutStatus:
    """Outputs of the main strut beside its force, at stroke `s` [m] and its law's states."""
    return chosen(MAIN_STRUTS, p.main_kind).status(s, z1, z2, p)


def auxiliary_strut(s: float, v: float, p: LegModel) -> AuxiliaryForce:
    """The auxiliary strut at stroke `s` [m] and stroke rate `v` [m/s]."""
    return chosen(AUXILIARY_STRUTS, p.auxiliary_kind).force(s, v, p)


def auxiliary_strut_held(s: float, work: float, p: LegModel) -> float:
    """As `auxiliary_strut_energy`, where the strut's law gave `work` [J]."""
    return chosen(AUXILIARY_STRUTS, p.auxiliary_kind).energy(s, work, p)


def auxiliary_strut_energy(s: float, p: LegModel) -> float:
    """Energy [J] that the auxiliary strut holds at stroke `s` [m]."""
    return auxiliary_strut_held(s, auxiliary_strut(s, 0.0, p).work, p)
