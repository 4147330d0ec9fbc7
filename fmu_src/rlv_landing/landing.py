"""`Landing`: one landing in time. The only way to run the model."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import inf
from typing import TYPE_CHECKING, Any

from .assembly import DeckMotion, begin, ground_motion, landing_system, waves_of
from .core import DormandPrince, Exponential, Inputs, Phase, Solver, SpatialInputs
from .errors import LandingError, unknown
from .events.search import EventSearch
from .inputs.driven import DrivenInputs, Setting, changed_setting
from .interruptible import advance, check_going, record, view
from .outputs import Extreme, OutputReader, output_order
from .parameters import Parameters
from .quantities import SPACE, Interface
from .state import LATEST, load_state, state_of
from .touchdown import AT_REST, GroundMotion, each_leg

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from .history import History
    from .sampling import Samples

DEFAULT_RTOL = 1e-5
# the loosest that keeps peak forces and strokes to 1 %, which the FMU takes at most
LOOSEST_RTOL = 1e-4
# the integration methods: see `rlv_landing.core.solvers`
METHODS: dict[str, type[Solver]] = {"exponential": Exponential, "dormand-prince": DormandPrince}
# samples between two calls of `progress` in a run
SLICE = 250
# and the longest time between them [s]: a study looks between samples from the state at such a call
SLICE_TIME = 0.125
# and until EARLY from a landing's start: first contacts are looked for there
EARLY, EARLY_SLICE_TIME = 0.05, 0.01


class Landing:
    """One landing: a vehicle, its ground, its drop, and the present state. SI units throughout.

    Args:
        parameters: the vehicle, ground and drop; default is the preset `yue2022-figures`.
        mode: landing mode `2-2`, `1-2-1` or `space`; default is that of the parameters.
        rtol: relative tolerance of the integrator, 1e-12 to 1e-2. The default keeps peak forces and
            strokes to 0.05 %.
        method: `exponential`, or `dormand-prince`, the paper's ode45: slower, but not below rtol =
            1e-7.
        inputs, rates: inputs at the start, and their rates, as for `set_inputs`; default is 0.

    Attributes:
        parameters: The parameters, with the values that belong to the mode.
        interface: Its inputs and outputs: quantities, names, legs.

    A landing is copied and pickled whole. The copy continues by itself, with the same digits.

    Raises:
        LandingError: a value is out of bounds, not finite or of the wrong type, or the mode or
            method is unknown, or a footpad would pass below the ground in the free flight.
        IntegrationError: by `step`, `advance_to` and `run` if the integrator cannot go on. The
            landing has then ended at `time`: these and `set_inputs` raise it until `reset` or
            `restore`.
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
        self._rtol, self._method = rtol, method
        mode = self.parameters.drop.mode
        self.interface: Interface = self.parameters.interface
        self._system = landing_system(self.parameters)
        self._solver: Solver = METHODS[method](self._system, rtol)
        self._solver.limit = self.parameters.solver.max_steps_per_second
        self._reader = OutputReader(self._solver, mode, self.interface.output_names)
        self._inputs = DrivenInputs(self._solver, self.interface)
        self._search: EventSearch | None = None
        none = (0.0,) * len(self.interface.inputs)
        self._first = changed_setting(self.interface, (none, none), inputs or {}, rates or {})
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
        """The integrator's work so far, and whether the landing sleeps (1, else 0).

        The work is steps, rejected steps and calls of the right-hand side. A landing sleeps at rest
        under loads and a ground that do not change: time passes without steps, until `set_inputs`
        changes something.
        """
        s = self._solver
        return {
            "steps": int(s.steps),
            "rejected": int(s.rejected),
            "rhs_calls": int(s.rhs_calls),
            "asleep": int(s.asleep),
        }

    @property
    def settled_since(self) -> float | None:
        """Time [s] since when `status.phase` is settled; None where it is not.

        It is the end of an internal step: it does not depend on samples.
        """
        s = self._solver
        # what lies on its side rests, too
        rests = s.rest_since <= self._time < s.rest_until
        return float(s.rest_since) if rests and self.get("status.phase") == Phase.SETTLED else None

    def _repr_html_(self) -> str:
        """The table that notebooks show: the present outputs, with units and meanings."""
        from html import escape

        rows = []
        for q, value in zip(self.interface.outputs, self.values()):
            cells = map(escape, (q.name, f"{value:.6g}", q.unit, q.meaning))
            rows.append("".join(f"<td>{cell}</td>" for cell in cells))
        head = "".join(f"<th>{h}</th>" for h in ("output", "value", "unit", "meaning"))
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        return (
            f'<details open=""><summary>{escape(self.parameters.drop.mode)} landing at '
            f"{self.time:g} s</summary><table><tr>{head}</tr>{body}</table></details>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        made = (self.parameters, self._rtol, self._method, self._first, self.state())
        return _revived, (type(self), *made)

    def reset(self) -> None:
        """Go back to the start: time 0, the first inputs, the flight before the first contact.

        The first inputs are those that the landing was made with.
        """
        self._begin(*self._first)

    def _begin(self, inputs: Sequence[float], rates: Sequence[float]) -> None:
        """Place the vehicle above the ground of the inputs, at time 0."""
        begin(self._solver, self.parameters, inputs, rates)
        self._inputs.begin()
        self._time = 0.0
        self._reader.forget()

    def set_inputs(self, values: Mapping[str, Any], rates: Mapping[str, Any] | None = None) -> None:
        """Set inputs by name from now on; others go on as they were.

        An input goes on from its value at its rate in `rates` [unit/s], else constant; heave and
        tilt of the ground always go on at `ground.heave_rate` and `ground.tilt_rate`, and a rate
        given for them is taken for these.

        At time 0 they set the ground of the first contact: the vehicle is placed so that its lowest
        footpad touches the moving ground at `drop.contact_time`, with the drop's pitch and
        velocities in the inertial frame. Later the ground does not jump: if heave or tilt is set to
        another value than the ground has, it moves there at a constant rate, on top of its own
        rates. That takes as long as the time since the last such position, at least the next step
        (of `step`, `advance_to`, or the first `every` of `run`). So positions without rates are a
        motion that is linear between them, one interval late, also if a position is set again at
        each step until it changes. If intervals vary, the longest counts, until one is less than
        0.45 of it. The start counts as a position, and an interval of more than 1 s as 1 s. A
        position that is set again, unchanged, together with its rate is no new position, unless the
        rate is 0.

        Raises LandingError for an unknown name, NaN, a value out of bounds, or, at time 0, a flight
        in which a footpad would pass below the ground; nothing is changed then.
        """
        check_going(self._solver)
        if self._time == 0.0:
            present = self._inputs.setting(0.0)
            new = changed_setting(self.interface, present, values, rates or {})
            if new != present:
                self._begin(*new)
        elif self._inputs.set(self._time, values, rates or {}):
            self._reader.forget()

    def inputs(self) -> dict[str, float]:
        """The inputs at the present time, by name; a sea's motion of the deck is on top of them.

        Heave and tilt are the ground's present position, which is on its way to a new one that was
        set; their rates are those of its motion.
        """
        self._solver.inputs_at(self._time)
        return dict(zip(self.interface.input_names, view(self._solver.u_now)))

    def ground_places(self) -> dict[str, float]:
        """The ground's positions by name as they are now, with the sea's motion of the deck.

        Those that were set may be on their ways.
        """
        found = self._inputs.places(self._time)
        motion = DeckMotion.at_sea(self.parameters)
        if motion is None:
            return found
        deck = motion.at(self._time)
        return {name: at + getattr(deck, name.partition(".")[2]) for name, at in found.items()}

    def step(self, dt: float) -> None:
        """Go on by `dt` [s].

        Raises:
            LandingError: `dt` is not finite and above 0.
            IntegrationError: The integrator cannot go on.
        """
        if not 0.0 < dt < inf:
            raise LandingError(f"step = {dt:g} s must be finite and above 0 s")
        self.advance_to(self._time + dt)

    def advance_to(self, time: float) -> None:
        """Go on to `time` [s], not before the present time.

        Results do not depend on the steps by which one gets there. The exception is a ground that
        reaches a new position over the next step: that is longer than the interval of positions.
        """
        self.advance_within_step(time, time, to_event=False)

    def advance_within_step(self, time: float, step_end: float, *, to_event: bool) -> bool:
        """Go on to `time` [s] in a step that ends at `step_end` [s], not before `time`.

        With `to_event`, go on to the first event before `time`, if there is one: a footpad or the
        body touches the ground or leaves it, a main strut comes to an end stop or leaves it, or
        `status.phase` changes. It is found to 1e-9 s. Results do not depend on where a step is left
        and continued.

        Returns whether there is an event at the time reached; False without `to_event`.
        """
        if not self._time <= time <= LATEST:
            raise LandingError(
                f"time = {time:g} s is not a time from {self._time:g} to {LATEST:g} s; "
                "reset() starts again"
            )
        return self._move_ground(time, step_end, to_event=to_event) or self._integrate(
            time, to_event=to_event
        )

    def _integrate(self, time: float, *, to_event: bool) -> bool:
        """Integrate to `time` [s], or to an event; the ground keeps its motion until then."""
        reached, found = time, False
        try:
            if to_event:
                reached, found = self._event_search().advance(self._time, time)
            else:
                advance(self._solver, time)
        except BaseException:
            self._end_before(time)
            raise
        self._time = reached
        return found

    def _event_search(self) -> EventSearch:
        if self._search is None:
            stops = [p.main_strut.stroke_max for p in each_leg(self.parameters)]
            names = self.interface.output_names
            order = output_order(self.parameters.drop.mode, len(names))
            self._search = EventSearch(self._solver, names, order, stops)
        return self._search

    def _move_ground(self, time: float, step_end: float, *, to_event: bool) -> bool:
        """Begin and end motions of the ground to new positions until `time` [s], or to an event.

        The landing goes on to the last end before it. New motions end at `step_end` [s] at the
        earliest. Returns whether there is an event at the time reached.
        """
        if not self._inputs.pending or time == self._time:
            return False
        self._inputs.begin_step(self._time, step_end)
        while (end := self._inputs.next_end(time)) is not None:
            if self._integrate(end, to_event=to_event):
                return True
            self._inputs.begin_step(end, step_end)
        return False

    def values(self) -> list[float]:
        """All outputs at the present time, in the order of `interface.outputs`."""
        return self._reader.values(self._time)

    def outputs(self) -> dict[str, float]:
        """All outputs at the present time, by name."""
        return dict(zip(self.interface.output_names, self.values()))

    def get(self, name: str) -> float:
        """One output at the present time. Raises LandingError for an unknown name."""
        names = self.interface.output_names
        if name not in names:
            raise unknown("output", name, names)
        return self.values()[names.index(name)]

    def extremes(self, names: Sequence[str] | None = None) -> dict[str, Extreme]:
        """The extremes of outputs from the start to the present time, by name.

        They are kept at the integrator's steps, and looked for between these where an output turns:
        they depend neither on samples nor on communication steps.

        Args:
            names: The outputs [all].
        """
        return self._reader.extremes(self._time, names)

    def state(self) -> array[float]:
        """The whole state, the integrator's included.

        `restore` needs it to go on with the very same digits.
        """
        ways = self._inputs.state()
        return state_of(self._solver, self._time, ways)

    def restore(self, state: array[float], *, checked: bool = True) -> None:
        """Restore a state that `state()` of a landing with the same parameters gave.

        Args:
            state: The state.
            checked: Whether its numbers are checked; those that this landing itself gave need not.

        Raises:
            LandingError: Its length is not that of this landing's state, a number in it is not
                finite, or no landing has such numbers; nothing is changed then.
        """
        header, ways = load_state(self._solver, self.interface.positions, state, checked=checked)
        self._time = header.time
        self._inputs.restore(ways)
        self._reader.forget()

    def run(
        self,
        until: float = 1.0,
        every: float = 1e-3,
        progress: Callable[[float], object] | None = None,
    ) -> History:
        """Land from now until `until` [s].

        Times are counted, now + k * every, never summed. Other threads run meanwhile: landings in
        several threads use several cores.

        Args:
            until: Time to land to [s].
            every: Time between two samples [s].
            progress: Called with the time reached [s], every 250 samples or 0.125 s.

        Returns:
            The outputs every `every` [s], the present time included.

        Raises:
            LandingError: `every` is not above 0, `until` is not ahead, the samples need more memory
                than is free, or the landing would take longer than 30 days.
        """
        with self.span() as extremes:
            history = self.sampled(until, every, progress)
            history.extremes = extremes()
        return history

    @contextmanager
    def span(self) -> Iterator[Callable[[], Mapping[str, Extreme]]]:
        """Keep the extremes of all outputs from now on, beside those from the start.

        One span is kept at a time. It yields a function: the extremes from now to the present time
        then, by name.
        """
        check_going(self._solver)
        self._solver.open_span(self._time)
        try:
            yield lambda: self._reader.extremes_of_span(self._time)
        finally:
            self._solver.close_span()

    def sampled(
        self, until: float, every: float, progress: Callable[[float], object] | None = None
    ) -> History:
        """As `run`, without the extremes: `span` keeps those of several parts at once."""
        return self.history([self.samples(until, every, progress)])

    def samples(
        self, until: float, every: float, progress: Callable[[float], object] | None = None
    ) -> Samples:
        """As `sampled`, before a history is made of it."""
        import numpy as np

        from .sampling import Samples, sample_count

        start, row = self._time, self._system.row
        # rows, the same turned, and columns are there at once
        count = sample_count(start, until, every, 2 * row + len(self.interface.outputs))
        check_going(self._solver)
        ground = self._ground(start)
        rows = np.empty((count, row))
        self._record(rows, start, every, progress)
        time: NDArray[float64] = np.array([start + k * every for k in range(count)])
        return Samples(time, rows, ground)

    def history(self, parts: Sequence[Samples]) -> History:
        """One history of `parts`, each of which begins with the last sample of that before."""
        import numpy as np

        from .history import History

        first, *later = parts
        time = np.concatenate([first.time, *(part.time[1:] for part in later)])
        rows = np.concatenate([first.rows, *(part.rows[1:] for part in later)])
        data = self._reader.columns(rows)
        return History(time, self.interface.output_names, data, self.parameters, first.ground)

    def _ground(self, t: float) -> GroundMotion | DeckMotion:
        """The motion of the ground from time `t` [s] on, as it was set."""
        values, rates = self._inputs.setting(t)
        if self.parameters.drop.mode == SPACE:
            places = (*self.interface.positions, *self.interface.position_rates)
            waves = waves_of(self.parameters)
            driven = any(numbers[i] for numbers in (values, rates) for i in places)
            if not driven and not waves.numbers:
                return AT_REST
            return DeckMotion(SpatialInputs(*values), SpatialInputs(*rates), waves, t)
        return ground_motion(Inputs(*values), Inputs(*rates))

    def _record(
        self,
        rows: NDArray[float64],
        start: float,
        every: float,
        progress: Callable[[float], object] | None,
    ) -> None:
        """Write the outputs from `start` [s] on, `every` [s], to `rows`."""
        samples, numbers = len(rows), rows.reshape(-1)
        reached = 0
        while reached < samples:
            span = SLICE_TIME if self._time >= EARLY else EARLY_SLICE_TIME
            most = max(1, min(SLICE, round(span / every)))
            # the first sample is where the last slice before it ended
            goal = min(reached + most + (not reached), samples)
            if self._inputs.pending:
                goal = reached + 1
                sample = start + reached * every
                self._move_ground(sample, sample, to_event=False)
            time = start + (goal - 1) * every
            try:
                record(self._solver, numbers, start, every, reached, goal)
            except BaseException:
                self._end_before(time)
                raise
            self._time, reached = time, goal
            if progress is not None:
                progress(time)

    def _end_before(self, time: float) -> None:
        """End at the last internal step, where a fault or Ctrl-C ends the way to `time` [s]."""
        self._time = max(self._time, min(self._solver.t, time))
        self._reader.forget()


def _revived(
    kind: type[Landing],
    parameters: Parameters,
    rtol: float,
    method: str,
    first: Setting,
    state: array[float],
) -> Landing:
    """The landing that was pickled."""
    interface = parameters.interface
    inputs, rates = (dict(zip(interface.input_names, numbers)) for numbers in first)
    for i in interface.positions:
        del rates[interface.input_names[i]]
    landing = kind(parameters, rtol=rtol, method=method, inputs=inputs, rates=rates)
    landing.restore(state)
    return landing
