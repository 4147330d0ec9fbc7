"""The planar body as a user sees it: its motion, and what is read of it."""

from __future__ import annotations

from collections.abc import Sequence
from math import fabs, sqrt

from ..access import (
    BALANCE,
    BODY,
    BODY_OUTPUTS,
    DISSIPATED,
    ENERGY_OUTPUTS,
    INPUTS,
    KINETIC,
    LEG,
    LEG_OUTPUTS,
    LEG_STATUS,
    STATUS_OUTPUTS,
    accounts,
    attitude_of,
    body_model,
    body_state,
    inputs,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    leg_status_of,
    planar_loads_of,
    put,
    status_outputs,
)
from ..leg import leg_status
from ..memory import Buffer, Doubles, Records, room
from ..records import (
    BodyModel,
    BodyOutputs,
    EnergyOutputs,
    HeldEnergy,
    LegModel,
    LegOutputs,
    LegPlace,
    LegStatus,
    Phase,
    StatusOutputs,
    Turn,
)
from .planar_legs import footpad_kinetic_energy, footpad_moment
from .planar_motion import PlanarMotion
from .planar_status import is_phase, is_slow, phase_of

# The energy balance may come to this part of what was dissipated, of which a step may use up a
# share of what is left; whatever is left, it may grow by so much more a second [1/s]
MOST_LOST, STEP_SHARE, LOST_RATE = 4e-5, 0.25, 2e-5
# of the energy at touchdown, so much counts as dissipated from the start on
LEAST_TURNED = 0.1
# what rounding does to it, in parts of the liquid's stiffness times its volume
ROUNDING = 4e-15


