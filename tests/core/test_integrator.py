"""Integration methods: order conditions, convergence, stiffness.

Compiled and pure core give the same digits.
"""

import os
import subprocess
import sys
import threading
import time
from array import array
from concurrent.futures import ThreadPoolExecutor
from math import exp, factorial

import numpy as np
import pytest
from pytest import approx
from scipy.integrate import quad

from rlv_landing import Landing, Parameters, core, load_preset
from rlv_landing.assembly import new_solver
from rlv_landing.core.access import BODY, LEG, leg_state
from rlv_landing.core.records import Fault
from rlv_landing.core.solvers import dormand_prince as dp
from rlv_landing.core.solvers.phi import SMALL, phi1, phi2, phi3
from rlv_landing.landing import DEFAULT_RTOL, METHODS
from rlv_landing.quantities import MODES

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
    """Left side minus right side of every order condition up to order 5, by order.

    Source: Hairer, Norsett, Wanner, II.2.
    """
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


@pytest.mark.parametrize("z", [0.0, 1e-9, 1e-3, SMALL, 0.11, 0.4, 3.0, 80.0])
def test_the_exponential_methods_functions_are_their_integrals(z):
    """phi_k(-z) is the integral over [0, 1] of exp(-(1 - x) z) x^(k - 1)/(k - 1)!."""
    f1, f2 = phi1(z), phi2(z, phi1(z))
    for k, ours in ((1, f1), (2, f2), (3, phi3(z, f2))):
        wanted, _ = quad(
            lambda x, k=k: exp(-(1.0 - x) * z) * x ** (k - 1) / factorial(k - 1),
            0.0,
            1.0,
            epsabs=1e-13,
        )
        assert ours == approx(wanted, rel=1e-12)


def test_the_methods_agree(mode):
    """To what friction lets any two solvers agree in; see `convergence`."""
    ours, papers = (
        Landing(load_preset("yue2022-figures"), mode, 1e-8, method) for method in METHODS
    )
    for t in (0.15, 0.3, 0.6):
        ours.advance_to(t)
        papers.advance_to(t)
        for name in (
            "body.x",
            "body.y",
            "body.pitch",
            "leg[1].main_strut.stroke",
            "leg[3].main_strut.stroke",
        ):
            assert ours.get(name) == approx(papers.get(name), abs=1e-6)


def test_a_stiff_orifice_does_not_hold_the_exponential_method():
    """A tenth of the laminar pressure makes a chamber three times as stiff at rest."""

    def work(method, laminar_pressure):
        values = {"main_strut.laminar_pressure": laminar_pressure}
        landing = Landing(
            load_preset("yue2022-figures").with_values(values), rtol=1e-4, method=method
        )
        landing.advance_to(1.0)
        return landing.statistics["rhs_calls"]

    assert work("exponential", 1e4) < 1.3 * work("exponential", 1e5)
    assert work("dormand-prince", 1e4) > 1.8 * work("dormand-prince", 1e5)


def test_friction_displacements_of_the_papers_law_never_pass_the_slip_limit(mode):
    parameters = load_preset("yue2022-figures", mode).with_values({"ground.friction_law": "paper"})
    solver, limit = new_solver(parameters, 1e-3), parameters.ground.stick_displacement
    reached = 0.0
    while solver.t < 0.5:
        solver.advance(solver.t + 1e-6)
        for i in range(len(MODES[mode])):
            leg = leg_state(solver.y, BODY + LEG * i)
            reached = max(reached, abs(leg.q1), abs(leg.q2))
    assert reached == limit


def in_flight(rtol: float, method: str) -> Landing:
    """A vehicle turning fast in free flight, its struts ringing: smooth, no contact."""
    values = {
        "drop.contact_time": 0.5,
        "drop.pitch_rate": 2.0,
        "drop.vertical_velocity": -12.0,
        "main_strut.seal_coulomb": 0.0,
    }
    return Landing(load_preset("yue2022-figures").with_values(values), rtol=rtol, method=method)


@pytest.mark.parametrize("method", METHODS)
def test_error_falls_with_the_tolerance_on_a_smooth_arc(method):
    def state(rtol, method=method):
        landing = in_flight(rtol, method)
        landing.advance_to(0.2)
        return np.array([landing.get("body.x"), landing.get("body.y"), landing.get("body.pitch")])

    reference = state(1e-11, "dormand-prince")
    errors = [float(np.abs(state(rtol) - reference).max()) for rtol in (1e-4, 1e-6, 1e-8)]
    assert errors[0] > errors[2]
    assert errors[1] < 1e-6
    assert errors[2] < 1e-8


