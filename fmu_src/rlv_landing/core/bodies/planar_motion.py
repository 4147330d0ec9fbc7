"""Motion of the planar body on its leg groups: the vehicle of a symmetric landing."""

from __future__ import annotations

from collections.abc import Sequence

from ..access import (
    ACCELERATIONS,
    ATTITUDE,
    BALANCE,
    BODY,
    BODY_ACCELERATION,
    BODY_OUTPUTS,
    ENERGY_OUTPUTS,
    INPUTS,
    LEG,
    LEG_OUTPUTS,
    PLANAR_LOADS,
    STATUS_OUTPUTS,
    TURN,
    body_acceleration_of,
    body_model,
    body_state,
    foot_loads_of,
    foot_motion_of,
    inputs,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    planar_loads_of,
    put,
    turn_of,
)
from ..leg import leg_forces
from ..memory import Buffer, Doubles, Records, room, stored
from ..records import (
    Attitude,
    BodyAcceleration,
    BodyModel,
    BodyState,
    Inputs,
    LegModel,
    LegPlace,
    PlanarLoads,
    Turn,
)
from .legged import Legged
from .planar_legs import (
    foot_loads,
    foot_motion,
    foot_point,
    frame_acceleration,
    leg_rates,
    planar_loads,
    transverse_height,
    turned,
)


class PlanarMotion(Legged):
    """One body in its symmetric plane on leg groups, and its ground: its state is a `BodyState`."""

    _body: Records[BodyModel]
    _loads: Records[PlanarLoads]
    _attitude: Records[Attitude]
    _turn: Records[Turn]
    _acceleration: Records[BodyAcceleration]

    def __init__(
        self,
        body: BodyModel,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        scale: Buffer,
        relative: Buffer,
    ) -> None:
        row = BODY_OUTPUTS + ENERGY_OUTPUTS + STATUS_OUTPUTS + LEG_OUTPUTS * len(legs)
        super().__init__(legs, places, (scale, relative), INPUTS, row, 0)
        self.mass += body.m_u
        self._energies = BODY_OUTPUTS
        self.unsought = self._energies + BALANCE
        self._accelerations = ACCELERATIONS
        self._axes = 3
        self._body = stored([body])
        self._loads = room(len(legs), PLANAR_LOADS)
        self._attitude = room(1, ATTITUDE)
        self._turn = room(1, TURN)
        self._acceleration = room(1, BODY_ACCELERATION)

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
        keep(turned(body.pitch, p.alpha + now.tilt), self._turn, 0)
        turn = turn_of(self._turn, 0)
        for i in range(self.groups):
            self._load(i, y, body, now, turn)
        keep(self._accelerated(y, body, now, turn), self._acceleration, 0)
        a = body_acceleration_of(self._acceleration, 0)
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
        keep(foot_motion(point, u, turn), self._motions, i)
        foot = foot_motion_of(self._motions, i)
        keep(leg_forces(leg, foot, model), self._forces, i)
        forces = leg_forces_of(self._forces, i)
        keep(foot_loads(forces, point, foot.depth, turn), self._feet, i)
        weight = model.m_d * body_model(self._body, 0).g
        keep(
            planar_loads(forces, foot_loads_of(self._feet, i), place, turn, weight), self._loads, i
        )

    def _accelerated(self, y: Doubles, body: BodyState, u: Inputs, turn: Turn) -> BodyAcceleration:
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
