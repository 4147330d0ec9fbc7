"""Damper, auxiliary strut and contact against their laws."""

from math import sqrt

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Parameters
from rlv_landing.assembly import leg_models
from rlv_landing.core.ground.kinds import ground_force
from rlv_landing.core.ground.normal import damping_ramp, normal_energy, normal_force
from rlv_landing.core.ground.paper_friction import friction_along
from rlv_landing.core.leg import leg_forces, liquid_excess, without_excess
from rlv_landing.core.records import FootMotion, LegState
from rlv_landing.core.struts.elastic import elastic, elastic_energy
from rlv_landing.core.struts.end_stops import stop_force
from rlv_landing.core.struts.liquid_spring import (
    chamber,
    liquid_spring,
    orifice_flow,
    orifice_slope,
    seal_friction,
)

P = leg_models(Parameters().with_values({"ground.friction_law": "paper"}))[0]
speeds = st.floats(-5.0, 5.0)


@given(st.floats(-3e7, 3e7))
def test_orifice_flow_goes_down_the_pressure_drop_and_dissipates(dP):
    assert orifice_flow(dP, 1.0, P) * dP >= 0.0


def test_orifice_flow_follows_the_square_root_law_far_from_zero():
    assert orifice_flow(2e7, 1.0, P) == approx(P.CdAo_c * sqrt(2.0 * 2e7 / P.rho0), rel=1e-4)
    assert orifice_flow(-2e7, 1.0, P) == approx(-P.CdAo_r * sqrt(2.0 * 2e7 / P.rho0), rel=1e-4)


@given(speeds, st.floats(1e3, 2e7), st.floats(1e3, 2e7))
def test_seal_friction_opposes_the_motion(v, P1, P2):
    assert seal_friction(v, P1, P2, P) * v >= 0.0


@given(st.floats(0.0, P.s_max), speeds)
def test_end_stops_are_silent_between_the_ends(s, v):
    assert stop_force(s, v, P) == (0.0, 0.0)


@given(st.floats(1e-6, 0.01), speeds)
def test_end_stops_only_push_back_and_only_dissipate(overlap, v):
    extension, power = stop_force(-overlap, v, P)
    assert extension <= 0.0
    assert power >= -1e-9
    compression, power = stop_force(P.s_max + overlap, v, P)
    assert compression >= 0.0
    assert power >= -1e-9


# strokes beyond both ends, and chambers' states from deep in a cavity up
strokes = st.floats(-0.2, 0.8)
states = st.one_of(st.floats(-200.0, 100.0), st.floats(10.0, 1e7))


@given(strokes, speeds, states, states)
def test_chambers_keep_the_liquid_mass(s, v, z1, z2):
    """The mass's rate is zero whatever the state."""
    given = liquid_spring(s, v, z1, z2, P)
    step = 1e-6
    high, low = (liquid_spring(s + k * step, v, z1, z2, P).liquid_mass for k in (1, -1))
    by_stroke = (high - low) / (2.0 * step)
    rates = (by_stroke * v, given.mass_1 * given.dz1, given.mass_2 * given.dz2)
    assert sum(rates) == approx(0.0, abs=1e-5 * max(map(abs, rates)) + 1e-9)


@given(strokes, states, states)
def test_slopes_of_the_liquid_mass_are_those_by_the_states(s, z1, z2):
    given = liquid_spring(s, 0.0, z1, z2, P)
    for slope, d1, d2 in (
        (given.mass_1, 1e-4 * (10.0 + abs(z1)), 0.0),
        (given.mass_2, 0.0, 1e-4 * (10.0 + abs(z2))),
    ):
        step = d1 + d2
        assume(all(abs(z - 10.0) > 2.0 * step for z in (z1, z2)))  # where state and pressure part
        high, low = (liquid_spring(s, 0.0, z1 + k * d1, z2 + k * d2, P) for k in (1, -1))
        found = (high.liquid_mass - low.liquid_mass) / (2.0 * step)
        rounding = 1e-15 * given.liquid_mass / step
        assert slope == approx(found, rel=1e-3, abs=rounding)
        assert slope > 0.0