@pytest.mark.parametrize("method", METHODS)
def test_dense_output_meets_both_ends_of_a_step_and_is_smooth_between(method):
    solver = new_solver(Parameters(), DEFAULT_RTOL, METHODS[method])
    solver.advance(0.1)
    n = solver.n
    end = array("d", bytes(8 * n))
    solver.interpolate(solver.t, end)
    assert np.array(end) == approx(np.array(solver.y), rel=1e-12, abs=1e-12)
    before = array("d", bytes(8 * n))
    solver.interpolate(solver.t_old, before)
    solver.advance(solver.t + 1e-9)
    after = array("d", bytes(8 * n))
    solver.interpolate(solver.t_old, after)
    assert np.array(after) == approx(np.array(end), rel=1e-13, abs=1e-12)


PROBE = """
import sys
from rlv_landing import Landing, core, load_preset
landing = Landing(load_preset("yue2022-figures"), sys.argv[1], method=sys.argv[2])
values = []
for time in (0.1, 0.15, 0.26, 0.4):
    landing.advance_to(time)
    values += landing.values()
landing.set_inputs({"ground.heave": 1e-4, "ground.heave_rate": 0.1, "external.moment": 30.0})
landing.advance_to(0.45)
print(core.COMPILED)
values += [*landing.values(), *landing.state()]
values += [v for e in landing.extremes().values() for v in e]
span = landing.run(0.46).extremes
print(" ".join(float(v).hex() for v in [*values, *(v for e in span.values() for v in e)]))
"""


def probe(mode: str, method: str, pure: str) -> list[str]:
    environment = {**os.environ, "RLV_LANDING_PURE": pure}
    done = subprocess.run(
        [sys.executable, "-c", PROBE, mode, method],
        capture_output=True,
        text=True,
        env=environment,
        timeout=120,
        check=True,
    )
    return done.stdout.splitlines()


@pytest.mark.parametrize("method", METHODS)
def test_compiled_and_pure_core_give_the_same_digits(mode, method):
    compiled, pure = probe(mode, method, "0"), probe(mode, method, "1")
    assert compiled[0] == "True", "the core is not compiled here: run make"
    assert pure[0] == "False"
    assert compiled[1] == pure[1]


@pytest.mark.skipif(not core.COMPILED, reason="measured on the pure core")
def test_other_threads_run_during_a_run():
    """A long run releases Python's lock.

    The interpreter does not switch threads by itself here, so the other thread, which stops the
    run, continues only while the core has released the lock.
    """
    solver = new_solver(Parameters(), DEFAULT_RTOL)
    solver.u_rate[0] = 1e-3  # under a load that grows, nothing rests
    rows = np.empty(4 * solver.system.row)
    waiting, running = threading.Event(), threading.Event()

    def other():
        waiting.set()
        while not running.is_set():
            time.sleep(0.0)
        solver.limit = 0.0

    usual = sys.getswitchinterval()
    thread = threading.Thread(target=other)
    thread.start()
    try:
        waiting.wait()
        sys.setswitchinterval(1000.0)
        running.set()
        reached = solver.record(0.0, 1e3, 0, 4, rows)
    finally:
        sys.setswitchinterval(usual)
        running.set()
        thread.join()
    assert reached < 4
    assert solver.fault == Fault.TOO_MANY_STEPS


def test_landings_in_several_threads_are_the_same_as_one_by_one(mode):
    def land(slope):
        parameters = load_preset("yue2022-figures", mode).with_values({"ground.slope": slope})
        return Landing(parameters, rtol=1e-4).run(0.3).data

    slopes = np.linspace(-0.1, 0.1, 8).tolist()
    with ThreadPoolExecutor(4) as pool:
        assert all(map(np.array_equal, pool.map(land, slopes), map(land, slopes)))


@pytest.mark.skipif(not core.COMPILED, reason="measured on the pure core")
def test_compiled_core_is_made_from_the_present_kernels():
    sys.path.insert(0, str(core.__path__[0]) + "/../..")
    try:
        from fmu_build.core_source import source_hashes
    finally:
        sys.path.pop(0)
    from rlv_landing.core import compiled

    assert source_hashes() == compiled.SOURCES, "the kernels have changed since: run make"
