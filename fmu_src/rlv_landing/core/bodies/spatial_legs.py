"""Motion of a leg with the spatial body, and its loads on it, body axes (derived)."""

from __future__ import annotations

from ..records import (
    FootPlace,
    LegForces,
    LegModel,
    LegPlace,
    LegState,
    SpatialLoads,
    SpatialModel,
    Vector,
)
from ..vectors import added, cross, dot, less, scaled


def outward(place: LegPlace) -> Vector:
    """The leg's axis r."""
    return Vector(place.cos_g, 0.0, place.sin_g)


def across(place: LegPlace) -> Vector:
    """The leg's axis t, across its plane."""
    return Vector(-place.sin_g, 0.0, place.cos_g)


def in_leg(place: LegPlace, r: float, h: float) -> Vector:
    """The vector r, h of the leg's plane in body axes."""
    return Vector(r * place.cos_g, h, r * place.sin_g)


def cg_of(p: SpatialModel) -> Vector:
    """The CG from the point of the legs' axis at its height [m]."""
    return Vector(p.cg_x, 0.0, p.cg_z)


def foot_place(leg: LegState, place: LegPlace, p: SpatialModel) -> FootPlace:
    """The footpad from the CG, and its rate."""
    return FootPlace(less(in_leg(place, leg.r, leg.h), cg_of(p)), in_leg(place, leg.vr, leg.vh))


def foot_bias(foot: FootPlace, spin: Vector) -> Vector:
    """Acceleration that a footpad has by the body's spin alone [m/s2]."""
    return added(cross(spin, cross(spin, foot.from_cg)), scaled(cross(spin, foot.rate), 2.0))


def acts_at(foot: Vector, place: LegPlace, leg: LegModel, p: SpatialModel) -> Vector:
    """The point from the CG at which the leg's transverse force acts on the body [m]."""
    if p.at_joint > 0.0:
        return less(in_leg(place, leg.Lc, leg.Ld), cg_of(p))
    return foot


def spatial_loads(
    force: Vector, bias: Vector, foot: Vector, at: Vector, forces: LegForces, place: LegPlace
) -> SpatialLoads:
    """Loads by the leg's `forces`, and by the `force` of ground and gravity on the footpad [N]."""
    return SpatialLoads(
        radial=dot(outward(place), force) + forces.main_r + forces.auxiliary_r,
        vertical=force.y + forces.main_h + forces.auxiliary_h,
        tangential=dot(across(place), force),
        bias_x=bias.x,
        bias_y=bias.y,
        bias_z=bias.z,
        foot_x=foot.x,
        foot_y=foot.y,
        foot_z=foot.z,
        at_x=at.x,
        at_y=at.y,
        at_z=at.z,
    )


def force_on_body(forces: LegForces, place: LegPlace) -> Vector:
    """The struts' force on the body [N]."""
    return in_leg(
        place, -(forces.main_r + forces.auxiliary_r), -(forces.main_h + forces.auxiliary_h)
    )


def moment_on_body(forces: LegForces, force: Vector, place: LegPlace, p: SpatialModel) -> Vector:
    """The moment of the struts' `force` about the CG [N m]."""
    return less(scaled(across(place), -forces.moment), cross(cg_of(p), force))


def foot_acceleration(loads: SpatialLoads, a: Vector, spin_rate: Vector) -> Vector:
    """Acceleration of a footpad at rest in its leg's plane [m/s2]."""
    foot = Vector(loads.foot_x, loads.foot_y, loads.foot_z)
    bias = Vector(loads.bias_x, loads.bias_y, loads.bias_z)
    return added(added(a, cross(spin_rate, foot)), bias)


def spatial_leg_rates(
    leg: LegState,
    forces: LegForces,
    loads: SpatialLoads,
    place: LegPlace,
    frame: Vector,
    m_d: float,
) -> LegState:
    """The rates of a leg's state, whose frame has the acceleration `frame` [m/s2]."""
    return LegState(
        r=leg.vr,
        h=leg.vh,
        vr=loads.radial / m_d - dot(outward(place), frame),
        vh=loads.vertical / m_d - frame.y,
        z1=forces.dz1,
        z2=forces.dz2,
        q1=forces.dq1,
        q2=forces.dq2,
    )
