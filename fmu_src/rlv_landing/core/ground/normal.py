"""The ground's normal force on a footpad. Eqs. (14), (15)."""

from __future__ import annotations

from math import pow

from ..records import LegModel, NormalForce


def damping_ramp(d: float, p: LegModel) -> float:
    """0 to 1, smooth, as the penetration `d` [m] grows from 0 to d_ramp (closure)."""
    q = d / p.d_ramp
    if q >= 1.0:
        return 1.0
    if q <= 0.0:
        return 0.0
    return q * q * (3.0 - 2.0 * q)


def normal_force(d: float, v: float, p: LegModel) -> NormalForce:
    """The ground at penetration `d` [m] growing at `v` [m/s]; it never pulls. Eqs. (14), (15)."""
    if d <= 0.0:
        return NormalForce(0.0, 0.0, 0.0)
    elastic = p.Kg * pow(d, p.en)
    force = elastic + p.Cgmax * damping_ramp(d, p) * v
    if force < 0.0:
        force = 0.0
    return NormalForce(force, (force - elastic) * v, elastic * d)


def normal_energy(work: float, p: LegModel) -> float:
    """Energy [J] that the ground's elasticity holds where its force gave `work` [J]."""
    return work / (p.en + 1.0)
