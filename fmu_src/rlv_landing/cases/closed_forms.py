"""What a vehicle does in closed form: falling, tumbling, on springs, on a slope, over its edge.

Each gives, of the parameters and the end of the landing, what is compared: the output, the time, a
time whose value is taken off (or None), the value and how far ours may be from it, in SI.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import atan2, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

from ..core import Phase
from ..errors import LandingError, unknown
from ..parameters import Parameters
from ..quantities import TRIPOD
from ..touchdown import footpad_at_rest

Told = Iterator[tuple[str, float, float | None, float, float]]
# parts of the landing at which a motion is compared
PARTS = 4


def free_fall(p: Parameters, until: float) -> Told:
    """A vehicle that does not turn, before its contact: velocity and way, to rounding."""
    g, contact = p.ground.gravity, p.drop.contact_time
    vx, vy, vz = p.drop.horizontal_velocity, p.drop.vertical_velocity, p.drop.lateral_velocity
    for k in range(1, PARTS + 1):
        t = until * k / PARTS
        yield "body.vy", t, None, vy + g * (contact - t), 1e-9
        yield "body.x", t, 0.0, vx * t, 1e-9
        yield "body.y", t, 0.0, (vy + g * contact) * t - 0.5 * g * t * t, 1e-9
        yield "body.z", t, 0.0, vz * t, 1e-9


def tumbling(p: Parameters, until: float) -> Told:
    """A top whose inertia about its axis is another: its spin precesses about the axis.

    The spin's part across the axis turns from x towards z at (1 - I_axis/I_across) times the part
    along it, in body axes. Its legs are all but rigid: the tolerance is 1e-4 of the spin.
    """
    v, drop, whole = p.vehicle, p.drop, _rigid(p)
    across, along = whole.across, whole.along
    if (v.inertia_roll or v.inertia) != v.inertia or drop.tilt or drop.roll:
        raise LandingError("closed form tumbling: the vehicle is no upright symmetric top")
    # at the contact the body's axes are those of the heading
    s, c = sin(drop.heading), cos(drop.heading)
    x, z = c * drop.roll_rate + s * drop.pitch_rate, s * drop.roll_rate - c * drop.pitch_rate
    spin, rate = hypot(x, z), (1.0 - along / across) * drop.yaw_rate
    for k in range(1, PARTS + 1):
        t = until * k / PARTS
        # I_across x' = (I_along - I_across) y z and I_across z' = (I_across - I_along) x y
        angle = atan2(z, x) + rate * (t - drop.contact_time)
        yield "body.spin_x", t, None, spin * cos(angle), 1e-4 * spin
        yield "body.spin_y", t, None, drop.yaw_rate, 1e-4 * abs(drop.yaw_rate)
        yield "body.spin_z", t, None, spin * sin(angle), 1e-4 * spin


def mass_on_springs(p: Parameters, until: float) -> Told:
    """An upright vehicle that touches with all legs at once: a mass on undamped springs.

    The footpads slide without friction: a leg's stiffness is that of its two struts with the
    footpad free along the radius, in series with the ground's. The legs' geometry is that at the
    contact, and the footpads have no mass: the tolerance is 1 % of the largest sag and speed.
    """
    main, aux = p.main_strut, p.auxiliary_strut
    r, h = footpad_at_rest(p)
    rr = rh = hh = 0.0
    for k, joint_r, joint_h in (
        (main.stiffness, main.joint_radius, -main.joint_depth),
        (aux.stiffness, aux.joint_radius, -aux.joint_depth),
    ):
        length = hypot(r - joint_r, h - joint_h)
        u, w = (r - joint_r) / length, (h - joint_h) / length
        rr, rh, hh = rr + k * u * u, rh + k * u * w, hh + k * w * w
    leg = hh - rh * rh / rr
    stiffness = p.vehicle.legs / (1.0 / leg + 1.0 / p.ground.stiffness)
    mass, g = p.whole_mass, p.ground.gravity
    w, fall = sqrt(stiffness / mass), -p.drop.vertical_velocity
    sag = g / (w * w)
    largest = sag + hypot(sag, fall / w)
    for k in range(1, PARTS + 1):
        t = until * k / PARTS
        since = t - p.drop.contact_time
        height = -sag + sag * cos(w * since) - fall / w * sin(w * since)
        speed = -sag * w * sin(w * since) - fall * cos(w * since)
        yield "body.y", t, p.drop.contact_time, height, 0.01 * largest
        yield "body.vy", t, None, speed, 0.01 * largest * w


def standing_on_slope(p: Parameters, until: float) -> Told:
    """An all but rigid vehicle that stands on a slope: the margin over its lower, nearest edge.

    The CG of a regular polygon of legs is the distance to an edge's middle from it, and its height,
    seen from above on the slope. The tolerance is 1 mm, for what legs and ground give.
    """
    whole, slope = _rigid(p), p.ground.slope
    _check_edge(p, p.ground.slope_direction, "standing_on_slope")
    margin = whole.edge * cos(slope) - whole.height * sin(slope)
    yield "status.stability_margin", until, None, margin, 1e-3


def tip_over(p: Parameters, until: float) -> Told:
    """An all but rigid vehicle that turns about its edge towards +x: whether it falls over it.

    It does where its energy of motion lifts the CG over the edge: with the inertia J about the
    edge, where J w^2/2 > m g (sqrt(d^2 + h^2) - h).
    """
    whole, drop = _rigid(p), p.drop
    _check_edge(p, 0.0, "tip_over")
    w = drop.pitch_rate
    _, foot = footpad_at_rest(p)
    told = (drop.horizontal_velocity, drop.vertical_velocity)
    pivot = (-w * foot, w * whole.edge)
    if any(abs(a - b) > 1e-6 for a, b in zip(told, pivot)):
        raise LandingError(
            f"closed form tip_over: the CG moves at {told[0]:g}, {told[1]:g} m/s; about the edge "
            f"it moves at {pivot[0]:.9g}, {pivot[1]:.9g} m/s"
        )
    about_edge = whole.across + p.whole_mass * (whole.edge**2 + whole.height**2)
    lift = p.whole_mass * p.ground.gravity * (hypot(whole.edge, whole.height) - whole.height)
    falls = 0.5 * about_edge * w * w > lift
    yield "status.phase", until, None, float(Phase.TOPPLED if falls else Phase.SETTLED), 0.5


class Rigid(NamedTuple):
    """A vehicle on rigid legs round its axis, its footpads the corners of a regular polygon."""

    across: float  # inertia about axes across its own, through the whole vehicle's CG [kg m2]
    along: float  # about its axis [kg m2]
    height: float  # of that CG above the footpads [m]
    edge: float  # distance of the polygon's edges from the axis [m]


def _rigid(p: Parameters) -> Rigid:
    v = p.vehicle
    legs, m = int(v.legs), v.footpad_mass
    r, h = footpad_at_rest(p)
    below = legs * m * h / p.whole_mass
    return Rigid(
        across=v.inertia + v.mass * below**2 + legs * m * (0.5 * r * r + (h - below) ** 2),
        along=v.inertia_yaw + legs * m * r * r,
        height=below - h,
        edge=r * cos(pi / legs),
    )


def _check_edge(p: Parameters, direction: float, form: str) -> None:
    """Check that an edge of the polygon lies across a `direction` [rad], from +x towards +z."""
    turn = 2.0 * pi / p.vehicle.legs
    off = (direction - p.vehicle.leg_azimuth + p.drop.heading) % turn
    if abs(off - 0.5 * turn) > 1e-6:
        raise LandingError(
            f"closed form {form}: no edge of the vehicle's polygon is across {direction:g} rad; "
            "turn its legs"
        )


CLOSED_FORMS: dict[str, Callable[[Parameters, float], Told]] = {
    "free_fall": free_fall,
    "tumbling": tumbling,
    "mass_on_springs": mass_on_springs,
    "standing_on_slope": standing_on_slope,
    "tip_over": tip_over,
}
# those that know nothing of the legs
OF_ANY_LEGS = ("free_fall",)


def closed_form(name: str, p: Parameters, until: float) -> Told:
    """What the closed form of this name tells of a landing that ends at `until` [s].

    Raises:
        LandingError: There is no such form, or the vehicle is not one that it is for.
    """
    if name not in CLOSED_FORMS:
        raise unknown("closed form", name, CLOSED_FORMS)
    if name not in OF_ANY_LEGS:
        if p.leg.kind == TRIPOD:
            raise LandingError(
                f"closed form {name}: leg.kind = tripod; it is for radial legs; write leg.kind = "
                "radial, or numbers of your own"
            )
        if p.overrides:
            raise LandingError(
                f"closed form {name}: {min(p.overrides)} is one leg's own; it is for legs that are "
                "alike; leave it out, or write numbers of your own"
            )
    return CLOSED_FORMS[name](p, until)
