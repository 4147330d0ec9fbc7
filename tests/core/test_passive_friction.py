"""The passive friction law: what it takes from the motion it holds or loses, whatever goes in."""

import sys
from math import cos, exp, hypot, sin

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Parameters
from rlv_landing.assembly import leg_models, tangential_stiffness
from rlv_landing.core.ground.kinds import friction, friction_energy, ground_force
from rlv_landing.core.ground.passive_friction import slider_share, stick_limit
from rlv_landing.core.records import FootMotion

P = leg_models(Parameters())[0]
PAPER = leg_models(Parameters().with_values({"ground.friction_law": "paper"}))[0].friction_kind
FREE = {"allow_nan": False, "allow_infinity": False}
depths = st.one_of(st.just(0.0), st.floats(-1e-3, 5e-3, **FREE))
slips = st.one_of(st.just(0.0), st.floats(-10.0, 10.0, **FREE))
displacements = st.one_of(st.just(0.0), st.floats(-5e-3, 5e-3, **FREE))
forces = st.one_of(st.just(0.0), st.floats(0.0, 1e5, **FREE))
models = st.builds(
    lambda mu, ar, Cr, K_t, zone, tau: P._replace(
        mu=mu, ar=ar, Cr=Cr, K_t=K_t, zone=zone, tau_sr=tau
    ),
    st.one_of(st.just(0.0), st.floats(0.0, 3.0, **FREE)),
    st.floats(0.0, 2.0, **FREE),
    st.floats(0.0, 1e4, **FREE),
    st.floats(1e3, 1e9, **FREE),
    st.floats(1e-7, 1e-3, **FREE),
    st.floats(1e-5, 1.0, **FREE),
)


def powers(foot, Fn, q1, q2, p):
    """Powers [W]: taken from the motion, held, dissipated; and the size of their terms."""
    f = friction(foot, Fn, q1, q2, p)
    taken = (-f.f1 * foot.slip_1, -f.f2 * foot.slip_2)
    held = (p.K_t * q1 * f.dq1, p.K_t * q2 * f.dq2)
    size = sum(map(abs, (*taken, *held, f.dissipated)))
    # the rates are differences of speeds, whose rounding the spring's force multiplies
    size += p.K_t * hypot(q1, q2) * (hypot(foot.slip_1, foot.slip_2) + hypot(q1, q2) / p.tau_sr)
    return sum(taken), sum(held), f.dissipated, size


@given(depths, slips, slips, forces, displacements, displacements, models)
def test_what_friction_takes_is_held_or_lost_and_nothing_is_ever_won(d, v1, v2, Fn, q1, q2, p):
    """For any input at all: Fn may have jumped, the displacement may be far beyond its limit."""
    Fn = Fn if d > 0.0 else 0.0
    taken, held, lost, size = powers(FootMotion(d, 0.0, v1, v2), Fn, q1, q2, p)
    assert lost >= -1e-12 * size
    # below the least normal number, digits are lost
    assert taken == approx(held + lost, abs=1e-12 * size + sys.float_info.min)


@given(depths, slips, slips, forces, displacements, displacements, models)
def test_the_force_stays_within_the_cone_and_turns_with_the_scene(d, v1, v2, Fn, q1, q2, p):
    p = p._replace(Cr=0.0)
    Fn = Fn if d > 0.0 else 0.0
    f = friction(FootMotion(d, 0.0, v1, v2), Fn, q1, q2, p)
    limit = p.mu * Fn * (1.0 + p.ar * exp(-hypot(v1, v2) / p.b_strib))
    # squares of displacements below 1e-150 m lose digits
    assert hypot(f.f1, f.f2) <= limit * (1.0 + 1e-12) + p.K_t * 1e-150
    # a quarter turn: (1, 2) becomes (2, -1)
    t = friction(FootMotion(d, 0.0, v2, -v1), Fn, q2, -q1, p)
    assert (t.f1, t.f2) == (f.f2, -f.f1)
    assert (t.dq1, t.dq2) == approx((f.dq2, -f.dq1), rel=1e-12, abs=1e-15)


