"""The FMI 2.0 co-simulation slave: registers the table's quantities as variables and delegates to
`Landing`. No arithmetic.

The C front (`fmu_front/`) calls it through pythonfmu's binary, with known value references of the
right type only, in the order that FMI allows, and returns the worst status that is logged here
during a call. `fmu_build/build.py` packs this file into its own copy of the package, whose name
carries the version; `fmu_build/description.py` adds units, types and dependencies to the
description.
"""

import json
import math
import sys
from array import array
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from typing import Any
from uuid import NAMESPACE_URL, uuid5
from xml.etree.ElementTree import Element

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
from rlv_landing.landing import DEFAULT_RTOL
from rlv_landing.parameters import PARAMETER_QUANTITIES, check_value
from rlv_landing.quantities import (
    INPUT_QUANTITIES,
    OUTPUT_QUANTITIES,
    STATISTIC_QUANTITIES,
    Quantity,
)

# value references of the front's own: the rate of input i is set as the real RATES + i
RATES = 2_000_000
LARGEST_INTEGER = 2**31 - 1
_kept: list[Any] = []
keep = _kept.append
KINDS = {"real": Real, "integer": Integer, "boolean": Boolean, "string": String}


def logs_faults(method: Callable[..., Any]) -> Callable[..., Any]:
    """`method`, whose exceptions are logged as errors: the front returns the status logged, while
    pythonfmu makes every exception Fatal.

    Returns False after an exception.
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
    """A landing with the parameters `values`, the others being the defaults, that begins with the
    `inputs` and their `rates`.
    """
    checked = {name: check_value(PARAMETER_QUANTITIES[name], v) for name, v in values.items()}
    return Landing(Parameters().with_values(checked), rtol=rtol, inputs=inputs, rates=rates)


class RlvLanding(Fmi2Slave):
    """Touchdown of a four-legged rocket stage: parameters, external loads and ground motion in;
    loads, strokes and motion out.
    """

    author = "The rlv-landing authors"
    license = "Apache-2.0"
    copyright = "Copyright The rlv-landing authors"
    version = __version__
    description = "Touchdown of a vertical-landing rocket stage on four legs (Yue, Lin, Zheng, Du 2022), quasi-3D"
    default_experiment = DefaultExperiment(
        start_time=0.0, stop_time=1.0, step_size=1e-3, tolerance=DEFAULT_RTOL
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._start_time = 0.0
        self._rtol = DEFAULT_RTOL
        self._values: list[Any] = []
        self._parameters: dict[str, Any] = {}
        # what the next step starts with; rates of a step that was refused hold until the input is
        # set again
        self._inputs: dict[str, float] = {}
        self._rates: dict[str, float] = {}
        self._refused_rates: set[str] = set()
        # inputs and rates that the landing was made with
        self._first: tuple[dict[str, float], dict[str, float]] = {}, {}
        self._landing: Landing | None = None
        self._broken = ""
        # once they were asked for at this time
        self._outputs: list[float] = []
        for q in PARAMETER_QUANTITIES.values():
            self._register(
                q, q.default, Fmi2Causality.parameter, Fmi2Variability.fixed, Fmi2Initial.exact
            )
        for q in INPUT_QUANTITIES:
            self._register(q, 0.0, Fmi2Causality.input, Fmi2Variability.continuous, None)
        self._first_output = len(self.vars)
        for q in OUTPUT_QUANTITIES:
            changes = Fmi2Variability.continuous if q.kind == "real" else Fmi2Variability.discrete
            self._register(q, 0.0, Fmi2Causality.output, changes, Fmi2Initial.calculated)
        self._output_references = list(range(self._first_output, len(self.vars)))
        for q in STATISTIC_QUANTITIES:
            self._register(
                q, 0.0, Fmi2Causality.local, Fmi2Variability.discrete, Fmi2Initial.calculated
            )
        self._names = [v.name for v in self.vars.values()]

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """pythonfmu's description, with a GUID made from the version and the variables.

        Called at build time only.
        """
        quantities = [
            *PARAMETER_QUANTITIES.values(),
            INPUT_QUANTITIES,
            OUTPUT_QUANTITIES,
            STATISTIC_QUANTITIES,
        ]
        self.guid = uuid5(NAMESPACE_URL, f"rlv-landing {__version__} {quantities!r}")
        return super().to_xml(model_options or {})

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

    @logs_faults
    def setup_experiment(
        self, start_time: float, stop_time: float | None, tolerance: float | None
    ) -> None:
        """Takes the start time, and the tolerance for the integrator's own."""
        self._start_time = start_time
        self._rtol = DEFAULT_RTOL if tolerance is None else tolerance
        self._landing = None

    @logs_faults
    def enter_initialization_mode(self) -> None:
        """Takes the resources off Python's path, where pythonfmu puts them for each instance: all
        is imported by now.
        """
        while self.resources in sys.path:
            sys.path.remove(self.resources)

    @logs_faults
    def exit_initialization_mode(self) -> None:
        """Checks parameters and inputs and starts the landing.

        A bad one is an error; others may be set then.
        """
        self._present()
        self._apply_inputs()

    @logs_faults
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Goes on to `current_time + step_size`; refuses (Discard, with a logged reason) what
        cannot be done, and stays as it was.

        Where the integrator gives up within the step, that is an error, and the landing has ended:
        outputs and steps are errors until a state is restored, or reset.
        """
        try:
            landing = self._present()
            if not 0.0 < step_size < math.inf:
                raise LandingError(f"step = {step_size:g} s must be finite and above 0 s")
            now = current_time - self._start_time
            if not abs(now - landing.time) <= 1e-9 * (1.0 + landing.time):
                raise LandingError(
                    f"the importer's time is {now:g} s, the landing's is {landing.time:g} s; restore a state or reset to go back"
                )
            self._apply_inputs()
        except LandingError as e:
            self.log(str(e), Fmi2Status.error if self._broken else Fmi2Status.discard)
            return False
        self._inputs, self._rates = {}, {}
        try:
            self._outputs = []
            landing.advance_to(max(now + step_size, landing.time))
        except LandingError as e:
            self._broken = f"{e}; the landing has ended there: restore a state, or reset"
            self.log(self._broken, Fmi2Status.error)
            return False
        return True

    def _present(self) -> Landing:
        if self._broken:
            raise LandingError(self._broken)
        if self._landing is None:
            first = dict(self._inputs), dict(self._rates)
            self._landing = new_landing(self._parameters, self._rtol, *first)
            self._first = first
            self._outputs = []
        return self._landing

    def _apply_inputs(self) -> None:
        """Gives the landing what was set since the last step, however often before the next."""
        if self._inputs or self._rates:
            try:
                self._present().set_inputs(self._inputs, self._rates)
            except LandingError:
                self._refused_rates = set(self._rates)
                raise
            self._refused_rates.clear()
            self._outputs = []

    @logs_faults
    def _values_of(self, vrs: list[int]) -> list[Any]:
        known, first = self._values, self._first_output
        # all outputs are what the front asks for
        whole = vrs == self._output_references
        if whole or max(vrs, default=0) >= first:
            landing = self._present()
            # inputs act at once; those that are out of bounds the next step refuses
            if self._inputs or self._rates:
                with suppress(LandingError):
                    self._apply_inputs()
            if not self._outputs:
                self._outputs = landing.values()
        if whole:
            return self._outputs
        calculated: list[Any] = self._outputs
        if max(vrs, default=0) >= first + len(OUTPUT_QUANTITIES):
            calculated = [
                *calculated,
                *(min(count, LARGEST_INTEGER) for count in self._present().statistics.values()),
            ]
        return [known[vr] if vr < first else calculated[vr - first] for vr in vrs]

    def get_real(self, vrs: list[int]) -> list[float]:
        return self._values_of(vrs) or [math.nan] * len(vrs)

    def get_string(self, vrs: list[int]) -> list[str]:
        return self._values_of(vrs) or [""] * len(vrs)

    def get_integer(self, vrs: list[int]) -> list[int]:
        return [int(v) for v in self._values_of(vrs) or [0] * len(vrs)]

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return [v > 0 for v in self._values_of(vrs) or [0] * len(vrs)]

    @logs_faults
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
        self._set(vrs, values)

    def set_string(self, vrs: list[int], values: list[str]) -> None:
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
            "broken": self._broken,
            "landing": None if self._landing is None else list(self._landing.state()),
        }

    @logs_faults
    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        """Takes up all of `state`, or, where it is no state of this FMU, nothing of it."""
        if "fault" in state:
            raise LandingError(f"the state cannot be read: {state['fault']}")
        start_time, rtol, values, broken = (
            float(state["start_time"]),
            float(state["rtol"]),
            list(state["values"]),
            str(state["broken"]),
        )
        parameters, inputs, rates = (
            dict(state["parameters"]),
            dict(state["inputs"]),
            dict(state["rates"]),
        )
        refused_rates, numbers = set(state["refused_rates"]), state["landing"]
        first_inputs, first_rates = map(dict, state["first"])
        landing = self._landing
        if numbers is None:
            landing = None
        else:
            if landing is None or parameters != self._parameters or rtol != self._rtol:
                landing = new_landing(parameters, rtol, first_inputs, first_rates)
            landing.restore(array("d", numbers))
        self._landing, self._start_time, self._rtol, self._values, self._broken = (
            landing,
            start_time,
            rtol,
            values,
            broken,
        )
        self._parameters, self._inputs, self._rates, self._refused_rates = (
            parameters,
            inputs,
            rates,
            refused_rates,
        )
        self._first = first_inputs, first_rates
        self._outputs = []

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
