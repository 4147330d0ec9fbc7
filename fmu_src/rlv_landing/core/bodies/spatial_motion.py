"""Motion of the spatial body on its legs: six degrees of freedom, any attitude (derived)."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from ..access import (
    ENERGY_OUTPUTS,
    LEG,
    LEG_LOAD_OUTPUTS,
    LEG_OUTPUTS,
    SPATIAL_ATTITUDE,
    SPATIAL_INPUTS,
    SPATIAL_LOADS,
    SPATIAL_OUTPUTS,
    STATUS_OUTPUTS,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    put,
    spatial_inputs,
    spatial_loads_of,
    spatial_model,
    spatial_state,
)
from ..leg import leg_forces
from ..linear import solve
from ..memory import Buffer, Doubles, Records, data, room, stored
from ..records import (
    Deck,
    FootLoads,
    LegModel,
    LegPlace,
    Rotation,
    SpatialAttitude,
    SpatialLoads,
    SpatialModel,
    SpatialState,
    Vector,
)
from ..vectors import added, cross, dot, length_of, less, rotation, scaled, to_body, to_inertial
from .deck import deck_of, deck_velocity, motion_on_deck
from .legged import Legged
from .spatial_legs import (
    across,
    acts_at,
    foot_acceleration,
    foot_bias,
    foot_place,
    force_on_body,
    moment_on_body,
    spatial_leg_rates,
    spatial_loads,
)

# accelerations of the CG and of the spin
DEGREES = 6


class SpatialMotion(Legged):
    """One body in space on legs, and its ground: its state is a `SpatialState`.

    Each leg is a group of its own. The body's and the footpads' accelerations are found together,
    since the force that keeps each footpad in its leg's plane contains both.
    """

    _body: Records[SpatialModel]
    _loads: Records[SpatialLoads]
    _attitude: Records[SpatialAttitude]
    _matrix: Buffer
    _right: Buffer
    _transverse: Buffer

    def __init__(
        self,
        body: SpatialModel,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        scale: Buffer,
        relative: Buffer,
    ) -> None:
        leg_row = LEG_OUTPUTS + LEG_LOAD_OUTPUTS
        row = SPATIAL_OUTPUTS + ENERGY_OUTPUTS + STATUS_OUTPUTS + leg_row * len(legs)
        super().__init__(legs, places, scale, relative, SPATIAL_INPUTS, row)
        self.mass += body.m_u
        self._energies = SPATIAL_OUTPUTS
        self._body = stored([body])
        self._loads = room(len(legs), SPATIAL_LOADS)
        self._attitude = room(1, SPATIAL_ATTITUDE)
        self._matrix = array("d", bytes(8 * DEGREES * DEGREES))
        self._right = array("d", bytes(8 * DEGREES))
        # the force that keeps each footpad in its leg's plane, along t [N]
        self._transverse = array("d", bytes(8 * len(legs)))

    def inputs_after(self, u: Doubles, rates: Doubles, dt: float, now: Doubles) -> None:
        """Loads go on at their rates, the deck at its own, which change at theirs.

        Rates of the deck's position in `rates` are those of a motion to a new one; they add to the
        deck's own.
        """
        first_of_deck = DEGREES
        for i in range(DEGREES):
            now[i] = u[i] + rates[i] * dt
        for k in range(DEGREES):
            i = first_of_deck + 2 * k
            speed = u[i + 1] + rates[i]
            now[i] = u[i] + (speed + 0.5 * rates[i + 1] * dt) * dt
            now[i + 1] = speed + rates[i + 1] * dt

    def rhs(self, y: Doubles, u: Doubles, dy: Doubles) -> None:
        """Write dy/dt at the state `y` and the inputs `u` to `dy`.

        It keeps the legs' forces and loads and the body's acceleration on the way.
        """
        p = spatial_model(self._body, 0)
        s = spatial_state(y, 0)
        now = spatial_inputs(u, 0)
        turn = rotation(s.q_w, s.q_x, s.q_y, s.q_z)
        spin = Vector(s.spin_x, s.spin_y, s.spin_z)
        deck = deck_of(now, p)
        for i in range(self.groups):
            self._load(i, y, s, turn, deck)
        force = to_body(turn, Vector(now.force_x, now.force_y - p.m_u * p.g, now.force_z))
        moment = to_body(turn, Vector(now.moment_x, now.moment_y, now.moment_z))
        self._accelerate(spin, force, moment)
        right = data(self._right)
        a = Vector(right[0], right[1], right[2])
        spin_rate = Vector(right[3], right[4], right[5])
        keep(
            SpatialAttitude(a.x, a.y, a.z, spin_rate.x, spin_rate.y, spin_rate.z),
            self._attitude,
            0,
        )
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
        turned = to_inertial(turn, spin)
        external = (
            now.force_x * s.vx
            + now.force_y * s.vy
            + now.force_z * s.vz
            + now.moment_x * turned.x
            + now.moment_y * turned.y
            + now.moment_z * turned.z
        )
        self._put_powers(external, transverse, dy)

    def _load(self, i: int, y: Doubles, s: SpatialState, turn: Rotation, deck: Deck) -> None:
        """Keep the forces and loads of leg `i`."""
        p = spatial_model(self._body, 0)
        leg = leg_state(y, self._first_leg + LEG * i)
        place = leg_place(self._places, i)
        model = leg_model(self._legs, i)
        spin = Vector(s.spin_x, s.spin_y, s.spin_z)
        foot = foot_place(leg, place, p)
        point = added(Vector(s.x, s.y, s.z), to_inertial(turn, foot.from_cg))
        moved = to_inertial(turn, added(cross(spin, foot.from_cg), foot.rate))
        ground = deck_velocity(deck, point)
        velocity = less(added(Vector(s.vx, s.vy, s.vz), moved), ground)
        motion = motion_on_deck(deck, point, velocity)
        keep(leg_forces(leg, motion, model), self._forces, i)
        forces = leg_forces_of(self._forces, i)
        along = added(scaled(deck.down, forces.f1), scaled(deck.along, forces.f2))
        contact = added(along, scaled(deck.normal, forces.normal))
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
        weight = model.m_d * p.g
        force = to_body(turn, Vector(contact.x, contact.y - weight, contact.z))
        at = acts_at(foot.from_cg, place, model, p)
        keep(
            spatial_loads(force, foot_bias(foot, spin), foot.from_cg, at, forces, place),
            self._loads,
            i,
        )

    def _accelerate(self, spin: Vector, force: Vector, moment: Vector) -> None:
        """Write the accelerations of the CG and of the spin to `_right`, body axes.

        With e_t across each leg's plane, c = rho x e_t and d = p_N x e_t, where p_N is the point at
        which its transverse force N = m e_t.(a + w' x rho + b) - F.e_t acts on the body:
        (m_u 1 + sum m e_t e_t^T) a + sum m e_t c^T w' = f - sum e_t (m e_t.b - F.e_t) and
        sum m d e_t^T a + (I + sum m d c^T) w' = t - w x I w - sum d (m e_t.b - F.e_t).

        Args:
            spin: The body's angular velocity [rad/s].
            force: All forces on the body but the legs' [N].
            moment: Their moment about the CG [N m].
        """
        p = spatial_model(self._body, 0)
        m, right = data(self._matrix), data(self._right)
        for k in range(DEGREES * DEGREES):
            m[k] = 0.0
        m[0] = m[7] = m[14] = p.m_u
        m[21] = p.I_x
        m[28] = p.I_y
        m[35] = p.I_z
        m[22] = m[27] = p.I_xy
        m[23] = m[33] = p.I_xz
        m[29] = m[34] = p.I_yz
        turning = Vector(
            p.I_x * spin.x + p.I_xy * spin.y + p.I_xz * spin.z,
            p.I_xy * spin.x + p.I_y * spin.y + p.I_yz * spin.z,
            p.I_xz * spin.x + p.I_yz * spin.y + p.I_z * spin.z,
        )
        moment = less(moment, cross(spin, turning))
        for i in range(self.groups):
            place = leg_place(self._places, i)
            loads = spatial_loads_of(self._loads, i)
            forces = leg_forces_of(self._forces, i)
            m_d = leg_model(self._legs, i).m_d
            e = across(place)
            c = cross(Vector(loads.foot_x, loads.foot_y, loads.foot_z), e)
            d = cross(Vector(loads.at_x, loads.at_y, loads.at_z), e)
            bias = m_d * dot(e, Vector(loads.bias_x, loads.bias_y, loads.bias_z))
            bias -= loads.tangential
            on_body = force_on_body(forces, place)
            force = less(added(force, on_body), scaled(e, bias))
            moment = added(moment, moment_on_body(forces, on_body, place, p))
            moment = less(moment, scaled(d, bias))
            self._add_row(0, m_d * e.x, e, c)
            self._add_row(2, m_d * e.z, e, c)
            self._add_row(3, m_d * d.x, e, c)
            self._add_row(4, m_d * d.y, e, c)
            self._add_row(5, m_d * d.z, e, c)
        right[0] = force.x
        right[1] = force.y
        right[2] = force.z
        right[3] = moment.x
        right[4] = moment.y
        right[5] = moment.z
        solve(m, right, DEGREES)

    def _add_row(self, k: int, part: float, e: Vector, c: Vector) -> None:
        """Add a `part` of (e, c) to row `k` of the matrix; e has no y."""
        m = data(self._matrix)
        at = DEGREES * k
        m[at] += part * e.x
        m[at + 2] += part * e.z
        m[at + 3] += part * c.x
        m[at + 4] += part * c.y
        m[at + 5] += part * c.z

    def _move(
        self, i: int, y: Doubles, a: Vector, spin: Vector, spin_rate: Vector, dy: Doubles
    ) -> float:
        """Write the rates of leg `i` to `dy`, and keep its transverse force.

        Returns:
            The power that this force creates [W].
        """
        at = self._first_leg + LEG * i
        leg = leg_state(y, at)
        place = leg_place(self._places, i)
        m_d = leg_model(self._legs, i).m_d
        loads = spatial_loads_of(self._loads, i)
        frame = foot_acceleration(loads, a, spin_rate)
        put(
            spatial_leg_rates(leg, leg_forces_of(self._forces, i), loads, place, frame, m_d), dy, at
        )
        e = across(place)
        force = m_d * dot(e, frame) - loads.tangential
        arm = Vector(
            loads.foot_x - loads.at_x, loads.foot_y - loads.at_y, loads.foot_z - loads.at_z
        )
        self._transverse[i] = force
        return force * dot(e, cross(spin, arm))

    def project(self, y: Doubles) -> None:
        """Bring what the friction laws keep to where they let it be, the quaternion to length 1."""
        self._project_friction(y)
        s = spatial_state(y, 0)
        size = length_of(s.q_w, s.q_x, s.q_y, s.q_z)
        for i in range(3, 7):
            y[i] /= size
