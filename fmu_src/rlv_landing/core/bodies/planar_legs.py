"""Motion of a leg with the planar body, and its loads on it, without small angles.

Eqs. (2)-(11), (29)-(37), as derived.
"""

from __future__ import annotations

from math import cos, sin

from ..records import (
    Attitude,
    BodyAcceleration,
    BodyModel,
    BodyState,
    FootLoads,
    FootMotion,
    FootPoint,
    FrameAcceleration,
    Inputs,
    LegForces,
    LegModel,
    LegPlace,
    LegState,
    PlanarLoads,
    Turn,
)


def turned(pitch: float, slope: float) -> Turn:
    """The `pitch` [rad] of the body and the `slope` [rad] of the ground."""
    return Turn(sin(pitch), cos(pitch), sin(slope), cos(slope))


def foot_point(body: BodyState, leg: LegState, place: LegPlace, u: Inputs, turn: Turn) -> FootPoint:
    """The footpad in the inertial frame.

    The ground turns clockwise about the inertial origin and is lifted by the heave.
    """
    bx = leg.r * place.cos_g
    vbx = leg.vr * place.cos_g + body.pitch_rate * leg.h
    vby = leg.vh - body.pitch_rate * bx
    x = body.x + bx * turn.cos_p + leg.h * turn.sin_p
    y = body.y - bx * turn.sin_p + leg.h * turn.cos_p
    vx = body.vx + vbx * turn.cos_p + vby * turn.sin_p
    vy = body.vy - vbx * turn.sin_p + vby * turn.cos_p
    ground_vx = u.tilt_rate * (y - u.heave)
    ground_vy = u.heave_rate - u.tilt_rate * x
    return FootPoint(x, y, leg.r * place.sin_g, vx, vy, leg.vr * place.sin_g, ground_vx, ground_vy)


def foot_motion(foot: FootPoint, u: Inputs, turn: Turn) -> FootMotion:
    """The footpad against the moving, sloped ground."""
    yo = foot.y - u.heave
    rx = foot.vx - foot.ground_vx
    ry = foot.vy - foot.ground_vy
    depth = -(foot.x * turn.sin_a + yo * turn.cos_a)
    return FootMotion(
        depth, -(rx * turn.sin_a + ry * turn.cos_a), rx * turn.cos_a - ry * turn.sin_a, foot.vz
    )


def foot_loads(forces: LegForces, foot: FootPoint, depth: float, turn: Turn) -> FootLoads:
    """The ground's force on the footpad by the leg's `forces`."""
    x = forces.f1 * turn.cos_a + forces.normal * turn.sin_a
    y = forces.normal * turn.cos_a - forces.f1 * turn.sin_a
    return FootLoads(
        x=foot.x,
        y=foot.y,
        z=foot.z,
        depth=depth,
        contact_x=x,
        contact_y=y,
        contact_z=forces.f2,
        ground=x * foot.ground_vx + y * foot.ground_vy,
    )


def planar_loads(
    forces: LegForces, foot: FootLoads, place: LegPlace, turn: Turn, weight: float
) -> PlanarLoads:
    """Loads by the leg's `forces`: on the footpad in the leg's axes, on the body in its own.

    `weight` is that of the footpad [N].
    """
    y = foot.contact_y - weight
    body_x = foot.contact_x * turn.cos_p - y * turn.sin_p
    body_y = foot.contact_x * turn.sin_p + y * turn.cos_p
    return PlanarLoads(
        radial=body_x * place.cos_g + forces.f2 * place.sin_g + forces.main_r + forces.auxiliary_r,
        vertical=body_y + forces.main_h + forces.auxiliary_h,
        tangential=forces.f2 * place.cos_g - body_x * place.sin_g,
        body_x=-(forces.main_r + forces.auxiliary_r) * place.cos_g,
        body_y=-(forces.main_h + forces.auxiliary_h),
        moment=place.cos_g * forces.moment,
    )


def transverse_height(h: float, p: BodyModel, leg: LegModel) -> float:
    """Height above the CG at which the auxiliary strut's transverse force acts on the body [m].

    It is along the body's axis, that of the footpad or of the joint.
    """
    return h + p.at_joint * (leg.Ld - h)


def frame_acceleration(
    leg: LegState, place: LegPlace, rate: float, a: BodyAcceleration
) -> FrameAcceleration:
    """Acceleration along the body's x and y of a footpad at rest in its leg's plane.

    What moves with vr, vh themselves is left out.
    """
    bx = leg.r * place.cos_g
    x = a.x + a.pitch * leg.h - rate * rate * bx + 2.0 * rate * leg.vh
    y = a.y - a.pitch * bx - rate * rate * leg.h - 2.0 * rate * leg.vr * place.cos_g
    return FrameAcceleration(x, y)


def leg_rates(
    leg: LegState,
    forces: LegForces,
    loads: PlanarLoads,
    place: LegPlace,
    frame: FrameAcceleration,
    m_d: float,
) -> LegState:
    """The rates of a leg's state."""
    return LegState(
        r=leg.vr,
        h=leg.vh,
        vr=loads.radial / m_d - frame.x * place.cos_g,
        vh=loads.vertical / m_d - frame.y,
        z1=forces.dz1,
        z2=forces.dz2,
        q1=forces.dq1,
        q2=forces.dq2,
    )


def footpad_kinetic_energy(
    vx: float, vy: float, rate: float, leg: LegState, place: LegPlace, m_d: float
) -> float:
    """Twice the kinetic energy of all footpads of the group [J].

    `vx`, `vy` [m/s] are those of the body along its own axes, `rate` that of its pitch [rad/s].
    """
    fx = vx + leg.vr * place.cos_g + rate * leg.h
    fy = vy + leg.vh - rate * leg.r * place.cos_g
    fz = leg.vr * place.sin_g
    return place.legs * m_d * (fx * fx + fy * fy + fz * fz)


def footpad_moment(
    body: BodyState, leg: LegState, place: LegPlace, stands: Attitude, m_d: float
) -> float:
    """Mass times height [kg m] above the inertial origin of all footpads of the group."""
    return place.legs * m_d * (body.y - leg.r * place.cos_g * stands.sin_p + leg.h * stands.cos_p)
