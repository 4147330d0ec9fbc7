"""Solvers by others on the core's compiled right-hand side, and MuJoCo's model of the vehicle.

Solvers in Python call `Solver.derivatives` through one Python function that copies the state in and
the derivatives out. All integrate without the energy integrals, with the core's absolute tolerances
and its longest step. Only the core clamps the friction displacements to their limit after a step.
The others continue with what they have gathered beyond it, which shows in their errors.
"""

from __future__ import annotations

import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import numpy as np
from cvode_in_c import ADAMS, BDF, CvodeInC
from peers import Peer, Task
from problem import PRESET, TIMES, UNTIL, Error, Problem, error
from rows import HERE
from scipy.integrate import odeint, solve_ivp
from sksundae.cvode import CVODE

from rlv_landing import load_preset
from rlv_landing.core.solvers.solver import LONGEST_STEP

sys.path.insert(0, str(HERE.parent / "tests" / "independent"))
import mujoco
from mujoco_vehicle import DAMPING, STIFFNESS, build

TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 3e-7, 1e-7, 1e-8)
FEW_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 3e-7)
LSODA_TOLERANCES = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6)
# limits after which a landing is abandoned
MOST_STEPS, MOST_SECONDS = 500_000, 3.0
# times at which a plain landing is read
ENDS = np.array([0.0, 0.5 * UNTIL, UNTIL])
# MuJoCo: time constant [s] and damping ratio of its contact, about those of 4.2 kg on the model's
# ground under 4 kN
CONTACT = (1.5e-3, 1.0)
TIME_STEPS = (5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)
REFERENCE_STEP = 2e-6
IMPLICIT, RK4 = mujoco.mjtIntegrator.mjINT_IMPLICITFAST, mujoco.mjtIntegrator.mjINT_RK4

Solve = Callable[["RightHandSide", np.ndarray, float], np.ndarray]


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise TimeoutError in a block that takes more than `seconds` of processor time."""

    def stop(number: int, frame: object) -> None:
        raise TimeoutError(f"no end after {seconds:g} s of processor time")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


class RightHandSide:
    """The core's right-hand side for solvers in Python.

    `derivatives(t, y)` returns a new array, `fill_derivatives(t, y, dy)` writes to one.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.solver = problem.new_solver()
        self.start = self.solver.rhs_calls
        m = problem.m
        y, dy = np.zeros(problem.n), np.zeros(problem.n)
        head, found, core_derivatives = y[:m], dy[:m], self.solver.derivatives

        def derivatives(t: float, state: Any) -> np.ndarray:
            head[:] = state
            core_derivatives(t, y, dy)
            return found.copy()

        def fill_derivatives(t: float, state: Any, target: Any) -> None:
            head[:] = state
            core_derivatives(t, y, dy)
            target[:] = found

        self.derivatives, self.fill_derivatives = derivatives, fill_derivatives

    def jacobian(self, t: float, state: np.ndarray) -> np.ndarray:
        """Jacobian by forward differences.

        scipy's own increments overflow: they grow without bound for a state that changes nothing.
        """
        y, m, scale = state.copy(), self.problem.m, self.problem.scale
        increments = 1.5e-8 * np.maximum(np.abs(y), scale)
        matrix, base = np.empty((m, m)), self.derivatives(t, y)
        for i in range(m):
            y[i] += increments[i]
            matrix[:, i] = self.derivatives(t, y)
            y[i] = state[i]
        matrix -= base[:, None]
        matrix /= increments
        return matrix

    def calls(self) -> int:
        """Number of calls so far."""
        return int(self.solver.rhs_calls - self.start)


def by_scipy(method: str) -> Solve:
    """A method of `solve_ivp`."""

    def solve(f: RightHandSide, times: np.ndarray, rtol: float) -> np.ndarray:
        options: dict[str, Any] = {"jac": f.jacobian} if method in ("Radau", "BDF") else {}
        p = f.problem
        options |= {"rtol": rtol, "atol": rtol * p.scale, "max_step": LONGEST_STEP}
        done = solve_ivp(f.derivatives, (0.0, UNTIL), p.state, method, times, **options)
        if not done.success:
            raise ArithmeticError(done.message)
        return done.y.T

    return solve


