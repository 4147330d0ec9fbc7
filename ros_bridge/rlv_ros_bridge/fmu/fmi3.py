"""An instance of an FMU of FMI 3.0 in FMPy, without its event mode."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, ClassVar

from rlv_landing.errors import LandingError
from rlv_landing.inputs.driven import RATE_INPUTS

from .fmi2 import Call, Log, function, slave_arguments

DO_STEP = (
    ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_bool, *[ctypes.c_void_p] * 4,
)  # fmt: skip
GET = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t)
# the host will not return to a state before the step
NO_STATE_BEFORE = True


class Fmi3:
    """An instance of FMI 3.0, before its initialisation.

    Args:
        description: The FMU's description.
        folder: Its unpacked files.
        name: The instance's name.
        log: Called with each message.

    Raises:
        Exception: It does not load.
    """

    GETTERS: ClassVar[dict[str, tuple[str, Any]]] = {
        "real": ("fmi3GetFloat64", ctypes.c_double),
        "integer": ("fmi3GetInt32", ctypes.c_int32),
        "boolean": ("fmi3GetBoolean", ctypes.c_bool),
    }
    SET_REAL = "setFloat64"

    def __init__(self, description: Any, folder: str, name: str, log: Log) -> None:
        from fmpy.fmi3 import FMU3Slave

        def logger(_environment: Any, status: int, _category: bytes, message: bytes) -> None:
            text = (message or b"").decode("utf-8", "replace").strip()
            log(status, text.replace("##", "#"))

        self.slave = FMU3Slave(**slave_arguments(description, folder, name))
        self.slave.instantiate(loggingOn=True, logMessage=logger)
        self._step = function(self.slave, "fmi3DoStep", DO_STEP)
        # event, end, early return: they and the last time are of no use where steps are made whole
        self._flags, self._last = (ctypes.c_bool * 3)(), ctypes.c_double()
        flags = ctypes.addressof(self._flags)
        self._results = (flags, flags + 1, flags + 2, ctypes.addressof(self._last))

    def initialise(self, call: Call, reals: Mapping[int, float], texts: Mapping[int, str]) -> None:
        """Initialise it at time 0 with parameters by value reference."""
        call("enterInitializationMode", startTime=0.0)
        call("setFloat64", list(reals), list(reals.values()))
        call("setString", list(texts), list(texts.values()))
        call("exitInitializationMode")

    def step(self, now: float, step: float) -> int:
        """Status of a communication step."""
        return int(self._step(self.slave.component, now, step, NO_STATE_BEFORE, *self._results))

    def getter(self, kind: str, references: Any, values: Any) -> Callable[[], int]:
        """What reads variables, all their elements, into an array; it gives the status."""
        get = function(self.slave, self.GETTERS[kind][0], GET)
        component, count, size = self.slave.component, len(references), len(values)
        where, to = ctypes.addressof(references), ctypes.addressof(values)
        return partial(get, component, where, count, to, size)


def with_ground_rates(values: Mapping[str, float], rates: Mapping[str, float]) -> dict[str, float]:
    """Inputs with the rates of ground positions as the inputs that they are; FMI 3.0 has no others.

    Args:
        values: Inputs by name [SI].
        rates: Rates of inputs by name [SI/s].

    Raises:
        LandingError: Another input has a rate.
    """
    found = dict(values)
    for name, rate in rates.items():
        if name in RATE_INPUTS:
            found[RATE_INPUTS[name]] = rate
        elif rate != 0.0:
            raise LandingError(
                f"{name} has a rate of {rate:g} per second, which FMI 3.0 cannot carry; set it in "
                "steps, or build the FMU for FMI 2.0"
            )
    return found
