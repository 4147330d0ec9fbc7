"""The equation of state against numerical quadrature and differentiation."""

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx
from scipy.integrate import quad

from rlv_landing.core.struts.fluid import fluid, strain_energy

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
    assert strain_energy(f, 1.0 / f.v, PA, 1e-4, PA) == approx(0.0, abs=1e-9)


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
    assert strain_energy(f, 1.0 / f.v, P, V, PA) == approx(1e-4 * expected, rel=1e-6, abs=1e-9)


@given(st.floats(-1e9, 1e3), constants)
def test_pressure_below_the_floor_leaves_finite_numbers(P, c):
    v, dv, h = fluid(P, *c, PA)
    assert v > 0.0
    assert dv < 0.0
    assert abs(h) < 1e12
