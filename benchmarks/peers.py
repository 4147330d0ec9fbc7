"""The solvers that are compared, each a `Peer`.

A peer has a plain landing, whose time is measured, and the error of a landing with the same steps.
Here are the project's own solvers and the landing in C; `other_solvers.py` has the others.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from ctypes import c_double, c_uint
from dataclasses import dataclass
from functools import cache
from typing import Any

import fmpy
import numpy as np
from c_landing import EXACT, FAST, CLanding, core_states
from fmpy.fmi2 import FMU2Slave
from problem import PRESET, SAMPLED, TIMES, UNTIL, Error, Problem, error
from rows import FMU

from rlv_landing import load_preset
from rlv_landing.assembly import new_solver
from rlv_landing.core.bodies.planar import Planar as PurePlanar
from rlv_landing.core.solvers.exponential import Exponential as PureExponential
from rlv_landing.quantities import MODES

TOLERANCES = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7)
# of solvers too slow to be run at each
FEW_TOLERANCES = (1e-3, 1e-4, 1e-5)


@dataclass(frozen=True)
class Task:
    """One landing, ready to start.

    `land()` is timed. `calls()` returns its right-hand sides (or steps) afterwards.
    """

    land: Callable[[], object]
    calls: Callable[[], int]


@dataclass(frozen=True)
class Peer:
    """A solver to compare.

    `task(problem, tolerance)` is its plain landing; `error(problem, tolerance)` is the error of a
    landing with the same steps. `kind` groups the curves: ours, C, other or simulator.
    """

    name: str
    kind: str
    tolerances: tuple[float, ...]
    task: Callable[[Problem, float], Task]
    error: Callable[[Problem, float], Error]


def core(name: str, method: str) -> Peer:
    """The compiled core by one of its methods."""

    def task(problem: Problem, rtol: float) -> Task:
        landing = problem.landing(rtol, method)
        return Task(lambda: landing.advance_to(UNTIL), lambda: landing.statistics["rhs_calls"])

    return Peer(
        name,
        "ours",
        TOLERANCES,
        task,
        lambda problem, rtol: problem.error(core_states(problem.new_solver(rtol, method), TIMES)),
    )


def cores_error(problem: Problem, rtol: float) -> Error:
    """The error of the compiled core, for those that give its digits."""
    return problem.error(core_states(problem.new_solver(rtol), TIMES))


def sampled(problem: Problem, rtol: float) -> Task:
    """The compiled core with all outputs every millisecond, as a user runs it."""
    landing = problem.landing(rtol)
    return Task(lambda: landing.run(UNTIL, 1e-3), lambda: landing.statistics["rhs_calls"])


def pure(problem: Problem, rtol: float) -> Task:
    """The core uncompiled."""
    solver = new_solver(load_preset(PRESET, problem.mode), rtol, PureExponential, PurePlanar)
    return Task(lambda: solver.advance(UNTIL), lambda: int(solver.rhs_calls))


def in_c(name: str, options: tuple[str, ...]) -> Peer:
    """The landing in C, compiled with `options`."""

    def task(problem: Problem, rtol: float) -> Task:
        landing = CLanding(problem.landing().parameters, rtol, options)
        return Task(lambda: landing.advance(UNTIL), lambda: landing.statistics()["rhs_calls"])

    def deviation(problem: Problem, rtol: float) -> Error:
        return problem.error(CLanding(problem.landing().parameters, rtol, options).states(TIMES))

    return Peer(name, "C", TOLERANCES, task, deviation)


@cache
def unpacked() -> tuple[Any, tempfile.TemporaryDirectory[str]]:
    """The FMU's description, and the folder of its files."""
    folder = tempfile.TemporaryDirectory(prefix="rlv_landing_")
    fmpy.extract(str(FMU), folder.name)
    return fmpy.read_model_description(str(FMU)), folder


class Slave:
    """An FMU at the start of a landing, called through FMPy."""

    def __init__(self, problem: Problem, rtol: float) -> None:
        description, folder = unpacked()
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        name = description.coSimulation.modelIdentifier
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder.name,
            modelIdentifier=name,
            instanceName="bench",
        )
        self.slave.instantiate()
        self.slave.setupExperiment(tolerance=rtol, startTime=0.0)
        for key, value in load_preset(PRESET, problem.mode).items():
            if key.startswith("drop."):
                (self.slave.setString if isinstance(value, str) else self.slave.setReal)(
                    [self.references[key]], [value]
                )
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def __del__(self) -> None:
        self.slave.terminate()
        self.slave.freeInstance()

    def land(self) -> None:
        """1000 steps of 1 ms."""
        step, component = self.slave.fmi2DoStep, self.slave.component
        for k in range(len(TIMES) - 1):
            step(component, TIMES[k], 1e-3, 1)

    def series(self, problem: Problem) -> np.ndarray:
        """A landing as [force, force, stroke; leg group; time]."""
        legs = [group.legs[0][0] for group in MODES[problem.mode]]
        chosen = [self.references[f"leg[{leg}].{name}"] for name in SAMPLED for leg in legs]
        references, values = (c_uint * len(chosen))(*chosen), (c_double * len(chosen))()
        rows = np.empty((len(TIMES), len(chosen)))
        for k, row in enumerate(rows):
            if k > 0:
                self.slave.fmi2DoStep(self.slave.component, TIMES[k - 1], 1e-3, 1)
            self.slave.fmi2GetReal(self.slave.component, references, len(chosen), values)
            row[:] = values
        return rows.T.reshape(len(SAMPLED), len(legs), len(TIMES))


def fmu(problem: Problem, rtol: float) -> Task:
    """The FMU by FMPy in 1000 steps, with no output read."""
    slave, landing = Slave(problem, rtol), problem.landing(rtol)
    landing.advance_to(UNTIL)
    return Task(slave.land, lambda: landing.statistics["rhs_calls"])


OURS = (
    core("core, exponential", "exponential"),
    core("core, Dormand-Prince", "dormand-prince"),
    Peer(
        "core, exponential, 1001 samples of all outputs", "ours", TOLERANCES, sampled, cores_error
    ),
    Peer(
        "FMU by FMPy, 1000 steps",
        "ours",
        TOLERANCES,
        fmu,
        lambda p, rtol: error(Slave(p, rtol).series(p), p.reference),
    ),
    Peer("pure core, exponential", "ours", FEW_TOLERANCES, pure, cores_error),
    in_c("C, exponential, gcc -O3", EXACT),
    in_c("C, exponential, gcc -O3 -march=native -ffast-math", FAST),
)
