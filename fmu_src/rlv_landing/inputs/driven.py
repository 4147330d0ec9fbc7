"""The inputs of a landing as they were set, and the motion of the ground to a new position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import Any

from ..core import Solver
from ..errors import unknown
from ..interruptible import view
from ..parameters import check_value
from ..quantities import MODES, SPACE, Interface, Quantity, interface_of
from .ground_way import Way, next_interval, reached, ways_of

# the ground's positions whose rate is an input of its own, in every landing
RATE_INPUTS = {
    interface.input_names[i]: interface.input_names[j]
    for interface in (interface_of(SPACE), interface_of(min(MODES)))
    for i, j in zip(interface.positions, interface.position_rates)
}
# values of the inputs, and their rates [unit/s], in the order of their quantities
Setting = tuple[tuple[float, ...], tuple[float, ...]]


class DrivenInputs:
    """The inputs of a landing as they were set, and the motion of the ground to a new position.

    If a position of the ground is set to another value than it has, the ground moves there at a
    constant rate, on top of its own rates, and does not jump. That takes as long as the time since
    the last such setting, 1 s at most (see `ground_way.next_interval`), but not less than the
    caller's next step. So positions without rates are a motion that is linear between them, one
    interval late.

    The solver's `u` holds the ground's present position. Its `u_rate` holds, in the places of
    positions, the rates of the motion to a new position.

    Attributes:
        pending: Whether the next step has to begin, continue or end a motion to a new position.

    Args:
        solver: The solver whose inputs these are.
        interface: The inputs' quantities.
    """

    def __init__(self, solver: Solver, interface: Interface) -> None:
        self._solver = solver
        self._interface = interface
        self._positions = interface.positions
        self.begin()

    def begin(self) -> None:
        """Use the solver's inputs as those of time 0, with the ground where they say."""
        places = (self._solver.u[i] for i in self._positions)
        self._adopt([Way(at, at, 0.0, 0.0, 0.0) for at in places])

    def state(self) -> list[float]:
        """The numbers that `restore` needs besides the solver's inputs."""
        return [number for way in self._ways for number in way]

    def restore(self, numbers: Sequence[float]) -> None:
        """Restore the `numbers` that `state` gave, after the solver's inputs were restored."""
        self._adopt(ways_of(numbers))

    def setting(self, t: float) -> Setting:
        """The inputs as they were set, at time `t` [s], and their rates."""
        solver = self._solver
        solver.inputs_at(t)
        u: list[float] = list(view(solver.u))
        rate: list[float] = list(view(solver.u_rate))
        now: list[float] = list(view(solver.u_now))
        passed = t - solver.t_input
        for i, j, way in zip(self._positions, self._interface.position_rates, self._ways):
            now[i] = way.goal + (u[j] + 0.5 * rate[j] * passed) * passed
            now[j] = u[j] + rate[j] * passed
            rate[i] = 0.0
        return tuple(now), tuple(rate)

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
        self._restart(t, setting, position, [rate[i] for i in self._positions])
        return True

    def places(self, t: float) -> dict[str, float]:
        """The ground's positions by name at time `t` [s], on their ways to those that were set."""
        names = self._interface.input_names
        found = self._position(t, self.setting(t))
        return {names[i]: at for i, at in zip(self._positions, found)}

    def begin_step(self, t: float, until: float) -> None:
        """Begin the ways whose goals were set at time `t` [s], and end those that end there.

        It is needed only if `pending`, at the start of a step and at each `next_end` in it. A way
        ends at the end of the step, `until` [s], at the earliest.
        """
        setting, ways = self.setting(t), []
        position, rates = self._position(t, setting), []
        for i, at, way in zip(self._positions, position, self._ways):
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
        if rates != [self._solver.u_rate[i] for i in self._positions]:
            self._restart(t, setting, position, rates)

    def next_end(self, until: float) -> float | None:
        """End of the first motion to a new position [s], if it is before `until` [s]."""
        rate = self._solver.u_rate
        ends = (way.end for i, way in zip(self._positions, self._ways) if rate[i] != 0.0)
        return min((end for end in ends if not reached(until, end)), default=None)

    def _changed(
        self, t: float, present: Setting, values: Mapping[str, Any], rates: Mapping[str, Any]
    ) -> tuple[Setting, list[Way]]:
        """The setting after `present` that `values` and `rates` make, and its ways.

        A position that is no news is left out.
        """
        setting = changed_setting(self._interface, present, values, rates)
        u, ways = list(setting[0]), []
        names = self._interface.input_names
        for i, i_rate, way in zip(self._positions, self._interface.position_rates, self._ways):
            name, rate = names[i], names[i_rate]
            if name in values:
                last_set, with_rate = u[i], rate in values or name in rates
                if last_set == way.last_set and with_rate and u[i_rate] != 0.0:
                    u[i] = present[0][i]
                way = way._replace(last_set=last_set)
            if u[i] != present[0][i] and way.since != t:
                way = way._replace(since=t, interval=next_interval(way.interval, t - way.since))
            ways.append(way)
        return (tuple(u), setting[1]), ways

    def _position(self, t: float, setting: Setting) -> list[float]:
        """Positions [m, rad] of the ground at time `t` [s], at which the `setting` holds."""
        solver = self._solver
        if t == solver.t_input:
            return [solver.u[i] for i in self._positions]
        solver.inputs_at(t)
        return [
            setting[0][i] if reached(way.end, t) else solver.u_now[i]
            for i, way in zip(self._positions, self._ways)
        ]

    def _restart(
        self, t: float, setting: Setting, position: Sequence[float], rates: Sequence[float]
    ) -> None:
        """Restart the integration at time `t` [s] with the `setting`.

        Args:
            t: The time [s].
            setting: The inputs as they were set, and their rates.
            position: Present positions of the ground [m, rad].
            rates: Rates of its motion to a new position [m/s, rad/s].
        """
        solver = self._solver
        solver.cut(t)
        u, u_rate = list(setting[0]), list(setting[1])
        for i, at, rate in zip(self._positions, position, rates):
            u[i], u_rate[i] = at, rate
        for target, numbers in ((solver.u, u), (solver.u_rate, u_rate)):
            for i, value in enumerate(numbers):
                target[i] = value
        solver.restart(t)
        self._adopt(
            [way._replace(goal=setting[0][i]) for i, way in zip(self._positions, self._ways)]
        )

    def _adopt(self, ways: list[Way]) -> None:
        u, rate = self._solver.u, self._solver.u_rate
        self._ways = ways
        self.pending = any(u[i] != w.goal or rate[i] != 0.0 for i, w in zip(self._positions, ways))


