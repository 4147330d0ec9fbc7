"""A landing that a host drives: values are set one by one, then the host asks for steps."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from contextlib import suppress
from math import inf
from typing import Any

from .errors import LandingError
from .landing import DEFAULT_RTOL, Landing
from .parameters import Parameters, check_value, parameters_of
from .quantities import SPACE, Interface
from .state import LATEST

# beyond it a host's time, a double, is rounded to more than 1 us [s]
LATEST_START = 1e10


class HostedLanding:
    """A landing that begins when it is first needed, with the values that were set until then.

    A parameter that is set later begins it anew. Inputs act when outputs are read, or at the next
    step, which refuses those that are out of bounds.

    Args:
        starts: Parameters by name, in SI units, that hold until others are set; the rest are the
            defaults.

    Attributes:
        interface: Its inputs and outputs, which no parameter changes.
        start_time: The host's time at the start of the landing [s].
        failure: The reason why the landing has ended; empty while it runs.
    """

    def __init__(self, starts: Mapping[str, Any] | None = None) -> None:
        self._vehicle = Parameters().with_values(starts or {})
        self.interface: Interface = self._vehicle.interface
        self.start_time = 0.0
        self.failure = ""
        self._rtol = DEFAULT_RTOL
        self._parameters: dict[str, Any] = {}
        # set since the last step; rates of a refused step stay until their input is set again
        self._inputs: dict[str, float] = {}
        self._rates: dict[str, float] = {}
        self._refused_rates: set[str] = set()
        # inputs and rates with which the landing was made
        self._first: tuple[dict[str, float], dict[str, float]] = {}, {}
        self._landing: Landing | None = None
        # the outputs at the present time, if they were read; else empty
        self._outputs: list[float] = []
        # the peaks until the present time, if they were read, and the outputs that they belong to
        self._peaks: tuple[list[float], list[float]] = [], []

    def set_up(self, start_time: float, rtol: float) -> None:
        """Set the start time [s] and the integrator's relative tolerance; begin anew.

        Raises:
            LandingError: The start time is so late, or so early, that its rounding matters.
        """
        if not abs(start_time) <= LATEST_START:
            raise LandingError(
                f"start time = {start_time:g} s is outside [-{LATEST_START:g}, {LATEST_START:g}] "
                "s, where doubles distinguish times 2 us apart; start nearer to 0 s"
            )
        self.start_time, self._rtol = start_time, rtol
        self._landing = None

    def set_parameter(self, name: str, value: float | str) -> None:
        """Set a parameter in its SI unit, unchecked until the landing begins anew."""
        self._parameters[name] = value
        self._landing, self._outputs = None, []

    def set_input(self, name: str, value: float) -> None:
        """Set an input in its SI unit; a rate of it that was refused is dropped."""
        self._inputs[name] = value
        if name in self._refused_rates:
            del self._rates[name]
            self._refused_rates.discard(name)
        self._outputs = []

    def set_rate(self, name: str, rate: float) -> None:
        """Set the rate of an input [unit/s]."""
        self._rates[name] = rate
        self._refused_rates.discard(name)
        self._outputs = []

    def begin(self) -> None:
        """Check parameters and inputs, and begin the landing if it has not begun.

        Raises:
            LandingError: A value is out of bounds, values contradict each other, or the free flight
                would pass below the ground.
        """
        self._current()
        self._apply_inputs()

    def prepare_step(self, current_time: float, step_size: float) -> float:
        """Check a step of the host, and apply the inputs that were set.

        Args:
            current_time: The host's time at the start of the step [s].
            step_size: Its length [s].

        Returns:
            The landing's time at the end of the step [s], for `advance`.

        Raises:
            LandingError: The step cannot be made; nothing is changed.
        """
        landing = self._current()
        if not 0.0 < step_size < inf:
            raise LandingError(f"step = {step_size:g} s must be finite and above 0 s")
        now = current_time - self.start_time
        # the rounding of the importer's time, as a sum of doubles from its start, or as float32
        rounding = 2.0**-50 * abs(current_time) + 2.0**-22 * landing.time
        if not abs(now - landing.time) <= 1e-9 + rounding:
            raise LandingError(
                f"the importer's time is {now:g} s, the landing's is {landing.time:g} s; "
                "restore a state or reset to go back"
            )
        end = max(now + step_size, landing.time)
        if end > LATEST:
            raise LandingError(
                f"step = {step_size:g} s ends {end:g} s after the start, beyond {LATEST:g} s; "
                "make a shorter step"
            )
        self._apply_inputs()
        self._inputs, self._rates = {}, {}
        return end

    def advance(self, end: float, stop: float = inf, *, to_event: bool = False) -> list[float]:
        """Go on in a step that ends at the landing's time `end` [s].

        Args:
            end: The step's end, as `prepare_step` gives it [s].
            stop: The host's time at which to leave the step at the latest [s].
            to_event: Leave it at the first event.

        Returns:
            The host's time reached [s], which is `stop` or that of an event before; and 1 if there
            is an event at it, else 0.

        Raises:
            LandingError: The integrator cannot go on; the landing has ended then.
        """
        landing = self._current()
        until = min(max(stop - self.start_time, landing.time), end)
        self._outputs = []
        try:
            event = landing.advance_within_step(until, end, to_event=to_event)
        except LandingError as e:
            self.failure = f"{e}; the landing has ended there: restore a state, or reset"
            raise LandingError(self.failure) from e
        reached = min(self.start_time + landing.time, stop) if landing.time < until else stop
        return [reached, float(event)]

    def outputs(self) -> list[float]:
        """All outputs at the present time, in the order of the interface."""
        landing = self._current()
        # inputs act at once; the next step refuses those that are out of bounds
        with suppress(LandingError):
            self._apply_inputs()
        if not self._outputs:
            self._outputs = landing.values()
        return self._outputs

    def peaks(self) -> list[float]:
        """Value and the host's time [s] of each of the interface's peaks until the present time.

        They are computed once after each change.
        """
        outputs = self.outputs()
        if self._peaks[0] is not outputs:
            extremes = self._current().extremes()
            found: list[float] = []
            for peak in self.interface.peaks:
                low, low_time, high, high_time = extremes[peak.output]
                value, time = (low, low_time) if peak.side == "min" else (high, high_time)
                found += [value, self.start_time + time]
            self._peaks = outputs, found
        return self._peaks[1]

    def statistics(self) -> list[int]:
        """The numbers of `Landing.statistics`, in the order of STATISTIC_QUANTITIES."""
        return list(self._current().statistics.values())

    def state(self) -> dict[str, Any]:
        """All that `restore` needs, as JSON holds it."""
        return {
            "start_time": self.start_time,
            "rtol": self._rtol,
            "parameters": dict(self._parameters),
            "inputs": dict(self._inputs),
            "rates": dict(self._rates),
            "refused_rates": sorted(self._refused_rates),
            "first": [dict(kind) for kind in self._first],
            "broken": self.failure,
            "landing": None if self._landing is None else list(self._landing.state()),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Restore a state that `state` gave; change nothing if it cannot be restored."""
        # all conversions come first, since each may fail
        start_time, rtol = float(state["start_time"]), float(state["rtol"])
        failure = str(state["broken"])
        parameters, inputs = dict(state["parameters"]), dict(state["inputs"])
        rates, refused_rates = dict(state["rates"]), set(state["refused_rates"])
        first_inputs, first_rates = map(dict, state["first"])
        landing = None
        if state["landing"] is not None:
            landing = self._landing
            if landing is None or parameters != self._parameters or rtol != self._rtol:
                landing = new_landing(self._vehicle, parameters, rtol, first_inputs, first_rates)
            landing.restore(array("d", state["landing"]))
        self._landing, self._outputs = landing, []
        self.start_time, self._rtol, self.failure = start_time, rtol, failure
        self._parameters, self._inputs = parameters, inputs
        self._rates, self._refused_rates = rates, refused_rates
        self._first = first_inputs, first_rates

    def _current(self) -> Landing:
        if self.failure:
            raise LandingError(self.failure)
        if self._landing is None:
            first = dict(self._inputs), dict(self._rates)
            self._landing = new_landing(self._vehicle, self._parameters, self._rtol, *first)
            self._first = first
            self._outputs = []
        return self._landing

    def _apply_inputs(self) -> None:
        """Pass the inputs that were set since the last step to the landing; may be called twice."""
        if self._inputs or self._rates:
            try:
                self._current().set_inputs(self._inputs, self._rates)
            except LandingError:
                self._refused_rates = set(self._rates)
                raise
            self._refused_rates.clear()
            self._outputs = []


