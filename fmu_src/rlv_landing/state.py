"""The state of a landing as numbers: its time, and all that its solver keeps."""

from __future__ import annotations

from array import array
from math import isfinite
from typing import NamedTuple

from .core import Solver
from .core.memory import Buffer
from .errors import LandingError


class StateHeader(NamedTuple):
    """What a state begins with: the landing's time, and what the solver keeps beside its arrays."""

    time: float  # [s]
    t: float  # end of the last internal step [s]
    t_old: float  # its start [s]
    t_before: float  # and that of the step before [s]
    t_start: float  # when extremes began to be kept [s]
    t_input: float  # when the inputs were set [s]
    h: float  # the next internal step [s]
    error_old: float  # error of the last step, in units of the tolerance
    energy_start: float  # [J]
    steps: float
    rejected: float
    rhs_calls: float
    dense_at: float  # where the last step's interpolant begins
    seen: float  # see `rlv_landing.core.solvers.watch`
    noted: float
    heave: float  # of the ground at t_input, as it was set [m]
    tilt: float  # of the ground at t_input, as it was set [rad]


def _arrays(solver: Solver) -> tuple[Buffer, ...]:
    """What a state holds after its header."""
    s = solver
    return (s.u, s.u_rate, s.y, s.dense, s.kept, s.before, s.middle, s.last)


def state_of(
    solver: Solver, time: float, energy_start: float, goal: tuple[float, float]
) -> array[float]:
    """The state of a landing.

    Args:
        solver: The landing's solver.
        time: The landing's time [s].
        energy_start: The system's energy at the start [J].
        goal: Heave [m] and tilt [rad] of the ground as they were set.
    """
    s = solver
    header = StateHeader(
        time,
        s.t,
        s.t_old,
        s.t_before,
        s.t_start,
        s.t_input,
        s.h,
        s.error_old,
        energy_start,
        s.steps,
        s.rejected,
        s.rhs_calls,
        float(s.dense_at),
        float(s.seen),
        float(s.noted),
        *goal,
    )
    return array("d", [*header, *(number for numbers in _arrays(s) for number in numbers)])


def take_up(solver: Solver, state: array[float]) -> StateHeader:
    """Give the `solver` the state; return its header.

    Raises:
        LandingError: The length is not that of this solver's state, or a number is not finite.
    """
    s, targets = solver, _arrays(solver)
    at = len(StateHeader._fields)
    expected = at + sum(map(len, targets))
    if len(state) != expected:
        raise LandingError(
            f"state has {len(state)} numbers, this landing's has {expected}; "
            "it comes from another mode or version"
        )
    if not all(map(isfinite, state)):
        raise LandingError("state holds numbers that are not finite; take one that state() gave")
    header = StateHeader(*state[:at])
    s.t, s.t_old, s.t_before, s.t_start = header.t, header.t_old, header.t_before, header.t_start
    s.t_input, s.h = header.t_input, header.h
    s.dense_at, s.seen, s.noted = int(header.dense_at), int(header.seen), bool(header.noted)
    for target in targets:
        for i in range(len(target)):
            target[i] = state[at + i]
        at += len(target)
    s.recompute_derived()
    s.error_old, s.steps, s.rejected, s.rhs_calls = (
        header.error_old,
        header.steps,
        header.rejected,
        header.rhs_calls,
    )
    return header
