"""The state of a landing as numbers: its time, and all that its solver keeps."""

from __future__ import annotations

import itertools
from array import array
from collections.abc import Iterator, Sequence
from math import hypot, isfinite
from operator import attrgetter
from typing import NamedTuple

from .core import Fault, Solver, Spatial
from .core.solvers.path import NEVER
from .core.solvers.step_control import LEAST_PREVIOUS_ERROR, LONGEST_STEP
from .errors import LandingError
from .inputs.ground_way import Way, way_faults
from .interruptible import view

# a count that doubles distinguish from the next one
LARGEST_COUNT = 2.0**53
# steps or probes: no landing counts so many at rest
MOST_STILL = 1e6
# [s]: not long after it, a landing's first step would be nothing beside its time
LATEST = 1e9
# the last step's interpolant, in parts of its state's scale and size; that of landings comes to 1
MOST_INSIDE = 1e6
# where the state of a body in space has its attitude, and how far its length may be off 1
QUATERNION, MOST_OFF_LENGTH = slice(3, 7), 1e-6


class StateHeader(NamedTuple):
    """The head of a state: the landing's time, and the solver's numbers beside its arrays."""

    time: float  # [s]
    t: float  # end of the last internal step [s]
    t_old: float  # its start [s]
    t_before: float  # and that of the step before [s]
    t_start: float  # when extremes began to be kept [s]
    t_input: float  # when the inputs were set [s]
    h: float  # the next internal step [s]
    error_old: float  # error of the last step, in units of the tolerance
    energy_start: float  # [J]
    most_balance: float  # the largest energy balance at a step's end [J]
    steps: float
    rejected: float
    rhs_calls: float
    spent: float  # steps beyond the rate that is allowed
    fault: float  # a `Fault`
    dense_at: float  # where the last step's interpolant begins
    seen: float  # see `rlv_landing.core.solvers.watch`
    noted: float
    calm_since: float  # see `rlv_landing.core.solvers.path` [s]
    rest_since: float  # [s]
    rest_until: float  # [s]
    asleep: float  # see `rlv_landing.core.solvers.rest`
    nearest: float  # [m]
    still: float
    waited: float


# fields that the solver's system has by the same name, and those that the solver has
OF_SYSTEM = ("energy_start", "most_balance")
OF_SOLVER = tuple(name for name in StateHeader._fields if name not in ("time", *OF_SYSTEM))
# reads all that the header has after the time from a solver
AFTER_TIME = attrgetter(
    *(f"system.{name}" if name in OF_SYSTEM else name for name in StateHeader._fields[1:])
)
WHOLE = ("fault", "dense_at", "seen", "still", "waited")


def _arrays(solver: Solver) -> list[memoryview]:
    """The arrays that a state holds after its header, as views."""
    s = solver
    arrays = (s.u, s.u_rate, s.y, s.dense, s.kept, s.before, s.middle, s.last)
    return [view(numbers) for numbers in arrays]


def state_of(solver: Solver, time: float, ways: Sequence[float]) -> array[float]:
    """The state of a landing.

    Args:
        solver: The landing's solver.
        time: The landing's time [s].
        ways: The numbers of `DrivenInputs.state`.
    """
    state = array("d", (time, *AFTER_TIME(solver), *ways))
    for numbers in _arrays(solver):
        state.frombytes(numbers.tobytes())
    return state


def load_state(
    solver: Solver, positions: Sequence[int], state: array[float], *, checked: bool = True
) -> tuple[StateHeader, Sequence[float]]:
    """Load a state into the `solver`.

    Args:
        solver: The landing's solver.
        positions: Places of the ground's positions among the inputs.
        state: The state.
        checked: Whether its numbers are checked, beside their count.

    Returns:
        The state's header, and the ways for `DrivenInputs.restore`.

    Raises:
        LandingError: The length is not that of this solver's state, a number is not finite, or the
            header is not that of a landing; nothing is changed then.
    """
    targets = _arrays(solver)
    head = len(StateHeader._fields)
    at = head + len(positions) * len(Way._fields)
    expected = at + sum(map(len, targets))
    if len(state) != expected:
        raise LandingError(
            f"state has {len(state)} numbers, this landing's has {expected}; "
            "it comes from another mode or version"
        )
    header, ways = StateHeader(*state[:head]), state[head:at]
    if checked:
        _check(solver, positions, state, at)
    numbers = memoryview(state)
    for target in targets:
        target[:] = numbers[at : at + len(target)]
        at += len(target)
    for name in OF_SYSTEM:
        setattr(solver.system, name, getattr(header, name))
    for name in ("t", "t_input"):
        setattr(solver, name, getattr(header, name))
    solver.recompute_derived()
    for name in OF_SOLVER:
        value = getattr(header, name)
        setattr(solver, name, int(value) if name in WHOLE else value)
    solver.noted, solver.asleep = bool(header.noted), bool(header.asleep)
    return header, ways


