"""The FMI 2.0 co-simulation slave: maps FMI variables and calls to a `HostedLanding`.

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
from collections.abc import Callable
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

from rlv_landing import LandingError, __version__
from rlv_landing.core import COMPILED
from rlv_landing.hosted import HostedLanding
from rlv_landing.landing import DEFAULT_RTOL, LOOSEST_RTOL
from rlv_landing.parameters import PARAMETER_QUANTITIES, parameters_of
from rlv_landing.quantities import STATISTIC_QUANTITIES, Quantity

# the front sets the rate of input i as the real RATES + i, a value reference of no variable
RATES = 2_000_000
LARGEST_INTEGER = 2**31 - 1
# steps refused in a row from which on a refusal is an error
MOST_REFUSALS = 10
# start values of the vehicle that the FMU was built for; there is no file for the default vehicle
VEHICLE = Path(__file__).with_name("vehicle.json")
STARTS: dict[str, Any] = json.loads(VEHICLE.read_text()) if VEHICLE.is_file() else {}
PARAMETERS = parameters_of(STARTS.get("drop.mode", PARAMETER_QUANTITIES["drop.mode"].default))
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


class RlvLanding(Fmi2Slave):
    """Touchdown of a rocket stage on legs as an FMI 2.0 co-simulation slave.

    It lands in a plane, or in space, as the vehicle that it was built for does. Inputs are external
    loads and ground motion. Outputs are motion, strut and contact forces, strokes, energies and
    status.
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
        self._hosted = HostedLanding(STARTS)
        self._values: list[Any] = []
        # steps that were refused since the last one that was made
        self._refusals = 0
        interface = self._hosted.interface
        for q in PARAMETERS.values():
            self._register(
                q,
                STARTS.get(q.name, q.default),
                Fmi2Causality.parameter,
                Fmi2Variability.fixed,
                Fmi2Initial.exact,
            )
        for q in interface.inputs:
            self._register(q, 0.0, Fmi2Causality.input, Fmi2Variability.continuous, None)
        self._first_output = len(self.vars)
        for q in interface.outputs:
            variability = (
                Fmi2Variability.continuous if q.kind == "real" else Fmi2Variability.discrete
            )
            self._register(q, 0.0, Fmi2Causality.output, variability, Fmi2Initial.calculated)
        for q in STATISTIC_QUANTITIES:
            self._register(
                q, 0.0, Fmi2Causality.local, Fmi2Variability.discrete, Fmi2Initial.calculated
            )
        for q in interface.peak_quantities:
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
        rtol = DEFAULT_RTOL if tolerance is None else tolerance
        if rtol > LOOSEST_RTOL:
            rtol = LOOSEST_RTOL
            self.log(
                f"tolerance = {tolerance:g} makes peak forces and strokes wrong by more than 1 %; "
                f"{LOOSEST_RTOL:g} is taken instead: set at most that, or none",
                Fmi2Status.warning,
            )
        self._hosted.set_up(start_time, rtol)

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
        self._hosted.begin()

    @log_exceptions
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Integrate from `current_time` to `current_time + step_size` [s].

        A step that cannot be made is refused: Discard with a logged reason, and nothing changes.
        From the tenth refusal in a row on it is an error, since an importer that repeats a
        discarded step as it was, as FMPy's `simulate_fmu` does, would never end. An integrator that
        fails within the step is an error and ends the landing: outputs and steps are errors until
        the importer restores a state or resets.
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
            end = self._hosted.prepare_step(current_time, step_size)
        except LandingError as e:
            self._refuse(str(e))
            return []
        self._refusals = 0
        return self._hosted.advance(end, stop, to_event=to_event)

    def _refuse(self, reason: str) -> None:
        self._refusals += 1
        if self._hosted.failure:
            self.log(reason, Fmi2Status.error)
        elif self._refusals < MOST_REFUSALS:
            self.log(reason, Fmi2Status.discard)
        else:
            self.log(f"{reason} (refusal {self._refusals} in a row)", Fmi2Status.error)

    @log_exceptions
    def _read(self, vrs: list[int]) -> list[Any]:
        first, last = self._first_output, max(vrs, default=0)
        calculated: list[Any] = []
        if last >= first:
            calculated = self._hosted.outputs()
        if last >= first + len(self._hosted.interface.outputs):
            counts = [min(count, LARGEST_INTEGER) for count in self._hosted.statistics()]
            calculated = [*calculated, *counts, COMPILED]
        if last >= first + len(calculated):
            calculated = [*calculated, *self._hosted.peaks()]
        return [self._values[vr] if vr < first else calculated[vr - first] for vr in vrs]

    @log_exceptions
    def _read_outputs(self) -> list[float]:
        return self._hosted.outputs()

    def get_outputs(self) -> list[float]:
        """All outputs, in order, for the front; NaN after an error."""
        return self._read_outputs() or [math.nan] * len(self._hosted.interface.outputs)

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
                self._hosted.set_rate(self._names[vr - RATES], value)
                continue
            name = self._names[vr]
            self._values[vr] = value
            if name in PARAMETERS:
                self._hosted.set_parameter(name, value)
            else:
                self._hosted.set_input(name, value)

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set parameters, inputs, or, from RATES on, the rates of inputs."""
        self._set(vrs, values)

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        """Set parameters that are texts."""
        self._set(vrs, values)

    def _get_fmu_state(self) -> dict[str, Any]:
        return {"values": list(self._values), **self._hosted.state()}

    @log_exceptions
    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        """Restore `state`; change nothing if it is no state of this FMU."""
        if "fault" in state:
            raise LandingError(f"the state cannot be read: {state['fault']}")
        values = list(state["values"])
        self._hosted.restore(state)
        self._values = values
        self._refusals = 0

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
