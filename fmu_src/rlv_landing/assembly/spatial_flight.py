"""The free flight in space before the first contact, above the ground as it moves."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from math import ceil, cos, inf, sin, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core import LegPlace, SpatialInputs, SpatialModel, SpatialState
from ..core.bodies.deck import deck_turn, from_origin, ground_axes
from ..core.bodies.sea import FREEDOMS
from ..core.bodies.spatial_legs import cg_of, in_leg
from ..core.bodies.spatial_motion import gone_on
from ..core.ground.terrain import terrain_place
from ..core.records import Rotation, TerrainPlace, Vector
from ..core.vectors import added, cross, dot, less, rotation, scaled, solved, to_body, to_inertial
from ..errors import LandingError
from ..parameters import Parameters
from ..parameters.operators import FREEDOMS as NAMES
from ..touchdown import DEPTH_LIMIT, STEEPEST, each_leg, footpad_at_rest
from .sea import CALM, Waves, waves_of
from .surroundings import body_points, height_field

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

# numbers of the deck's motion, a place and a rate a freedom; the places among them
MOTION = 2 * FREEDOMS
MOVED = dict(zip(range(0, MOTION, 2), NAMES))
# parts of the free flight's duration at which the footpads are checked to be above the ground
CHECKS = 64
# steps down to a height field, the shortest one [m], and how often the last is halved
DESCENT, LEAST_DESCENT, HALVINGS = 200, 1e-3, 60
# longest turn of the body in a step of the tumbling flight [rad]
TURN = 0.01
Quaternion = tuple[float, float, float, float]
# rows of a symmetric 3 x 3 tensor, or of its inverse
Tensor = tuple[Vector, Vector, Vector]


class DeckMotion:
    """The motion of the deck from some time on: at constant accelerations, on top of the sea's.

    Args:
        inputs: Its places and rates at that time, without the sea's.
        rates: Rates of these.
        waves: The sea.
        since: That time [s], 0 at the start of the landing.
    """

    def __init__(
        self, inputs: SpatialInputs, rates: SpatialInputs, waves: Waves = CALM, since: float = 0.0
    ) -> None:
        self._made_of = (inputs, rates, waves, since)
        self._sea = waves.kernel() if waves.numbers else None

    @classmethod
    def at_sea(cls, parameters: Parameters, since: float = 0.0) -> DeckMotion | None:
        """The motion in the parameters' sea without inputs; None where there is no sea."""
        waves = waves_of(parameters)
        still = SpatialInputs(*[0.0] * len(SpatialInputs._fields))
        return cls(still, still, waves, since) if waves.numbers else None

    def __reduce__(self) -> tuple[type[DeckMotion], tuple[Any, ...]]:
        return type(self), self._made_of

    def at(self, t: float) -> SpatialInputs:
        """The deck's place `t` [s] later, as in the kernels."""
        u, rate, _, since = self._made_of
        u = u._replace(
            surge=gone_on(u.surge, u.surge_rate, rate.surge_rate, t),
            heave=gone_on(u.heave, u.heave_rate, rate.heave_rate, t),
            sway=gone_on(u.sway, u.sway_rate, rate.sway_rate, t),
            roll=gone_on(u.roll, u.roll_rate, rate.roll_rate, t),
            yaw=gone_on(u.yaw, u.yaw_rate, rate.yaw_rate, t),
            tilt=gone_on(u.tilt, u.tilt_rate, rate.tilt_rate, t),
        )
        if self._sea is None:
            return u
        now = array("d", bytes(8 * MOTION))
        self._sea.places(array("d", [since + t]), 1, now)
        return u._replace(**{name: getattr(u, name) + now[k] for k, name in MOVED.items()})

    def places(self, times: NDArray[float64]) -> NDArray[float64]:
        """The deck's places at `times` [s] later, (n,): (6, n), in the order of the inputs."""
        import numpy as np

        u, rate, _, since = self._made_of
        found = np.empty((len(MOVED), len(times)))
        for row, name in enumerate(MOVED.values()):
            speed, change = getattr(u, f"{name}_rate"), getattr(rate, f"{name}_rate")
            found[row] = getattr(u, name) + (speed + 0.5 * change * times) * times
        if self._sea is not None:
            rows = np.zeros((len(times), MOTION))
            self._sea.places(np.ascontiguousarray(since + times), len(times), rows.reshape(-1))
            found += rows[:, ::2].T
        return found


