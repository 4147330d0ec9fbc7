"""One leg: main strut, auxiliary strut and footpad in a plane fixed in the body.

It knows neither the body's motion nor the mode.
"""

from __future__ import annotations

from math import fabs, sqrt

from .ground.kinds import friction_energy, ground_force_on
from .ground.normal import normal_energy
from .records import FootMotion, LegForces, LegModel, LegState, LegStatus, StrutMotion
from .struts.kinds import auxiliary_strut, auxiliary_strut_held, main_strut, main_strut_status

# how little is left, in parts, of an excess of liquid that has been taken off
NOTHING_LEFT = 1e-12
# the search for the states without it: how many corrections at most
CORRECTIONS = 60
# the first one's size, and where none is [the states' unit, Pa of a liquid spring]
FIRST_REACH, FARTHEST = 1e3, 1e15


def strut_motion(leg: LegState, joint_r: float, joint_h: float, length: float) -> StrutMotion:
    """A strut from its joint on the body to the footpad, in the body's frame. Eqs. (19), (25).

    Its unloaded `length` is in m.
    """
    dr = leg.r - joint_r
    dh = leg.h - joint_h
    now = sqrt(dr * dr + dh * dh)
    er = dr / now
    eh = dh / now
    return StrutMotion(length - now, -(leg.vr * er + leg.vh * eh), er, eh)


def leg_forces(leg: LegState, foot: FootMotion, p: LegModel) -> LegForces:
    """All forces and powers of one leg, and the rates of its laws' states.

    `foot` is the footpad's motion against the ground.
    """
    return leg_forces_on(leg, foot, 1.0, p)


def leg_forces_on(leg: LegState, foot: FootMotion, steep: float, p: LegModel) -> LegForces:
    """As `leg_forces`, on ground whose normal force is `steep` times that of the normal law."""
    main = strut_motion(leg, p.La, p.Lb, p.Lm0)
    aux = strut_motion(leg, p.Lc, p.Ld, p.Ls0)
    return forces_between(leg, foot, steep, main, aux, p)


def forces_between(
    leg: LegState, foot: FootMotion, steep: float, main: StrutMotion, aux: StrutMotion, p: LegModel
) -> LegForces:
    """The forces of a main strut and an auxiliary strut that move so, and of the ground."""
    strut = main_strut(main.stroke, main.rate, leg.z1, leg.z2, p)
    link = auxiliary_strut(aux.stroke, aux.rate, p)
    ground = ground_force_on(foot, steep, leg.q1, leg.q2, p)
    main_r = strut.force * main.e_r
    main_h = strut.force * main.e_h
    aux_r = link.force * aux.e_r
    aux_h = link.force * aux.e_h
    return LegForces(
        stroke=main.stroke,
        stroke_rate=main.rate,
        main=strut.force,
        auxiliary_stroke=aux.stroke,
        auxiliary_rate=aux.rate,
        auxiliary=link.force,
        main_r=main_r,
        main_h=main_h,
        auxiliary_r=aux_r,
        auxiliary_h=aux_h,
        moment=p.La * main_h - p.Lb * main_r + p.Lc * aux_h - p.Ld * aux_r,
        normal=ground.normal,
        f1=ground.f1,
        f2=ground.f2,
        dz1=strut.dz1,
        dz2=strut.dz2,
        dq1=ground.dq1,
        dq2=ground.dq2,
        a1=strut.a1,
        a2=strut.a2,
        orifice=strut.orifice,
        seal=strut.seal,
        stop=strut.stop,
        auxiliary_dissipated=link.dissipated,
        contact=ground.dissipated,
        friction=ground.friction,
        held=strut.held,
        liquid_mass=strut.liquid_mass,
        mass_1=strut.mass_1,
        mass_2=strut.mass_2,
        auxiliary_work=link.work,
        contact_work=ground.work,
    )


def leg_status(leg: LegState, forces: LegForces, p: LegModel) -> LegStatus:
    """The energies that one leg holds, and its main strut's chambers."""
    strut = main_strut_status(forces.stroke, leg.z1, leg.z2, p)
    return LegStatus(
        stop=strut.held_by_stop,
        auxiliary=auxiliary_strut_held(forces.auxiliary_stroke, forces.auxiliary_work, p),
        contact=normal_energy(forces.contact_work, p),
        friction=friction_energy(leg.q1, leg.q2, p),
        pressure_upper=strut.pressure_upper,
        pressure_lower=strut.pressure_lower,
    )


def liquid_excess(forces: LegForces, p: LegModel) -> float:
    """The main strut's liquid beyond that of its fill, in parts of the fill.

    It is 0 for a law without a liquid.
    """
    if forces.liquid_mass > 0.0:
        return forces.liquid_mass / p.fill - 1.0
    return 0.0


def without_excess(leg: LegState, forces: LegForces, p: LegModel, left: float) -> LegState:
    """The leg with both states of its main strut law moved alike to the mass of the fill.

    That mass is missed by `left` parts of it, on the side where it was.

    Newton's steps, held between states known to have too little and too much, and no longer than a
    reach that doubles: the mass grows with either state, but by many orders more in a cavity than
    in a liquid, and deep in a cavity next to nothing.
    """
    moved = 0.0
    low = -FARTHEST
    high = FARTHEST
    reach = FIRST_REACH
    aim = p.fill * (1.0 + left if forces.liquid_mass > p.fill else 1.0 - left)
    excess = forces.liquid_mass - aim
    slope = forces.mass_1 + forces.mass_2
    for _ in range(CORRECTIONS):
        if excess > 0.0:
            high = moved
        else:
            low = moved
        tried = min(max(moved - excess / slope, moved - reach), moved + reach)
        if fabs(excess) < NOTHING_LEFT * p.fill or tried == moved:
            break
        if tried <= low or tried >= high:
            tried = 0.5 * (low + high)
        moved = tried
        reach *= 2.0
        strut = main_strut(forces.stroke, forces.stroke_rate, leg.z1 + moved, leg.z2 + moved, p)
        excess = strut.liquid_mass - aim
        slope = strut.mass_1 + strut.mass_2
    return LegState(leg.r, leg.h, leg.vr, leg.vh, leg.z1 + moved, leg.z2 + moved, leg.q1, leg.q2)
