"""The table of quantities: the model's inputs and outputs with unit, meaning, bounds and source.

Everything that names a quantity is made from this table or from the annotated parameters in
`parameters.py`: the FMU's variables, the TOML reader, `--set`, the columns of a history and the
reference pages.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Literal

Source = Literal["paper", "derived", "closure", "identified", "user"]


@dataclass(frozen=True)
class Quantity:
    """One named number (or choice) of the model.

    Attributes:
        unit: SI unit of the number.
        meaning: The meaning, in words.
        lo: Least value allowed.
        hi: Largest value allowed.
        symbol: The paper's and the kernel's name.
        source: Source of a default: the paper, derived from it, a closure that the paper leaves
            open, or identified from the paper's printed numbers.
        display_unit: The unit that people read.
        choices: The texts allowed, for a quantity that is no number.
        name: The name.
        default: The default.
        kind: The FMI type.
    """

    unit: str
    meaning: str
    lo: float = -inf
    hi: float = inf
    symbol: str = ""
    source: Source = "closure"
    display_unit: str = ""
    choices: tuple[str, ...] = ()
    name: str = ""
    default: float | str = 0.0
    kind: Literal["real", "integer", "boolean", "string"] = "real"

    @property
    def nominal(self) -> float:
        """Order of magnitude [SI unit], by the display unit; 1 for plain numbers."""
        return NOMINALS.get(self.display_unit or self.unit, 1.0)


def flat_name(name: str) -> str:
    """A quantity's name without dots and brackets: `leg1_main_strut_force`.

    For hosts in which `a.b` is a part of a bus, or `a[1]` an element of an array.
    """
    return name.replace("[", "").replace("]", "").replace(".", "_")


# display unit -> (SI unit, factor): value_SI = factor * value_display
DISPLAY_UNITS = {
    "deg": ("rad", 0.017453292519943295),
    "deg/s": ("rad/s", 0.017453292519943295),
    "mm": ("m", 1e-3),
    "kN": ("N", 1e3),
    "MPa": ("Pa", 1e6),
    "mm2": ("m2", 1e-6),
    "cm3": ("m3", 1e-6),
}


def shown(q: Quantity) -> tuple[str, float]:
    """The unit that people read, and its size in the SI unit."""
    return (
        (q.display_unit, DISPLAY_UNITS[q.display_unit][1])
        if q.display_unit in DISPLAY_UNITS
        else (q.unit, 1.0)
    )


# display unit -> order of magnitude [SI unit]; 1 where none is listed
NOMINALS = {
    "mm": 1e-2,
    "deg": 0.1,
    "kN": 1e3,
    "N.m": 1e3,
    "MPa": 1e6,
    "J": 100.0,
    "m/s2": 10.0,
    "rad/s2": 10.0,
}

# SI unit -> exponents of its base units, for FMI's UnitDefinitions
BASE_UNITS: dict[str, dict[str, int]] = {
    "m": {"m": 1},
    "m2": {"m": 2},
    "m3": {"m": 3},
    "s": {"s": 1},
    "kg": {"kg": 1},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/s2": {"rad": 1, "s": -2},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "s/m": {"s": 1, "m": -1},
    "1/s": {"s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N/Pa": {"m": 2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "kg/m3": {"kg": 1, "m": -3},
    "kg.m2": {"kg": 1, "m": 2},
}

INPUT_QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "N",
        "external force on the body at its CG, along inertial x",
        -1e7,
        1e7,
        name="external.force_x",
        display_unit="kN",
    ),
    Quantity(
        "N",
        "external force on the body at its CG, along inertial y (up)",
        -1e7,
        1e7,
        name="external.force_y",
        display_unit="kN",
    ),
    Quantity(
        "N.m",
        "external moment on the body, clockwise positive, as the pitch",
        -1e7,
        1e7,
        name="external.moment",
    ),
    Quantity(
        "m",
        "lift of the ground along inertial y; a change after the start is spread over the time "
        "since the last change, at least the next step",
        -100.0,
        100.0,
        name="ground.heave",
    ),
    Quantity(
        "m/s",
        "rate of the lift; the ground goes on at it until inputs are set again",
        -100.0,
        100.0,
        name="ground.heave_rate",
    ),
    Quantity(
        "rad",
        "tilt of the ground about its origin, on top of ground.slope, clockwise positive; "
        "a change after the start is spread over the time since the last change, at least the "
        "next step",
        -1.0,
        1.0,
        name="ground.tilt",
        display_unit="deg",
    ),
    Quantity(
        "rad/s",
        "rate of the tilt; the ground goes on at it until inputs are set again",
        -10.0,
        10.0,
        name="ground.tilt_rate",
        display_unit="deg/s",
    ),
)

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

LEGS = (1, 2, 3, 4)
# quantities of a leg whose sign changes in its mirror image
MIRRORED = ("footpad.z", "contact.force_z")


def _leg_quantity(leg: int, q: Quantity) -> Quantity:
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
    _leg_quantity(leg, q) for leg in LEGS for q in LEG_QUANTITIES
)
OUTPUT_NAMES: tuple[str, ...] = tuple(q.name for q in OUTPUT_QUANTITIES)
# the integrator's work, and whether it sleeps: `Landing.statistics`; and what does the work
STATISTIC_QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "", "steps of the integrator since the start", 0.0, name="solver.steps", kind="integer"
    ),
    Quantity(
        "",
        "steps that the integrator has rejected and tried again shorter",
        0.0,
        name="solver.rejected",
        kind="integer",
    ),
    Quantity(
        "",
        "calls of the right-hand side since the start",
        0.0,
        name="solver.rhs_calls",
        kind="integer",
    ),
    Quantity(
        "",
        "whether the landing sleeps: at rest under inputs that do not change, time passes "
        "without steps",
        0.0,
        1.0,
        name="solver.asleep",
        kind="integer",
    ),
    Quantity(
        "",
        "whether the core is compiled; uncompiled, it gives the same digits slowly",
        0.0,
        name="solver.compiled",
        kind="boolean",
    ),
)
INPUT_NAMES: tuple[str, ...] = tuple(q.name for q in INPUT_QUANTITIES)


@dataclass(frozen=True)
class Peak:
    """One extreme of an output since the start, and when it first was.

    Attributes:
        output: The output's name.
        side: `min` or `max`.
        value: The quantity `peak.OUTPUT.SIDE`.
        time: The quantity `peak.OUTPUT.SIDE_time` [s].
    """

    output: str
    side: Literal["min", "max"]
    value: Quantity
    time: Quantity


def _peak(q: Quantity, side: Literal["min", "max"]) -> Peak:
    words = {"min": "least", "max": "greatest"}[side]
    name = f"peak.{q.name}.{side}"
    value = Quantity(
        q.unit,
        f"{words} value since the start, between steps too: {q.meaning}",
        q.lo,
        q.hi,
        name=name,
        display_unit=q.display_unit,
    )
    time = Quantity("s", f"time at which {name} was first so", name=f"{name}_time")
    return Peak(q.name, side, value, time)


# the extremes that the FMU tells; `Landing.extremes` has those of every output
PEAKS_OF_A_LEG: tuple[tuple[str, tuple[Literal["min", "max"], ...]], ...] = (
    ("main_strut.force", ("min", "max")),
    ("main_strut.stroke", ("max",)),
    ("main_strut.pressure_lower", ("max",)),
    ("auxiliary_strut.force", ("min", "max")),
    ("contact.force", ("max",)),
)
_BY_NAME = {q.name: q for q in OUTPUT_QUANTITIES}
PEAKS: tuple[Peak, ...] = (
    _peak(_BY_NAME["body.top_axial_acceleration"], "max"),
    _peak(_BY_NAME["status.stability_margin"], "min"),
    *(
        _peak(_BY_NAME[f"leg[{leg}].{name}"], side)
        for leg in LEGS
        for name, sides in PEAKS_OF_A_LEG
        for side in sides
    ),
)
PEAK_QUANTITIES: tuple[Quantity, ...] = tuple(q for p in PEAKS for q in (p.value, p.time))


@dataclass(frozen=True)
class LegGroup:
    """Legs that are each other's mirror images.

    Attributes:
        azimuth: Azimuth of the legs of side +1 [deg].
        legs: (number, side) of each leg; side -1 is the mirror image, with z reversed.
    """

    azimuth: int
    legs: tuple[tuple[int, int], ...] = field(default=())


# the landing modes; legs are numbered round the body, and no other place knows the mode
MODES: dict[str, tuple[LegGroup, ...]] = {
    "2-2": (LegGroup(135, ((1, 1), (2, -1))), LegGroup(45, ((4, 1), (3, -1)))),
    "1-2-1": (LegGroup(180, ((1, 1),)), LegGroup(90, ((4, 1), (2, -1))), LegGroup(0, ((3, 1),))),
}
