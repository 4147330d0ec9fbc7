"""Play in the auxiliary strut's joints: its energy, its dissipation, and the law without play."""

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.assembly import bearing_nothing_at_rest, leg_models
from rlv_landing.audit.energy import imbalance, largest_fall
from rlv_landing.core.struts.elastic import elastic
from rlv_landing.core.struts.kinds import auxiliary_strut, auxiliary_strut_energy

BASE = leg_models(Parameters())[0]
WITH_PLAY = {
    "auxiliary_strut.play_tension": 1e-3,
    "auxiliary_strut.play_compression": 7e-4,
    "auxiliary_strut.play_stiffness": 5e4,
    "auxiliary_strut.play_damping": 0.1,
}
strokes = st.floats(-0.01, 0.01)
speeds = st.floats(-5.0, 5.0)
plays = st.one_of(st.just(0.0), st.floats(1e-5, 5e-3))
models = st.builds(
    lambda g_t, g_c, ek, k_play, c_play: bearing_nothing_at_rest(
        BASE._replace(auxiliary_kind=1.0, g_t=g_t, g_c=g_c, ek=ek, k_play=k_play, c_play=c_play)
    ),
    plays,
    st.floats(1e-5, 5e-3),
    st.floats(1.0, 3.0),
    st.floats(0.0, 1e6),
    st.floats(0.0, 1.0),
)


@given(strokes, models)
def test_the_spring_is_the_slope_of_its_energy_for_every_exponent(s, p):
    step = 1e-4 * (p.g_t + p.g_c)
    slope = (auxiliary_strut_energy(s + step, p) - auxiliary_strut_energy(s - step, p)) / (2 * step)
    force = auxiliary_strut(s, 0.0, p).force
    assert slope == approx(force, rel=1e-4, abs=1e-4 * p.Ka * (p.g_t + p.g_c) ** p.ek)


@given(strokes, speeds, models)
def test_energy_is_never_negative_and_damping_only_dissipates(s, v, p):
    assert auxiliary_strut_energy(s, p) >= 0.0
    moving, still = auxiliary_strut(s, v, p), auxiliary_strut(s, 0.0, p)
    assert still.dissipated == 0.0
    assert moving.dissipated >= 0.0
    assert (moving.force - still.force) * v == approx(moving.dissipated, rel=1e-6, abs=1e-6)
    assert moving.dissipated <= p.Ca * v * v * (1.0 + 1e-12)


@given(models)
def test_at_stroke_zero_the_strut_bears_and_holds_exactly_nothing_however_unequal_the_plays(p):
    assert auxiliary_strut(0.0, 0.0, p).force == 0.0
    assert auxiliary_strut_energy(0.0, p) == 0.0


@given(strokes, strokes, models)
def test_the_spring_hardens_so_that_its_energy_is_convex(s, t, p):
    s, t = min(s, t), max(s, t)
    lower, higher = (auxiliary_strut(x, 0.0, p).force for x in (s, t))
    assert higher >= lower - 1e-12 * p.Ka * (p.g_t + p.g_c) ** p.ek


@given(st.floats(-0.9, 0.9), models)
def test_well_inside_the_play_the_strut_hardly_bears(part, p):
    p = bearing_nothing_at_rest(p._replace(k_play=0.0, g_t=p.g_c, ek=1.0))
    assert abs(auxiliary_strut(part * p.g_c, 0.0, p).force) < 0.05 * p.Ka * p.g_c


@given(st.floats(2.0, 10.0), st.floats(1e-4, 2e-3))
def test_well_past_the_play_it_is_the_strut_that_is_shorter_by_the_play(part, g):
    p = bearing_nothing_at_rest(BASE._replace(auxiliary_kind=1.0, g_t=g, g_c=g, k_play=0.0))
    s = part * g
    rest = elastic(s - g, 0.0, p).force
    assert auxiliary_strut(s, 0.0, p).force == approx(rest, rel=5e-3)
    assert auxiliary_strut(-s, 0.0, p).force == approx(-rest, rel=5e-3)


def test_without_play_the_law_is_the_papers_whatever_else_is_set():
    none = {"auxiliary_strut.play_tension": 0.0, "auxiliary_strut.play_compression": 0.0}
    values = {"auxiliary_strut.play_stiffness": 1e6, "auxiliary_strut.play_damping": 0.5}
    p = leg_models(Parameters().with_values(none | values))[0]
    assert p.auxiliary_kind == 0.0
    rigid = load_preset("yue2022-figures").with_values(none)
    plain, other = (Landing(rigid.with_values(v)) for v in ({}, values))
    assert list(plain.run(0.3).data.ravel()) == list(other.run(0.3).data.ravel())


def test_a_landing_with_play_closes_the_balance_and_loses_what_is_lost(mode):
    landing = Landing(load_preset("yue2022-figures", mode).with_values(WITH_PLAY), rtol=1e-8)
    history = landing.run(1.0)
    assert imbalance(history) < 1e-7
    assert largest_fall(history) < 1e-9
    assert history["energy.auxiliary"].min() >= 0.0
    # the strut does cross its play
    assert abs(history["leg[1].auxiliary_strut.stroke"]).max() > 1e-3
