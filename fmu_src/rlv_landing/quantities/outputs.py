"""The outputs: motion, energies, status, and the quantities of each leg."""

from __future__ import annotations

from .legs import LEGS
from .quantity import Quantity

BODY_QUANTITIES: tuple[Quantity, ...] = (
    Quantity("m", "CG of the upper mass along inertial x", name="body.x"),
    Quantity("m", "CG of the upper mass along inertial y (up)", name="body.y"),
    Quantity("rad", "pitch psi, clockwise positive", name="body.pitch", display_unit="deg"),
    Quantity("m/s", "velocity of the CG along inertial x", name="body.vx"),
    Quantity("m/s", "velocity of the CG along inertial y", name="body.vy"),
    Quantity(
        "rad/s", "pitch rate, clockwise positive", name="body.pitch_rate", display_unit="deg/s"
    ),
    Quantity("m/s2", "acceleration of the CG along inertial x", name="body.ax"),
    Quantity("m/s2", "acceleration of the CG along inertial y", name="body.ay"),
    Quantity("rad/s2", "pitch acceleration, clockwise positive", name="body.pitch_acceleration"),
    Quantity(
        "m/s2",
        "inertial acceleration of the top sensor along the body's axis: -g in free fall, 0 at rest",
        name="body.top_axial_acceleration",
    ),
)

ENERGY_QUANTITIES: tuple[Quantity, ...] = (
    Quantity("J", "kinetic energy of body and footpads", 0.0, name="energy.kinetic"),
    Quantity(
        "J",
        "potential energy of body and footpads above the inertial origin",
        name="energy.potential",
    ),
    Quantity("J", "energy held by the dampers' liquid", name="energy.liquid"),
    Quantity("J", "energy held by the auxiliary struts' springs", 0.0, name="energy.auxiliary"),
    Quantity("J", "energy held by the ground's normal elasticity", 0.0, name="energy.contact"),
    Quantity(
        "J",
        "energy held by the footpads' friction while they stick (0 with friction_law = paper)",
        0.0,
        name="energy.friction",
    ),
    Quantity("J", "energy held by the dampers' end stops", 0.0, name="energy.stop"),
    Quantity("J", "dissipated so far in the orifices", name="energy.dissipated_orifice"),
    Quantity("J", "dissipated so far by seal friction", name="energy.dissipated_seal"),
    Quantity("J", "dissipated so far by the end stops", name="energy.dissipated_stop"),
    Quantity(
        "J",
        "dissipated so far by the auxiliary struts' dampers",
        name="energy.dissipated_auxiliary",
    ),
    Quantity(
        "J", "dissipated so far by the ground's normal damping", name="energy.dissipated_contact"
    ),
    Quantity(
        "J",
        "dissipated so far by ground friction (with friction_law = paper, which may supply energy, "
        "all that it took)",
        name="energy.dissipated_friction",
    ),
    Quantity("J", "work done so far by the external force and moment", name="energy.work_external"),
    Quantity("J", "work done so far by the moving ground", name="energy.work_ground"),
    Quantity(
        "J",
        "work created so far by transverse_load_at = joint (0 for footpad)",
        name="energy.work_transverse",
    ),
    Quantity("J", "sum of all that was dissipated", name="energy.dissipated"),
    Quantity(
        "J",
        "energy balance: held + dissipated - work - held at the start; "
        "0 but for the integrator's error",
        name="energy.balance",
    ),
)

STATUS_QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "",
        "0 falling, 1 contact, 2 settled, 3 toppled (beyond its feet, or over)",
        0,
        3,
        name="status.phase",
        kind="integer",
    ),
    Quantity(
        "m",
        "from the whole vehicle's CG along x to the nearer outermost footpad, negative beyond",
        name="status.stability_margin",
    ),
)

LEG_QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "N", "axial force, negative in compression", name="main_strut.force", display_unit="kN"
    ),
    Quantity(
        "m", "damper stroke, positive in compression", name="main_strut.stroke", display_unit="mm"
    ),
    Quantity("m/s", "stroke rate, positive in compression", name="main_strut.stroke_rate"),
    Quantity(
        "Pa",
        "absolute pressure in the upper chamber (1)",
        0.0,
        name="main_strut.pressure_upper",
        display_unit="MPa",
    ),
    Quantity(
        "Pa",
        "absolute pressure in the lower chamber (2)",
        0.0,
        name="main_strut.pressure_lower",
        display_unit="MPa",
    ),
    Quantity("kg", "mass of the liquid in both chambers", 0.0, name="main_strut.liquid_mass"),
    Quantity(
        "J",
        "work done on the strut so far: the energy that it has taken up and not given back",
        name="main_strut.work",
    ),
    Quantity("N", "axial force, tension positive", name="auxiliary_strut.force", display_unit="kN"),
    Quantity(
        "m", "stroke, positive in compression", name="auxiliary_strut.stroke", display_unit="mm"
    ),
    Quantity("m/s", "stroke rate, positive in compression", name="auxiliary_strut.stroke_rate"),
    Quantity("m", "position along inertial x", name="footpad.x"),
    Quantity("m", "position along inertial y (up)", name="footpad.y"),
    Quantity("m", "position along inertial z", name="footpad.z"),
    Quantity(
        "N",
        "force of the ground on the footpad along inertial x",
        name="contact.force_x",
        display_unit="kN",
    ),
    Quantity(
        "N",
        "force of the ground on the footpad along inertial y (up)",
        name="contact.force_y",
        display_unit="kN",
    ),
    Quantity(
        "N",
        "force of the ground on the footpad along inertial z",
        name="contact.force_z",
        display_unit="kN",
    ),
    Quantity(
        "N",
        "force between ground and footpad, all directions together",
        0.0,
        name="contact.force",
        display_unit="kN",
    ),
    Quantity(
        "m",
        "penetration of the ground, positive in contact",
        name="contact.penetration",
        display_unit="mm",
    ),
    Quantity("", "whether the footpad touches the ground", name="contact.active", kind="boolean"),
)


def leg_quantity(leg: int, q: Quantity) -> Quantity:
    """The quantity `q` of the leg with the number `leg`."""
    owner, what = q.name.split(".")
    meaning = f"leg {leg}, {owner.replace('_', ' ')}: {q.meaning}"
    return Quantity(
        q.unit,
        meaning,
        q.lo,
        q.hi,
        name=f"leg[{leg}].{owner}.{what}",
        display_unit=q.display_unit,
        kind=q.kind,
    )


SHARED_QUANTITIES = BODY_QUANTITIES + ENERGY_QUANTITIES + STATUS_QUANTITIES
OUTPUT_QUANTITIES: tuple[Quantity, ...] = SHARED_QUANTITIES + tuple(
    leg_quantity(leg, q) for leg in LEGS for q in LEG_QUANTITIES
)
OUTPUT_NAMES: tuple[str, ...] = tuple(q.name for q in OUTPUT_QUANTITIES)
OUTPUTS_BY_NAME: dict[str, Quantity] = {q.name: q for q in OUTPUT_QUANTITIES}
