"""The spatial body as a user sees it: its motion, and what is read of it."""

from __future__ import annotations

from math import asin, atan2, fabs, inf, sqrt

from ..access import (
    ACROSS,
    DECK_INPUTS,
    ENERGY_OUTPUTS,
    LEG,
    LEG_OUTPUTS,
    SPATIAL_OUTPUTS,
    STATUS_OUTPUTS,
    across_state,
    deck_turn_of,
    foot_loads_of,
    leg_model,
    leg_place,
    leg_state,
    put,
    rotation_of,
    spatial_attitude_of,
    spatial_inputs,
    spatial_model,
    spatial_state,
)
from ..memory import Doubles, data
from ..records import LegLoadOutputs, Rotation, SpatialOutputs, StatusOutputs, Vector
from ..vectors import added, cross, dot, length_of, less, to_body
from .deck import deck_acceleration, deck_spin, deck_spin_rate, deck_velocity, from_origin
from .sea import FREEDOMS
from .spatial_legs import cg_of, foot_place, moved_across
from .spatial_motion import SpatialMotion
from .status import phase_of

PI = 3.141592653589793
# two footpads nearer to each other than this are one corner [m]
ONE_CORNER = 1e-9


def near(angle: float, other: float) -> float:
    """The `angle` [rad] in the turn whose middle is the `other` one."""
    off = angle - other
    if off > PI:
        return angle - 2.0 * PI
    if off < -PI:
        return angle + 2.0 * PI
    return angle