def _check(solver: Solver, positions: Sequence[int], state: array[float], at: int) -> None:
    """Check the numbers of a state, whose arrays begin at the place `at`.

    Raises:
        LandingError: One is not finite, or no landing has such numbers.
    """
    if not all(map(isfinite, state)):
        raise LandingError("state holds numbers that are not finite; take one that state() gave")
    head = len(StateHeader._fields)
    header, ways = StateHeader(*state[:head]), state[head:at]
    rates = state[at + len(solver.u) :]
    for fault in itertools.chain(
        _faults(header, len(solver.dense) // 2),
        way_faults(ways, positions, rates, header.time),
        _step_faults(solver, header, state[at + 2 * len(solver.u) :]),
        _attitude_faults(solver, state[at + 2 * len(solver.u) :]),
    ):
        raise LandingError(f"state holds {fault}; take one that state() gave")


def _step_faults(solver: Solver, h: StateHeader, numbers: Sequence[float]) -> Iterator[str]:
    """The faults of the last step's interpolant; `numbers` are those from the solver's `y` on."""
    n, scale = solver.n, solver.system.scale
    if h.dense_at not in (0, len(solver.dense) // 2):
        return
    start = n + int(h.dense_at)
    for j, number in enumerate(numbers[start : start + len(solver.dense) // 2]):
        size = scale[j % n] + abs(numbers[j % n])
        if abs(number) > MOST_INSIDE * size:
            yield f"an interpolant of {number:g} for a state of the size {size:g}"


def _attitude_faults(solver: Solver, numbers: Sequence[float]) -> Iterator[str]:
    """The faults of the attitude in space; `numbers` are those from the solver's `y` on."""
    if not isinstance(solver.system, Spatial):
        return
    length = hypot(*numbers[QUATERNION])
    if not abs(length - 1.0) <= MOST_OFF_LENGTH:
        yield f"a quaternion of length {length:g}, which is no attitude"


def _faults(h: StateHeader, dense: int) -> Iterator[str]:
    """The faults of a header; `dense` is the length of one interpolant."""
    if not 0.0 <= h.t_start <= h.t_before <= h.t_old <= h.time <= h.t <= LATEST:
        yield (
            f"times that are not in order: start {h.t_start:g}, steps {h.t_before:g}, "
            f"{h.t_old:g}, {h.t:g}, present {h.time:g} s"
        )
    if not h.t_start <= h.t_input <= h.time:
        yield f"inputs set at {h.t_input:g} s, which is not a time until {h.time:g} s"
    if not 0.0 < h.h <= LONGEST_STEP:
        yield f"a next step of {h.h:g} s, outside (0, {LONGEST_STEP:g}] s"
    if not LEAST_PREVIOUS_ERROR <= h.error_old <= 1.0:
        yield f"an error of the last step of {h.error_old:g}, outside [{LEAST_PREVIOUS_ERROR:g}, 1]"
    for name in ("calm_since", "rest_since", "rest_until"):
        if not (h.t_start <= getattr(h, name) <= h.t or getattr(h, name) == NEVER):
            yield f"{name} = {getattr(h, name):g} s, which is not a time until {h.t:g} s"
    for name in ("steps", "rejected", "rhs_calls", "still", "waited"):
        value = getattr(h, name)
        if not (0.0 <= value < LARGEST_COUNT and value.is_integer()):
            yield f"{name} = {value:g}, which is not a count"
    if max(h.still, h.waited) >= MOST_STILL:
        yield f"still = {h.still:g}, waited = {h.waited:g}, which none has"
    if h.most_balance < 0.0:
        yield f"a largest energy balance of {h.most_balance:g} J, which is a magnitude"
    if h.nearest < 0.0:
        yield f"a rest {h.nearest:g} m away"
    if not 0.0 <= h.spent < LARGEST_COUNT:
        yield f"{h.spent:g} steps spent"
    for name, allowed in (
        ("fault", tuple(Fault)),
        ("seen", (1, 2, 3)),
        ("noted", (0, 1)),
        ("asleep", (0, 1)),
        ("dense_at", (0, dense)),
    ):
        if getattr(h, name) not in allowed:
            yield f"{name} = {getattr(h, name):g}, which none has"
