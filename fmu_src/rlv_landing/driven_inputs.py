"""The inputs of a landing as they were set, and the motion of the ground to a new position."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from .assembly import ground_motion
from .core import Inputs, Solver
from .errors import LandingError, unknown
from .parameters import check_value
from .quantities import INPUT_NAMES, INPUT_QUANTITIES
from .touchdown import GroundMotion

# ground inputs whose rate is an input of its own
RATE_INPUTS = {"ground.heave": "ground.heave_rate", "ground.tilt": "ground.tilt_rate"}
POSITIONS = (Inputs._fields.index("heave"), Inputs._fields.index("tilt"))

# values of the inputs, and their rates [unit/s]
Setting = tuple[Inputs, Inputs]


class DrivenInputs:
    """The inputs of a landing as they were set, and the motion of the ground to a new position.

    If heave or tilt is set to another value than the ground has, the ground moves there at a
    constant rate over the caller's next step, on top of its own rates. It is one step late and does
    not jump. So positions that are set at each step, without rates, are a motion that is linear
    between them.

    The solver's `u` holds the ground's present position. Its `u_rate` holds, in the places of heave
    and tilt, the rates of the motion to a new position.

    Attributes:
        goal: Heave [m] and tilt [rad] as they were set, at the solver's `t_input`.
        pending: Whether the next step has to begin or end a motion to a new position.

    Args:
        solver: The solver whose inputs these are.
    """

    def __init__(self, solver: Solver) -> None:
        self._solver = solver
        self.adopt((0.0, 0.0))

    def adopt(self, goal: tuple[float, float]) -> None:
        """Use the solver's inputs as they are, with the `goal`: heave [m] and tilt [rad]."""
        u, rate = self._solver.u, self._solver.u_rate
        self.goal = goal
        self.pending = any(u[i] != value or rate[i] != 0.0 for i, value in zip(POSITIONS, goal))

    def ground(self, t: float) -> GroundMotion:
        """The motion of the ground from time `t` [s] on, as it was set."""
        return ground_motion(*self.setting(t))

    def setting(self, t: float) -> Setting:
        """The inputs as they were set, at time `t` [s], and their rates."""
        solver = self._solver
        solver.inputs_at(t)
        u, rate = Inputs(*solver.u), Inputs(*solver.u_rate)
        passed = t - solver.t_input
        goal = u._replace(heave=self.goal[0], tilt=self.goal[1])
        heave, tilt = ground_motion(goal, rate).at(passed)
        now = Inputs(*solver.u_now)._replace(
            heave=heave,
            heave_rate=u.heave_rate + rate.heave_rate * passed,
            tilt=tilt,
            tilt_rate=u.tilt_rate + rate.tilt_rate * passed,
        )
        return now, rate._replace(heave=0.0, tilt=0.0)

    def set(self, t: float, setting: Setting) -> None:
        """Apply the `setting` from time `t` [s] on.

        Outputs follow at once. A motion of the ground to a new position begins with the next step.
        """
        rate = self._solver.u_rate
        self._restart(t, setting, self._position(t), tuple(rate[i] for i in POSITIONS))

    def begin_step(self, t: float, dt: float) -> None:
        """Begin a step of `dt` [s] at time `t` [s], at whose end the ground is where it was set.

        It is needed only if `pending`.
        """
        setting, position = self.setting(t), self._position(t)
        rates = tuple((setting[0][i] - at) / dt for i, at in zip(POSITIONS, position))
        if rates != tuple(self._solver.u_rate[i] for i in POSITIONS):
            self._restart(t, setting, position, rates)

    def _position(self, t: float) -> tuple[float, ...]:
        """Heave [m] and tilt [rad] of the ground at time `t` [s], the start or end of a step.

        A motion to a new position ends with the step in which it began.
        """
        inputs = self._solver.u if t == self._solver.t_input else self.setting(t)[0]
        return tuple(inputs[i] for i in POSITIONS)

    def _restart(
        self, t: float, setting: Setting, position: tuple[float, ...], rates: tuple[float, ...]
    ) -> None:
        """Restart the integration at time `t` [s] with the `setting`.

        Args:
            t: The time [s].
            setting: The inputs as they were set, and their rates.
            position: Present heave [m] and tilt [rad] of the ground.
            rates: Rates of its motion to a new position [m/s, rad/s].
        """
        solver = self._solver
        solver.cut(t)
        u, u_rate = list(setting[0]), list(setting[1])
        for i, at, rate in zip(POSITIONS, position, rates):
            u[i], u_rate[i] = at, rate
        for target, numbers in ((solver.u, u), (solver.u_rate, u_rate)):
            for i, value in enumerate(numbers):
                target[i] = value
        solver.restart(t)
        self.adopt((setting[0].heave, setting[0].tilt))


def changed_setting(
    setting: Setting, values: Mapping[str, Any], rates: Mapping[str, Any]
) -> Setting:
    """The `setting` with some inputs changed.

    An input that is set without a rate stays constant. A rate of heave or tilt is taken as
    `ground.heave_rate` or `ground.tilt_rate`.

    Args:
        setting: The inputs and their rates before.
        values: New values by name [SI].
        rates: New rates by name [unit/s].

    Raises:
        LandingError: A name is unknown, or a value is NaN or out of bounds.
    """
    new, new_rates = list(setting[0]), list(setting[1])
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
