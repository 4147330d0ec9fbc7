"""The FMI 2.0 co-simulation slave: registers the table's quantities as variables and delegates to `Landing`. No arithmetic.

`build_fmu.py` packs this file with `pythonfmu` and its own copy of the package, whose name carries the version; units, types and
dependencies come into the description there (`fmu_description.py`).
"""

import math
import sys
from array import array
from typing import Any
from uuid import NAMESPACE_URL, uuid5

from pythonfmu import Boolean, DefaultExperiment, Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real, String
from pythonfmu.enums import Fmi2Status

from rlv_landing import Landing, LandingError, Parameters, __version__
from rlv_landing.parameters import PARAMETER_QUANTITIES, check_value
from rlv_landing.quantities import INPUT_QUANTITIES, OUTPUT_QUANTITIES, Quantity

KINDS = {"real": Real, "integer": Integer, "boolean": Boolean, "string": String}


class RlvLanding(Fmi2Slave):
    """Touchdown of a four-legged rocket stage: parameters, external loads and ground motion in; loads, strokes and motion out."""

    author = "The rlv-landing authors"
    license = "Apache-2.0"
    copyright = "Copyright The rlv-landing authors"
    version = __version__
    description = "Touchdown of a vertical-landing rocket stage on four legs (Yue, Lin, Zheng, Du 2022), quasi-3D"
    default_experiment = DefaultExperiment(start_time=0.0, stop_time=1.0, step_size=1e-3, tolerance=1e-6)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._start_time = 0.0
        self._values: list[Any] = []
        self._parameters: dict[str, Any] = {}
        self._inputs: dict[str, float] = {}
        self._landing: Landing | None = None
        self._outputs: list[float] = []
        for q in PARAMETER_QUANTITIES.values():
            self._register(q, q.default, Fmi2Causality.parameter, Fmi2Variability.fixed, Fmi2Initial.exact)
        for q in INPUT_QUANTITIES:
            self._register(q, 0.0, Fmi2Causality.input, Fmi2Variability.continuous, None)
        self._first_output = len(self.vars)
        for q in OUTPUT_QUANTITIES:
            changes = Fmi2Variability.continuous if q.kind == "real" else Fmi2Variability.discrete
            self._register(q, 0.0, Fmi2Causality.output, changes, Fmi2Initial.calculated)
        self._names = [v.name for v in self.vars.values()]
        self.guid = uuid5(
            NAMESPACE_URL, f"rlv-landing {__version__} " + repr([*PARAMETER_QUANTITIES.values(), INPUT_QUANTITIES, OUTPUT_QUANTITIES])
        )

    def _register(self, q: Quantity, value: Any, causality: Any, variability: Any, initial: Any) -> None:
        attributes = {"causality": causality, "variability": variability, "initial": initial, "getter": lambda: None}
        self.register_variable(KINDS[q.kind](q.name, description=q.meaning, **attributes), nested=False)
        self._values.append(value)

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        self._start_time = start_time

    def exit_initialization_mode(self) -> None:
        """Checks parameters and inputs and starts the landing.

        A bad one is logged as an error, and every step is then refused with the same reason: an exception would reach the importer as
        Fatal, after which it must not even free the instance. Importers that switch logging off read the reason on standard error.
        """
        try:
            self._present()
            self._apply_inputs()
        except LandingError as e:
            self.log(str(e), Fmi2Status.error)
            print(f"RlvLanding: {e}", file=sys.stderr)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Goes on to `current_time + step_size`; refuses (Discard, with a logged reason) what cannot be done, and stays as it was."""
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
            landing.advance_to(max(now + step_size, landing.time))
            self._outputs = []
        except LandingError as e:
            self.log(str(e), Fmi2Status.discard)
            return False
        return True

    def _present(self) -> Landing:
        if self._landing is None:
            parameters = Parameters().with_values({n: check_value(PARAMETER_QUANTITIES[n], v) for n, v in self._parameters.items()})
            self._landing = Landing(parameters)
            self._outputs = []
        return self._landing

    def _apply_inputs(self) -> None:
        if self._inputs and self._landing is not None:
            self._landing.set_inputs(self._inputs)
            self._inputs = {}
            self._outputs = []

    def _get(self, vrs: list[int]) -> list[Any]:
        first = self._first_output
        if not self._outputs and any(vr >= first for vr in vrs):
            try:
                self._outputs = self._present().values()
            except LandingError:
                return [math.nan if vr >= first else self._values[vr] for vr in vrs]
        return [self._outputs[vr - first] if vr >= first else self._values[vr] for vr in vrs]

    def get_real(self, vrs: list[int]) -> list[float]:
        return self._get(vrs)

    def get_string(self, vrs: list[int]) -> list[str]:
        return self._get(vrs)

    def get_integer(self, vrs: list[int]) -> list[int]:
        return [int(v) if v == v else -1 for v in self._get(vrs)]

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return [v > 0 for v in self._get(vrs)]

    def _set(self, vrs: list[int], values: list[Any]) -> None:
        for vr, value in zip(vrs, values):
            name = self._names[vr]
            if name in PARAMETER_QUANTITIES:
                self._parameters[name] = value
                self._landing = None
            elif vr < self._first_output:
                self._inputs[name] = value
            self._values[vr] = value
        self._outputs = []

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        self._set(vrs, values)

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        self._set(vrs, values)

    def _get_fmu_state(self) -> dict[str, Any]:
        return {
            "start_time": self._start_time,
            "values": list(self._values),
            "parameters": dict(self._parameters),
            "inputs": dict(self._inputs),
            "landing": None if self._landing is None else list(self._landing.state()),
        }

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._start_time = state["start_time"]
        self._values = list(state["values"])
        self._inputs = dict(state["inputs"])
        if state["parameters"] != self._parameters or self._landing is None:
            self._parameters = dict(state["parameters"])
            self._landing = None
        if state["landing"] is None:
            self._landing = None
        else:
            self._present().restore(array("d", state["landing"]))
        self._outputs = []