@given(slips, slips, st.floats(1.0, 1e5), st.floats(-0.7, 0.7), st.floats(-0.7, 0.7))
def test_below_the_limit_the_footpad_sticks_and_nothing_leaks(v1, v2, Fn, a, b):
    p = P._replace(Cr=0.0)
    foot = FootMotion(1e-3, 0.0, v1, v2)
    limit = stick_limit(foot, Fn, p)
    f = friction(foot, Fn, a * limit, b * limit, p)
    assert (f.dq1, f.dq2, f.dissipated) == (v1, v2, 0.0)
    assert (f.f1, f.f2) == (-p.K_t * (a * limit), -p.K_t * (b * limit))


def test_in_steady_slip_the_slider_takes_the_whole_motion_and_the_force_is_coulombs():
    foot = FootMotion(1e-3, 0.0, 0.3, 0.4)
    p = P._replace(ar=0.0)
    size = stick_limit(foot, 1000.0, p) + p.zone
    f = friction(foot, 1000.0, 0.6 * size, 0.8 * size, p)
    assert (f.dq1, f.dq2) == approx((0.0, 0.0), abs=1e-15)
    assert (f.f1, f.f2) == approx((-0.6 * p.mu * 1000.0, -0.8 * p.mu * 1000.0))
    assert f.dissipated == approx(p.mu * 1000.0 * 0.5)


@given(st.floats(0.0, 2.0), st.floats(0.0, 2.0))
def test_the_slider_comes_into_motion_smoothly(a, b):
    low, high = sorted((a, b))
    assert 0.0 <= slider_share(low * P.zone, P) <= slider_share(high * P.zone, P) <= 1.0
    assert slider_share(0.0, P) == 0.0
    assert slider_share(P.zone, P) == 1.0


@given(st.floats(0.0, 1.0), st.floats(0.0, 6.28), slips, slips)
def test_force_and_rate_are_continuous_at_the_limit(share, angle, v1, v2):
    foot = FootMotion(1e-3, 0.0, v1, v2)
    limit = stick_limit(foot, 500.0 * (1.0 + share), P)
    sides = [
        friction(foot, 500.0 * (1.0 + share), at * cos(angle), at * sin(angle), P)
        for at in (limit * (1.0 - 1e-9), limit * (1.0 + 1e-9))
    ]
    assert sides[0][:4] == approx(sides[1][:4], rel=1e-6, abs=1e-6)


@given(displacements, displacements, st.floats(1e-5, 1.0))
def test_out_of_contact_the_displacement_returns_and_loses_what_it_held(q1, q2, tau):
    p = P._replace(tau_sr=tau)
    f = friction(FootMotion(-1e-3, 0.0, 1.0, 1.0), 0.0, q1, q2, p)
    assert (f.f1, f.f2) == (0.0, 0.0)
    assert (f.dq1, f.dq2) == (-q1 / tau, -q2 / tau)
    assert f.dissipated == approx(2.0 * friction_energy(q1, q2, p) / tau)


@given(slips, slips)
def test_without_friction_nothing_happens_from_rest(v1, v2):
    foot = FootMotion(1e-3, 0.0, v1, v2)
    assert friction(foot, 1000.0, 0.0, 0.0, P._replace(mu=0.0)) == (0.0, 0.0, 0.0, 0.0, 0.0)


def test_the_papers_law_supplies_energy_where_the_load_on_a_stuck_foot_grows():
    """The paper's K grows with the normal force at no cost of energy."""
    paper = P._replace(friction_kind=PAPER, Cr=0.0)
    there = ground_force(FootMotion(1e-3, 0.0, 1e-3, 0.0), 5e-4, 0.0, paper)
    back = ground_force(FootMotion(2e-3, 0.0, -1e-3, 0.0), 5e-4, 0.0, paper)
    assert there.friction + back.friction < 0.0


def test_the_stiffness_scales_with_the_weight_unless_it_is_given():
    base = Parameters()
    heavy = base.with_values({"vehicle.mass": 10.0 * 178.0, "vehicle.footpad_mass": 42.0})
    assert tangential_stiffness(heavy) == approx(10.0 * tangential_stiffness(base))
    over = base.ground.stick_displacement
    assert tangential_stiffness(base) == approx((178.0 + 16.8) * 9.80665 / over)
    given = base.with_values({"ground.tangential_stiffness": 2e6})
    assert tangential_stiffness(given) == 2e6
    assert leg_models(given)[0].K_t == 2e6
