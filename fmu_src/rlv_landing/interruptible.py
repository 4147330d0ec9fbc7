"""A solver goes on in short calls, between which Python handles signals.

So Ctrl-C also ends a step that takes hours, and none is lost.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from .core import Fault, Solver
from .core.memory import Buffer
from .errors import OffGroundError, StepLimitError, StepSizeError

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

# tries of a step in a call: some 20 ms
TRIES = 10_000
# the parameter that limits the steps
LIMIT = "solver.max_steps_per_second"


def view(numbers: Buffer) -> memoryview:
    """A view of an array that the solver keeps, for Python to iterate and to copy.

    An array of the compiled core ends an iteration with an exception, and Cython drops a Ctrl-C
    that comes while it records that. A view does not.
    """
    return memoryview(cast("Any", numbers))


def check_going(solver: Solver) -> None:
    """Check that the solver can go on.

    Raises:
        IntegrationError: It cannot.
    """
    s = solver
    if s.fault == Fault.COLLAPSED:
        raise StepSizeError(
            f"the integrator's step size has collapsed at t = {s.t:g} s; "
            "soften the parameters or the loads"
        )
    if s.fault == Fault.OFF_GROUND:
        raise OffGroundError(
            f"a footpad or a point of the body is beyond the height field ground.terrain at "
            f"t = {s.t:g} s; give a larger field, or land nearer to its middle"
        )
    if s.fault == Fault.TOO_MANY_STEPS:
        raise StepLimitError(
            f"the integrator takes more than {LIMIT} = {s.limit:g} 1/s at t = {s.t:g} s; "
            "soften the parameters, loosen rtol, or raise the limit"
        )


def advance(solver: Solver, time: float) -> None:
    """Take the solver to or past `time` [s].

    Raises:
        IntegrationError: The solver cannot go on.
    """
    check_going(solver)
    while not solver.advance_some(time, TRIES):
        check_going(solver)


def record(
    solver: Solver, rows: NDArray[float64], start: float, every: float, first: int, last: int
) -> None:
    """Write the outputs at start + k every [s], k from `first` to `last` - 1, to `rows`.

    Raises:
        IntegrationError: The solver cannot go on.
    """
    while first < last:
        check_going(solver)
        first = solver.record_some(start, every, first, last, rows, TRIES)
