"""A solver taken on in stints, between which Python looks at signals: Ctrl-C acts in the midst of a
step that takes hours.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from .core import Fault, Solver
from .errors import StepLimitError, StepSizeError

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

# tries of a step in a stint: some 20 ms
STINT = 10_000
# samples between two calls of `progress`
SLICE = 250
# the parameter that limits the steps
LIMIT = "solver.max_steps_per_second"


def check_going(solver: Solver) -> None:
    """Raise IntegrationError if the solver cannot go on."""
    s = solver
    if s.fault == Fault.COLLAPSED:
        raise StepSizeError(
            f"the integrator's step size has collapsed at t = {s.t:g} s; soften the parameters or the loads"
        )
    if s.fault == Fault.TOO_MANY_STEPS:
        raise StepLimitError(
            f"the integrator takes more than {LIMIT} = {s.limit:g} 1/s at t = {s.t:g} s; "
            "soften the parameters, loosen rtol, or raise the limit"
        )


def advance(solver: Solver, time: float) -> None:
    """Take the solver to or past `time` [s]. Raises IntegrationError."""
    check_going(solver)
    while not solver.advance_some(time, STINT):
        check_going(solver)


def record(
    solver: Solver,
    rows: NDArray[float64],
    start: float,
    every: float,
    samples: int,
    progress: Callable[[float], object],
) -> None:
    """Write the outputs at so many `samples` from `start` [s] on, `every` [s], to `rows`; call
    `progress` with the time reached every SLICE samples.

    Raises IntegrationError.
    """
    reached = 0
    while reached < samples:
        goal = min(reached + SLICE, samples)
        while reached < goal:
            check_going(solver)
            reached = solver.record_some(start, every, reached, goal, rows, STINT)
        progress(start + (goal - 1) * every)
