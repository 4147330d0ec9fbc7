"""Dormand-Prince: its order conditions, its convergence, and the same digits compiled and pure."""

import os
import subprocess
import sys

import numpy as np
import pytest
from pytest import approx

from rlv_landing import Landing, core, load_preset
from rlv_landing.core import integrator as dp
from rlv_landing.landing import Landing as LandingType

A = np.zeros((7, 7))
for row in range(2, 8):
    for column in range(1, row):
        A[row - 1, column - 1] = getattr(dp, f"A{row}{column}", 0.0)
B = A[6].copy()
ERROR = np.array([getattr(dp, f"E{i}", 0.0) for i in range(1, 8)])
C = A.sum(axis=1)


def test_nodes_are_those_of_the_scheme():
    assert np.array([0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0]) == approx(C, abs=1e-14)


def order_conditions(b):
    """Left side minus right side of every order condition up to order 5, by order (Hairer, Norsett, Wanner, II.2)."""
    Ac = A @ C
    return {
        1: [b.sum() - 1.0],
        2: [b @ C - 1 / 2],
        3: [b @ C**2 - 1 / 3, b @ Ac - 1 / 6],
        4: [b @ C**3 - 1 / 4, b @ (C * Ac) - 1 / 8, b @ (A @ C**2) - 1 / 12, b @ (A @ Ac) - 1 / 24],
        5: [
            b @ C**4 - 1 / 5,
            b @ (C**2 * Ac) - 1 / 10,
            b @ (Ac**2) - 1 / 20,
            b @ (C * (A @ C**2)) - 1 / 15,
            b @ (A @ C**3) - 1 / 20,
            b @ (C * (A @ Ac)) - 1 / 30,
            b @ (A @ (C * Ac)) - 1 / 40,
            b @ (A @ (A @ C**2)) - 1 / 60,
            b @ (A @ (A @ Ac)) - 1 / 120,
        ],
    }


def test_solution_is_of_order_5():
    assert np.concatenate(list(order_conditions(B).values())) == approx(0.0, abs=1e-14)


def test_embedded_solution_is_of_order_4_and_not_5():
    conditions = order_conditions(B - ERROR)
    assert np.concatenate([conditions[p] for p in (1, 2, 3, 4)]) == approx(0.0, abs=1e-14)
    assert max(map(abs, conditions[5])) > 1e-5


def in_flight(rtol: float) -> Landing:
    """A vehicle turning fast in free flight, its struts ringing: smooth, no contact."""
    values = {"drop.contact_time": 0.5, "drop.pitch_rate": 2.0, "drop.vertical_velocity": -12.0, "main_strut.seal_coulomb": 0.0}
    return Landing(load_preset("yue2022-figures").with_values(values), rtol=rtol)


def test_error_falls_with_the_tolerance_on_a_smooth_arc():
    def state(rtol):
        landing = in_flight(rtol)
        landing.advance_to(0.2)
        return np.array([landing.get("body.x"), landing.get("body.y"), landing.get("body.pitch")])

    reference = state(1e-11)
    errors = [float(np.abs(state(rtol) - reference).max()) for rtol in (1e-4, 1e-6, 1e-8)]
    assert errors[0] > errors[2]
    assert errors[1] < 1e-6
    assert errors[2] < 1e-8


def test_dense_output_meets_both_ends_of_a_step_and_is_smooth_between():
    landing: LandingType = Landing()
    solver = landing._solver
    solver.advance(0.1)
    n = solver.n
    from array import array

    end = array("d", bytes(8 * n))
    solver.interpolate(solver.t, end)
    assert np.array(end) == approx(np.array(solver.y), rel=1e-13, abs=1e-12)
    before = array("d", bytes(8 * n))
    solver.interpolate(solver.t_old, before)
    solver.advance(solver.t + 1e-9)
    after = array("d", bytes(8 * n))
    solver.interpolate(solver.t_old, after)
    assert np.array(after) == approx(np.array(end), rel=1e-13, abs=1e-12)


PROBE = """
import sys
from rlv_landing import Landing, core, load_preset
landing = Landing(load_preset("yue2022-figures"), sys.argv[1])
values = []
for time in (0.1, 0.15, 0.26, 0.4):
    landing.advance_to(time)
    values += landing.values()
landing.set_inputs({"ground.heave": 1e-4, "ground.heave_rate": 0.1, "external.moment": 30.0})
landing.advance_to(0.45)
print(core.COMPILED)
print(" ".join(float(v).hex() for v in [*values, *landing.values(), *landing.state()]))
"""


def probe(mode: str, pure: str) -> list[str]:
    environment = {**os.environ, "RLV_LANDING_PURE": pure}
    done = subprocess.run([sys.executable, "-c", PROBE, mode], capture_output=True, text=True, env=environment, timeout=120, check=True)
    return done.stdout.splitlines()


def test_compiled_and_pure_core_give_the_same_digits(mode):
    compiled, pure = probe(mode, "0"), probe(mode, "1")
    assert compiled[0] == "True", "the core is not compiled here: run make"
    assert pure[0] == "False"
    assert compiled[1] == pure[1]


@pytest.mark.skipif(not core.COMPILED, reason="measured on the pure core")
def test_compiled_core_is_made_from_the_present_kernels():
    sys.path.insert(0, str(core.__path__[0]) + "/../..")
    try:
        from core_source import digest
    finally:
        sys.path.pop(0)
    from rlv_landing.core import compiled

    assert digest() == compiled.SOURCE_DIGEST, "the kernels have changed since: run make"