@given(strokes, speeds, states, states)
def test_what_the_piston_does_is_stored_or_lost(s, v, z1, z2):
    """Power of the force = growth of what the liquid holds + what the passage dissipates."""
    p = P._replace(Fc=0.0, Fs=0.0, kp=0.0, K_stop=0.0)
    given = liquid_spring(s, v, z1, z2, p)
    # a change above rounding, and small for a cavity [Pa]
    change = 1e-3 * (10.0 + min(abs(z1), abs(z2)))
    assume(all(abs(z - 10.0) > change for z in (z1, z2)))  # where state and pressure part
    step = change / max(abs(given.dz1), abs(given.dz2), 1e6 * abs(v), 1.0)

    def held(k):
        at = (s + k * step * v, z1 + k * step * given.dz1, z2 + k * step * given.dz2)
        return liquid_spring(at[0], v, at[1], at[2], p).held

    growth = (held(1.0) - held(-1.0)) / (2.0 * step)
    size = abs(given.force * v) + given.orifice
    rounding = 1e-15 * p.B0 * (p.V10 + p.V20) / step
    assert given.force * v == approx(growth + given.orifice, abs=1e-3 * size + 10.0 * rounding)


@given(st.floats(1e-7, 1e-2), st.floats(1e-6, 1e-2), st.floats(-2.0, 2.0))
def test_a_chamber_never_vanishes_and_its_area_is_its_slope(V0, area, travel):
    step = 1e-6 * V0 / area
    found = chamber(V0, area, travel)
    low, high = (chamber(V0, area, travel + k * step).V for k in (-1, 1))
    assert found.V >= 0.025 * V0
    assert found.area == approx((high - low) / (2.0 * step), rel=1e-4, abs=1e-6 * area)
    if V0 + area * travel >= 0.05 * V0:
        assert found == (V0 + area * travel, area)


@given(
    states,
    states,
    st.one_of(st.floats(-0.5, -1e-7), st.floats(1e-7, 0.5), st.floats(-1e-4, 1e-4)),
)
def test_an_excess_of_liquid_mass_is_removed_with_and_without_cavitation(z1, z2, part):
    """Of the liquid's mass: up to a half too much or too little, next to a cavity or in it."""
    radius, height = P.Lc + 0.95, P.Ld - 0.63
    leg = LegState(radius, height, 0.0, 0.0, z1, z2, 1e-4, 2e-4)
    still = FootMotion(-1.0, 0.0, 0.0, 0.0)
    p = P._replace(fill=leg_forces(leg, still, P).liquid_mass / (1.0 + part))
    forces = leg_forces(leg, still, p)
    assert liquid_excess(forces, p) == approx(part, rel=1e-6, abs=1e-12)
    mended = without_excess(leg, forces, p, 0.0)
    assert abs(liquid_excess(leg_forces(mended, still, p), p)) < 1e-9
    assert mended[:4] == leg[:4]
    assert mended[6:] == leg[6:]


@given(st.floats(0.0, 0.03), speeds, st.floats(2e3, 1e7), st.floats(2e3, 1e7))
def test_damper_dissipates_in_orifice_and_seal(s, v, P1, P2):
    given = liquid_spring(s, v, P1, P2, P)
    assert given.orifice >= 0.0
    assert given.seal >= 0.0


@given(st.floats(-2e7, 2e7))
def test_orifice_slope_is_the_flows_derivative(dP):
    step = 1e-4 * (P.dP_lam + abs(dP))
    assume((dP - step) * (dP + step) > 0.0)  # the two areas make a kink at zero
    assert orifice_slope(dP, 1.0, P) == approx(
        (orifice_flow(dP + step, 1.0, P) - orifice_flow(dP - step, 1.0, P)) / (2.0 * step), rel=1e-5
    )


@given(st.floats(0.0, 0.03), st.floats(2e3, 1e7), st.sampled_from((1.0, -1.0)))
def test_the_pressure_difference_of_chambers_decays_at_the_rates_of_the_stiff_pair(s, pressure, x):
    """At rest and nearly even, P1' = a1 x and P2' = -a2 x with x = P2 - P1 [Pa]."""
    given = liquid_spring(s, 0.0, pressure, pressure + x, P)
    assert given.dz1 == approx(given.a1 * x, rel=1e-6)
    assert given.dz2 == approx(-given.a2 * x, rel=1e-6)


@given(st.floats(-0.01, 0.01), speeds)
def test_auxiliary_strut_is_odd_and_dissipates(s, v):
    force, power, work = elastic(s, v, P)
    opposite, _, same = elastic(-s, -v, P)
    assert opposite == approx(-force)
    assert power >= 0.0
    assert same == work >= 0.0


