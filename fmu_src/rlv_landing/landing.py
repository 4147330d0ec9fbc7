"""`Landing`: one landing in time. The only way to run the model."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from math import inf, isfinite
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from .assembly import NO_INPUTS, begin, build_system
from .core import DormandPrince, Exponential, Inputs, Solver
from .driven_inputs import DrivenInputs, changed_setting
from .errors import LandingError, unknown
from .extremes import Extreme, by_name
from .parameters import Parameters
from .quantities import (
    LEG_QUANTITIES,
    MIRRORED,
    MODES,
    OUTPUT_NAMES,
    SHARED_QUANTITIES,
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
                    float(side) if q.name in MIRRORED else 1.0,
                )
            )
    return order


class Landing:
    """One landing: a vehicle, its ground, its drop, and the present state. SI units throughout.

    Args:
        parameters: the vehicle, ground and drop; default is the preset `yue2022-figures`.
        mode: landing mode `2-2` or `1-2-1`; default is that of the parameters.
        rtol: relative tolerance of the integrator, 1e-12 to 1e-2. The default keeps peak forces and
            strokes to 0.05 %.
        method: `exponential`, or `dormand-prince`, the paper's ode45: slower, but not below rtol =
            1e-7.
        inputs, rates: inputs at the start, and their rates, as for `set_inputs`; default is 0.

    Raises:
        LandingError: a value is out of bounds, not finite or of the wrong type, or the mode or
            method is unknown, or a footpad would pass below the ground in the free flight.
    """

    def __init__(
        self,
        parameters: Parameters | None = None,
        mode: str | None = None,
        rtol: float = DEFAULT_RTOL,
        method: str = "exponential",
        inputs: Mapping[str, Any] | None = None,
        rates: Mapping[str, Any] | None = None,
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
        self._inputs = DrivenInputs(self._solver)
        self._first = changed_setting((NO_INPUTS, NO_INPUTS), inputs or {}, rates or {})
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
        """Go back to the start: time 0, the first inputs, the flight before the first contact.

        The first inputs are those that the landing was made with.
        """
        self._begin(*self._first)

    def _begin(self, inputs: Inputs, rates: Inputs) -> None:
        """Place the vehicle above the ground of the inputs, at time 0."""
        begin(self._solver, self.parameters, inputs, rates)
        self._inputs.adopt((inputs.heave, inputs.tilt))
        self._time = 0.0
        self._out_time = inf

    def set_inputs(self, values: Mapping[str, Any], rates: Mapping[str, Any] | None = None) -> None:
        """Set inputs by name from now on; others go on as they were.

        An input goes on from its value at its rate in `rates` [unit/s], else constant; heave and
        tilt of the ground always go on at `ground.heave_rate` and `ground.tilt_rate`, and a rate
        given for them is taken for these.

        At time 0 they set the ground of the first contact: the vehicle is placed so that its lowest
        footpad touches the moving ground at `drop.contact_time`, with the drop's pitch and
        velocities in the inertial frame. Later the ground does not jump: if heave or tilt is set to
        another value than the ground has, it moves there at a constant rate over the next step (of
        `step`, `advance_to`, or the first `every` of `run`), on top of its own rates. So positions
        that are set at each step, without rates, are a motion that is linear between them, one step
        late.

        Raises LandingError for an unknown name, NaN, a value out of bounds, or, at time 0, a flight
        in which a footpad would pass below the ground; nothing is changed then.
        """
        present = self._inputs.setting(self._time)
        new = changed_setting(present, values, rates or {})
        if new == present:
            return
        if self._time == 0.0:
            self._begin(*new)
        else:
            self._inputs.set(self._time, new)
            self._out_time = inf

    def step(self, dt: float) -> None:
        """Go on by `dt` [s]. Raises LandingError unless `dt` is finite and positive."""
        if not 0.0 < dt < inf:
            raise LandingError(f"step = {dt:g} s must be finite and above 0 s")
        self.advance_to(self._time + dt)

    def advance_to(self, time: float) -> None:
        """Go on to `time` [s], not before the present time.

        Results do not depend on the steps by which one gets there. The exception is a ground whose
        position was set anew: it is there at the end of the next step.
        """
        if not (isfinite(time) and time >= self._time):
            raise LandingError(
                f"time = {time:g} s is not a time from {self._time:g} s on; reset() starts again"
            )
        if self._inputs.pending and time > self._time:
            self._inputs.begin_step(self._time, time - self._time)
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
        return state_of(self._solver, self._time, self._system.energy_start, self._inputs.goal)

    def restore(self, state: array[float]) -> None:
        """Take up a state that `state()` of a landing with the same parameters gave.

        Raises LandingError if its length is not that of this landing's state or a number in it is
        not finite.
        """
        header = take_up(self._solver, state)
        self._time = header.time
        self._system.energy_start = header.energy_start
        self._inputs.adopt((header.heave, header.tilt))
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
        start, ground = self._time, self._inputs.ground(self._time)
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
        return History(time, OUTPUT_NAMES, columns.T, self.parameters, ground, extremes)

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
            if self._inputs.pending:
                # a motion to a new ground position begins at the first sample, ends at the second
                goal = reached + 1
                if reached > 0:
                    self._inputs.begin_step(self._time, start + reached * every - self._time)
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