def changed_setting(
    interface: Interface, setting: Setting, values: Mapping[str, Any], rates: Mapping[str, Any]
) -> Setting:
    """The `setting` with some inputs changed.

    An input that is set without a rate stays constant. A rate of a position of the ground, such as
    `ground.heave`, is taken as the input `ground.heave_rate`.

    Args:
        interface: The inputs' quantities.
        setting: The inputs and their rates before.
        values: New values by name [SI].
        rates: New rates by name [unit/s].

    Raises:
        LandingError: A name is unknown, or a value is NaN or out of bounds.
    """
    quantities = interface.inputs
    own_rates = dict(zip(interface.positions, interface.position_rates))
    new, new_rates = list(setting[0]), list(setting[1])
    for name, value in values.items():
        i = _index(interface, name)
        new[i], new_rates[i] = float(check_value(quantities[i], value)), 0.0
    for name, rate in rates.items():
        i = _index(interface, name)
        speed = Quantity(f"{quantities[i].unit}/s", "", -inf, inf, name=f"rate of {name}")
        rate = float(check_value(speed, rate))
        if i in own_rates:
            own = own_rates[i]
            new[own] = float(check_value(quantities[own], rate))
        else:
            new_rates[i] = rate
    return tuple(new), tuple(new_rates)


def _index(interface: Interface, name: str) -> int:
    if name not in interface.input_names:
        raise unknown("input", name, interface.input_names)
    return interface.input_names.index(name)
