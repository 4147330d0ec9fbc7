"""The planar body as a user sees it: its motion, and what is read of it."""

from __future__ import annotations

from math import fabs

from ..access import (
    BODY,
    BODY_OUTPUTS,
    ENERGY_OUTPUTS,
    LEG,
    LEG_OUTPUTS,
    STATUS_OUTPUTS,
    attitude_of,
    body_model,
    body_state,
    foot_loads_of,
    inputs,
    leg_model,
    leg_place,
    leg_state,
    put,
)
from ..memory import Doubles
from ..records import BodyOutputs, StatusOutputs
from .planar_legs import footpad_kinetic_energy, footpad_moment
from .planar_motion import PlanarMotion
from .status import phase_of

# [rad]
TURNED_OVER = 1.5707963267948966


class Planar(PlanarMotion):
    """The planar body with its outputs: body, energies, status, then each leg group.

    The order is that of `rlv_landing.quantities`.
    """

    def read(self, y: Doubles, u: Doubles, dy: Doubles, out: Doubles, at: int) -> None:
        """Write all outputs to `out[at:]`, from what `rhs` has kept of the legs."""
        self._keep_status(y)
        body = body_state(y, 0)
        kinetic = self._kinetic_energy(y, body.vx, body.vy, body.pitch_rate)
        self._put_body(y, dy, out, at)
        at += BODY_OUTPUTS
        self._put_energies(y, kinetic, self._potential_energy(y), out, at)
        at += ENERGY_OUTPUTS
        self._put_status(y, out, at)
        at += STATUS_OUTPUTS
        for i in range(self.groups):
            self._put_leg(i, y, out, at + LEG_OUTPUTS * i)

    def _ground_is_still(self, u: Doubles) -> bool:
        now = inputs(u, 0)
        return now.heave_rate == 0.0 and now.tilt_rate == 0.0

    def distance(self, shift: Doubles) -> float:
        """The way of the body, turns of which count a metre a radian, or of a footpad."""
        body = body_state(shift, 0)
        way = max(fabs(body.x), fabs(body.y), fabs(body.pitch))
        for i in range(self.groups):
            leg = leg_state(shift, BODY + LEG * i)
            way = max(way, fabs(leg.r), fabs(leg.h))
        return way

    def _put_body(self, y: Doubles, rates: Doubles, out: Doubles, at: int) -> None:
        s = body_state(y, 0)
        r = body_state(rates, 0)
        along = attitude_of(self._attitude, 0).along
        top = along - s.pitch_rate * s.pitch_rate * body_model(self._body, 0).H
        put(
            BodyOutputs(s.x, s.y, s.pitch, s.vx, s.vy, s.pitch_rate, r.vx, r.vy, r.pitch_rate, top),
            out,
            at,
        )

    def follow_ground(self, t: float, y: Doubles, dy: Doubles, u: Doubles, rates: Doubles) -> None:
        """Keep the motion relative to the ground, which moves as a rigid body.

        Of the acceleration, what the ground's has at the CG is taken off.
        """
        now = inputs(u, 0)
        change = inputs(rates, 0)
        self.ground_moves = (
            now.heave_rate != 0.0
            or now.tilt_rate != 0.0
            or change.heave_rate != 0.0
            or change.tilt_rate != 0.0
        )
        if not self.ground_moves:
            return
        s = body_state(y, 0)
        r = body_state(dy, 0)
        w = now.tilt_rate
        height = s.y - now.heave
        vx = s.vx - w * height
        vy = s.vy - now.heave_rate + w * s.x
        self.relative_kinetic = self._kinetic_energy(y, vx, vy, s.pitch_rate - w)
        ax = change.tilt_rate * height - w * w * s.x
        ay = change.heave_rate - change.tilt_rate * s.x - w * w * height
        self.relative_acceleration = (
            fabs(r.vx - ax) + fabs(r.vy - ay) + fabs(r.pitch_rate - change.tilt_rate)
        )

    def _kinetic_energy(self, y: Doubles, x: float, h: float, rate: float) -> float:
        """Kinetic energy [J] of body and footpads.

        The CG's velocity is `x`, `h` [m/s], inertial axes, the pitch rate `rate` [rad/s].
        """
        p = body_model(self._body, 0)
        turn = attitude_of(self._attitude, 0)
        vx = x * turn.cos_p - h * turn.sin_p
        vy = x * turn.sin_p + h * turn.cos_p
        twice = p.m_u * (x * x + h * h) + p.I_u * rate * rate
        for i in range(self.groups):
            m_d = leg_model(self._legs, i).m_d
            twice += footpad_kinetic_energy(
                vx,
                vy,
                rate,
                leg_state(y, BODY + LEG * i),
                leg_place(self._places, i),
                m_d,
            )
        return 0.5 * twice

    def _potential_energy(self, y: Doubles) -> float:
        """Potential energy [J] of body and footpads above the inertial origin."""
        p = body_model(self._body, 0)
        body = body_state(y, 0)
        stands = attitude_of(self._attitude, 0)
        height = p.m_u * body.y
        for i in range(self.groups):
            leg = leg_state(y, BODY + LEG * i)
            m_d = leg_model(self._legs, i).m_d
            height += footpad_moment(body, leg, leg_place(self._places, i), stands, m_d)
        return p.g * height

    def _put_status(self, y: Doubles, out: Doubles, at: int) -> None:
        """Write the phase, which is not yet told to be settled, and the stability margin.

        The margin is the distance [m] from the whole vehicle's CG to the nearer of the outermost
        footpads, negative beyond.
        """
        body = body_state(y, 0)
        mass = body_model(self._body, 0).m_u
        moment = mass * body.x
        first = foot_loads_of(self._feet, 0)
        low = first.x
        high = first.x
        depth = first.depth
        for i in range(self.groups):
            foot = foot_loads_of(self._feet, i)
            footpads = leg_place(self._places, i).legs * leg_model(self._legs, i).m_d
            mass += footpads
            moment += footpads * foot.x
            low = min(low, foot.x)
            high = max(high, foot.x)
            depth = max(depth, foot.depth)
        x = moment / mass
        margin = min(x - low, high - x)
        phase = phase_of(margin, TURNED_OVER - fabs(body.pitch), depth)
        put(StatusOutputs(phase, margin), out, at)
