"""Motion of a leg with the spatial body, and its loads on it, body axes (derived)."""

from __future__ import annotations

from ..records import (
    AcrossState,
    FootPlace,
    LegForces,
    LegModel,
    LegPlace,
    LegState,
    SpatialLoads,
    SpatialModel,
    Vector,
)
from ..vectors import added, cross, less


def radial_part(place: LegPlace, v: Vector) -> float:
    """Part along the leg's axis r of a vector of body axes."""
    return place.cos_g * v.x + place.sin_g * v.z


def transverse_part(place: LegPlace, v: Vector) -> float:
    """Part along the leg's axis t of a vector of body axes."""
    return place.cos_g * v.z - place.sin_g * v.x


def about_across(place: LegPlace, point: Vector) -> Vector:
    """The moment of a unit force along the leg's axis t at a point, body axes [m]."""
    return Vector(place.cos_g * point.y, -radial_part(place, point), place.sin_g * point.y)


def along_across(place: LegPlace, t: float) -> Vector:
    """The vector t across the leg's plane in body axes."""
    return Vector(-t * place.sin_g, 0.0, t * place.cos_g)


def in_leg(place: LegPlace, r: float, h: float) -> Vector:
    """The vector r, h of the leg's plane in body axes."""
    return Vector(r * place.cos_g, h, r * place.sin_g)


def cg_of(p: SpatialModel) -> Vector:
    """The CG from the point of the legs' axis at its height [m]."""
    return Vector(p.cg_x, 0.0, p.cg_z)


def foot_place(leg: LegState, place: LegPlace, p: SpatialModel) -> FootPlace:
    """The footpad from the CG, and its rate."""
    return FootPlace(less(in_leg(place, leg.r, leg.h), cg_of(p)), in_leg(place, leg.vr, leg.vh))


def moved_across(foot: FootPlace, across: AcrossState, place: LegPlace) -> FootPlace:
    """A footpad that is free, from where it would be in its leg's plane."""
    return FootPlace(
        added(foot.from_cg, along_across(place, across.t)),
        added(foot.rate, along_across(place, across.vt)),
    )


def joint_place(place: LegPlace, leg: LegModel, p: SpatialModel) -> Vector:
    """The auxiliary strut's joint from the CG [m]."""
    return less(in_leg(place, leg.Lc, leg.Ld), cg_of(p))


def spatial_loads(
    force: Vector, bias: Vector, foot: Vector, forces: LegForces, place: LegPlace
) -> SpatialLoads:
    """Loads by the leg's `forces`, and by the `force` of ground and gravity on the footpad [N].

    `bias` is the acceleration [m/s2] that the footpad at the place `foot` has by the body's spin,
    body axes.
    """
    return SpatialLoads(
        radial=radial_part(place, force) + forces.main_r + forces.auxiliary_r,
        vertical=force.y + forces.main_h + forces.auxiliary_h,
        tangential=transverse_part(place, force),
        bias_r=radial_part(place, bias),
        bias_h=bias.y,
        bias_t=transverse_part(place, bias),
        foot_x=foot.x,
        foot_y=foot.y,
        foot_z=foot.z,
    )


def force_on_body(forces: LegForces, place: LegPlace) -> Vector:
    """The struts' force on the body [N]."""
    return in_leg(
        place, -(forces.main_r + forces.auxiliary_r), -(forces.main_h + forces.auxiliary_h)
    )


def foot_acceleration(loads: SpatialLoads, place: LegPlace, a: Vector, spin_rate: Vector) -> Vector:
    """Acceleration of a footpad at rest in its leg's plane, along r, h, t [m/s2]."""
    moved = added(a, cross(spin_rate, Vector(loads.foot_x, loads.foot_y, loads.foot_z)))
    return Vector(
        radial_part(place, moved) + loads.bias_r,
        moved.y + loads.bias_h,
        transverse_part(place, moved) + loads.bias_t,
    )


def spatial_leg_rates(
    leg: LegState,
    forces: LegForces,
    loads: SpatialLoads,
    frame: Vector,
    m_d: float,
) -> LegState:
    """The rates of a leg's state, whose frame has the acceleration `frame` along r, h [m/s2]."""
    return LegState(
        r=leg.vr,
        h=leg.vh,
        vr=loads.radial / m_d - frame.x,
        vh=loads.vertical / m_d - frame.y,
        z1=forces.dz1,
        z2=forces.dz2,
        q1=forces.dq1,
        q2=forces.dq2,
    )
