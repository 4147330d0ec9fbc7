"""`Landing`: one landing in time. The only way to run the model."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from math import inf, isfinite
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from .assembly import begin, build_system
from .core import DormandPrince, Exponential, Solver
from .errors import LandingError, unknown
from .extremes import Extreme, by_name
from .parameters import Parameters, check_value
from .quantities import (
    INPUT_NAMES,
    INPUT_QUANTITIES,
    LEG_QUANTITIES,
    MODES,
    OUTPUT_NAMES,
    SHARED_QUANTITIES,
    Z_TURNS,
)
from .state import state_of, take_up

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from .history import History

DEFAULT_RTOL = 1e-5
# the integration methods: see `rlv_landing.core.solvers`
METHODS: dict[str, type[Solver]] = {"exponential": Exponential, "dormand-prince": DormandPrince}
# samples between two looks at signals and two calls of `progress` in a run
SLICE = 250
# where a ground motion's rate is an input of its own
RATE_INPUTS = {"ground.heave": "ground.heave_rate", "ground.tilt": "ground.tilt_rate"}


def output_order(mode: str) -> list[tuple[int, float]]:
    """For each of OUTPUT_NAMES: where the kernel's outputs hold it, and the factor (-1 turns Z of a
    mirror image).
    """
    shared = len(SHARED_QUANTITIES)
    order = [(i, 1.0) for i in range(shared)]
    where = {leg: (group, side) for group, g in enumerate(MODES[mode]) for leg, side in g.legs}
    for leg in sorted(where):
        group, side = where[leg]
        for i, q in enumerate(LEG_QUANTITIES):
            order.append(
                (
                    shared + len(LEG_QUANTITIES) * group + i,
                    float(side) if q.name in Z_TURNS else 1.0,
                )
            )
    return order


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

    Raises:
        LandingError: a value is out of bounds, not finite or of the wrong type, or the mode or
            method is unknown.
    """

    def __init__(
        self,
        parameters: Parameters | None = None,
        mode: str | None = None,
        rtol: float = DEFAULT_RTOL,
        method: str = "exponential",
    ) -> None:
        parameters = parameters if parameters is not None else Parameters()
        self.parameters = parameters.for_mode(mode if mode is not None else parameters.drop.mode)
        if not 1e-12 <= rtol <= 1e-2:
            raise LandingError(f"rtol = {rtol:g} is outside [1e-12, 1e-2]")
        if method not in METHODS:
            raise unknown("integration method", method, METHODS)
        self._rtol = rtol
        self._system = build_system(self.parameters)
        self._solver: Solver = METHODS[method](self._system, rtol)
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
        """What the integrator has done so far: steps, rejected steps, calls of the right-hand side."""
        s = self._solver
        return {"steps": int(s.steps), "rejected": int(s.rejected), "rhs_calls": int(s.rhs_calls)}

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
        if not (isfinite(time) and time >= self._time):
            raise LandingError(
                f"time = {time:g} s is not a time from {self._time:g} s on; reset() starts again"
            )
        if not self._solver.advance(time):
            raise self._collapsed()
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
        if not (isfinite(until) and until > self._time):
            raise LandingError(
                f"until = {until:g} s must be finite and after the present time, {self._time:g} s"
            )
        start = self._time
        samples = int((until - start) / every * (1.0 + 1e-12) + 1e-9) + 1
        rows = np.empty((samples, self._system.row))
        self._solver.open_span(start)
        try:
            self._record(rows.reshape(-1), start, every, samples, progress)
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

    def _record(
        self,
        rows: NDArray[float64],
        start: float,
        every: float,
        samples: int,
        progress: Callable[[float], object] | None,
    ) -> None:
        """Write the outputs at so many `samples` from `start` [s] on, `every` [s], to `rows`."""
        reached = 0
        while reached < samples:
            goal = min(reached + SLICE, samples)
            reached = self._solver.record(start, every, reached, goal, rows)
            if reached < goal:
                raise self._collapsed()
            self._time = start + (reached - 1) * every
            if progress is not None:
                progress(self._time)

    def _collapsed(self) -> LandingError:
        return LandingError(
            f"the integrator's step size has collapsed at t = {self._solver.t:g} s; soften the parameters or the loads"
        )
