"""A body on legs: what does not depend on how it moves."""

from __future__ import annotations

from collections.abc import Sequence
from math import fabs, sqrt

from ..access import (
    ACCOUNTS,
    BALANCE,
    DISSIPATED,
    ENERGY_OUTPUTS,
    FOOT_LOADS,
    FOOT_MOTION,
    FRICTION,
    KINETIC,
    LEG,
    LEG_FORCES,
    LEG_STATUS,
    Z1,
    Z2,
    accounts,
    foot_loads_of,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    leg_status_of,
    put,
    status_outputs,
)
from ..ground.kinds import friction_bound, friction_only_takes
from ..leg import leg_status, liquid_excess, without_excess
from ..memory import Buffer, Doubles, Records, room, stored
from ..records import (
    Accounts,
    EnergyOutputs,
    FootLoads,
    FootMotion,
    LegForces,
    LegModel,
    LegOutputs,
    LegPlace,
    LegState,
    LegStatus,
    Phase,
    StatusOutputs,
    StiffPair,
)
from .status import is_phase, is_slow, is_still, phase_at_rest
from .system import System

# Of a main strut's liquid, in parts: the excess that is left where it is; what is left of a larger
# one, next to as much, so that outputs do not jump where it becomes larger; the excess that a step
# may gather at most, and the change that a step's error in one of the law's states may stand for
CONSERVED, LEFT_OVER = 8e-7, 7.99e-7
MOST_GATHERED, MOST_FOR_AN_ERROR = 1e-5, 1e-4
# The energy balance may come to this part of what was dissipated, of which a step may use up a
# share of what is left; beyond, it may grow by so much more a second [1/s], and by the less the
# nearer it comes to a farther part, by a least part of that
MOST_LOST, STEP_SHARE, LOST_RATE = 4e-5, 0.25, 2e-5
FARTHEST_LOST, LEAST_SPARE = 9e-5, 0.01
# of the energy at touchdown, so much counts as dissipated from the start on
LEAST_TURNED = 0.1
# what rounding does to it, in parts of the liquid's stiffness times its volume
ROUNDING = 4e-15


