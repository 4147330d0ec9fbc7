"""An instance of an FMU of FMI 2.0 in FMPy."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, ClassVar

# called with the status of each of the FMU's messages, and its text
Log = Callable[[int, str], None]
# FMPy's wrapper of a call, by the name of its method, which raises what the FMU refuses
Call = Callable[..., Any]
# Argument types of the FMI functions that are called at every step. Arrays are passed by address.
DO_STEP = (ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int)
GET = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
SET_RATES = (*GET, ctypes.c_void_p)
FMI_TRUE = 1


class Fmi2:
    """An instance of FMI 2.0, before its initialisation.

    Args:
        description: The FMU's description.
        folder: Its unpacked files.
        name: The instance's name.
        log: Called with each message.

    Raises:
        Exception: It does not load.
    """

    GETTERS: ClassVar[dict[str, tuple[str, Any]]] = {
        "real": ("fmi2GetReal", ctypes.c_double),
        "integer": ("fmi2GetInteger", ctypes.c_int),
        "boolean": ("fmi2GetBoolean", ctypes.c_int),
    }
    SET_REAL, SET_RATES = "setReal", "fmi2SetRealInputDerivatives"

    def __init__(self, description: Any, folder: str, name: str, log: Log) -> None:
        from fmpy.fmi2 import FMU2Slave

        self.slave = FMU2Slave(**slave_arguments(description, folder, name))
        self.slave.instantiate(callbacks=self._callbacks(log), loggingOn=True)
        self._step = function(self.slave, "fmi2DoStep", DO_STEP)

    def _callbacks(self, log: Log) -> Any:
        from fmpy import calloc, fmi2, free
        from fmpy.logging import addLoggerProxy

        def logger(
            _environment: Any, _instance: bytes, status: int, _category: bytes, message: bytes
        ) -> None:
            log(status, (message or b"").decode("utf-8", "replace").strip())

        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(logger)
        callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(calloc)
        callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(free)
        # FMI's logger is variadic, which ctypes does not support. The proxy formats the message.
        addLoggerProxy(ctypes.byref(callbacks))
        self._kept = callbacks
        return callbacks

    def initialise(self, call: Call, reals: Mapping[int, float], texts: Mapping[int, str]) -> None:
        """Initialise it at time 0 with parameters by value reference."""
        call("setupExperiment", startTime=0.0)
        call("enterInitializationMode")
        call("setReal", list(reals), list(reals.values()))
        call("setString", list(texts), list(texts.values()))
        call("exitInitializationMode")

    def step(self, now: float, step: float) -> int:
        """Status of a communication step."""
        return int(self._step(self.slave.component, now, step, FMI_TRUE))

    def getter(self, kind: str, references: Any, values: Any) -> Callable[[], int]:
        """What reads variables into an array; it gives the status."""
        get = function(self.slave, self.GETTERS[kind][0], GET)
        component, count = self.slave.component, len(references)
        where, to = ctypes.addressof(references), ctypes.addressof(values)
        return partial(get, component, where, count, to)

    def set_rates(self, rates: Mapping[int, float]) -> int:
        """Status of setting the rates of inputs by value reference."""
        # FMPy's own call of it takes nine inputs, neither more nor fewer
        count = len(rates)
        wanted = (ctypes.c_uint * count)(*rates)
        orders = (ctypes.c_int * count)(*[1] * count)
        values = (ctypes.c_double * count)(*rates.values())
        set_rates = function(self.slave, self.SET_RATES, SET_RATES)
        return int(set_rates(self.slave.component, wanted, count, orders, values))


def slave_arguments(description: Any, folder: str, name: str) -> dict[str, str]:
    """Arguments of FMPy's slaves of both versions.

    Args:
        description: The FMU's description.
        folder: Its unpacked files.
        name: The instance's name.
    """
    return {
        "guid": description.guid,
        "modelIdentifier": description.coSimulation.modelIdentifier,
        "unzipDirectory": folder,
        "instanceName": name,
    }


def function(slave: Any, name: str, arguments: Sequence[Any]) -> Any:
    """The C function `name` of an FMU, which is called with Python's lock held.

    The FMU computes in this process's Python: were the lock given up, it would take it back at
    once, or wait for a thread that came first. FMPy's wrapper of the function costs as much
    processor time as reading twenty values.
    """
    library = slave.dll
    found = ctypes.PyDLL(library._name, handle=library._handle)[name]
    found.argtypes, found.restype = arguments, ctypes.c_int
    return found
