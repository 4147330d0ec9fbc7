"""The inputs of a landing as they were set, and the motion of the ground to a new position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

from ..assembly import ground_motion
from ..core import Inputs, Solver
from ..errors import LandingError, unknown
from ..interruptible import view
from ..parameters import check_value
from ..quantities import INPUT_NAMES, INPUT_QUANTITIES
from ..touchdown import GroundMotion
from .ground_way import POSITIONS, Way, next_interval, reached, ways_of

# ground inputs whose rate is an input of its own
RATE_INPUTS = {"ground.heave": "ground.heave_rate", "ground.tilt": "ground.tilt_rate"}
POSITION_RATES = (Inputs._fields.index("heave_rate"), Inputs._fields.index("tilt_rate"))
# values of the inputs, and their rates [unit/s]
Setting = tuple[Inputs, Inputs]


class DrivenInputs:
    """The inputs of a landing as they were set, and the motion of the ground to a new position.

    If heave or tilt is set to another value than the ground has, the ground moves there at a
    constant rate, on top of its own rates, and does not jump. That takes as long as the time since
    the last such setting, 1 s at most (see `ground_way.next_interval`), but not less than the
    caller's next step. So positions without rates are a motion that is linear between them, one
    interval late.

    The solver's `u` holds the ground's present position. Its `u_rate` holds, in the places of heave
    and tilt, the rates of the motion to a new position.

    Attributes:
        pending: Whether the next step has to begin, continue or end a motion to a new position.

    Args:
        solver: The solver whose inputs these are.
    """

    def __init__(self, solver: Solver) -> None:
        self._solver = solver
        self.begin()

    def begin(self) -> None:
        """Use the solver's inputs as those of time 0, with the ground where they say."""
        places = (self._solver.u[i] for i in POSITIONS)
        self._adopt([Way(at, at, 0.0, 0.0, 0.0) for at in places])

    def state(self) -> list[float]:
        """The numbers that `restore` needs besides the solver's inputs."""
        return [number for way in self._ways for number in way]

    def restore(self, numbers: Sequence[float]) -> None:
        """Restore the `numbers` that `state` gave, after the solver's inputs were restored."""
        self._adopt(ways_of(numbers))

    def ground(self, t: float) -> GroundMotion:
        """The motion of the ground from time `t` [s] on, as it was set."""
        return ground_motion(*self.setting(t))

    def setting(self, t: float) -> Setting:
        """The inputs as they were set, at time `t` [s], and their rates."""
        solver = self._solver
        solver.inputs_at(t)
        u, rate = Inputs(*view(solver.u)), Inputs(*view(solver.u_rate))
        passed = t - solver.t_input
        goal = u._replace(heave=self._ways[0].goal, tilt=self._ways[1].goal)
        heave, tilt = ground_motion(goal, rate).at(passed)
        now = Inputs(*view(solver.u_now))._replace(
            heave=heave,
            heave_rate=u.heave_rate + rate.heave_rate * passed,
            tilt=tilt,
            tilt_rate=u.tilt_rate + rate.tilt_rate * passed,
        )
        return now, rate._replace(heave=0.0, tilt=0.0)

    def set(self, t: float, values: Mapping[str, Any], rates: Mapping[str, Any]) -> bool:
        """Change inputs from time `t` [s] on, above 0, as `changed_setting`; whether any changes.

        Outputs follow at once. A motion of the ground to a new position begins with the next step.
        A position that is set again, unchanged, with a rate other than 0 is no new position: the
        ground goes on at the rate.

        Raises:
            LandingError: As `changed_setting`; nothing is changed then.
        """
        present = self.setting(t)
        setting, ways = self._changed(t, present, values, rates)
        if setting == present:
            self._ways = ways
            return False
        rate = self._solver.u_rate
        position = self._position(t, present)
        self._ways = ways
        self._restart(t, setting, position, [rate[i] for i in POSITIONS])
        return True

    def begin_step(self, t: float, until: float) -> None:
        """Begin the ways whose goals were set at time `t` [s], and end those that end there.

        It is needed only if `pending`, at the start of a step and at each `next_end` in it. A way
        ends at the end of the step, `until` [s], at the earliest.
        """
        setting, ways = self.setting(t), []
        position, rates = self._position(t, setting), []
        for i, at, way in zip(POSITIONS, position, self._ways):
            rate = self._solver.u_rate[i]
            if way.since == t:
                end = t + way.interval
                way = way._replace(end=until if reached(end, until) else end)
                rate = (setting[0][i] - at) / (way.end - t)
            elif reached(way.end, t):
                rate = 0.0
            ways.append(way)
            rates.append(rate)
        self._ways = ways
        if rates != [self._solver.u_rate[i] for i in POSITIONS]:
            self._restart(t, setting, position, rates)

    def next_end(self, until: float) -> float | None:
        """End of the first motion to a new position [s], if it is before `until` [s]."""
        rate = self._solver.u_rate
        ends = (way.end for i, way in zip(POSITIONS, self._ways) if rate[i] != 0.0)
        return min((end for end in ends if not reached(until, end)), default=None)

    def _changed(
        self, t: float, present: Setting, values: Mapping[str, Any], rates: Mapping[str, Any]
    ) -> tuple[Setting, list[Way]]:
        """The setting after `present` that `values` and `rates` make, and its ways.

        A position that is no news is left out.
        """
        setting = changed_setting(present, values, rates)
        u, ways = list(setting[0]), []
        for (name, rate), i, i_rate, way in zip(
            RATE_INPUTS.items(), POSITIONS, POSITION_RATES, self._ways
        ):
            if name in values:
                last_set, with_rate = u[i], rate in values or name in rates
                if last_set == way.last_set and with_rate and u[i_rate] != 0.0:
                    u[i] = present[0][i]
                way = way._replace(last_set=last_set)
            if u[i] != present[0][i] and way.since != t:
                way = way._replace(since=t, interval=next_interval(way.interval, t - way.since))
            ways.append(way)
        return (Inputs(*u), setting[1]), ways

    def _position(self, t: float, setting: Setting) -> list[float]:
        """Heave [m] and tilt [rad] of the ground at time `t` [s], at which the `setting` holds."""
        solver = self._solver
        if t == solver.t_input:
            return [solver.u[i] for i in POSITIONS]
        solver.inputs_at(t)
        return [
            setting[0][i] if reached(way.end, t) else solver.u_now[i]
            for i, way in zip(POSITIONS, self._ways)
        ]

    def _restart(
        self, t: float, setting: Setting, position: Sequence[float], rates: Sequence[float]
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
        self._adopt([way._replace(goal=setting[0][i]) for i, way in zip(POSITIONS, self._ways)])

    def _adopt(self, ways: list[Way]) -> None:
        u, rate = self._solver.u, self._solver.u_rate
        self._ways = ways
        self.pending = any(u[i] != w.goal or rate[i] != 0.0 for i, w in zip(POSITIONS, ways))


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
