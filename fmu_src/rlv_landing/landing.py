"""`Landing`: one landing in time. The only way to run the model."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from math import inf, isfinite
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from .assembly import begin, build_system
from .core import DormandPrince, Exponential, Solver
from .errors import LandingError, unknown
from .extremes import Extreme, by_name, output_order
from .parameters import Parameters, check_value
from .quantities import (
    INPUT_NAMES,
    INPUT_QUANTITIES,
    OUTPUT_NAMES,
)
from .state import LATEST, state_of, take_up
from .stints import LIMIT, advance, check_going, record

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from .history import History

DEFAULT_RTOL = 1e-5
# the integration methods: see `rlv_landing.core.solvers`
METHODS: dict[str, type[Solver]] = {"exponential": Exponential, "dormand-prince": DormandPrince}
# where a ground motion's rate is an input of its own
RATE_INPUTS = {"ground.heave": "ground.heave_rate", "ground.tilt": "ground.tilt_rate"}


def _input_index(name: str) -> int:
    if name not in INPUT_NAMES:
        raise unknown("input", name, INPUT_NAMES)
    return INPUT_NAMES.index(name)


class Landing:
    """One landing: a vehicle, its ground, its drop, and the present state. SI units throughout.

    Args:
        parameters: the vehicle, ground and drop; default is the preset `yue2022-figures`.
        mode: landing mode `2-2` or `1-2-1`; default is that of the parameters.
        rtol: relative tolerance of the integrator, 1e-12 to 1e-2. The default keeps peak forces and
            strokes to 0.05 %.
        method: `exponential`, or `dormand-prince`, the paper's ode45: slower, but not below rtol =
            1e-7.
        max_steps_per_second: the parameter `solver.max_steps_per_second`, default that of the
            parameters.

    A landing is copied and pickled whole; the copy goes on by itself, with the very same digits.

    Raises:
        LandingError: a value is out of bounds, not finite or of the wrong type, or the mode or
            method is unknown.
        IntegrationError: by `step`, `advance_to`, `run` and `set_inputs`, where the integrator cannot go
            on, and by all of them from then on, until `reset` or `restore`. The landing has ended at
            `time`.
    """

    def __init__(
        self,
        parameters: Parameters | None = None,
        mode: str | None = None,
        rtol: float = DEFAULT_RTOL,
        method: str = "exponential",
        max_steps_per_second: float | None = None,
    ) -> None:
        parameters = parameters if parameters is not None else Parameters()
        if max_steps_per_second is not None:
            parameters = parameters.with_values({LIMIT: max_steps_per_second})
        self.parameters = parameters.for_mode(mode if mode is not None else parameters.drop.mode)
        if not 1e-12 <= rtol <= 1e-2:
            raise LandingError(f"rtol = {rtol:g} is outside [1e-12, 1e-2]")
        if method not in METHODS:
            raise unknown("integration method", method, METHODS)
        self._rtol, self._method = rtol, method
        self._system = build_system(self.parameters)
        self._solver: Solver = METHODS[method](self._system, rtol)
        self._solver.limit = self.parameters.solver.max_steps_per_second
        self._y = array("d", bytes(8 * self._system.n))
        self._out = array("d", bytes(8 * self._system.row))
        self._out_time = inf
        self._order = output_order(self.parameters.drop.mode)
        self._pick = itemgetter(*(i for i, _ in self._order))
        self._turned = [k for k, (_, factor) in enumerate(self._order) if factor < 0.0]
        self.reset()

    @classmethod
    def from_toml(cls, path: str, mode: str | None = None, rtol: float = DEFAULT_RTOL) -> Landing:
        """A landing with the parameters of a TOML file (see `rlv_landing.presets.read_toml`)."""
        from .presets import read_toml

        return cls(read_toml(path), mode, rtol)

    @property
    def time(self) -> float:
        """Present time [s], 0 at the start."""
        return self._time

    @property
    def statistics(self) -> dict[str, int]:
        """What the integrator has done so far: steps, rejected steps, calls of the right-hand side;
        and whether the landing sleeps (1, else 0).

        A landing that has come to rest under loads and a ground that do not change sleeps: time
        passes without steps, until `set_inputs` changes something.
        """
        s = self._solver
        return {
            "steps": int(s.steps),
            "rejected": int(s.rejected),
            "rhs_calls": int(s.rhs_calls),
            "asleep": int(s.asleep),
        }

    def __reduce__(self) -> tuple[Any, ...]:
        return _revived, (type(self), self.parameters, self._rtol, self._method, self.state())

    def reset(self) -> None:
        """Go back to the start: time 0, inputs 0, the flight before the first contact."""
        self._system.energy_start = 0.0
        begin(self._solver, self.parameters)
        self._time = 0.0
        self._out_time = inf
        self._system.energy_start = self.get("energy.balance")
        self._solver.start(0.0)
        self._out_time = inf

    def set_inputs(self, values: Mapping[str, Any], rates: Mapping[str, Any] | None = None) -> None:
        """Set inputs by name from now on; others go on as they were.

        An input goes on from its value at its rate in `rates` [unit/s], else constant; heave and
        tilt of the ground always go on at `ground.heave_rate` and `ground.tilt_rate`, and a rate
        given for them is taken for these.

        Raises LandingError for an unknown name, NaN, or a value out of bounds; nothing is changed
        then.
        """
        check_going(self._solver)
        solver = self._solver
        solver.inputs_at(self._time)
        new, new_rates = list(solver.u_now), list(solver.u_rate)
        for name, value in values.items():
            i = _input_index(name)
            new[i], new_rates[i] = float(check_value(INPUT_QUANTITIES[i], value)), 0.0
        for name, rate in (rates or {}).items():
            i = _input_index(name)
            if not isfinite(rate):
                raise LandingError(
                    f"rate of {name} = {rate:g} {INPUT_QUANTITIES[i].unit}/s must be finite"
                )
            if name in RATE_INPUTS:
                own = _input_index(RATE_INPUTS[name])
                new[own] = float(check_value(INPUT_QUANTITIES[own], rate))
            else:
                new_rates[i] = float(rate)
        if new == list(solver.u_now) and new_rates == list(solver.u_rate):
            return
        before = self.get("energy.contact")
        solver.cut(self._time)
        for target, numbers in ((solver.u, new), (solver.u_rate, new_rates)):
            for i, v in enumerate(numbers):
                target[i] = v
        solver.restart(self._time)
        self._out_time = inf
        jump = self.get("energy.contact") - before
        if jump != 0.0:
            self._system.add_ground_work(solver.y, jump)
            solver.restart(self._time)
            self._out_time = inf

    def step(self, dt: float) -> None:
        """Go on by `dt` [s]. Raises LandingError unless `dt` is finite and positive."""
        if not 0.0 < dt < inf:
            raise LandingError(f"step = {dt:g} s must be finite and above 0 s")
        self.advance_to(self._time + dt)

    def advance_to(self, time: float) -> None:
        """Go on to `time` [s], not before the present time.

        Results do not depend on the steps by which one gets there.
        """
        if not self._time <= time <= LATEST:
            raise LandingError(
                f"time = {time:g} s is not a time from {self._time:g} to {LATEST:g} s; reset() starts again"
            )
        with self._until(time):
            advance(self._solver, time)
        self._time = time

    def values(self) -> list[float]:
        """All outputs at the present time, in the order of `rlv_landing.quantities.OUTPUT_NAMES`."""
        if self._out_time != self._time:
            self._solver.interpolate(self._time, self._y)
            self._solver.outputs_at(self._time, self._y, self._out)
            self._out_time = self._time
        values = list(self._pick(self._out))
        for i in self._turned:
            values[i] = -values[i]
        return values

    def outputs(self) -> dict[str, float]:
        """All outputs at the present time, by name."""
        return dict(zip(OUTPUT_NAMES, self.values()))

    def get(self, name: str) -> float:
        """One output at the present time. Raises LandingError for an unknown name."""
        if name not in OUTPUT_NAMES:
            raise unknown("output", name, OUTPUT_NAMES)
        return self.values()[OUTPUT_NAMES.index(name)]

    def extremes(self) -> dict[str, Extreme]:
        """The extremes of all outputs from the start to the present time, by name.

        They are kept at the integrator's steps, and looked for between these where an output turns:
        they depend neither on samples nor on communication steps.
        """
        found = array("d", bytes(8 * 4 * self._system.row))
        self._solver.extremes(self._time, found)
        return by_name(found, self._order)

    def state(self) -> array[float]:
        """The whole state, the integrator's included: what `restore` needs to go on with the very
        same digits.
        """
        return state_of(self._solver, self._time, self._system.energy_start)

    def restore(self, state: array[float]) -> None:
        """Take up a state that `state()` of a landing with the same parameters gave.

        Raises LandingError if its length is not that of this landing's state or a number in it is
        not finite.
        """
        header = take_up(self._solver, state)
        self._time = header.time
        self._system.energy_start = header.energy_start
        self._out_time = inf

    def run(
        self,
        until: float = 1.0,
        every: float = 1e-3,
        progress: Callable[[float], object] | None = None,
    ) -> History:
        """Land from now until `until` [s]; return the outputs every `every` [s], the present time
        included.

        Times are counted, now + k * every, never summed. Other threads run meanwhile: landings in
        several threads use several cores. `progress` is called with the time reached, every SLICE
        samples. Raises LandingError unless `every` is above 0 and `until` is ahead.
        """
        import numpy as np

        from .history import History

        if not 0.0 < every < inf:
            raise LandingError(f"every = {every:g} s must be finite and above 0 s")
        if not self._time < until <= LATEST:
            raise LandingError(
                f"until = {until:g} s must be finite, after the present time, {self._time:g} s, and at most {LATEST:g} s"
            )
        check_going(self._solver)
        start = self._time
        samples = int((until - start) / every * (1.0 + 1e-12) + 1e-9) + 1
        rows = np.empty((samples, self._system.row))

        def told(time: float) -> None:
            self._time = time
            if progress is not None:
                progress(time)

        self._solver.open_span(start)
        try:
            with self._until(start + (samples - 1) * every):
                record(self._solver, rows.reshape(-1), start, every, samples, told)
            found = array("d", bytes(8 * 4 * self._system.row))
            self._solver.extremes_of_span(self._time, found)
        finally:
            self._solver.close_span()
        # a column of the history is contiguous: what studies make of it takes a fraction of the
        # time
        columns = np.ascontiguousarray(rows.T)[[i for i, _ in self._order]]
        columns[self._turned] *= -1.0
        time: NDArray[float64] = np.array([start + k * every for k in range(samples)])
        extremes = by_name(found, self._order)
        return History(time, OUTPUT_NAMES, columns.T, self.parameters, extremes)

    @contextmanager
    def _until(self, time: float) -> Iterator[None]:
        """Where what goes on to `time` [s] ends before it, by a fault or by Ctrl-C, the landing is at
        the end of the last internal step.
        """
        try:
            yield
        except BaseException:
            self._time = max(self._time, min(self._solver.t, time))
            self._out_time = inf
            raise


def _revived(
    kind: type[Landing], parameters: Parameters, rtol: float, method: str, state: array[float]
) -> Landing:
    """The landing that was pickled."""
    landing = kind(parameters, rtol=rtol, method=method)
    landing.restore(state)
    return landing