def new_landing(
    vehicle: Parameters,
    values: Mapping[str, Any],
    rtol: float,
    inputs: Mapping[str, float],
    rates: Mapping[str, float],
) -> Landing:
    """A landing of a vehicle with some parameters set anew, in SI units.

    Args:
        vehicle: The parameters that hold where none is set anew.
        values: Parameter values by name.
        rtol: Relative tolerance of the integrator.
        inputs: Inputs at the start by name; the others are 0.
        rates: Rates of inputs at the start by name; the others are 0.

    Raises:
        LandingError: A value is out of bounds, values contradict each other, the landing has other
            inputs and outputs than the vehicle's, or the free flight would pass below the ground.
    """
    table = parameters_of(vehicle.drop.mode)
    _check_same_interface(vehicle, values)
    checked = {name: check_value(table[name], v) for name, v in values.items()}
    return Landing(vehicle.with_values(checked), rtol=rtol, inputs=inputs, rates=rates)


def _check_same_interface(vehicle: Parameters, values: Mapping[str, Any]) -> None:
    """Check that a landing with these `values` has the inputs and outputs of the `vehicle`'s.

    Raises:
        LandingError: It has others.
    """
    mode, legs = vehicle.drop.mode, vehicle.vehicle.legs
    other = values.get("drop.mode", mode)
    if (other == SPACE) != (mode == SPACE):
        raise LandingError(
            f"drop.mode = {other} has other inputs and outputs than this FMU, which is of "
            f"drop.mode = {mode}; build one for it by `rlv-landing fmu build`"
        )
    if values.get("leg.kind", vehicle.leg.kind) != vehicle.leg.kind:
        raise LandingError(
            f"leg.kind = {values['leg.kind']} has other outputs than this FMU, which is of "
            f"leg.kind = {vehicle.leg.kind}; build one for it by `rlv-landing fmu build`"
        )
    if values.get("vehicle.legs", legs) != legs:
        raise LandingError(
            f"vehicle.legs = {values['vehicle.legs']:g} has other outputs than this FMU, which is "
            f"of {legs:g} legs; build one for them by `rlv-landing fmu build`"
        )