def by_odeint(f: RightHandSide, times: np.ndarray, rtol: float) -> np.ndarray:
    """LSODA with its loop in compiled code."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        atol = rtol * f.problem.scale
        return odeint(
            f.derivatives,
            f.problem.state,
            times,
            tfirst=True,
            rtol=rtol,
            atol=atol,
            hmax=LONGEST_STEP,
            mxstep=MOST_STEPS,
        )


def by_sundae(method: str) -> Solve:
    """CVODE by scikit-sundae, with its dense Newton iteration."""

    def solve(f: RightHandSide, times: np.ndarray, rtol: float) -> np.ndarray:
        p = f.problem
        solver = CVODE(
            f.fill_derivatives,
            method=method,
            rtol=rtol,
            atol=rtol * p.scale,
            max_step=LONGEST_STEP,
            max_num_steps=MOST_STEPS,
        )
        done = solver.solve(times, p.state)
        if not done.success:
            raise ArithmeticError(done.message)
        return done.y

    return solve


def in_python(name: str, solve: Solve, tolerances: tuple[float, ...] = TOLERANCES) -> Peer:
    """A solver that calls the compiled right-hand side from Python."""

    def task(problem: Problem, rtol: float) -> Task:
        f = RightHandSide(problem)
        return Task(lambda: limited(f, ENDS, rtol), f.calls)

    def deviation(problem: Problem, rtol: float) -> Error:
        return problem.error(limited(RightHandSide(problem), TIMES, rtol))

    def limited(f: RightHandSide, times: np.ndarray, rtol: float) -> np.ndarray:
        with time_limit(MOST_SECONDS):
            return solve(f, times, rtol)

    return Peer(name, "other", tolerances, task, deviation)


def cvode_in_c(name: str, method: int) -> Peer:
    """CVODE on the right-hand side of `c_landing.c`, with no Python in its loop."""

    def solver(problem: Problem, rtol: float) -> CvodeInC:
        return CvodeInC(problem, rtol, method, LONGEST_STEP, MOST_STEPS)

    def task(problem: Problem, rtol: float) -> Task:
        cvode = solver(problem, rtol)
        return Task(lambda: cvode.advance(UNTIL), cvode.calls)

    return Peer(
        name,
        "C",
        TOLERANCES,
        task,
        lambda problem, rtol: problem.error(solver(problem, rtol).states(TIMES)),
    )


class MujocoLanding:
    """The vehicle of `tests/independent/mujoco_vehicle.py` on MuJoCo's own contact.

    Args:
        problem: The landing.
        step: Time step [s].
        integrator: One of MuJoCo's.
    """

    def __init__(self, problem: Problem, step: float, integrator: int = IMPLICIT) -> None:
        self.parameters = load_preset(PRESET, problem.mode)
        self.model = build(self.parameters, step, CONTACT)
        self.model.opt.integrator = integrator
        self.model.opt.tolerance = 1e-8  # MuJoCo's default, and enough here
        self.data = mujoco.MjData(self.model)
        x, y, pitch, vx, vy, rate = problem.state[:6]
        self.data.qpos[:7] = [x, y, 0.0, np.cos(-0.5 * pitch), 0.0, 0.0, np.sin(-0.5 * pitch)]
        self.data.qvel[:6] = [vx, vy, 0.0, 0.0, 0.0, -rate]
        self.every = round(1e-3 / step)

    def land(self) -> None:
        """All steps in one call."""
        mujoco.mj_step(self.model, self.data, (len(TIMES) - 1) * self.every)

    def series(self) -> np.ndarray:
        """[force, force, stroke; leg; time] of a landing."""
        data, a = self.data, self.parameters.auxiliary_strut
        joints = [self.model.joint(f"slide{i}") for i in range(4)]
        at, rates = [j.qposadr[0] for j in joints], [j.dofadr[0] for j in joints]
        rows = np.empty((len(TIMES), 3, 4))
        for k, row in enumerate(rows):
            if k > 0:
                mujoco.mj_step(self.model, data, self.every)
            mujoco.mj_forward(self.model, data)
            stroke = self.parameters.main_strut.length - data.ten_length
            row[0] = -(STIFFNESS * stroke - DAMPING * data.ten_velocity)
            row[1] = -(a.stiffness * data.qpos[at] + a.damping * data.qvel[rates])
            row[2] = stroke
        return rows.transpose(1, 2, 0)


@cache
def mujoco_reference(problem: Problem) -> np.ndarray:
    """MuJoCo's own landing at a far smaller step."""
    return MujocoLanding(problem, REFERENCE_STEP).series()


def by_mujoco(name: str, integrator: int, steps: tuple[float, ...]) -> Peer:
    """MuJoCo; its error is against its own reference, its calls are steps."""

    def task(problem: Problem, step: float) -> Task:
        landing = MujocoLanding(problem, step, integrator)
        return Task(landing.land, lambda: round(UNTIL / step))

    def deviation(problem: Problem, step: float) -> Error:
        return error(MujocoLanding(problem, step, integrator).series(), mujoco_reference(problem))

    return Peer(name, "simulator", steps, task, deviation)


OTHERS = (
    cvode_in_c("C, CVODE BDF", BDF),
    cvode_in_c("C, CVODE Adams", ADAMS),
    in_python("CVODE BDF by scikit-sundae", by_sundae("BDF")),
    in_python("CVODE Adams by scikit-sundae", by_sundae("Adams")),
    in_python("LSODA by scipy's odeint", by_odeint, LSODA_TOLERANCES),
    in_python("LSODA by scipy's solve_ivp", by_scipy("LSODA"), LSODA_TOLERANCES),
    in_python("RK45 by scipy", by_scipy("RK45"), FEW_TOLERANCES),
    in_python("Radau by scipy", by_scipy("Radau"), FEW_TOLERANCES),
    in_python("BDF by scipy", by_scipy("BDF"), FEW_TOLERANCES),
    by_mujoco("MuJoCo, implicitfast", IMPLICIT, TIME_STEPS),
    by_mujoco("MuJoCo, RK4", RK4, TIME_STEPS[:-2]),
)
