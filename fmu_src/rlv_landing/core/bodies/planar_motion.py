"""Motion of the planar body on its leg groups: the vehicle of a symmetric landing."""

from __future__ import annotations

from collections.abc import Sequence
from math import fabs

from ..access import (
    ACCOUNTS,
    ATTITUDE,
    BODY,
    BODY_OUTPUTS,
    ENERGY_OUTPUTS,
    FRICTION,
    INPUTS,
    LEG,
    LEG_FORCES,
    LEG_OUTPUTS,
    PLANAR_LOADS,
    STATUS_OUTPUTS,
    Z1,
    Z2,
    body_model,
    body_state,
    inputs,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    planar_loads_of,
    put,
)
from ..ground.kinds import friction_bound, friction_only_takes
from ..leg import leg_forces, liquid_excess, without_excess
from ..memory import Buffer, Doubles, Records, room, stored
from ..records import (
    Accounts,
    Attitude,
    BodyAcceleration,
    BodyModel,
    BodyState,
    Inputs,
    LegForces,
    LegModel,
    LegPlace,
    LegState,
    PlanarLoads,
    StiffPair,
    Turn,
)
from .planar_legs import (
    foot_motion,
    foot_point,
    frame_acceleration,
    leg_rates,
    planar_loads,
    transverse_height,
    turned,
)
from .system import System

# Of a main strut's liquid, in parts: the excess that is left where it is; what is left of a larger
# one, next to as much, so that outputs do not jump where it becomes larger; the excess that a step
# may gather at most, and the change that a step's error in one of the law's states may stand for
CONSERVED, LEFT_OVER = 8e-7, 7.99e-7
MOST_GATHERED, MOST_FOR_AN_ERROR = 1e-5, 1e-4


