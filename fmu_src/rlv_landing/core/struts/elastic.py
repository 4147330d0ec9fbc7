"""The elastic auxiliary strut: nonlinear spring and damper along its axis. Eq. (13)."""

from __future__ import annotations

from math import fabs, pow

from ..records import AxialForce, LegModel
from .laws import AUXILIARY_STRUTS, AuxiliaryStrutLaw


def elastic(s: float, v: float, p: LegModel) -> AxialForce:
    """The strut at stroke `s` [m] and stroke rate `v` [m/s]. Eq. (13)."""
    spring = p.Ka * pow(fabs(s), p.ek)
    if s < 0.0:
        spring = -spring
    return AxialForce(spring + p.Ca * v, p.Ca * v * v)


def elastic_energy(s: float, p: LegModel) -> float:
    """Energy [J] that the spring holds at stroke `s` [m]."""
    return p.Ka * pow(fabs(s), p.ek + 1.0) / (p.ek + 1.0)


AUXILIARY_STRUTS["elastic"] = AuxiliaryStrutLaw(elastic, elastic_energy)