class Planar(PlanarMotion):
    """The planar body with its outputs: body, energies, status, then each leg group.

    The order is that of `rlv_landing.quantities`. Strut forces change sign here: the user's are
    negative in compression. Mirror images are made where the names are made.

    Attributes:
        energy_start: The mechanical energy at the start [J], against which the energy balance is
            drawn up.
        most_balance: The largest energy balance since then at a step's end [J].
        rounding: How far rounding may put the balance off [J].
        mass: The whole vehicle's [kg].
    """

    energy_start: float
    most_balance: float
    rounding: float
    mass: float
    _status: Records[LegStatus]

    def __init__(
        self,
        body: BodyModel,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        scale: Buffer,
        relative: Buffer,
    ) -> None:
        super().__init__(body, legs, places, scale, relative)
        self.energy_start = 0.0
        self.most_balance = 0.0
        self.rounding = 0.0
        self.mass = body.m_u
        for leg, place in zip(legs, places):
            self.mass += place.legs * leg.m_d
            self.rounding += ROUNDING * place.legs * leg.B0 * (leg.V10 + leg.V20)
        self._status = room(self.groups, LEG_STATUS)

    def read(self, y: Doubles, u: Doubles, dy: Doubles, out: Doubles, at: int) -> None:
        """Write all outputs to `out[at:]`, from what `rhs` has kept of the legs."""
        for i in range(self.groups):
            depth = planar_loads_of(self._loads, i).depth
            keep(
                leg_status(
                    leg_state(y, BODY + LEG * i),
                    leg_forces_of(self._forces, i),
                    depth,
                    leg_model(self._legs, i),
                ),
                self._status,
                i,
            )
        kinetic = self._kinetic_energy(y)
        self._put_body(y, dy, out, at)
        at += BODY_OUTPUTS
        self._put_energies(y, self._held(y, kinetic), out, at)
        at += ENERGY_OUTPUTS
        self._put_status(y, dy, kinetic, out, at)
        at += STATUS_OUTPUTS
        for i in range(self.groups):
            self._put_leg(i, out, at + LEG_OUTPUTS * i)

    def may_rest(self, u: Doubles, rates: Doubles, outputs: Doubles) -> bool:
        """Whether it stands and is slow, with loads and ground that do not change.

        Its acceleration does not count: an explicit method trembles.
        """
        phase = status_outputs(outputs, BODY_OUTPUTS + ENERGY_OUTPUTS).phase
        if is_phase(phase, Phase.FALLING) or is_phase(phase, Phase.TOPPLED):
            return False
        if not is_slow(outputs[BODY_OUTPUTS + KINETIC], self.mass):
            return False
        for i in range(INPUTS):
            if rates[i] != 0.0:
                return False
        now = inputs(u, 0)
        return now.heave_rate == 0.0 and now.tilt_rate == 0.0

    def rests(self, outputs: Doubles) -> bool:
        """Where it has settled."""
        return is_phase(status_outputs(outputs, BODY_OUTPUTS + ENERGY_OUTPUTS).phase, Phase.SETTLED)

    def distance(self, shift: Doubles) -> float:
        """The way of the body, turns of which count a metre a radian, or of a footpad."""
        body = body_state(shift, 0)
        way = max(fabs(body.x), fabs(body.y), fabs(body.pitch))
        for i in range(self.groups):
            leg = leg_state(shift, BODY + LEG * i)
            way = max(way, fabs(leg.r), fabs(leg.h))
        return way

    def note(self, outputs: Doubles) -> None:
        """Keep the largest energy balance."""
        self.most_balance = max(self.most_balance, fabs(outputs[BODY_OUTPUTS + BALANCE]))

    def lost(self, before: Doubles, after: Doubles, h: float) -> float:
        """The growth of the energy balance beyond rounding, in parts of what may be.

        Rounding comes and goes, and is allowed once: beyond the largest balance so far, all growth
        counts.
        """
        at = BODY_OUTPUTS + BALANCE
        was = fabs(before[at])
        most = max(was, self.rounding, self.most_balance)
        growth = fabs(after[at]) - min(most, was + self.rounding)
        if growth <= 0.0:
            return 0.0
        least = LEAST_TURNED * self.scale[BODY + LEG * self.groups]
        turned = max(least, before[BODY_OUTPUTS + DISSIPATED])
        left = max(MOST_LOST * turned + self.rounding - was, 0.0)
        return growth / (STEP_SHARE * left + LOST_RATE * h * turned)

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

    def _kinetic_energy(self, y: Doubles) -> float:
        """Kinetic energy [J] of body and footpads."""
        p = body_model(self._body, 0)
        body = body_state(y, 0)
        turn = attitude_of(self._attitude, 0)
        vx = body.vx * turn.cos_p - body.vy * turn.sin_p
        vy = body.vx * turn.sin_p + body.vy * turn.cos_p
        twice = (
            p.m_u * (body.vx * body.vx + body.vy * body.vy)
            + p.I_u * body.pitch_rate * body.pitch_rate
        )
        for i in range(self.groups):
            m_d = leg_model(self._legs, i).m_d
            twice += footpad_kinetic_energy(
                vx,
                vy,
                body.pitch_rate,
                leg_state(y, BODY + LEG * i),
                leg_place(self._places, i),
                m_d,
            )
        return 0.5 * twice

    def _held(self, y: Doubles, kinetic: float) -> HeldEnergy:
        """The mechanical energy, from the status that is kept of the legs."""
        p = body_model(self._body, 0)
        body = body_state(y, 0)
        stands = attitude_of(self._attitude, 0)
        turn = Turn(stands.sin_p, stands.cos_p, 0.0, 1.0)
        height = p.m_u * body.y
        liquid = auxiliary = contact = friction = stop = 0.0
        for i in range(self.groups):
            leg = leg_state(y, BODY + LEG * i)
            place = leg_place(self._places, i)
            s = leg_status_of(self._status, i)
            height += footpad_moment(body, leg, place, turn, leg_model(self._legs, i).m_d)
            liquid += place.legs * leg_forces_of(self._forces, i).held
            auxiliary += place.legs * s.auxiliary
            contact += place.legs * s.contact
            friction += place.legs * s.friction
            stop += place.legs * s.stop
        return HeldEnergy(kinetic, p.g * height, liquid, auxiliary, contact, friction, stop)

    def _put_energies(self, y: Doubles, held: HeldEnergy, out: Doubles, at: int) -> None:
        a = accounts(y, BODY + LEG * self.groups)
        motion = held.kinetic + held.potential
        stored = held.liquid + held.auxiliary + held.contact + held.friction + held.stop
        mechanical = motion + stored
        dissipated = a.orifice + a.seal + a.stop + a.auxiliary + a.contact + a.friction
        supplied = a.external + a.ground + a.transverse
        put(
            EnergyOutputs(
                kinetic=held.kinetic,
                potential=held.potential,
                liquid=held.liquid,
                auxiliary=held.auxiliary,
                contact=held.contact,
                friction=held.friction,
                stop=held.stop,
                dissipated_orifice=a.orifice,
                dissipated_seal=a.seal,
                dissipated_stop=a.stop,
                dissipated_auxiliary=a.auxiliary,
                dissipated_contact=a.contact,
                dissipated_friction=a.friction,
                work_external=a.external,
                work_ground=a.ground,
                work_transverse=a.transverse,
                dissipated=dissipated,
                balance=mechanical + dissipated - supplied - self.energy_start,
            ),
            out,
            at,
        )

    def _put_status(
        self, y: Doubles, rates: Doubles, kinetic: float, out: Doubles, at: int
    ) -> None:
        """Write the phase and the stability margin to `out[at:]`.

        The margin is the distance [m] from the whole vehicle's CG to the nearer of the outermost
        footpads, negative beyond.
        """
        body = body_state(y, 0)
        mass = body_model(self._body, 0).m_u
        moment = mass * body.x
        first = planar_loads_of(self._loads, 0)
        low = first.foot_x
        high = first.foot_x
        depth = first.depth
        for i in range(self.groups):
            loads = planar_loads_of(self._loads, i)
            footpads = leg_place(self._places, i).legs * leg_model(self._legs, i).m_d
            mass += footpads
            moment += footpads * loads.foot_x
            low = min(low, loads.foot_x)
            high = max(high, loads.foot_x)
            depth = max(depth, loads.depth)
        x = moment / mass
        margin = min(x - low, high - x)
        phase = phase_of(body, body_state(rates, 0), margin, depth, kinetic, mass)
        put(StatusOutputs(phase, margin), out, at)

    def _put_leg(self, i: int, out: Doubles, at: int) -> None:
        f = leg_forces_of(self._forces, i)
        loads = planar_loads_of(self._loads, i)
        s = leg_status_of(self._status, i)
        put(
            LegOutputs(
                main_strut_force=-f.main,
                main_strut_stroke=f.stroke,
                main_strut_stroke_rate=f.stroke_rate,
                main_strut_pressure_upper=s.pressure_upper,
                main_strut_pressure_lower=s.pressure_lower,
                main_strut_liquid_mass=f.liquid_mass,
                auxiliary_strut_force=-f.auxiliary,
                auxiliary_strut_stroke=f.auxiliary_stroke,
                auxiliary_strut_stroke_rate=f.auxiliary_rate,
                footpad_x=loads.foot_x,
                footpad_y=loads.foot_y,
                footpad_z=loads.foot_z,
                contact_force_x=loads.contact_x,
                contact_force_y=loads.contact_y,
                contact_force_z=loads.contact_z,
                contact_force=sqrt(
                    loads.contact_x * loads.contact_x
                    + loads.contact_y * loads.contact_y
                    + loads.contact_z * loads.contact_z
                ),
                contact_penetration=loads.depth,
                contact_active=1.0 if loads.depth > 0.0 else 0.0,
            ),
            out,
            at,
        )
