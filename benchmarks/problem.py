"""The benchmarks' problem: a 1 s landing of the default preset in one mode, and a solution's error.

The error is defined alike for every solver. A solution is the state that the solver's own dense
output gives every millisecond; the core computes the loads from it. The error of the peaks is the
largest relative deviation of any peak from the reference. Peaks are the largest and smallest main
strut force and auxiliary strut force and the largest main strut stroke of every leg group, in parts
of the largest absolute value of that force or stroke. The error of the strokes is the largest
difference of any main strut stroke at any time [m].
"""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from c_landing import core_states

from rlv_landing import Landing, load_preset
from rlv_landing.assembly import new_solver
from rlv_landing.core import Solver
from rlv_landing.landing import METHODS
from rlv_landing.quantities import LEG_QUANTITIES, MODES, SHARED_QUANTITIES

UNTIL = 1.0
TIMES = 1e-3 * np.arange(1001)
PRESET = "yue2022-figures"
REFERENCE_RTOL = 1e-11
SAMPLED = ("main_strut.force", "auxiliary_strut.force", "main_strut.stroke")
COLUMNS = [[q.name for q in LEG_QUANTITIES].index(name) for name in SAMPLED]


@dataclass(frozen=True)
class Error:
    """Error of a solution.

    `peaks` is the largest relative deviation of any peak, `stroke` the largest stroke error [m].
    """

    peaks: float
    stroke: float


def error(series: np.ndarray, reference: np.ndarray) -> Error:
    """Error of `series` [force, force, stroke; leg group; time] against the `reference`."""
    largest = np.abs(reference).max(axis=2)
    high = np.abs(series.max(axis=2) - reference.max(axis=2)) / largest
    low = np.abs(series.min(axis=2) - reference.min(axis=2)) / largest
    return Error(
        max(float(high.max()), float(low[:2].max())), float(np.abs(series[2] - reference[2]).max())
    )


class Problem:
    """The landing in `mode`: the start for other solvers, and the error of their solutions.

    `state` is the start without the energy integrals, which no other state depends on. `scale` and
    `relative` are the core's measures of error for it.
    """

    def __init__(self, mode: str) -> None:
        self.mode = mode
        self.groups = len(MODES[mode])
        self.solver = self.new_solver()
        self.n, self.m = self.solver.n, self.solver.system.controlled
        self.state = np.array(self.solver.y)[: self.m]
        self.scale = np.array(self.solver.system.scale)[: self.m]
        self.relative = np.array(self.solver.system.relative)[: self.m]

    def landing(self, rtol: float = 1e-5, method: str = "exponential") -> Landing:
        """A new landing."""
        return Landing(load_preset(PRESET), self.mode, rtol, method)

    def new_solver(self, rtol: float = 1e-5, method: str = "exponential") -> Solver:
        """The kernels of a new landing."""
        return new_solver(load_preset(PRESET, self.mode), rtol, METHODS[method])

    def series(self, states: np.ndarray) -> np.ndarray:
        """Loads and strokes as [force, force, stroke; leg group; time].

        Args:
            states: One row for each of TIMES, with or without the energy integrals.
        """
        y, size = array("d", bytes(8 * self.n)), len(LEG_QUANTITIES)
        out = array("d", bytes(8 * (len(SHARED_QUANTITIES) + size * self.groups)))
        rows = np.empty((len(states), self.groups, len(COLUMNS)))
        for row, state in zip(rows, states):
            y[: len(state)] = array("d", state)
            self.solver.outputs_at(0.0, y, out)
            row[:] = np.array(out[len(SHARED_QUANTITIES) :]).reshape(self.groups, size)[:, COLUMNS]
        return rows.transpose(2, 1, 0)

    @cached_property
    def reference(self) -> np.ndarray:
        """The `series` at tolerance 1e-11."""
        return self.series(core_states(self.new_solver(REFERENCE_RTOL), TIMES))

    def error(self, states: np.ndarray) -> Error:
        """Error of the `states` at TIMES."""
        return error(self.series(states), self.reference)