class Tumbling(NamedTuple):
    """Attitude of the rigid vehicle, and its angular velocity [rad/s], body axes."""

    q: Quaternion
    spin: Vector


class SpatialFlight:
    """The free flight with the legs fully extended, up to the first contact.

    The whole vehicle's CG flies a parabola, and the rigid vehicle turns free of moments. The first
    contact is `drop.contact_time` after time 0: the footpad, or point of the body, that is lowest
    above the ground as it is then touches it, and the body's CG is above the inertial origin.
    [derived]

    Args:
        parameters: The vehicle, its drop and its ground.
        body: The body's numbers.
        places: Places of the legs.
        deck: Motion of the ground from time 0 on.
    """

    def __init__(
        self,
        parameters: Parameters,
        body: SpatialModel,
        places: Sequence[LegPlace],
        deck: DeckMotion,
    ) -> None:
        drop = parameters.drop
        legs = each_leg(parameters)
        self.footpads = [footpad_at_rest(leg) for leg in legs]
        self._feet = [less(in_leg(p, *f), cg_of(body)) for p, f in zip(places, self.footpads)]
        # what may meet the ground, and how far the ground there is above its plane or field
        struck = [less(Vector(*point), cg_of(body)) for point in body_points(parameters)]
        self._contacts = [
            *zip(self._feet, (leg.ground.step for leg in legs)),
            *((point, 0.0) for point in struck),
        ]
        self._field, self._heights = height_field(parameters)
        self._body, self._deck = body, deck
        self._duration, self._gravity = drop.contact_time, parameters.ground.gravity
        masses = [leg.vehicle.footpad_mass for leg in legs]
        mass = body.m_u + masses[0] * len(places)
        self._center = scaled(_sum(self._feet), masses[0] / mass)
        if len(set(masses)) > 1:
            moments = [scaled(foot, m_d) for foot, m_d in zip(self._feet, masses)]
            self._center = scaled(_sum(moments), 1.0 / (body.m_u + sum(masses)))
        self._inertia = _whole_inertia(body, self._feet, self._center, masses)
        q = attitude(drop.tilt, drop.roll, drop.heading)
        turn = rotation(*q)
        spin = to_body(turn, Vector(drop.roll_rate, drop.yaw_rate, -drop.pitch_rate))
        self._contact = Tumbling(q, spin)
        velocity = Vector(drop.horizontal_velocity, drop.vertical_velocity, drop.lateral_velocity)
        center = to_inertial(turn, self._center)
        self._velocity = added(velocity, to_inertial(turn, cross(spin, self._center)))
        up = ground_axes(deck_turn(deck.at(self._duration)), body).y_y
        if up < cos(STEEPEST):
            raise LandingError(
                f"the ground's normal is {up:.3g} upwards at the first contact, "
                f"{self._duration:g} s, the limit is {cos(STEEPEST):.3g}; tilt the ground less"
            )
        height = self._contact_height(turn, up)
        self._place = added(Vector(0.0, height, 0.0), center)

    def _contact_height(self, turn: Rotation, up: float) -> float:
        """Height [m] of the body's CG at which the vehicle, coming from above, meets the ground.

        Args:
            turn: Its attitude.
            up: Part upwards of the normal of the ground's plane.

        Raises:
            LandingError: It meets the ground beyond the height field.
        """
        over, height = Vector(0.0, 0.0, 0.0), 0.0
        if self._field.columns == 0.0:
            return -self._clearance(over, turn, self._duration) / up
        highest, lowest = max(self._heights), min(self._heights)
        deck = self._deck.at(self._duration)
        axes, above = ground_axes(deck_turn(deck), self._body), from_origin(deck, over)
        plane = min(
            to_body(axes, added(above, to_inertial(turn, place))).y - step
            for place, step in self._contacts
        )
        # above all heights, then down by parts of what they differ by, and to the digit
        high = (highest - plane) / up
        part = (highest - lowest) / up / DESCENT
        low = high
        while self._clearance(Vector(0.0, low, 0.0), turn, self._duration) > 0.0:
            if low < high - (DESCENT + 1) * part - 1.0:
                break
            high, low = low, low - max(part, LEAST_DESCENT)
        for _ in range(HALVINGS):
            height = 0.5 * (high + low)
            if self._clearance(Vector(0.0, height, 0.0), turn, self._duration) > 0.0:
                high = height
            else:
                low = height
        self._check_inside(Vector(0.0, height, 0.0), turn, self._duration)
        return high

    def _clearance(self, cg: Vector, turn: Rotation, t: float) -> float:
        """Height [m] of the lowest contact above the ground at time `t` [s], along its normal."""
        deck = self._deck.at(t)
        axes, above = ground_axes(deck_turn(deck), self._body), from_origin(deck, cg)
        least = inf
        for place, step in self._contacts:
            point = to_body(axes, added(above, to_inertial(turn, place)))
            height = point.y
            if self._field.columns > 0.0:
                height = -self._terrain(point).depth
            least = min(least, height - step)
        return least

    def _terrain(self, point: Vector) -> TerrainPlace:
        """The height field below a point, in the axes of the ground's plane."""
        return terrain_place(self._field, self._heights, int(self._field.columns) + 2, point)

    def _check_inside(self, cg: Vector, turn: Rotation, t: float) -> None:
        """Check that the height field is below all contacts."""
        if self._field.columns == 0.0:
            return
        deck, f = self._deck.at(t), self._field
        axes, above = ground_axes(deck_turn(deck), self._body), from_origin(deck, cg)
        for place, _ in self._contacts:
            point = to_body(axes, added(above, to_inertial(turn, place)))
            if self._terrain(point).outside > 0.0:
                x, z = f.cos_d * point.x - f.sin_d * point.z, f.sin_d * point.x + f.cos_d * point.z
                raise LandingError(
                    f"a footpad or a point of the body is at x = {x:g} m, z = {z:g} m at {t:g} s, "
                    f"beyond ground.terrain, x from {f.u0:g} to {f.u0 + f.du * (f.columns - 1):g} "
                    f"m, z from {f.v0:g} to {f.v0 + f.dv * (f.rows - 1):g} m; give a larger field"
                )

    def start(self) -> SpatialState:
        """The body's state at time 0.

        Raises:
            LandingError: Before the contact a footpad or point of the body would pass below the
                ground, or beyond its height field. 65 times are checked.
        """
        end, now = self._duration, self._contact
        state, lowest = self._state(now, 0.0), 0.0
        speed = sqrt(dot(now.spin, now.spin))
        steps = max(1, ceil(end * speed / (TURN * CHECKS)))
        for k in range(CHECKS if end > 0.0 else 0):
            for _ in range(steps):
                now = self._back(now, end / (CHECKS * steps))
            before = end * (k + 1) / CHECKS
            state = self._state(now, before)
            turn = rotation(*now.q)
            cg = Vector(state.x, state.y, state.z)
            self._check_inside(cg, turn, end - before)
            height = self._clearance(cg, turn, end - before)
            lowest = min(lowest, height)
        if lowest < -DEPTH_LIMIT:
            raise LandingError(
                f"drop.contact_time = {end:g} s of free flight would pass {-lowest:.3g} m "
                f"below the ground, the limit is {DEPTH_LIMIT:g} m; shorten it, or touch down with "
                "lower rates or a faster descent onto the ground"
            )
        return state

    def _state(self, now: Tumbling, before: float) -> SpatialState:
        """The body's state `before` [s] the first contact, where it has turned to `now`."""
        turn = rotation(*now.q)
        v = Vector(self._velocity.x, self._velocity.y + self._gravity * before, self._velocity.z)
        fallen = Vector(0.0, 0.5 * self._gravity * before * before, 0.0)
        center = added(less(self._place, scaled(v, before)), fallen)
        cg = less(center, to_inertial(turn, self._center))
        moved = less(v, to_inertial(turn, cross(now.spin, self._center)))
        return SpatialState(*cg, *now.q, *moved, *now.spin)

    def _back(self, now: Tumbling, dt: float) -> Tumbling:
        """The tumbling `dt` [s] before, by the classic Runge-Kutta scheme."""
        k1 = self._rate(now)
        k2 = self._rate(_moved(now, k1, -0.5 * dt))
        k3 = self._rate(_moved(now, k2, -0.5 * dt))
        k4 = self._rate(_moved(now, k3, -dt))
        for k, part in ((k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)):
            now = _moved(now, k, -dt * part / 6.0)
        size = sqrt(sum(x * x for x in now.q))
        w, x, y, z = (x / size for x in now.q)
        return Tumbling((w, x, y, z), now.spin)

    def _rate(self, now: Tumbling) -> Tumbling:
        """The rates of attitude and spin: q' = q w/2, I w' = -w x I w."""
        (w, x, y, z), s = now
        q = (
            -0.5 * (x * s.x + y * s.y + z * s.z),
            0.5 * (w * s.x + y * s.z - z * s.y),
            0.5 * (w * s.y + z * s.x - x * s.z),
            0.5 * (w * s.z + x * s.y - y * s.x),
        )
        momentum = Vector(*(dot(row, s) for row in self._inertia))
        return Tumbling(q, solved(*self._inertia, scaled(cross(s, momentum), -1.0)))


