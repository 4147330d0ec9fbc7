"""What drives a landing: its inputs as they were told, and a ground that never jumps."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from math import isfinite
from typing import Any

from .assembly import ground_motion
from .core import Inputs, Solver
from .errors import LandingError, unknown
from .parameters import check_value
from .quantities import INPUT_NAMES, INPUT_QUANTITIES
from .touchdown import GroundMotion

# where a ground motion's rate is an input of its own
RATE_INPUTS = {"ground.heave": "ground.heave_rate", "ground.tilt": "ground.tilt_rate"}
HEAVE, TILT = Inputs._fields.index("heave"), Inputs._fields.index("tilt")
PLACE = (HEAVE, TILT)

Told = tuple[Inputs, Inputs]


class DrivenInputs:
    """The inputs of a landing as they were told, and the way of the ground to where it was told to
    be.

    Told a heave or tilt that it has not, the ground moves there steadily over the caller's next
    step, on top of its own rates: one step late, without a jump. So a motion told by position alone,
    step by step, is one of straight pieces between its points.

    The solver's `u` is where the ground is; its `u_rate` has in the places of heave and tilt the
    rates at which the ground is on its way. `goal` is heave [m] and tilt [rad] where it was told to
    be at the solver's `t_input`. `on_the_way` says whether the next step has to see to the ground:
    its way begins, or has ended.
    """

    def __init__(self, solver: Solver) -> None:
        self._solver = solver
        self._y = array("d", bytes(8 * solver.n))
        self.take_up((0.0, 0.0))

    def take_up(self, goal: tuple[float, float]) -> None:
        """Go on with the solver's inputs as they are, and the `goal`."""
        u, rate = self._solver.u, self._solver.u_rate
        self.goal = goal
        self.on_the_way = any(u[i] != told or rate[i] != 0.0 for i, told in zip(PLACE, goal))

    def ground(self, t: float) -> GroundMotion:
        """How the ground moves from time `t` [s] on, as it was told to."""
        return ground_motion(*self.told(t))

    def told(self, t: float) -> Told:
        """The inputs as they were told, at time `t` [s], and their rates [unit/s]."""
        solver = self._solver
        solver.inputs_at(t)
        u, rate = Inputs(*solver.u), Inputs(*solver.u_rate)
        passed = t - solver.t_input
        told = u._replace(heave=self.goal[0], tilt=self.goal[1])
        heave, tilt = ground_motion(told, rate).at(passed)
        now = Inputs(*solver.u_now)._replace(
            heave=heave,
            heave_rate=u.heave_rate + rate.heave_rate * passed,
            tilt=tilt,
            tilt_rate=u.tilt_rate + rate.tilt_rate * passed,
        )
        return now, rate._replace(heave=0.0, tilt=0.0)

    def tell(self, t: float, told: Told) -> None:
        """From time `t` [s] on the inputs and rates are those `told`, and outputs show it at once;
        the ground is on its way with the next step.
        """
        rate = self._solver.u_rate
        self._restart(t, told, self._here(t), tuple(rate[i] for i in PLACE))

    def go_on(self, t: float, dt: float) -> None:
        """A step of `dt` [s] begins at time `t` [s], which takes the ground to where it was told to
        be. For a ground `on_the_way` only.
        """
        told, here = self.told(t), self._here(t)
        rates = tuple((told[0][i] - at) / dt for i, at in zip(PLACE, here))
        if rates != tuple(self._solver.u_rate[i] for i in PLACE):
            self._restart(t, told, here, rates)

    def _here(self, t: float) -> tuple[float, ...]:
        """Heave [m] and tilt [rad] where the ground is at time `t` [s]: its way ends with the step
        in which it began.
        """
        where = self._solver.u if t == self._solver.t_input else self.told(t)[0]
        return tuple(where[i] for i in PLACE)

    def _restart(
        self, t: float, told: Told, here: tuple[float, ...], rates: tuple[float, ...]
    ) -> None:
        """Integrate anew from time `t` [s], the ground being `here` [m, rad], and on its way at
        `rates` [m/s, rad/s].
        """
        solver = self._solver
        solver.interpolate(t, self._y)
        u, u_rate = list(told[0]), list(told[1])
        for place, at, rate in zip(PLACE, here, rates):
            u[place], u_rate[place] = at, rate
        for target, numbers in ((solver.y, self._y), (solver.u, u), (solver.u_rate, u_rate)):
            for i, value in enumerate(numbers):
                target[i] = value
        solver.restart(t)
        self.take_up((told[0].heave, told[0].tilt))


def changed(told: Told, values: Mapping[str, Any], rates: Mapping[str, Any]) -> Told:
    """The inputs `told`, with those in `values` set, and going on at those in `rates`.

    An input that is set without a rate goes on constant; a rate of heave or tilt is taken for
    `ground.heave_rate` or `ground.tilt_rate`.

    Raises LandingError for an unknown name, NaN, or a value out of bounds.
    """
    new, new_rates = list(told[0]), list(told[1])
    for name, value in values.items():
        i = _index(name)
        new[i], new_rates[i] = float(check_value(INPUT_QUANTITIES[i], value)), 0.0
    for name, rate in rates.items():
        i = _index(name)
        if not isfinite(rate):
            raise LandingError(
                f"rate of {name} = {rate:g} {INPUT_QUANTITIES[i].unit}/s must be finite"
            )
        if name in RATE_INPUTS:
            own = _index(RATE_INPUTS[name])
            new[own] = float(check_value(INPUT_QUANTITIES[own], rate))
        else:
            new_rates[i] = float(rate)
    return Inputs(*new), Inputs(*new_rates)


def _index(name: str) -> int:
    if name not in INPUT_NAMES:
        raise unknown("input", name, INPUT_NAMES)
    return INPUT_NAMES.index(name)
