"""The FMI 2.0 co-simulation slave: maps FMI variables and calls to `Landing`.

It is a plain slave of pythonfmu. In the FMU that `fmu_build/build.py` makes, the C front
(`fmu_front/`) calls it in place of pythonfmu's binary. The front passes only value references that
exist and are of the right type, in the order that FMI allows. It returns the worst status that is
logged here during a call.

The build packs this file into the FMU's own copy of the package, whose name no other build has.
`fmu_build/description.py` adds units, types and dependencies to the description.
"""

import json
import math
import sys
from array import array
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any

from pythonfmu import (
    Boolean,
    DefaultExperiment,
    Fmi2Causality,
    Fmi2Initial,
    Fmi2Slave,
    Fmi2Variability,
    Integer,
    Real,
    String,
)
from pythonfmu.enums import Fmi2Status

from rlv_landing import Landing, LandingError, Parameters, __version__
from rlv_landing.core import COMPILED
from rlv_landing.landing import DEFAULT_RTOL, LOOSEST_RTOL
from rlv_landing.parameters import PARAMETER_QUANTITIES, check_value
from rlv_landing.quantities import (
    INPUT_QUANTITIES,
    OUTPUT_QUANTITIES,
    PEAK_QUANTITIES,
    PEAKS,
    STATISTIC_QUANTITIES,
    Quantity,
)

# the front sets the rate of input i as the real RATES + i, a value reference of no variable
RATES = 2_000_000
LARGEST_INTEGER = 2**31 - 1
# start values of the vehicle that the FMU was built for; there is no file for the default vehicle
VEHICLE = Path(__file__).with_name("vehicle.json")
STARTS: dict[str, Any] = json.loads(VEHICLE.read_text()) if VEHICLE.is_file() else {}
KINDS = {"real": Real, "integer": Integer, "boolean": Boolean, "string": String}


def log_exceptions(method: Callable[..., Any]) -> Callable[..., Any]:
    """Decorate a method of the slave: log its exceptions as errors and return False then.

    The front returns the status that was logged. An exception would be Fatal in pythonfmu.
    """

    @wraps(method)
    def wrapped(self: "RlvLanding", *args: Any) -> Any:
        try:
            return method(self, *args)
        except LandingError as e:
            self.log(str(e), Fmi2Status.error)
        except Exception as e:
            self.log(
                f"internal error in {method.__name__}: {type(e).__name__}: {e}", Fmi2Status.error
            )
        return False

    return wrapped


def new_landing(
    values: dict[str, Any],
    rtol: float,
    inputs: dict[str, float],
    rates: dict[str, float],
) -> Landing:
    """A landing with some parameters set, in SI units, and start values for the others.

    Args:
        values: Parameter values by name.
        rtol: Relative tolerance of the integrator.
        inputs: Inputs at the start by name; the others are 0.
        rates: Rates of inputs at the start by name; the others are 0.

    Raises:
        LandingError: A value is out of bounds, values contradict each other, or the free flight
            would pass below the ground.
    """
    checked = {name: check_value(PARAMETER_QUANTITIES[name], v) for name, v in values.items()}
    return Landing(
        Parameters().with_values({**STARTS, **checked}), rtol=rtol, inputs=inputs, rates=rates
    )