def attitude(tilt: float, roll: float, heading: float) -> Quaternion:
    """The quaternion of a body turned by `heading` about y, `roll` about x, clockwise `tilt` [rad].

    In this order, each about the inertial axis.
    """
    st, ct = sin(-0.5 * tilt), cos(-0.5 * tilt)
    sr, cr = sin(0.5 * roll), cos(0.5 * roll)
    sh, ch = sin(0.5 * heading), cos(0.5 * heading)
    # qz(-tilt) qx(roll)
    w, x, y, z = ct * cr, ct * sr, st * sr, st * cr
    return w * ch - y * sh, x * ch - z * sh, w * sh + y * ch, x * sh + z * ch


def _moved(now: Tumbling, rate: Tumbling, dt: float) -> Tumbling:
    w, x, y, z = (a + dt * b for a, b in zip(now.q, rate.q))
    return Tumbling((w, x, y, z), added(now.spin, scaled(rate.spin, dt)))


def _sum(vectors: Sequence[Vector]) -> Vector:
    total = Vector(0.0, 0.0, 0.0)
    for v in vectors:
        total = added(total, v)
    return total


def _whole_inertia(
    body: SpatialModel, feet: Sequence[Vector], center: Vector, masses: Sequence[float]
) -> Tensor:
    """Inertia [kg m2] of body and footpads about their common CG, body axes."""
    rows = [
        [body.I_x, body.I_xy, body.I_xz],
        [body.I_xy, body.I_y, body.I_yz],
        [body.I_xz, body.I_yz, body.I_z],
    ]
    for mass, place in [(body.m_u, Vector(0.0, 0.0, 0.0)), *zip(masses, feet)]:
        d = less(place, center)
        for i in range(3):
            for j in range(3):
                rows[i][j] -= mass * d[i] * d[j]
            rows[i][i] += mass * dot(d, d)
    a, b, c = (Vector(*row) for row in rows)
    return a, b, c
