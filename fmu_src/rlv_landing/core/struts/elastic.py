"""The elastic auxiliary strut: nonlinear spring and damper along its axis. Eq. (13)."""

from __future__ import annotations

from math import fabs, pow

from ..records import AuxiliaryForce, LegModel
from .laws import AUXILIARY_STRUTS, AuxiliaryStrutLaw


def elastic(s: float, v: float, p: LegModel) -> AuxiliaryForce:
    """The strut at stroke `s` [m] and stroke rate `v` [m/s]. Eq. (13)."""
    spring = p.Ka * pow(fabs(s), p.ek)
    work = spring * fabs(s)
    if s < 0.0:
        spring = -spring
    return AuxiliaryForce(spring + p.Ca * v, p.Ca * v * v, work)


def elastic_energy(s: float, work: float, p: LegModel) -> float:
    """Energy [J] that the spring holds at stroke `s` [m], where it gave `work` [J]."""
    return work / (p.ek + 1.0)


AUXILIARY_STRUTS["elastic"] = AuxiliaryStrutLaw(elastic, elastic_energy)