class Spatial(SpatialMotion):
    """The spatial body with its outputs: body, energies, status, then each leg.

    The order is that of `rlv_landing.quantities`.
    """

    def read(self, y: Doubles, u: Doubles, dy: Doubles, out: Doubles, at: int) -> None:
        """Write all outputs to `out[at:]`, from what `rhs` has kept of the legs."""
        turn = rotation_of(self._turn, 0)
        self._off_ground = self._outside > 0
        self._keep_status(y)
        self._keep_point_energies(y)
        if self._tripod:
            self._keep_second_energies()
        s = spatial_state(y, 0)
        velocity = to_body(turn, Vector(s.vx, s.vy, s.vz))
        kinetic = self._kinetic_energy(y, velocity, Vector(s.spin_x, s.spin_y, s.spin_z))
        self._put_body(y, dy, turn, out, at)
        at += SPATIAL_OUTPUTS
        self._put_energies(y, kinetic, self._potential_energy(y), out, at)
        at += ENERGY_OUTPUTS
        self._put_status(y, turn, out, at)
        at += STATUS_OUTPUTS
        for i in range(self.groups):
            self._put_leg(i, y, out, at)
            if self._tripod:
                self._put_second_strut(i, out, at + LEG_OUTPUTS)
            else:
                put(LegLoadOutputs(self._transverse[i]), out, at + LEG_OUTPUTS)
            at += self._leg_row

    def _ground_is_still(self, u: Doubles) -> bool:
        if self.at_sea:
            return False
        now = spatial_inputs(u, 0)
        return (
            now.surge_rate == 0.0
            and now.heave_rate == 0.0
            and now.sway_rate == 0.0
            and now.roll_rate == 0.0
            and now.yaw_rate == 0.0
            and now.tilt_rate == 0.0
        )

    def distance(self, shift: Doubles) -> float:
        """The way of the body, turns of which count a metre a radian, or of a footpad."""
        s = spatial_state(shift, 0)
        way = max(fabs(s.x), fabs(s.y), fabs(s.z), 2.0 * length_of(s.q_w, s.q_x, s.q_y, s.q_z))
        for i in range(self.groups):
            leg = leg_state(shift, self._first_leg + LEG * i)
            way = max(way, fabs(leg.r), fabs(leg.h))
            if self._tripod:
                way = max(way, fabs(across_state(shift, self._first_across + ACROSS * i).t))
        return way

    def _put_body(self, y: Doubles, rates: Doubles, turn: Rotation, out: Doubles, at: int) -> None:
        s = spatial_state(y, 0)
        r = spatial_state(rates, 0)
        p = spatial_model(self._body, 0)
        a = spatial_attitude_of(self._attitude, 0)
        size = length_of(s.q_w, s.q_x, s.q_y, s.q_z)
        spin = Vector(s.spin_x, s.spin_y, s.spin_z)
        sensor = less(Vector(0.0, p.H, 0.0), cg_of(p))
        turning = cross(Vector(a.spin_x, a.spin_y, a.spin_z), sensor)
        force = self._strike_force()
        moment = self._strike_moment()
        put(
            SpatialOutputs(
                x=s.x,
                y=s.y,
                z=s.z,
                q_w=s.q_w / size,
                q_x=s.q_x / size,
                q_y=s.q_y / size,
                q_z=s.q_z / size,
                pitch=atan2(turn.y_x, turn.y_y),
                roll=asin(min(max(turn.y_z, -1.0), 1.0)),
                heading=near(atan2(-turn.x_z, turn.z_z), p.heading),
                vx=s.vx,
                vy=s.vy,
                vz=s.vz,
                spin_x=s.spin_x,
                spin_y=s.spin_y,
                spin_z=s.spin_z,
                ax=r.vx,
                ay=r.vy,
                az=r.vz,
                spin_acceleration_x=r.spin_x,
                spin_acceleration_y=r.spin_y,
                spin_acceleration_z=r.spin_z,
                top_axial_acceleration=a.a_y + turning.y + cross(spin, cross(spin, sensor)).y,
                clearance=self._clearance(),
                strike_force_x=force.x,
                strike_force_y=force.y,
                strike_force_z=force.z,
                strike_moment_x=moment.x,
                strike_moment_y=moment.y,
                strike_moment_z=moment.z,
            ),
            out,
            at,
        )

    def follow_ground(self, t: float, y: Doubles, dy: Doubles, u: Doubles, rates: Doubles) -> None:
        """Keep the motion relative to the deck, which moves as a rigid body.

        Of the acceleration, what the deck's has at the CG is taken off.
        """
        second = data(self._deck_accelerations)
        self.ground_moves = self.at_sea
        for j in range(FREEDOMS):
            rate = DECK_INPUTS + 2 * j + 1
            second[j] = rates[rate]
            if u[rate] != 0.0 or second[j] != 0.0:
                self.ground_moves = True
        if not self.ground_moves:
            return
        if self.at_sea:
            self._sea.add_accelerations(t, second)
        now = spatial_inputs(u, 0)
        s = spatial_state(y, 0)
        r = spatial_state(dy, 0)
        turn = rotation_of(self._turn, 0)
        deck = deck_turn_of(self._deck, 0)
        rolling = deck_spin(now, deck)
        angular = deck_spin_rate(now, deck, Vector(second[3], second[4], second[5]))
        above = from_origin(now, Vector(s.x, s.y, s.z))
        velocity = less(Vector(s.vx, s.vy, s.vz), deck_velocity(now, rolling, above))
        spin = less(Vector(s.spin_x, s.spin_y, s.spin_z), to_body(turn, rolling))
        self.relative_kinetic = self._kinetic_energy(y, to_body(turn, velocity), spin)
        origin = Vector(second[0], second[1], second[2])
        ground = deck_acceleration(origin, rolling, angular, above)
        a = less(Vector(r.vx, r.vy, r.vz), ground)
        turning = less(Vector(r.spin_x, r.spin_y, r.spin_z), to_body(turn, angular))
        self.relative_acceleration = (
            fabs(a.x) + fabs(a.y) + fabs(a.z) + fabs(turning.x) + fabs(turning.y) + fabs(turning.z)
        )

    def _kinetic_energy(self, y: Doubles, velocity: Vector, spin: Vector) -> float:
        """Kinetic energy [J] of body and footpads at these of the CG, body axes [m/s, rad/s]."""
        p = spatial_model(self._body, 0)
        turning = Vector(
            p.I_x * spin.x + p.I_xy * spin.y + p.I_xz * spin.z,
            p.I_xy * spin.x + p.I_y * spin.y + p.I_yz * spin.z,
            p.I_xz * spin.x + p.I_yz * spin.y + p.I_z * spin.z,
        )
        twice = p.m_u * dot(velocity, velocity) + dot(spin, turning)
        for i in range(self.groups):
            leg = leg_state(y, self._first_leg + LEG * i)
            place = leg_place(self._places, i)
            foot = foot_place(leg, place, p)
            if self._tripod:
                across = across_state(y, self._first_across + ACROSS * i)
                foot = moved_across(foot, across, place)
            moved = added(added(velocity, cross(spin, foot.from_cg)), foot.rate)
            twice += leg_model(self._legs, i).m_d * dot(moved, moved)
        return 0.5 * twice

    def _potential_energy(self, y: Doubles) -> float:
        """Potential energy [J] of body and footpads above the inertial origin."""
        p = spatial_model(self._body, 0)
        height = p.m_u * spatial_state(y, 0).y
        for i in range(self.groups):
            height += leg_model(self._legs, i).m_d * foot_loads_of(self._feet, i).y
        return p.g * height

    def _put_status(self, y: Doubles, turn: Rotation, out: Doubles, at: int) -> None:
        """Write the phase, which is not yet told to be settled, and the stability margin.

        The margin is the distance [m], seen from above, from the whole vehicle's CG to the nearest
        edge of the polygon that the footpads span, negative beyond.
        """
        s = spatial_state(y, 0)
        mass = spatial_model(self._body, 0).m_u
        x = mass * s.x
        z = mass * s.z
        depth = foot_loads_of(self._feet, 0).depth
        for i in range(self.groups):
            foot = foot_loads_of(self._feet, i)
            m_d = leg_model(self._legs, i).m_d
            mass += m_d
            x += m_d * foot.x
            z += m_d * foot.z
            depth = max(depth, foot.depth)
        for i in range(self.points):
            depth = max(depth, foot_loads_of(self._point_loads, i).depth)
        margin = self._margin(x / mass, z / mass)
        put(StatusOutputs(phase_of(margin, turn.y_y, depth), margin), out, at)

    def _margin(self, x: float, z: float) -> float:
        """Distance [m] of a point seen from above to the nearest edge of the footpads' polygon.

        An edge is a line from one footpad to another one that has all others on its inner side.
        Most footpads stand in the order of their legs.
        """
        margin = inf
        last = self.groups - 1
        for i in range(self.groups):
            edge = self._edge(last, i, x, z)
            if edge == inf:
                return self._margin_of_any(x, z)
            margin = min(margin, edge)
            last = i
        return margin

    def _margin_of_any(self, x: float, z: float) -> float:
        """The same for footpads in any order; -inf where there is no edge."""
        margin = inf
        for i in range(self.groups):
            for j in range(self.groups):
                margin = min(margin, self._edge(i, j, x, z))
        return -inf if margin == inf else margin

    def _edge(self, i: int, j: int, x: float, z: float) -> float:
        """Distance [m] of a point from the edge between two footpads; inf where it is none."""
        a = foot_loads_of(self._feet, i)
        b = foot_loads_of(self._feet, j)
        along_x = b.x - a.x
        along_z = b.z - a.z
        square = along_x * along_x + along_z * along_z
        if square < ONE_CORNER * ONE_CORNER:
            return inf
        for k in range(self.groups):
            c = foot_loads_of(self._feet, k)
            inner = along_x * (c.z - a.z) - along_z * (c.x - a.x)
            if inner < 0.0 and inner * inner > ONE_CORNER * ONE_CORNER * square:
                return inf
        return (along_x * (z - a.z) - along_z * (x - a.x)) / sqrt(square)
