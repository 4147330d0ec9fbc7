"""`Landing`: one landing in time. The only way to run the model."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from math import inf, isfinite
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from .core import DormandPrince, Exponential, Model, Solver, layout, output_size, state_size
from .errors import LandingError, unknown
from .parameters import PARAMETER_QUANTITIES, Parameters, azimuth, check_value
from .quantities import (
    INPUT_NAMES,
    INPUT_QUANTITIES,
    LEG_QUANTITIES,
    MIRRORED,
    MODES,
    OUTPUT_NAMES,
    SHARED_QUANTITIES,
)
from .touchdown import FreeFlight

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from .history import History

# Typical size of each state: the absolute part of the error that is allowed is rtol times this.
BODY_SCALE = (0.1, 0.1, 0.1, 1.0, 1.0, 1.0)
LEG_SCALE = (0.1, 0.1, 1.0, 1.0, 1e5, 1e5, 1e-3, 1e-3)
DEFAULT_RTOL = 1e-5
# the integration methods: see `rlv_landing.core.exponential` and `dormand_prince`
METHODS: dict[str, type[Solver]] = {"exponential": Exponential, "dormand-prince": DormandPrince}
HEADER = 10
# samples between two looks at signals and two calls of `progress` in a run
SLICE = 250
# where a ground motion's rate is an input of its own
RATE_INPUTS = {layout.HEAVE: layout.HEAVE_RATE, layout.TILT: layout.TILT_RATE}


def build_model(parameters: Parameters, kind: type[Model] = Model) -> Model:
    """The kernels' numbers from the user's parameters; `kind` is the compiled or the pure core's
    class.
    """
    groups = MODES[parameters.drop.mode]
    turns = [azimuth(g.azimuth) for g in groups]
    model = kind(
        array("d", (s for s, _ in turns)),
        array("d", (c for _, c in turns)),
        array("d", (float(len(g.legs)) for g in groups)),
        array("d", (1.0 if s == 0.0 else 0.5 for s, _ in turns)),
    )
    for name, q in PARAMETER_QUANTITIES.items():
        if q.symbol:
            setattr(model, q.symbol, parameters[name])
    model.Lb = -parameters.main_strut.joint_depth
    model.Ld = -parameters.auxiliary_strut.joint_depth
    model.at_joint = 1.0 if parameters.vehicle.transverse_load_at == "joint" else 0.0
    return model


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
        self._model = build_model(self.parameters)
        groups = len(MODES[self.parameters.drop.mode])
        n = state_size(groups)
        scale = array("d", BODY_SCALE + LEG_SCALE * groups + (1.0,) * layout.INTEGRALS)
        relative = array("d", bytes(8 * n))
        for g in range(groups):
            for p in (layout.P1, layout.P2):
                relative[layout.BODY + layout.LEG * g + p] = 1.0
        self._solver = METHODS[method](self._model, scale, relative, rtol)
        self._y = array("d", bytes(8 * n))
        self._out = array("d", bytes(8 * output_size(groups)))
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
        solver = self._solver
        for i, value in enumerate(self._start_state()):
            solver.y[i] = value
        for i in range(layout.INPUTS):
            solver.u[i] = solver.u_rate[i] = 0.0
        solver.steps = solver.rejected = solver.rhs_calls = 0.0
        solver.h = inf
        solver.energy_start = 0.0
        solver.restart(0.0)
        self._time = 0.0
        self._out_time = inf
        solver.energy_start = self.get("energy.balance")
        self._out_time = inf

    def _start_state(self) -> array[float]:
        """The state at time 0: the state at first contact taken back along the free flight of the
        rigid vehicle.

        The ground's origin lies below the CG at first contact, where the lowest footpad just
        touches.
        """
        p, drop = self.parameters, self.parameters.drop
        groups = len(MODES[drop.mode])
        flight = FreeFlight(p)
        lowest = flight.lowest(drop.contact_time)
        if lowest < -1e-6:
            raise LandingError(
                f"drop.contact_time = {drop.contact_time:g} s of free flight would pass {-lowest:.3g} m below the ground; "
                "shorten it, or touch down with less pitch rate or a faster descent"
            )
        y = array("d", bytes(8 * state_size(groups)))
        for i, value in enumerate(flight.before_contact(drop.contact_time)):
            y[i] = value
        radius, height = flight.footpad
        for i in range(groups):
            k = layout.BODY + layout.LEG * i
            y[k + layout.R], y[k + layout.H] = radius, height
            y[k + layout.P1] = y[k + layout.P2] = p.main_strut.charge_pressure
        return y

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
            if i in RATE_INPUTS:
                new[RATE_INPUTS[i]] = float(check_value(INPUT_QUANTITIES[RATE_INPUTS[i]], rate))
            else:
                new_rates[i] = float(rate)
        if new == list(solver.u_now) and new_rates == list(solver.u_rate):
            return
        before = self.get("energy.contact")
        solver.interpolate(self._time, self._y)
        for target, numbers in ((solver.y, self._y), (solver.u, new), (solver.u_rate, new_rates)):
            for i, v in enumerate(numbers):
                target[i] = v
        solver.restart(self._time)
        self._out_time = inf
        jump = self.get("energy.contact") - before
        if jump != 0.0:
            solver.y[solver.n - layout.INTEGRALS + layout.W_GROUND] += jump
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

    def state(self) -> array[float]:
        """The whole state, the integrator's included: what `restore` needs to go on with the very
        same digits.
        """
        s = self._solver
        header = (
            self._time,
            s.t,
            s.t_old,
            s.t_input,
            s.h,
            s.error_old,
            s.energy_start,
            s.steps,
            s.rejected,
            s.rhs_calls,
        )
        return array("d", [*header, *s.u, *s.u_rate, *s.y, *s.dense])

    def restore(self, state: array[float]) -> None:
        """Take up a state that `state()` of a landing with the same parameters gave.

        Raises LandingError if its length is not that of this landing's state or a number in it is
        not finite.
        """
        s = self._solver
        expected = HEADER + 2 * layout.INPUTS + 6 * s.n
        if len(state) != expected:
            raise LandingError(
                f"state has {len(state)} numbers, this landing's has {expected}; it comes from another mode or version"
            )
        if not all(isfinite(v) for i, v in enumerate(state) if i != 4):
            raise LandingError(
                "state holds numbers that are not finite; take one that state() gave"
            )
        (
            self._time,
            s.t,
            s.t_old,
            s.t_input,
            s.h,
            s.error_old,
            s.energy_start,
            s.steps,
            s.rejected,
            s.rhs_calls,
        ) = state[:HEADER]
        at = HEADER
        for target in (s.u, s.u_rate, s.y, s.dense):
            for i in range(len(target)):
                target[i] = state[at + i]
            at += len(target)
        calls = s.rhs_calls
        s.refresh()
        s.rhs_calls = calls
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
        start, solver = self._time, self._solver
        samples = int((until - start) / every * (1.0 + 1e-12) + 1e-9) + 1
        rows = np.empty((samples, solver.row))
        flat = rows.reshape(-1)
        reached = 0
        while reached < samples:
            goal = min(reached + SLICE, samples)
            reached = solver.record(start, every, reached, goal, flat)
            if reached < goal:
                raise self._collapsed()
            self._time = start + (reached - 1) * every
            if progress is not None:
                progress(self._time)
        # a column of the history is contiguous: what studies make of it takes a fraction of the
        # time
        columns = np.ascontiguousarray(rows.T)[[i for i, _ in self._order]]
        columns[self._turned] *= -1.0
        time: NDArray[float64] = np.array([start + k * every for k in range(samples)])
        return History(time, OUTPUT_NAMES, columns.T, self.parameters)

    def _collapsed(self) -> LandingError:
        return LandingError(
            f"the integrator's step size has collapsed at t = {self._solver.t:g} s; soften the parameters or the loads"
        )