class Legged(System):
    """A body on legs, or on groups of legs that are mirror images, and its ground.

    The state is the body's, a `LegState` for each group, the `Accounts`, and the work of each
    group's main strut; no other state depends on accounts and works. What is dissipated never
    falls, unless a friction law may give. A subclass moves the body, adds its mass, says where the
    outputs have the energies, and keeps each group's forces and footpad.

    Attributes:
        groups: How many leg groups there are.
        energy_start: The mechanical energy at the start [J], against which the energy balance is
            drawn up.
        most_balance: The largest energy balance since then at a step's end [J].
        rounding: How far rounding may put the balance off [J].
        mass: The whole vehicle's [kg].
        more_contact, more_friction: What contacts of the body itself hold as the legs' do [J].
        ground_moves: Whether the ground moved at the end of the last step.
        relative_kinetic: If so, the kinetic energy of the motion relative to it there [J].
        relative_acceleration: And the sum of the body's accelerations less the ground's
            [m/s2, rad/s2].
        more_auxiliary: What the legs' second auxiliary struts hold, where they have two [J].
    """

    groups: int
    energy_start: float
    most_balance: float
    rounding: float
    mass: float
    more_contact: float
    more_friction: float
    more_auxiliary: float
    ground_moves: bool
    relative_kinetic: float
    relative_acceleration: float
    _first_leg: int  # its place in the state
    _works: int  # their place in the state
    _energies: int  # their place in the outputs, behind the body's
    _accelerations: int  # the body's place in the outputs
    _axes: int  # how many they are
    _places: Records[LegPlace]
    _legs: Records[LegModel]
    _motions: Records[FootMotion]
    _forces: Records[LegForces]
    _feet: Records[FootLoads]
    _status: Records[LegStatus]

    def __init__(
        self,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        sizes: tuple[Buffer, Buffer],
        inputs: int,
        row: int,
        behind: int,
    ) -> None:
        groups = len(legs)
        scale, relative = sizes
        super().__init__(scale, relative, ACCOUNTS + groups, inputs, row, groups)
        self.groups = groups
        self.energy_start = 0.0
        self.most_balance = 0.0
        self.rounding = 0.0
        self.mass = 0.0
        self.more_contact = 0.0
        self.more_friction = 0.0
        self.more_auxiliary = 0.0
        self.ground_moves = False
        self.relative_kinetic = 0.0
        self.relative_acceleration = 0.0
        # so many states of others stand behind the legs'
        self._first_leg = self.controlled - LEG * groups - behind
        self._works = self.controlled + ACCOUNTS
        self._energies = 0
        self._accelerations = 0
        self._axes = 0
        self._places = stored(places)
        self._legs = stored(legs)
        self._motions = room(groups, FOOT_MOTION)
        self._forces = room(groups, LEG_FORCES)
        self._feet = room(groups, FOOT_LOADS)
        self._status = room(groups, LEG_STATUS)
        self.rising = FRICTION + 1
        for leg, place in zip(legs, places):
            self.mass += place.legs * leg.m_d
            self.rounding += ROUNDING * place.legs * leg.B0 * (leg.V10 + leg.V20)
        for i in range(groups):
            if not friction_only_takes(leg_model(self._legs, i)):
                self.rising = FRICTION

    def stiff(self, k: int) -> StiffPair:
        """The states of leg group `k`'s main strut law."""
        forces = leg_forces_of(self._forces, k)
        at = self._first_leg + LEG * k
        return StiffPair(at + Z1, at + Z2, forces.a1, forces.a2)

    def project(self, y: Doubles) -> None:
        """Bring what the friction laws keep to where they let it be."""
        self._project_friction(y)

    def _project_friction(self, y: Doubles) -> None:
        for i in range(self.groups):
            at = self._first_leg + LEG * i
            leg = leg_state(y, at)
            q = friction_bound(leg.q1, leg.q2, leg_model(self._legs, i))
            put(LegState(leg.r, leg.h, leg.vr, leg.vh, leg.z1, leg.z2, q.q1, q.q2), y, at)

    def weigh(self, ceiling: Doubles) -> None:
        """Write the ceiling of the error of each main strut law's state to `ceiling`.

        The error counts by what it changes of the liquid's mass, where that is more than by its
        size.
        """
        for i in range(self.groups):
            forces = leg_forces_of(self._forces, i)
            at = self._first_leg + LEG * i
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
                at = self._first_leg + LEG * i
                put(without_excess(leg_state(y, at), forces, model, LEFT_OVER), y, at)
                farthest = max(farthest, excess)
        return farthest / MOST_GATHERED

    def is_slow(self, outputs: Doubles, most: float) -> bool:
        """Whether it stands or lies, and is slow, relative to the ground.

        Its acceleration does not count: at rest an explicit method oscillates by a part of the
        tolerance.
        """
        phase = status_outputs(outputs, self._energies + ENERGY_OUTPUTS).phase
        if is_phase(phase, Phase.FALLING):
            return False
        return is_slow(self._kinetic_on_ground(outputs), most * self.mass)

    def _kinetic_on_ground(self, outputs: Doubles) -> float:
        """The kinetic energy [J] of the motion relative to the ground, at a step's end."""
        if self.ground_moves:
            return self.relative_kinetic
        return outputs[self._energies + KINETIC]

    def may_rest(self, u: Doubles, rates: Doubles, outputs: Doubles) -> bool:
        """Whether it stands and is slow, with loads and ground that do not change."""
        if not self.is_slow(outputs, 1.0):
            return False
        for i in range(self.inputs):
            if rates[i] != 0.0:
                return False
        return self._ground_is_still(u)

    def _ground_is_still(self, u: Doubles) -> bool:
        """Whether the ground does not move at the inputs `u`."""
        return True

    def rests(self, outputs: Doubles, most: float) -> bool:
        """Whether it touches the ground and is still on it, see `is_still`; on its side, too."""
        phase = status_outputs(outputs, self._energies + ENERGY_OUTPUTS).phase
        if is_phase(phase, Phase.FALLING):
            return False
        acceleration = 0.0
        if self.ground_moves:
            acceleration = self.relative_acceleration
        else:
            for i in range(self._axes):
                acceleration += fabs(outputs[self._accelerations + i])
        return is_still(self._kinetic_on_ground(outputs), self.mass, acceleration, most)

    def tell_rest(self, outputs: Doubles, at: int) -> None:
        """Write the phase: settled, where it touches the ground and has not toppled."""
        place = at + self._energies + ENERGY_OUTPUTS
        status = status_outputs(outputs, place)
        put(StatusOutputs(phase_at_rest(status.phase), status.stability_margin), outputs, place)

    def note(self, outputs: Doubles) -> None:
        """Keep the largest energy balance."""
        self.most_balance = max(self.most_balance, fabs(outputs[self._energies + BALANCE]))

    def lost(self, before: Doubles, after: Doubles, h: float) -> float:
        """The growth of the energy balance beyond rounding, in parts of what may be.

        Rounding comes and goes, and is allowed once: beyond the largest balance so far, all growth
        counts.
        """
        at = self._energies + BALANCE
        was = fabs(before[at])
        most = max(was, self.rounding, self.most_balance)
        growth = fabs(after[at]) - min(most, was + self.rounding)
        if growth <= 0.0:
            return 0.0
        least = LEAST_TURNED * self.scale[self.controlled]
        turned = max(least, before[self._energies + DISSIPATED])
        left = max(MOST_LOST * turned + self.rounding - was, 0.0)
        spare = (FARTHEST_LOST * turned + self.rounding - was) / (
            (FARTHEST_LOST - MOST_LOST) * turned
        )
        rate = LOST_RATE * min(max(spare, LEAST_SPARE), 1.0)
        return growth / (STEP_SHARE * left + rate * h * turned)

    def _keep_status(self, y: Doubles) -> None:
        """Keep what is read of each leg group beside its forces."""
        for i in range(self.groups):
            keep(
                leg_status(
                    leg_state(y, self._first_leg + LEG * i),
                    leg_forces_of(self._forces, i),
                    leg_model(self._legs, i),
                ),
                self._status,
                i,
            )

    def _put_powers(self, external: float, transverse: float, dy: Doubles) -> None:
        """Write the powers that the accounts and works gather to `dy` [W].

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
            ground += n * foot_loads_of(self._feet, i).ground
            dy[self._works + i] = forces.main * forces.stroke_rate
        put(
            Accounts(
                orifice, seal, stop, auxiliary, contact, friction, external, ground, transverse
            ),
            dy,
            self.controlled,
        )

    def _put_energies(
        self, y: Doubles, kinetic: float, potential: float, out: Doubles, at: int
    ) -> None:
        """Write the energies to `out[at:]`, those of motion given [J], from what is kept."""
        liquid = stop = 0.0
        auxiliary = self.more_auxiliary
        contact = self.more_contact
        friction = self.more_friction
        for i in range(self.groups):
            n = leg_place(self._places, i).legs
            s = leg_status_of(self._status, i)
            liquid += n * leg_forces_of(self._forces, i).held
            auxiliary += n * s.auxiliary
            contact += n * s.contact
            friction += n * s.friction
            stop += n * s.stop
        a = accounts(y, self.controlled)
        motion = kinetic + potential
        held = liquid + auxiliary + contact + friction + stop
        mechanical = motion + held
        dissipated = a.orifice + a.seal + a.stop + a.auxiliary + a.contact + a.friction
        supplied = a.external + a.ground + a.transverse
        put(
            EnergyOutputs(
                kinetic=kinetic,
                potential=potential,
                liquid=liquid,
                auxiliary=auxiliary,
                contact=contact,
                friction=friction,
                stop=stop,
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

    def _put_leg(self, i: int, y: Doubles, out: Doubles, at: int) -> None:
        """Write the outputs of leg group `i` at the state `y` to `out[at:]`.

        Strut forces change sign here: the user's are negative in compression. Mirror images are
        made where the names are made.
        """
        f = leg_forces_of(self._forces, i)
        foot = foot_loads_of(self._feet, i)
        s = leg_status_of(self._status, i)
        put(
            LegOutputs(
                main_strut_force=-f.main,
                main_strut_stroke=f.stroke,
                main_strut_stroke_rate=f.stroke_rate,
                main_strut_pressure_upper=s.pressure_upper,
                main_strut_pressure_lower=s.pressure_lower,
                main_strut_liquid_mass=f.liquid_mass,
                main_strut_work=y[self._works + i],
                auxiliary_strut_force=-f.auxiliary,
                auxiliary_strut_stroke=f.auxiliary_stroke,
                auxiliary_strut_stroke_rate=f.auxiliary_rate,
                footpad_x=foot.x,
                footpad_y=foot.y,
                footpad_z=foot.z,
                contact_force_x=foot.contact_x,
                contact_force_y=foot.contact_y,
                contact_force_z=foot.contact_z,
                contact_force=sqrt(
                    foot.contact_x * foot.contact_x
                    + foot.contact_y * foot.contact_y
                    + foot.contact_z * foot.contact_z
                ),
                contact_penetration=foot.depth,
                contact_active=1.0 if foot.depth > 0.0 else 0.0,
            ),
            out,
            at,
        )
