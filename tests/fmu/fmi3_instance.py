"""One instance of the FMU of FMI 3.0 in FMPy, with its log kept."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import byref, c_bool, c_double, c_size_t
from pathlib import Path
from typing import Any

from fmpy import fmi3

Update = Callable[..., None]


class Instance3:
    """An instance of the FMU in `folder`; `status` returns a call's bare status.

    Args:
        description: The FMU's description.
        folder: Its unpacked files.
        event_mode: Whether the host handles events.
        early_return: Whether the host lets a step end early.
        update: The host's callback for intermediate updates, called with this instance and FMI's
            arguments from the time on.
        logging: Whether the host wants messages that are no errors.
    """

    def __init__(
        self,
        description: Any,
        folder: Path,
        *,
        event_mode: bool = False,
        early_return: bool = False,
        update: Update | None = None,
        logging: bool = True,
    ) -> None:
        self.variables = {v.name: v for v in description.modelVariables}
        self.vr = {v.name: v.valueReference for v in description.modelVariables}
        self.log: list[tuple[int, str]] = []
        self.slave = fmi3.FMU3Slave(
            guid=description.instantiationToken,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="test",
        )
        self.slave.instantiate(
            loggingOn=logging,
            eventModeUsed=event_mode,
            earlyReturnAllowed=early_return,
            logMessage=lambda _, status, __, text: self.log.append((status, text.decode())),
            intermediateUpdate=update and self._update,
        )
        self.update = update
        self.freed = False
        self._raised: list[Exception] = []

    def _update(self, _environment: Any, time: float, *rest: Any) -> None:
        """Call the host's own callback; `step` raises what it raises, which ctypes would drop."""
        assert self.update is not None
        try:
            self.update(self, time, *rest)
        except Exception as e:
            self._raised.append(e)

    def free(self) -> None:
        """Free it, once."""
        if not self.freed:
            self.freed = True
            self.slave.freeInstance()

    def start(self, start_time: float = 0.0, **values: float) -> None:
        """Initialise it with `values`; into the step mode."""
        self.slave.enterInitializationMode(startTime=start_time)
        for name, value in values.items():
            self.set(name, value)
        self.slave.exitInitializationMode()

    def set(self, name: str, value: float) -> None:
        self.slave.setFloat64([self.vr[name]], [value])

    def get(self, name: str) -> list[float]:
        """All elements of a Float64 variable."""
        count = 4 if name.startswith(("leg.", "peak.leg.")) else 1
        return self.slave.getFloat64([self.vr[name]], count)

    def step(self, time: float, step: float) -> tuple[int, bool, bool, float]:
        """Status of fmi3DoStep, whether there is an event, early return, and the time reached."""
        event, end, early, last = c_bool(), c_bool(), c_bool(), c_double()
        status = self.status(
            "fmi3DoStep",
            c_double(time),
            c_double(step),
            c_bool(True),
            *(byref(result) for result in (event, end, early, last)),
        )
        if self._raised:
            raise self._raised[0]
        assert not end
        return status, event.value, early.value, last.value

    def steps(self, first: int, last: int) -> None:
        """Steps of 1 ms, from number `first` to before `last`."""
        for k in range(first, last):
            assert self.step(k * 1e-3, 1e-3)[0] == 0

    def update_discrete_states(self) -> int:
        """Status of fmi3UpdateDiscreteStates, which needs no further update."""
        flags = [c_bool(True) for _ in range(5)]
        time = c_double()
        status = self.status(
            "fmi3UpdateDiscreteStates", *(byref(result) for result in (*flags, time))
        )
        assert status or not any(flags)
        return status

    def status(self, function: str, *arguments: Any) -> int:
        """Call the FMI function on this instance, whatever comes of it."""
        return getattr(self.slave.dll, function)(self.slave.component, *arguments)

    def state(self) -> bytes:
        """Its state, serialised."""
        state = self.slave.getFMUState()
        data = self.slave.serializeFMUState(state)
        self.slave.freeFMUState(state)
        return data

    def restore(self, data: bytes) -> int:
        """Status of taking up a serialised state."""
        state = fmi3.fmi3FMUState()
        array = (fmi3.fmi3Byte * len(data))(*data)
        status = self.status("fmi3DeserializeFMUState", array, c_size_t(len(data)), byref(state))
        return status or self.status("fmi3SetFMUState", state)

    def reason(self) -> str:
        """The last message logged."""
        return self.log[-1][1]
