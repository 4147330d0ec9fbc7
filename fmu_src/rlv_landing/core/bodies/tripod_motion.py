"""Motion of the spatial body's legs on three struts, whose footpads are free (derived)."""

from __future__ import annotations

from ..access import (
    ACROSS,
    AUXILIARY_ACCOUNT,
    LEG,
    across_forces_of,
    across_state,
    foot_motion_of,
    keep,
    leg_forces_of,
    leg_model,
    leg_place,
    leg_state,
    put,
    spatial_loads_of,
    spatial_model,
)
from ..memory import Doubles, Records
from ..records import (
    AcrossForces,
    AcrossState,
    SecondStrutOutputs,
    SpatialAttitude,
    SpatialLoads,
    Vector,
)
from ..struts.kinds import auxiliary_strut_energy
from ..tripod import across_forces, tripod_forces
from ..vectors import added, cross, dot, less, scaled, solved
from .spatial_ground import SpatialGround
from .spatial_legs import along_across, cg_of, force_on_body, in_leg


class TripodMotion(SpatialGround):
    """What legs on three struts have of their own; each has an `AcrossState`, behind the legs'.

    No force keeps a footpad in its leg's plane, so that each footpad and the body are accelerated
    by the forces on it alone: m (a + w' x rho + b + rho'') = F and m_u a = f, I w' + w x I w = t.
    A subclass makes the room for what is kept.
    """

    _tripod: bool
    _across: Records[AcrossForces]
    _loads: Records[SpatialLoads]

    def _keep_tripod_forces(self, i: int, y: Doubles, steep: float) -> None:
        """Keep the forces of leg `i`, on ground of this steepness."""
        leg = leg_state(y, self._first_leg + LEG * i)
        across = across_state(y, self._first_across + ACROSS * i)
        model = leg_model(self._legs, i)
        motion = foot_motion_of(self._motions, i)
        keep(tripod_forces(leg, across, motion, steep, model), self._forces, i)
        keep(across_forces(leg, across, leg_forces_of(self._forces, i), model), self._across, i)

    def _add_across_loads(self, i: int) -> None:
        """Add the second auxiliary strut, and the struts across the plane, to leg `i`'s loads."""
        loads = spatial_loads_of(self._loads, i)
        across = across_forces_of(self._across, i)
        keep(
            SpatialLoads(
                radial=loads.radial + across.r,
                vertical=loads.vertical + across.h,
                tangential=loads.tangential + across.t,
                bias_r=loads.bias_r,
                bias_h=loads.bias_h,
                bias_t=loads.bias_t,
                foot_x=loads.foot_x,
                foot_y=loads.foot_y,
                foot_z=loads.foot_z,
            ),
            self._loads,
            i,
        )

    def _tripod_acceleration(self, spin: Vector, force: Vector, moment: Vector) -> SpatialAttitude:
        """The body's acceleration under its struts, body axes; completes each leg's loads.

        Args:
            spin: The body's angular velocity [rad/s].
            force: All forces on the body but the legs' [N].
            moment: Their moment about the CG [N m].
        """
        p = spatial_model(self._body, 0)
        i_x = Vector(p.I_x, p.I_xy, p.I_xz)
        i_y = Vector(p.I_xy, p.I_y, p.I_yz)
        i_z = Vector(p.I_xz, p.I_yz, p.I_z)
        turning = Vector(dot(i_x, spin), dot(i_y, spin), dot(i_z, spin))
        moment = less(moment, cross(spin, turning))
        struts = Vector(0.0, 0.0, 0.0)
        for i in range(self.groups):
            self._add_across_loads(i)
            place = leg_place(self._places, i)
            forces = leg_forces_of(self._forces, i)
            across = across_forces_of(self._across, i)
            more = added(in_leg(place, across.r, across.h), along_across(place, across.t))
            struts = added(struts, less(force_on_body(forces, place), more))
            moment = added(moment, in_leg(place, across.moment_r, across.moment_h))
            moment = less(moment, along_across(place, forces.moment + across.moment))
        moment = less(moment, cross(cg_of(p), struts))
        a = scaled(added(force, struts), 1.0 / p.m_u)
        spin_rate = solved(i_x, i_y, i_z, moment)
        return SpatialAttitude(
            a_x=a.x,
            a_y=a.y,
            a_z=a.z,
            spin_x=spin_rate.x,
            spin_y=spin_rate.y,
            spin_z=spin_rate.z,
        )

    def _put_across_rates(self, i: int, y: Doubles, frame: Vector, dy: Doubles) -> None:
        """Write the rates of leg `i` across its plane to `dy`.

        `frame` is the acceleration of a footpad at rest in the body, along r, h, t [m/s2].
        """
        at = self._first_across + ACROSS * i
        force = spatial_loads_of(self._loads, i).tangential
        rate = force / leg_model(self._legs, i).m_d - frame.z
        put(AcrossState(across_state(y, at).vt, rate), dy, at)

    def _add_second_powers(self, dy: Doubles) -> None:
        """Add what the second auxiliary struts dissipate to the accounts' powers [W]."""
        for i in range(self.groups):
            dissipated = across_forces_of(self._across, i).dissipated
            dy[self.controlled + AUXILIARY_ACCOUNT] += dissipated

    def _keep_second_energies(self) -> None:
        """Keep the energy that the second auxiliary struts hold [J]."""
        self.more_auxiliary = 0.0
        for i in range(self.groups):
            stroke = across_forces_of(self._across, i).stroke
            self.more_auxiliary += auxiliary_strut_energy(stroke, leg_model(self._legs, i))

    def _put_second_strut(self, i: int, out: Doubles, at: int) -> None:
        """Write the outputs of leg `i`'s second auxiliary strut to `out[at:]`."""
        across = across_forces_of(self._across, i)
        put(SecondStrutOutputs(-across.force, across.stroke, across.rate), out, at)