class PlanarMotion(System):
    """One body in its symmetric plane on leg groups, and its ground.

    The state is a `BodyState`, a `LegState` for each group, and the `Accounts`, which no other
    state depends on. What is dissipated never falls, unless a friction law may give.
    """

    groups: int
    _body: Records[BodyModel]
    _places: Records[LegPlace]
    _legs: Records[LegModel]
    _forces: Records[LegForces]
    _loads: Records[PlanarLoads]
    _attitude: Records[Attitude]

    def __init__(
        self,
        body: BodyModel,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        scale: Buffer,
        relative: Buffer,
    ) -> None:
        groups = len(legs)
        row = BODY_OUTPUTS + ENERGY_OUTPUTS + STATUS_OUTPUTS + LEG_OUTPUTS * groups
        super().__init__(scale, relative, ACCOUNTS, INPUTS, row, groups)
        self.groups = groups
        self._body = stored([body])
        self._places = stored(places)
        self._legs = stored(legs)
        self._forces = room(groups, LEG_FORCES)
        self._loads = room(groups, PLANAR_LOADS)
        self._attitude = room(1, ATTITUDE)
        self.rising = FRICTION + 1
        for i in range(groups):
            if not friction_only_takes(leg_model(self._legs, i)):
                self.rising = FRICTION

    def inputs_after(self, u: Doubles, rates: Doubles, dt: float, now: Doubles) -> None:
        """Loads go on at their rates, heave and tilt at their own, which change at theirs.

        Rates of heave and tilt in `rates` are those of a motion to a new position; they add to the
        ground's own.
        """
        a = inputs(u, 0)
        rate = inputs(rates, 0)
        put(
            Inputs(
                force_x=a.force_x + rate.force_x * dt,
                force_y=a.force_y + rate.force_y * dt,
                moment=a.moment + rate.moment * dt,
                heave=a.heave + (a.heave_rate + rate.heave + 0.5 * rate.heave_rate * dt) * dt,
                heave_rate=a.heave_rate + rate.heave + rate.heave_rate * dt,
                tilt=a.tilt + (a.tilt_rate + rate.tilt + 0.5 * rate.tilt_rate * dt) * dt,
                tilt_rate=a.tilt_rate + rate.tilt + rate.tilt_rate * dt,
            ),
            now,
            0,
        )

    def rhs(self, y: Doubles, u: Doubles, dy: Doubles) -> None:
        """Write dy/dt at the state `y` and the inputs `u` to `dy`.

        It keeps the legs' forces and loads and the body's attitude on the way.
        """
        p = body_model(self._body, 0)
        body = body_state(y, 0)
        now = inputs(u, 0)
        turn = turned(body.pitch, p.alpha + now.tilt)
        for i in range(self.groups):
            self._load(i, y, body, now, turn)
        a = self._acceleration(y, body, now, turn)
        keep(Attitude(turn.sin_p, turn.cos_p, a.y), self._attitude, 0)
        put(
            BodyState(
                x=body.vx,
                y=body.vy,
                pitch=body.pitch_rate,
                vx=a.x * turn.cos_p + a.y * turn.sin_p,
                vy=a.y * turn.cos_p - a.x * turn.sin_p,
                pitch_rate=a.pitch,
            ),
            dy,
            0,
        )
        transverse = 0.0
        for i in range(self.groups):
            transverse += self._move(i, y, body.pitch_rate, a, dy)
        external = now.force_x * body.vx + now.force_y * body.vy + now.moment * body.pitch_rate
        self._put_powers(external, transverse, dy)

    def _load(self, i: int, y: Doubles, body: BodyState, u: Inputs, turn: Turn) -> None:
        """Keep the forces and loads of leg group `i`."""
        leg = leg_state(y, BODY + LEG * i)
        place = leg_place(self._places, i)
        model = leg_model(self._legs, i)
        point = foot_point(body, leg, place, u, turn)
        foot = foot_motion(point, u, turn)
        keep(leg_forces(leg, foot, model), self._forces, i)
        weight = model.m_d * body_model(self._body, 0).g
        keep(
            planar_loads(leg_forces_of(self._forces, i), point, foot.depth, place, turn, weight),
            self._loads,
            i,
        )

    def _acceleration(self, y: Doubles, body: BodyState, u: Inputs, turn: Turn) -> BodyAcceleration:
        """The body's acceleration under the legs' loads.

        Two coupled equations for a_x and the pitch acceleration, because the transverse force that
        keeps each footpad in its plane contains both; a_y stands alone. Clockwise pitch and moments
        are positive.
        """
        p = body_model(self._body, 0)
        rate = body.pitch_rate
        fy = u.force_y - p.m_u * p.g
        force_x = u.force_x * turn.cos_p - fy * turn.sin_p
        force_y = u.force_x * turn.sin_p + fy * turn.cos_p
        moment = u.moment
        m11 = p.m_u
        m12 = 0.0
        m21 = 0.0
        m22 = p.I_u
        for i in range(self.groups):
            leg = leg_state(y, BODY + LEG * i)
            place = leg_place(self._places, i)
            model = leg_model(self._legs, i)
            loads = planar_loads_of(self._loads, i)
            n = place.legs
            s = place.sin_g
            yn = transverse_height(leg.h, p, model)
            mass = n * model.m_d * s * s
            m11 += mass
            m12 += mass * leg.h
            m21 += mass * yn
            m22 += mass * yn * leg.h
            bias = (
                n
                * s
                * (
                    loads.tangential
                    + model.m_d * s * (2.0 * rate * leg.vh - rate * rate * leg.r * place.cos_g)
                )
            )
            force_x += n * loads.body_x - bias
            force_y += n * loads.body_y
            moment += n * loads.moment - bias * yn
        determinant = m11 * m22 - m12 * m21
        return BodyAcceleration(
            (force_x * m22 - moment * m12) / determinant,
            force_y / p.m_u,
            (m11 * moment - m21 * force_x) / determinant,
        )

    def _move(self, i: int, y: Doubles, rate: float, a: BodyAcceleration, dy: Doubles) -> float:
        """Write the rates of leg group `i` to `dy`.

        Returns:
            The power that its transverse forces create [W].
        """
        leg = leg_state(y, BODY + LEG * i)
        place = leg_place(self._places, i)
        model = leg_model(self._legs, i)
        loads = planar_loads_of(self._loads, i)
        frame = frame_acceleration(leg, place, rate, a)
        put(
            leg_rates(leg, leg_forces_of(self._forces, i), loads, place, frame, model.m_d),
            dy,
            BODY + LEG * i,
        )
        force = -model.m_d * place.sin_g * frame.x - loads.tangential
        arm = leg.h - transverse_height(leg.h, body_model(self._body, 0), model)
        return place.legs * (-force * place.sin_g * rate * arm)

    def _put_powers(self, external: float, transverse: float, dy: Doubles) -> None:
        """Write the powers that the accounts gather to `dy` [W].

        Args:
            external: Power of the external loads [W].
            transverse: Power that the transverse forces create [W].
            dy: The state's rate.
        """
        orifice = seal = stop = auxiliary = contact = friction = ground = 0.0
        for i in range(self.groups):
            n = leg_place(self._places, i).legs
            forces = leg_forces_of(self._forces, i)
            orifice += n * forces.orifice
            seal += n * forces.seal
            stop += n * forces.stop
            auxiliary += n * forces.auxiliary_dissipated
            contact += n * forces.contact
            friction += n * forces.friction
            ground += n * planar_loads_of(self._loads, i).ground
        put(
            Accounts(
                orifice, seal, stop, auxiliary, contact, friction, external, ground, transverse
            ),
            dy,
            BODY + LEG * self.groups,
        )

    def stiff(self, k: int) -> StiffPair:
        """The states of leg group `k`'s main strut law."""
        forces = leg_forces_of(self._forces, k)
        at = BODY + LEG * k
        return StiffPair(at + Z1, at + Z2, forces.a1, forces.a2)

    def project(self, y: Doubles) -> None:
        """Bring what the friction laws keep to where they let it be."""
        for i in range(self.groups):
            leg = leg_state(y, BODY + LEG * i)
            q = friction_bound(leg.q1, leg.q2, leg_model(self._legs, i))
            put(
                LegState(leg.r, leg.h, leg.vr, leg.vh, leg.z1, leg.z2, q.q1, q.q2),
                y,
                BODY + LEG * i,
            )

    def weigh(self, ceiling: Doubles) -> None:
        """Write the ceiling of the error of each main strut law's state to `ceiling`.

        The error counts by what it changes of the liquid's mass, where that is more than by its
        size.
        """
        for i in range(self.groups):
            forces = leg_forces_of(self._forces, i)
            at = BODY + LEG * i
            most = MOST_FOR_AN_ERROR * forces.liquid_mass
            if most > 0.0:
                ceiling[at + Z1] = most / forces.mass_1
                ceiling[at + Z2] = most / forces.mass_2

    def conserve(self, y: Doubles) -> float:
        """Take off what the main struts have gathered of liquid."""
        farthest = 0.0
        for i in range(self.groups):
            forces = leg_forces_of(self._forces, i)
            model = leg_model(self._legs, i)
            excess = fabs(liquid_excess(forces, model))
            if excess > CONSERVED:
                leg = leg_state(y, BODY + LEG * i)
                put(without_excess(leg, forces, model, LEFT_OVER), y, BODY + LEG * i)
                farthest = max(farthest, excess)
        return farthest / MOST_GATHERED
