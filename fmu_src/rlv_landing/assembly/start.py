"""A system and a solver at the start of the parameters' landing."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from typing import cast

from ..core import Exponential, Inputs, Legged, Planar, Solver
from ..core.access import BALANCE, BODY_OUTPUTS, SPATIAL_OUTPUTS
from ..parameters import Parameters
from ..quantities import SPACE
from .planar import NO_INPUTS, ground_motion, planar_start, planar_system
from .spatial import spatial_start, spatial_system


def landing_system(parameters: Parameters) -> Legged:
    """The vehicle on its ground, for the parameters' landing mode."""
    if parameters.drop.mode == SPACE:
        return spatial_system(parameters)
    return planar_system(parameters)


def start_state(
    parameters: Parameters, inputs: Sequence[float], rates: Sequence[float]
) -> array[float]:
    """The state at time 0, on the ground of the inputs.

    Args:
        parameters: The parameters of the landing.
        inputs: The inputs at time 0, in the order of their quantities.
        rates: Their rates.

    Raises:
        LandingError: In the free flight before the first contact a footpad would pass below the
            ground, or the ground is too steep at the contact.
    """
    if parameters.drop.mode == SPACE:
        return spatial_start(parameters, inputs, rates)
    return planar_start(parameters, ground_motion(Inputs(*inputs), Inputs(*rates)))


def new_solver(
    parameters: Parameters,
    rtol: float,
    method: type[Solver] = Exponential,
    kind: type[Planar] = Planar,
) -> Solver:
    """A solver at the start of the parameters' symmetric landing.

    Args:
        parameters: The parameters of the landing.
        rtol: Relative tolerance.
        method: The integration method, of the same core as `kind`.
        kind: The vehicle's class, of the compiled or of the pure core.
    """
    solver = method(planar_system(parameters, kind), rtol)
    begin(solver, parameters, NO_INPUTS, NO_INPUTS)
    return solver


def begin(
    solver: Solver, parameters: Parameters, inputs: Sequence[float], rates: Sequence[float]
) -> None:
    """Take a solver to the start of the parameters' landing.

    The time, the counts and the energy balance are 0 then.

    Args:
        solver: A solver of `landing_system(parameters)`.
        parameters: The parameters of the landing.
        inputs: The inputs at time 0, in the order of their quantities.
        rates: Their rates.

    Raises:
        LandingError: As `start_state`; nothing is changed then.
    """
    for target, numbers in (
        (solver.y, start_state(parameters, inputs, rates)),
        (solver.u, inputs),
        (solver.u_rate, rates),
    ):
        for i, value in enumerate(numbers):
            target[i] = value
    system = cast(Legged, solver.system)
    system.energy_start = system.most_balance = 0.0
    solver.t_input = 0.0
    outputs = array("d", bytes(8 * system.row))
    solver.outputs_at(0.0, array("d", solver.y), outputs)
    body = SPATIAL_OUTPUTS if parameters.drop.mode == SPACE else BODY_OUTPUTS
    system.energy_start = outputs[body + BALANCE]
    solver.start(0.0)