class RlvLanding(Fmi2Slave):
    """Touchdown of a four-legged rocket stage as an FMI 2.0 co-simulation slave.

    Inputs are external loads and ground motion. Outputs are motion, strut and contact forces,
    strokes, energies and status.
    """

    author = "The rlv-landing authors"
    license = "Apache-2.0"
    copyright = "Copyright The rlv-landing authors"
    version = __version__
    description = (
        "Touchdown of a vertical-landing rocket stage on four legs (Yue, Lin, Zheng, Du 2022), "
        "quasi-3D"
    )
    default_experiment = DefaultExperiment(
        start_time=0.0, stop_time=1.0, step_size=1e-3, tolerance=DEFAULT_RTOL
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._start_time = 0.0
        self._rtol = DEFAULT_RTOL
        self._values: list[Any] = []
        self._parameters: dict[str, Any] = {}
        # set since the last step; rates of a refused step stay until their input is set again
        self._inputs: dict[str, float] = {}
        self._rates: dict[str, float] = {}
        self._refused_rates: set[str] = set()
        # inputs and rates with which the landing was made
        self._first: tuple[dict[str, float], dict[str, float]] = {}, {}
        self._landing: Landing | None = None
        # the reason why the landing has ended; empty while it runs
        self._failure = ""
        # the outputs at the present time, if they were read; else empty
        self._outputs: list[float] = []
        # the peaks until the present time, if they were read, and the outputs that they belong to
        self._peaks: tuple[list[float], list[float]] = [], []
        for q in PARAMETER_QUANTITIES.values():
            self._register(
                q,
                STARTS.get(q.name, q.default),
                Fmi2Causality.parameter,
                Fmi2Variability.fixed,
                Fmi2Initial.exact,
            )
        for q in INPUT_QUANTITIES:
            self._register(q, 0.0, Fmi2Causality.input, Fmi2Variability.continuous, None)
        self._first_output = len(self.vars)
        for q in OUTPUT_QUANTITIES:
            variability = (
                Fmi2Variability.continuous if q.kind == "real" else Fmi2Variability.discrete
            )
            self._register(q, 0.0, Fmi2Causality.output, variability, Fmi2Initial.calculated)
        for q in STATISTIC_QUANTITIES:
            self._register(
                q, 0.0, Fmi2Causality.local, Fmi2Variability.discrete, Fmi2Initial.calculated
            )
        for q in PEAK_QUANTITIES:
            self._register(
                q, 0.0, Fmi2Causality.local, Fmi2Variability.continuous, Fmi2Initial.calculated
            )
        self._names = [v.name for v in self.vars.values()]

    def _register(
        self, q: Quantity, value: Any, causality: Any, variability: Any, initial: Any
    ) -> None:
        attributes = {
            "causality": causality,
            "variability": variability,
            "initial": initial,
            "getter": lambda: None,
        }
        self.register_variable(
            KINDS[q.kind](q.name, description=q.meaning, **attributes), nested=False
        )
        self._values.append(value)

    @log_exceptions
    def setup_experiment(
        self, start_time: float, stop_time: float | None, tolerance: float | None
    ) -> None:
        """Set the start time [s] and the integrator's relative tolerance; `stop_time` is unused.

        A tolerance above LOOSEST_RTOL is a Warning, and LOOSEST_RTOL is taken.
        """
        self._start_time = start_time
        self._rtol = DEFAULT_RTOL if tolerance is None else tolerance
        if self._rtol > LOOSEST_RTOL:
            self._rtol = LOOSEST_RTOL
            self.log(
                f"tolerance = {tolerance:g} makes peak forces and strokes wrong by more than 1 %; "
                f"{LOOSEST_RTOL:g} is taken instead: set at most that, or none",
                Fmi2Status.warning,
            )
        self._landing = None

    @log_exceptions
    def enter_initialization_mode(self) -> None:
        """Remove the resources from Python's path, where pythonfmu puts them for each instance.

        All modules are imported by now.
        """
        while self.resources in sys.path:
            sys.path.remove(self.resources)

    @log_exceptions
    def exit_initialization_mode(self) -> None:
        """Check parameters and inputs and start the landing.

        A bad value is an error. The importer may then set another and call this again.
        """
        self._current_landing()
        self._apply_inputs()

    @log_exceptions
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Integrate from `current_time` to `current_time + step_size` [s].

        A step that cannot be made is refused: Discard with a logged reason, and nothing changes.
        An integrator that fails within the step is an error and ends the landing: outputs and
        steps are errors until the importer restores a state or resets.
        """
        return bool(self._part(current_time, step_size, math.inf, to_event=False))

    @log_exceptions
    def do_part(
        self, current_time: float, step_size: float, stop: float, to_event: float
    ) -> list[float]:
        """Integrate within the step from `current_time` to `current_time + step_size` [s].

        The front leaves a step of FMI 3.0 at events, and for intermediate updates. What is refused
        and what ends the landing are as for `do_step`.

        Args:
            current_time: Where the step, or what is left of it, starts [s].
            step_size: Its length [s].
            stop: Where to leave it at the latest [s]; infinite for its end.
            to_event: Above 0: leave it at the first event.

        Returns:
            The time reached [s], which is `stop` or that of an event before, and 1 if there is an
            event, else 0. Nothing if the step is refused or fails.
        """
        return self._part(current_time, step_size, stop, to_event=to_event > 0.0)

    def _part(
        self, current_time: float, step_size: float, stop: float, *, to_event: bool
    ) -> list[float]:
        try:
            landing = self._current_landing()
            if not 0.0 < step_size < math.inf:
                raise LandingError(f"step = {step_size:g} s must be finite and above 0 s")
            now = current_time - self._start_time
            # the rounding of the importer's time, as a sum of doubles from its start, or as float32
            rounding = 2.0**-50 * abs(current_time) + 2.0**-22 * landing.time
            if not abs(now - landing.time) <= 1e-9 + rounding:
                raise LandingError(
                    f"the importer's time is {now:g} s, the landing's is {landing.time:g} s; "
                    "restore a state or reset to go back"
                )
            self._apply_inputs()
        except LandingError as e:
            self.log(str(e), Fmi2Status.error if self._failure else Fmi2Status.discard)
            return []
        self._inputs, self._rates = {}, {}
        step_end = max(now + step_size, landing.time)
        until = min(max(stop - self._start_time, landing.time), step_end)
        try:
            self._outputs = []
            event = landing.advance_within_step(until, step_end, to_event=to_event)
        except LandingError as e:
            self._failure = f"{e}; the landing has ended there: restore a state, or reset"
            self.log(self._failure, Fmi2Status.error)
            return []
        early = landing.time < until
        return [min(self._start_time + landing.time, stop) if early else stop, float(event)]

    def _current_landing(self) -> Landing:
        if self._failure:
            raise LandingError(self._failure)
        if self._landing is None:
            first = dict(self._inputs), dict(self._rates)
            self._landing = new_landing(self._parameters, self._rtol, *first)
            self._first = first
            self._outputs = []
        return self._landing

    def _apply_inputs(self) -> None:
        """Pass the inputs that were set since the last step to the landing; may be called twice."""
        if self._inputs or self._rates:
            try:
                self._current_landing().set_inputs(self._inputs, self._rates)
            except LandingError:
                self._refused_rates = set(self._rates)
                raise
            self._refused_rates.clear()
            self._outputs = []

    @log_exceptions
    def _read(self, vrs: list[int]) -> list[Any]:
        first = self._first_output
        if max(vrs, default=0) >= first:
            self._update_outputs()
        calculated: list[Any] = self._outputs
        if max(vrs, default=0) >= first + len(OUTPUT_QUANTITIES):
            counts = self._current_landing().statistics.values()
            limited = [min(count, LARGEST_INTEGER) for count in counts]
            calculated = [*calculated, *limited, COMPILED]
        if max(vrs, default=0) >= first + len(calculated):
            calculated = [*calculated, *self._read_peaks()]
        return [self._values[vr] if vr < first else calculated[vr - first] for vr in vrs]

    @log_exceptions
    def _read_outputs(self) -> list[float]:
        self._update_outputs()
        return self._outputs

    def get_outputs(self) -> list[float]:
        """All outputs, in order, for the front; NaN after an error."""
        return self._read_outputs() or [math.nan] * len(OUTPUT_QUANTITIES)

    def _update_outputs(self) -> None:
        landing = self._current_landing()
        # inputs act at once; the next step refuses those that are out of bounds
        if self._inputs or self._rates:
            with suppress(LandingError):
                self._apply_inputs()
        if not self._outputs:
            self._outputs = landing.values()

    def _read_peaks(self) -> list[float]:
        """Values and times of the peaks until the present time; computed once after each change."""
        if self._peaks[0] is not self._outputs:
            extremes = self._current_landing().extremes()
            found: list[float] = []
            for peak in PEAKS:
                low, low_time, high, high_time = extremes[peak.output]
                value, time = (low, low_time) if peak.side == "min" else (high, high_time)
                found += [value, self._start_time + time]
            self._peaks = self._outputs, found
        return self._peaks[1]

    def get_real(self, vrs: list[int]) -> list[float]:
        """Values of real variables; NaN after an error."""
        return self._read(vrs) or [math.nan] * len(vrs)

    def get_string(self, vrs: list[int]) -> list[str]:
        """Values of string variables; empty after an error."""
        return self._read(vrs) or [""] * len(vrs)

    def get_integer(self, vrs: list[int]) -> list[int]:
        """Values of integer variables; 0 after an error."""
        return [int(v) for v in self._read(vrs) or [0] * len(vrs)]

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """Values of boolean variables; False after an error."""
        return [v > 0 for v in self._read(vrs) or [0] * len(vrs)]

    @log_exceptions
    def _set(self, vrs: list[int], values: list[Any]) -> None:
        for vr, value in zip(vrs, values):
            if vr >= RATES:
                name = self._names[vr - RATES]
                self._rates[name] = value
                self._refused_rates.discard(name)
                continue
            name = self._names[vr]
            self._values[vr] = value
            if name in PARAMETER_QUANTITIES:
                self._parameters[name] = value
                self._landing = None
            else:
                self._inputs[name] = value
                if name in self._refused_rates:
                    del self._rates[name]
                    self._refused_rates.discard(name)
        self._outputs = []

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set parameters, inputs, or, from RATES on, the rates of inputs."""
        self._set(vrs, values)

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        """Set parameters that are texts."""
        self._set(vrs, values)

    def _get_fmu_state(self) -> dict[str, Any]:
        return {
            "start_time": self._start_time,
            "rtol": self._rtol,
            "values": list(self._values),
            "parameters": dict(self._parameters),
            "inputs": dict(self._inputs),
            "rates": dict(self._rates),
            "refused_rates": sorted(self._refused_rates),
            "first": [dict(kind) for kind in self._first],
            "broken": self._failure,
            "landing": None if self._landing is None else list(self._landing.state()),
        }

    @log_exceptions
    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        """Restore `state`; change nothing if it is no state of this FMU."""
        if "fault" in state:
            raise LandingError(f"the state cannot be read: {state['fault']}")
        # all conversions come first, since each may fail
        start_time, rtol = float(state["start_time"]), float(state["rtol"])
        values, failure = list(state["values"]), str(state["broken"])
        parameters, inputs = dict(state["parameters"]), dict(state["inputs"])
        rates, refused_rates = dict(state["rates"]), set(state["refused_rates"])
        first_inputs, first_rates = map(dict, state["first"])
        landing = None
        if state["landing"] is not None:
            landing = self._landing
            if landing is None or parameters != self._parameters or rtol != self._rtol:
                landing = new_landing(parameters, rtol, first_inputs, first_rates)
            landing.restore(array("d", state["landing"]))
        self._landing, self._outputs = landing, []
        self._start_time, self._rtol = start_time, rtol
        self._values, self._failure = values, failure
        self._parameters, self._inputs = parameters, inputs
        self._rates, self._refused_rates = rates, refused_rates
        self._first = first_inputs, first_rates

    @staticmethod
    def _fmu_state_to_bytes(state: dict[str, Any]) -> bytes:
        return json.dumps(state).encode()

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> dict[str, Any]:
        try:
            found = json.loads(state)
        except (ValueError, RecursionError) as e:
            return {"fault": str(e)}
        return found if isinstance(found, dict) else {"fault": "no state"}