@given(st.floats(-0.01, 0.01), speeds)
def test_ground_never_pulls_and_its_damping_dissipates(d, v):
    force, power, work = normal_force(d, v, P)
    assert force >= 0.0
    assert work >= 0.0
    assert power >= -1e-9 * max(1.0, abs(force * v))
    if d <= 0.0:
        assert force == 0.0


@given(st.floats(1e-5, 0.01))
def test_forces_are_the_slopes_of_the_energies_that_their_works_give(x):
    step = 1e-3 * x

    def ground(d):
        return normal_energy(normal_force(d, 0.0, P).work, P)

    def strut(s):
        return elastic_energy(s, elastic(s, 0.0, P).work, P)

    for energy, force in ((ground, normal_force(x, 0.0, P)), (strut, elastic(x, 0.0, P))):
        slope = (energy(x + step) - energy(x - step)) / (2.0 * step)
        assert slope == approx(force.force, rel=1e-5)


def test_damping_ramp_is_smooth_at_both_ends():
    assert damping_ramp(0.0, P) == 0.0
    assert damping_ramp(P.d_ramp, P) == 1.0
    for end in (1e-6, 1.0 - 1e-6):
        slope = (
            damping_ramp((end + 1e-7) * P.d_ramp, P) - damping_ramp((end - 1e-7) * P.d_ramp, P)
        ) / 2e-7
        assert slope == approx(0.0, abs=1e-4)


@given(st.floats(1e-5, 2e-3), speeds, speeds, st.sampled_from([0.5, 1.0]))
def test_sliding_friction_stays_within_the_cone(d, vx, vz, share):
    """Both directions in slip: the friction is at most (1 + ar) mu Fn, and opposes the slip."""
    if share == 1.0:
        vz = 0.0
    sx, sz = (P.s_r0 if vx > 0.0 else -P.s_r0), (P.s_r0 if vz > 0.0 else -P.s_r0)
    Fn, Fx, Fz, *_ = ground_force(FootMotion(d, 0.0, vx, vz), sx, sz, P._replace(share_1=share))
    stick_damping = P.Cr * (abs(vx) + abs(vz))
    assert sqrt(Fx * Fx + Fz * Fz) <= (1.0 + P.ar) * P.mu * Fn * (1.0 + 1e-9) + stick_damping
    assert Fx * vx + Fz * vz <= 0.0


def test_friction_slips_only_where_it_has_reached_its_limit_in_the_sense_of_motion():
    Fn = 1000.0
    assert friction_along(1e-3, Fn, P.mu, 0.1, P.s_r0, P)[1] == 0.0
    assert friction_along(1e-3, Fn, P.mu, 0.1, 0.5 * P.s_r0, P)[1] == 0.1
    assert friction_along(1e-3, Fn, P.mu, -0.1, P.s_r0, P)[1] == -0.1
    assert friction_along(-1e-3, 0.0, P.mu, 0.1, P.s_r0, P) == (0.0, -P.s_r0 / P.tau_sr)


def test_friction_at_rest_is_shared_evenly_in_space_and_whole_in_the_symmetric_plane():
    s = 0.5 * P.s_r0
    pressed = FootMotion(1e-3, 0.0, 0.0, 0.0)
    Fn, Fx, Fz, *_ = ground_force(pressed, s, s, P._replace(share_1=0.5))
    assert Fx == Fz == approx(-P.mu / sqrt(2.0) * Fn * (1.0 + P.ar) * 0.5)
    Fn, Fx, Fz, *_ = ground_force(pressed, s, 0.0, P._replace(share_1=1.0))
    assert Fx == approx(-P.mu * Fn * (1.0 + P.ar) * 0.5)
    assert Fz == 0.0


@pytest.mark.parametrize("v", [1e-9, 1e-3, 1.0])
def test_stick_damping_has_faded_where_slip_begins(v):
    """So the force just below and just at the limit differ only by the Stribeck term."""
    below = friction_along(1e-3, 1000.0, P.mu, v, P.s_r0 * (1.0 - 1e-12), P)[0]
    expected = -P.mu * 1000.0 * (1.0 + P.ar)
    assert below == approx(expected, rel=1e-9)
