"""The end stops of a main strut, which every law of it may have (closure)."""

from __future__ import annotations

from ..records import AxialForce, LegModel


def stop_force(s: float, v: float, p: LegModel) -> AxialForce:
    """The end stops at stroke `s` [m] and stroke rate `v` [m/s].

    The force is positive where it pushes the strut longer: one-sided K e (1 + c e') with overlap
    `e` beyond full extension (s < 0) or full compression (s > s_max), never pulling.
    """
    if s < 0.0:
        force = -p.K_stop * s * (1.0 - p.c_stop * v)
        if force < 0.0:
            force = 0.0
        return AxialForce(-force, -(force + p.K_stop * s) * v)
    if s > p.s_max:
        e = s - p.s_max
        force = p.K_stop * e * (1.0 + p.c_stop * v)
        if force < 0.0:
            force = 0.0
        return AxialForce(force, (force - p.K_stop * e) * v)
    return AxialForce(0.0, 0.0)


def stop_energy(s: float, p: LegModel) -> float:
    """Energy [J] that the end stops hold at stroke `s` [m]."""
    if s < 0.0:
        return 0.5 * p.K_stop * s * s
    if s > p.s_max:
        return 0.5 * p.K_stop * (s - p.s_max) * (s - p.s_max)
    return 0.0
