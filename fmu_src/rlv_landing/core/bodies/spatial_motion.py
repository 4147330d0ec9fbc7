"""Motion of the spatial body on its legs: six degrees of freedom, any attitude (derived)."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from ..access import (
    ACROSS,
    ACROSS_FORCES,
    LEG,
    SPATIAL_ATTITUDE,
    SPATIAL_LOADS,
    across_state,
    deck_turn_of,
    foot_motion_of,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    put,
    rotation_of,
    spatial_attitude_of,
    spatial_inputs,
    spatial_loads_of,
    spatial_model,
    spatial_state,
)
from ..leg import leg_forces_on
from ..memory import Buffer, Doubles, Records, room
from ..records import (
    BodyPoint,
    FootLoads,
    HeightField,
    LegModel,
    LegPlace,
    SpatialAttitude,
    SpatialInputs,
    SpatialModel,
    SpatialState,
    Vector,
)
from ..vectors import (
    added,
    cross,
    dot,
    length_of,
    less,
    rotation,
    scaled,
    solved,
    to_body,
    to_inertial,
)
from .deck import deck_spin, deck_velocity, from_origin, motion_on_ground
from .sea import Sea
from .spatial_legs import (
    about_across,
    cg_of,
    foot_acceleration,
    foot_place,
    force_on_body,
    joint_place,
    moved_across,
    spatial_leg_rates,
    spatial_loads,
    transverse_part,
)
from .tripod_motion import TripodMotion


def gone_on(place: float, speed: float, acceleration: float, dt: float) -> float:
    """The place of the deck `dt` [s] after it was at `place` with a `speed`."""
    return place + (speed + 0.5 * acceleration * dt) * dt


class SpatialMotion(TripodMotion):
    """One body in space on legs, and its ground: its state is a `SpatialState`.

    Each leg is a group of its own. The body's and the footpads' accelerations are found together,
    since the force that keeps each footpad in its leg's plane contains both. Legs on three struts
    have no such force.
    """

    _attitude: Records[SpatialAttitude]
    _transverse: Buffer
    # inverse of the mass that an acceleration along the body's x, z moves [1/kg]
    _xx: float
    _xz: float
    _zz: float

    def __init__(
        self,
        body: SpatialModel,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        scale: Buffer,
        relative: Buffer,
        met: tuple[Sequence[BodyPoint], LegModel, HeightField, Buffer, Sea],
    ) -> None:
        super().__init__(body, legs, places, scale, relative, met)
        self._tripod = body.tripod > 0.0
        self._across = room(len(legs), ACROSS_FORCES)
        self._loads = room(len(legs), SPATIAL_LOADS)
        self._attitude = room(1, SPATIAL_ATTITUDE)
        # the force that keeps each footpad in its leg's plane, along t [N]
        self._transverse = array("d", bytes(8 * len(legs)))
        along_x = body.m_u
        along_z = body.m_u
        both = 0.0
        for leg, place in zip(legs, places):
            along_x += leg.m_d * place.sin_g * place.sin_g
            along_z += leg.m_d * place.cos_g * place.cos_g
            both -= leg.m_d * place.sin_g * place.cos_g
        determinant = along_x * along_z - both * both
        self._xx = along_z / determinant
        self._xz = -both / determinant
        self._zz = along_x / determinant

    def inputs_after(self, u: Doubles, rates: Doubles, dt: float, now: Doubles) -> None:
        """Loads go on at their rates, the deck at its own, which change at theirs.

        Rates of the deck's position in `rates` are those of a motion to a new one; they add to the
        deck's own.
        """
        a = spatial_inputs(u, 0)
        rate = spatial_inputs(rates, 0)
        put(
            SpatialInputs(
                force_x=a.force_x + rate.force_x * dt,
                force_y=a.force_y + rate.force_y * dt,
                force_z=a.force_z + rate.force_z * dt,
                moment_x=a.moment_x + rate.moment_x * dt,
                moment_y=a.moment_y + rate.moment_y * dt,
                moment_z=a.moment_z + rate.moment_z * dt,
                surge=gone_on(a.surge, a.surge_rate + rate.surge, rate.surge_rate, dt),
                surge_rate=a.surge_rate + rate.surge + rate.surge_rate * dt,
                heave=gone_on(a.heave, a.heave_rate + rate.heave, rate.heave_rate, dt),
                heave_rate=a.heave_rate + rate.heave + rate.heave_rate * dt,
                sway=gone_on(a.sway, a.sway_rate + rate.sway, rate.sway_rate, dt),
                sway_rate=a.sway_rate + rate.sway + rate.sway_rate * dt,
                roll=gone_on(a.roll, a.roll_rate + rate.roll, rate.roll_rate, dt),
                roll_rate=a.roll_rate + rate.roll + rate.roll_rate * dt,
                yaw=gone_on(a.yaw, a.yaw_rate + rate.yaw, rate.yaw_rate, dt),
                yaw_rate=a.yaw_rate + rate.yaw + rate.yaw_rate * dt,
                tilt=gone_on(a.tilt, a.tilt_rate + rate.tilt, rate.tilt_rate, dt),
                tilt_rate=a.tilt_rate + rate.tilt + rate.tilt_rate * dt,
            ),
            now,
            0,
        )

    def rhs(self, y: Doubles, u: Doubles, dy: Doubles) -> None:
        """Write dy/dt at the state `y` and the inputs `u` to `dy`.

        It keeps the legs' forces and loads and the body's acceleration on the way.
        """
        p = spatial_model(self._body, 0)
        s = spatial_state(y, 0)
        now = spatial_inputs(u, 0)
        keep(rotation(s.q_w, s.q_x, s.q_y, s.q_z), self._turn, 0)
        self._turn_ground(now)
        turn = rotation_of(self._turn, 0)
        spin = Vector(s.spin_x, s.spin_y, s.spin_z)
        rolling = deck_spin(now, deck_turn_of(self._deck, 0))
        self._outside = 0
        for i in range(self.groups):
            self._load(i, y, now, rolling)
        force = to_body(turn, Vector(now.force_x, now.force_y - p.m_u * p.g, now.force_z))
        moment = to_body(turn, Vector(now.moment_x, now.moment_y, now.moment_z))
        if self.points > 0:
            self._load_points(y, now, rolling)
            struck = added(force, to_body(turn, self._strike_force()))
            turned = added(moment, to_body(turn, self._strike_moment()))
            keep(self._acceleration(spin, struck, turned), self._attitude, 0)
        else:
            keep(self._acceleration(spin, force, moment), self._attitude, 0)
        attitude = spatial_attitude_of(self._attitude, 0)
        a = Vector(attitude.a_x, attitude.a_y, attitude.a_z)
        spin_rate = Vector(attitude.spin_x, attitude.spin_y, attitude.spin_z)
        a_inertial = to_inertial(turn, a)
        put(
            SpatialState(
                x=s.vx,
                y=s.vy,
                z=s.vz,
                q_w=-0.5 * (s.q_x * spin.x + s.q_y * spin.y + s.q_z * spin.z),
                q_x=0.5 * (s.q_w * spin.x + s.q_y * spin.z - s.q_z * spin.y),
                q_y=0.5 * (s.q_w * spin.y + s.q_z * spin.x - s.q_x * spin.z),
                q_z=0.5 * (s.q_w * spin.z + s.q_x * spin.y - s.q_y * spin.x),
                vx=a_inertial.x,
                vy=a_inertial.y,
                vz=a_inertial.z,
                spin_x=spin_rate.x,
                spin_y=spin_rate.y,
                spin_z=spin_rate.z,
            ),
            dy,
            0,
        )
        transverse = 0.0
        for i in range(self.groups):
            transverse += self._move(i, y, a, spin, spin_rate, dy)
        external = now.force_x * s.vx + now.force_y * s.vy + now.force_z * s.vz + dot(moment, spin)
        self._put_powers(external, transverse, dy)
        if self._tripod:
            self._add_second_powers(dy)
        self._put_point_rates(dy)

    def _load(self, i: int, y: Doubles, now: SpatialInputs, rolling: Vector) -> None:
        """Keep the forces and loads of leg `i`, on a deck whose spin is `rolling` [rad/s]."""
        p = spatial_model(self._body, 0)
        s = spatial_state(y, 0)
        turn = rotation_of(self._turn, 0)
        leg = leg_state(y, self._first_leg + LEG * i)
        place = leg_place(self._places, i)
        model = leg_model(self._legs, i)
        spin = Vector(s.spin_x, s.spin_y, s.spin_z)
        foot = foot_place(leg, place, p)
        if self._tripod:
            across = across_state(y, self._first_across + ACROSS * i)
            foot = moved_across(foot, across, place)
        moved = added(cross(spin, foot.from_cg), foot.rate)
        point = added(Vector(s.x, s.y, s.z), to_inertial(turn, foot.from_cg))
        above = from_origin(now, point)
        ground = deck_velocity(now, rolling, above)
        velocity = less(added(Vector(s.vx, s.vy, s.vz), to_inertial(turn, moved)), ground)
        axes = rotation_of(self._ground, 0)
        steep = 1.0
        if self._has_field:
            steep = self._meet_field(above, velocity, model.step, self._motions, i)
            axes = rotation_of(self._local, 0)
        else:
            keep(motion_on_ground(axes, above, velocity, model.step), self._motions, i)
        motion = foot_motion_of(self._motions, i)
        if self._tripod:
            self._keep_tripod_forces(i, y, steep)
        else:
            keep(leg_forces_on(leg, motion, steep, model), self._forces, i)
        forces = leg_forces_of(self._forces, i)
        contact = to_inertial(axes, Vector(forces.f1, forces.normal, forces.f2))
        keep(
            FootLoads(
                x=point.x,
                y=point.y,
                z=point.z,
                depth=motion.depth,
                contact_x=contact.x,
                contact_y=contact.y,
                contact_z=contact.z,
                ground=dot(contact, ground),
            ),
            self._feet,
            i,
        )
        force = to_body(turn, Vector(contact.x, contact.y - model.m_d * p.g, contact.z))
        bias = cross(spin, added(moved, foot.rate))
        keep(spatial_loads(force, bias, foot.from_cg, forces, place), self._loads, i)

    def _acceleration(self, spin: Vector, force: Vector, moment: Vector) -> SpatialAttitude:
        """The body's acceleration under the legs' loads, body axes.

        With e_t across each leg's plane, c = rho x e_t and d = p_N x e_t, where p_N is the point at
        which its transverse force N = m e_t.(a + w' x rho + b) - F.e_t acts on the body:
        (m_u 1 + sum m e_t e_t^T) a + sum m e_t c^T w' = f - sum e_t (m e_t.b - F.e_t) and
        sum m d e_t^T a + (I + sum m d c^T) w' = t - w x I w - sum d (m e_t.b - F.e_t).
        The first ones' matrix does not change, and a_y, along which no e_t has a part, stands
        alone: with a_x and a_z eliminated three equations for w' are left.

        Args:
            spin: The body's angular velocity [rad/s].
            force: All forces on the body but the legs' [N].
            moment: Their moment about the CG [N m].
        """
        if self._tripod:
            return self._tripod_acceleration(spin, force, moment)
        p = spatial_model(self._body, 0)
        # the inertia, by rows
        i_x = Vector(p.I_x, p.I_xy, p.I_xz)
        i_y = Vector(p.I_xy, p.I_y, p.I_yz)
        i_z = Vector(p.I_xz, p.I_yz, p.I_z)
        turning = Vector(dot(i_x, spin), dot(i_y, spin), dot(i_z, spin))
        moment = less(moment, cross(spin, turning))
        struts = Vector(0.0, 0.0, 0.0)
        # sum m e_t c^T by rows and sum m d e_t^T by columns, those of x and z
        c_x = Vector(0.0, 0.0, 0.0)
        c_z = Vector(0.0, 0.0, 0.0)
        d_x = Vector(0.0, 0.0, 0.0)
        d_z = Vector(0.0, 0.0, 0.0)
        for i in range(self.groups):
            place = leg_place(self._places, i)
            model = leg_model(self._legs, i)
            loads = spatial_loads_of(self._loads, i)
            forces = leg_forces_of(self._forces, i)
            foot = Vector(loads.foot_x, loads.foot_y, loads.foot_z)
            c = about_across(place, foot)
            d = c
            if p.at_joint > 0.0:
                d = about_across(place, joint_place(place, model, p))
            felt = scaled(d, model.m_d)
            c_x = less(c_x, scaled(c, model.m_d * place.sin_g))
            c_z = added(c_z, scaled(c, model.m_d * place.cos_g))
            d_x = less(d_x, scaled(felt, place.sin_g))
            d_z = added(d_z, scaled(felt, place.cos_g))
            i_x = added(i_x, scaled(c, felt.x))
            i_y = added(i_y, scaled(c, felt.y))
            i_z = added(i_z, scaled(c, felt.z))
            bias = model.m_d * loads.bias_t - loads.tangential
            struts = added(struts, force_on_body(forces, place))
            force = less(force, Vector(-bias * place.sin_g, 0.0, bias * place.cos_g))
            across = Vector(-forces.moment * place.sin_g, 0.0, forces.moment * place.cos_g)
            moment = less(moment, added(across, scaled(d, bias)))
        force = added(force, struts)
        moment = less(moment, cross(cg_of(p), struts))
        of_x = added(scaled(c_x, self._xx), scaled(c_z, self._xz))
        of_z = added(scaled(c_x, self._xz), scaled(c_z, self._zz))
        free_x = self._xx * force.x + self._xz * force.z
        free_z = self._xz * force.x + self._zz * force.z
        spin_rate = solved(
            less(i_x, added(scaled(of_x, d_x.x), scaled(of_z, d_z.x))),
            less(i_y, added(scaled(of_x, d_x.y), scaled(of_z, d_z.y))),
            less(i_z, added(scaled(of_x, d_x.z), scaled(of_z, d_z.z))),
            less(moment, added(scaled(d_x, free_x), scaled(d_z, free_z))),
        )
        return SpatialAttitude(
            a_x=free_x - dot(of_x, spin_rate),
            a_y=force.y / p.m_u,
            a_z=free_z - dot(of_z, spin_rate),
            spin_x=spin_rate.x,
            spin_y=spin_rate.y,
            spin_z=spin_rate.z,
        )

    def _move(
        self, i: int, y: Doubles, a: Vector, spin: Vector, spin_rate: Vector, dy: Doubles
    ) -> float:
        """Write the rates of leg `i` to `dy`, and keep its transverse force.

        Returns:
            The power that this force creates [W].
        """
        at = self._first_leg + LEG * i
        p = spatial_model(self._body, 0)
        leg = leg_state(y, at)
        place = leg_place(self._places, i)
        model = leg_model(self._legs, i)
        loads = spatial_loads_of(self._loads, i)
        frame = foot_acceleration(loads, place, a, spin_rate)
        put(spatial_leg_rates(leg, leg_forces_of(self._forces, i), loads, frame, model.m_d), dy, at)
        if self._tripod:
            self._put_across_rates(i, y, frame, dy)
            return 0.0
        force = model.m_d * frame.z - loads.tangential
        self._transverse[i] = force
        if p.at_joint > 0.0:
            foot = Vector(loads.foot_x, loads.foot_y, loads.foot_z)
            arm = less(foot, joint_place(place, model, p))
            return force * transverse_part(place, cross(spin, arm))
        return 0.0

    def normalise(self, y: Doubles) -> None:
        """Bring the quaternion to length 1."""
        s = spatial_state(y, 0)
        size = length_of(s.q_w, s.q_x, s.q_y, s.q_z)
        for i in range(3, 7):
            y[i] /= size

    def project(self, y: Doubles) -> None:
        """Bring what the friction laws keep to where they let it be."""
        self._project_friction(y)
        self._project_points(y)
