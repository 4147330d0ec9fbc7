"""The equation of state against numerical quadrature and differentiation."""

from math import isfinite

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx
from scipy.integrate import quad

from rlv_landing.core.struts.fluid import CAVITY_PRESSURE, fluid, strain_energy

PA = 101300.0
pressures = st.floats(2e3, 5e7)
constants = st.tuples(
    st.floats(1e-6, 0.05), st.floats(1.05, 1.6), st.floats(3e8, 3e9), st.floats(2.0, 12.0)
)


@given(constants)
def test_volume_is_one_and_energy_zero_at_ambient_pressure(c):
    f = fluid(PA, *c, PA)
    assert f.v == approx(1.0, rel=1e-14)
    assert f.h == approx(0.0, abs=1e-5)
    assert f.P == PA
    assert strain_energy(f, 1.0 / f.v, 1e-4, PA) == approx(0.0, abs=1e-9)


@given(pressures, constants)
def test_compressibility_is_the_derivative_of_volume(P, c):
    step = 1e-4 * P
    higher, lower = fluid(P + step, *c, PA).v, fluid(P - step, *c, PA).v
    assert fluid(P, *c, PA).dv == approx((higher - lower) / (2.0 * step), rel=1e-5)


@given(pressures, constants)
def test_flow_energy_is_the_integral_of_volume_over_pressure(P, c):
    expected, _ = quad(lambda p: fluid(p, *c, PA).v, PA, P, epsabs=0.0, epsrel=1e-10, limit=200)
    assert fluid(P, *c, PA).h == approx(expected, rel=1e-7, abs=1e-3)


@given(pressures, constants)
def test_strain_energy_is_the_work_of_compression(P, c):
    """Work on a fixed mass of 1e-4 m3 at ambient pressure: integral of (p - Pa) (-dV)."""
    expected, _ = quad(
        lambda p: (p - PA) * -fluid(p, *c, PA).dv, PA, P, epsabs=0.0, epsrel=1e-10, limit=200
    )
    f = fluid(P, *c, PA)
    V = 1e-4 * f.v
    assert strain_energy(f, 1.0 / f.v, V, PA) == approx(1e-4 * expected, rel=1e-6, abs=1e-9)


# states of a chamber in a cavity: pressures from 10 Pa down to 1e-20 Pa
cavities = st.floats(-500.0, CAVITY_PRESSURE - 0.01)


@given(st.one_of(st.floats(-1e3, 1e3), st.floats(-1e3, 5e7)), constants)
def test_every_state_of_a_chamber_has_a_pressure_above_zero_that_grows_with_it(z, c):
    step = 1e-3 * (CAVITY_PRESSURE + abs(z))
    low, high = fluid(z, *c, PA), fluid(z + step, *c, PA)
    assert 0.0 < low.P < high.P
    assert low.v > high.v > 0.0
    assert low.dv < 0.0
    assert low.h <= high.h


@given(st.floats(-1e12, 1e12), constants)
def test_numbers_stay_finite_wherever_a_step_that_is_too_long_leads(z, c):
    f = fluid(z, *c, PA)
    assert f.P > 0.0
    assert f.v > 0.0
    assert f.dv < 0.0
    assert all(map(isfinite, f))


@given(cavities, constants)
def test_in_a_cavity_slopes_are_those_by_the_state(z, c):
    step = 1e-4
    low, f, high = (fluid(z + k * step, *c, PA) for k in (-1, 0, 1))
    assert f.slope == approx((high.P - low.P) / (2.0 * step), rel=1e-6, abs=1e-12)
    assert f.dv == approx((high.v - low.v) / (2.0 * step), rel=1e-5)


@given(cavities, constants)
def test_in_a_cavity_flow_energy_is_the_integral_of_volume_over_pressure(z, c):
    """From the cavity's pressure down, over the state: integral of v dP/dz."""

    def rate(s: float) -> float:
        f = fluid(s, *c, PA)
        return f.v * f.slope

    expected, _ = quad(rate, CAVITY_PRESSURE, z, epsabs=1e-9, epsrel=1e-10, limit=500)
    change = fluid(z, *c, PA).h - fluid(CAVITY_PRESSURE, *c, PA).h
    assert change == approx(expected, rel=1e-6, abs=2e-6)


@given(constants)
def test_a_chambers_functions_are_continuous_at_the_onset_of_cavitation(c):
    below, above = (fluid(CAVITY_PRESSURE * (1.0 + d), *c, PA) for d in (-1e-9, 1e-9))
    assert below == approx(above, rel=1e-6)
    assert fluid(CAVITY_PRESSURE, *c, PA).P == CAVITY_PRESSURE
