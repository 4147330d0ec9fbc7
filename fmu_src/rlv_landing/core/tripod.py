"""One leg on three struts: a main strut in the leg's plane, and an auxiliary strut on each side.

The footpad is free in three directions. The laws of struts and ground are those of every leg.
"""

from __future__ import annotations

from math import sqrt

from .leg import forces_between
from .records import (
    AcrossForces,
    AcrossState,
    FootMotion,
    LegForces,
    LegModel,
    LegState,
    SpaceStrut,
    StrutMotion,
)
from .struts.kinds import auxiliary_strut


def space_strut(
    leg: LegState,
    across: AcrossState,
    joint_r: float,
    joint_h: float,
    joint_t: float,
    length: float,
) -> SpaceStrut:
    """A strut from its joint on the body to the footpad, the leg's axes.

    Its unloaded `length` is in m.
    """
    dr = leg.r - joint_r
    dh = leg.h - joint_h
    dt = across.t - joint_t
    now = sqrt(dr * dr + dh * dh + dt * dt)
    er = dr / now
    eh = dh / now
    et = dt / now
    return SpaceStrut(length - now, -(leg.vr * er + leg.vh * eh + across.vt * et), er, eh, et)


def tripod_main(leg: LegState, across: AcrossState, p: LegModel) -> SpaceStrut:
    """The main strut."""
    return space_strut(leg, across, p.La, p.Lb, 0.0, p.Lm0)


def tripod_auxiliary(leg: LegState, across: AcrossState, side: float, p: LegModel) -> SpaceStrut:
    """The auxiliary strut on a `side` of the leg's plane: 1 along t, the first, or -1."""
    return space_strut(leg, across, p.Lc, p.Ld, side * p.Lt, p.Ls0)


def tripod_forces(
    leg: LegState, across: AcrossState, foot: FootMotion, steep: float, p: LegModel
) -> LegForces:
    """Forces and powers of main strut, first auxiliary strut and ground, as `leg_forces_on`."""
    main = tripod_main(leg, across, p)
    aux = tripod_auxiliary(leg, across, 1.0, p)
    return forces_between(
        leg,
        foot,
        steep,
        StrutMotion(main.stroke, main.rate, main.e_r, main.e_h),
        StrutMotion(aux.stroke, aux.rate, aux.e_r, aux.e_h),
        p,
    )


def across_forces(
    leg: LegState, across: AcrossState, forces: LegForces, p: LegModel
) -> AcrossForces:
    """The second auxiliary strut, and what all struts do across the leg's plane.

    `forces` are those of main strut and first auxiliary strut.
    """
    second = tripod_auxiliary(leg, across, -1.0, p)
    link = auxiliary_strut(second.stroke, second.rate, p)
    r = link.force * second.e_r
    h = link.force * second.e_h
    main_t = forces.main * tripod_main(leg, across, p).e_t
    first_t = forces.auxiliary * tripod_auxiliary(leg, across, 1.0, p).e_t
    both_t = first_t + link.force * second.e_t
    return AcrossForces(
        stroke=second.stroke,
        rate=second.rate,
        force=link.force,
        dissipated=link.dissipated,
        r=r,
        h=h,
        t=main_t + both_t,
        moment_r=p.Lt * (forces.auxiliary_h - h) - p.Lb * main_t - p.Ld * both_t,
        moment_h=p.La * main_t + p.Lc * both_t - p.Lt * (forces.auxiliary_r - r),
        moment=p.Lc * h - p.Ld * r,
    )
