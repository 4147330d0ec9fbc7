"""One instance of the FMU in FMPy, with a method for each call and its log kept."""

from __future__ import annotations

from ctypes import Array, c_double, c_int, c_uint
from pathlib import Path
from typing import Any

from fmpy import fmi2

from rlv_landing import Landing

OK, WARNING, DISCARD, ERROR = range(4)
# of this module: another process that imports it has it on its path
FOLDER = Path(__file__).parent


class Instance:
    """An instance of the FMU in `folder`.

    Methods raise FMPy's FMICallException; `status` returns a call's bare status instead.
    """

    def __init__(self, description, folder: Path) -> None:
        self.vr = {v.name: v.valueReference for v in description.modelVariables}
        self.log: list[tuple[int, str]] = []
        self.categories: list[str] = []
        self.slave = fmi2.FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="test",
        )
        self.callbacks = fmi2.fmi2CallbackFunctions()
        self.callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(self._note)
        self.callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
        self.callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
        self.slave.instantiate(callbacks=self.callbacks, loggingOn=True)
        self.freed = False

    def _note(
        self, _environment: Any, _name: bytes, status: int, category: bytes, message: bytes, *_: Any
    ) -> None:
        self.log.append((status, message.decode()))
        self.categories.append(category.decode())

    def free(self) -> None:
        """Free it, once."""
        if not self.freed:
            self.freed = True
            self.slave.freeInstance()

    def start(self, **values: float) -> None:
        """Initialise it with `values`, at time 0."""
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        for name, value in values.items():
            self.set(name, value)
        self.slave.exitInitializationMode()

    def set(self, name: str, value: float) -> None:
        self.slave.setReal([self.vr[name]], [value])

    def set_rate(self, name: str, value: float, order: int = 1) -> int:
        """Status of fmi2SetRealInputDerivatives."""
        return self.status(
            "fmi2SetRealInputDerivatives",
            (c_uint * 1)(self.vr[name]),
            1,
            (c_int * 1)(order),
            (c_double * 1)(value),
        )

    def get(self, name: str) -> float:
        return self.slave.getReal([self.vr[name]])[0]

    def step(self, time: float, step: float) -> int:
        """Status of fmi2DoStep."""
        return self.status("fmi2DoStep", c_double(time), c_double(step), 1)

    def steps(self, first: int, last: int) -> None:
        """Steps of 1 ms, from number `first` to before `last`."""
        for k in range(first, last):
            self.slave.doStep(k * 1e-3, 1e-3)

    def status(self, function: str, *arguments: Any) -> int:
        """Call the FMI function on this instance, whatever comes of it."""
        return getattr(self.slave.dll, function)(self.slave.component, *arguments)

    def reason(self) -> str:
        """The last message logged."""
        return self.log[-1][1]


def refs(*numbers: int) -> Array[c_uint]:
    """Value references for a call."""
    return (c_uint * len(numbers))(*numbers)


def reals(*numbers: float) -> Array[c_double]:
    """Reals for a call."""
    return (c_double * len(numbers))(*numbers)


def assert_lands_like_landing(instance: Instance, first: int = 0) -> None:
    """The instance gives `Landing`'s digits after 20 more steps of 1 ms, from step `first`."""
    instance.steps(first, first + 20)
    landing = Landing()
    landing.advance_to((first + 19) * 1e-3 + 1e-3)
    names = ("body.x", "body.pitch", "leg[2].footpad.y")
    vrs = [instance.vr[name] for name in names]
    assert instance.slave.getReal(vrs) == [landing.get(name) for name in names]
