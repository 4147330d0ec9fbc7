"""Steps the landing's FMU through FMPy."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from contextlib import suppress
from operator import itemgetter
from pathlib import Path
from tempfile import gettempdir
from types import TracebackType
from typing import Any, NoReturn

from rlv_landing.errors import LandingError, unknown
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import (
    INPUT_NAMES,
    OUTPUT_NAMES,
    OUTPUT_QUANTITIES,
    PEAK_QUANTITIES,
    PEAKS,
    STATISTIC_QUANTITIES,
)
from rlv_landing.text.durable import writing

from .description import MODEL_NAME, check_size, read_description, references
from .folder import ProcessFolder

FOLDER_PREFIX = "rlv-landing-fmu-"
# fmi2Status.
WARNING, FATAL = 1, 4
# Argument types of the FMI functions that are called at every step. Arrays are passed by address.
DO_STEP = (ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int)
FMI_TRUE = 1
GET = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
SET_RATES = (*GET, ctypes.c_void_p)


class FmuRunner:
    """One instance of the FMU at time 0, ready to step.

    Args:
        fmu_path: the `.fmu` file.
        values: parameters by name, SI; others keep the FMU's defaults.

    Raises:
        LandingError: no such file, not an FMU, another model, an unknown parameter, or one that the
            FMU refuses (with its reason), or there is no room to unpack it.
    """

    def __init__(self, fmu_path: str | Path, values: Mapping[str, float | str]) -> None:
        self.path = Path(fmu_path)
        self._messages: list[tuple[int, str]] = []
        self._slave: Any = None
        self._component: int | None = None
        # For each FMI type: the getter's name, the getter, its arguments. The arguments hold the
        # addresses of the arrays of value references and of values, which are kept alive here.
        self._getters: list[tuple[str, Any, tuple[Any, ...]]] = []
        self._reference_arrays: list[Any] = []
        self._reals: Any = None
        # Integer and Boolean outputs: index in a sample, array of values, index in that array.
        self._not_real: list[tuple[int, Any, int]] = []
        self._folder: ProcessFolder | None = None
        description = read_description(self.path)
        self.guid: str = description.guid
        self.version: str = description.version or ""
        self.made_by: str = description.generationTool or ""
        self._references = references(description, self.path)
        for name in values:
            if name not in PARAMETER_QUANTITIES:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
        try:
            self._instantiate(description, values)
            self._prepare_outputs(self._references)
        except BaseException:
            self.close()
            raise

    def _instantiate(self, description: Any, values: Mapping[str, float | str]) -> None:
        from fmpy import extract
        from fmpy.fmi2 import FMU2Slave

        with writing(Path(gettempdir()), "name another folder by TMPDIR"):
            self._folder = ProcessFolder(FOLDER_PREFIX)
            unpacked = str(self._folder.path)
            try:
                check_size(self.path)
                extract(str(self.path), unzipdir=unpacked)
            except (OSError, LandingError):
                raise
            except Exception as e:  # of a name that leads out of the folder, FMPy's has no type
                reason = str(e).rstrip(".")
                raise LandingError(f"{self.path} is damaged: {reason}; build it again") from None
        try:
            slave = FMU2Slave(
                guid=description.guid,
                modelIdentifier=description.coSimulation.modelIdentifier,
                unzipDirectory=unpacked,
                instanceName=MODEL_NAME,
            )
            slave.instantiate(callbacks=self._make_callbacks(), loggingOn=True)
        except Exception as e:
            raise LandingError(f"{self.path} does not load here: {self._reason(str(e))}") from None
        self._slave, self._component = slave, slave.component
        self._do_step = self._function("fmi2DoStep", DO_STEP)
        self._call("setupExperiment", startTime=0.0)
        self._call("enterInitializationMode")
        reals = {n: float(v) for n, v in values.items() if not isinstance(v, str)}
        texts = {n: v for n, v in values.items() if isinstance(v, str)}
        self._call("setReal", [self._references[n] for n in reals], list(reals.values()))
        self._call("setString", [self._references[n] for n in texts], list(texts.values()))
        self._call("exitInitializationMode")

    def _function(self, name: str, arguments: Sequence[Any]) -> Any:
        """The C function `name` of the FMU.

        FMPy's wrapper of it costs as much processor time as reading twenty values.
        """
        function = self._slave.dll[name]
        function.argtypes, function.restype = arguments, ctypes.c_int
        return function

    def _prepare_outputs(self, references: Mapping[str, int]) -> None:
        for kind, getter, c_type in (
            ("real", "fmi2GetReal", ctypes.c_double),
            ("integer", "fmi2GetInteger", ctypes.c_int),
            ("boolean", "fmi2GetBoolean", ctypes.c_int),
        ):
            indices = [i for i, q in enumerate(OUTPUT_QUANTITIES) if q.kind == kind]
            count = len(indices)
            wanted = (ctypes.c_uint * count)(*(references[OUTPUT_NAMES[i]] for i in indices))
            values = (c_type * count)()
            arguments = (
                self._component,
                ctypes.addressof(wanted),
                count,
                ctypes.addressof(values),
            )
            self._getters.append((getter, self._function(getter, GET), arguments))
            self._reference_arrays.append(wanted)
            if kind == "real":
                self._reals = values
            else:
                self._not_real += [(i, values, j) for j, i in enumerate(indices)]
        self._not_real.sort(key=itemgetter(0))

    def _make_callbacks(self) -> Any:
        from fmpy import calloc, fmi2, free
        from fmpy.logging import addLoggerProxy

        def logger(
            _environment: Any, _instance: bytes, status: int, _category: bytes, message: bytes
        ) -> None:
            self._messages.append((status, (message or b"").decode("utf-8", "replace").strip()))

        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(logger)
        callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(calloc)
        callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(free)
        # FMI's logger is variadic, which ctypes does not support. The proxy formats the message.
        addLoggerProxy(ctypes.byref(callbacks))
        self._callbacks = callbacks
        return callbacks

    def _call(self, function: str, *args: Any, **kwargs: Any) -> Any:
        from fmpy.fmi1 import FMICallException

        try:
            return getattr(self._slave, function)(*args, **kwargs)
        except FMICallException as e:
            self._fail(function, e.status, str(e))

    def _fail(self, function: str, status: int, text: str = "") -> NoReturn:
        if status == FATAL:
            # FMI forbids every further call of the instance after fmi2Fatal, also the freeing.
            self._forget_instance()
        raise LandingError(
            f"{self.path}: {function} failed: {self._reason(text or f'status {status}')}"
        ) from None

    def _forget_instance(self) -> Any:
        slave, self._slave = self._slave, None
        self._component, self._getters, self._reals = None, [], None
        return slave

    def _reason(self, otherwise: str) -> str:
        texts = list(dict.fromkeys(text for _, text in self._messages if text))
        return " ".join("; ".join(texts or [otherwise]).split())

    def step(self, k: int, h: float) -> None:
        """Goes from k*h to (k+1)*h [s].

        The step asked for is the difference of the two, not h, so that the time reached is (k+1)*h
        to the bit.

        Args:
            k: number of the step, from 0.
            h: communication step [s].

        Raises:
            LandingError: the FMU refuses the step (with its reason).
        """
        self.advance(k * h, (k + 1) * h)

    def advance(self, now: float, end: float) -> None:
        """Goes from the present time `now` to `end` [s].

        Raises:
            LandingError: the FMU refuses the step (with its reason).
        """
        self._messages.clear()
        status = self._do_step(self._component, now, end - now, FMI_TRUE)
        if status > WARNING:
            self._fail("doStep", status)

    def values(self) -> list[float]:
        """All outputs at the current time, SI, in the order of `OUTPUT_NAMES`.

        Raises:
            LandingError: the FMU refuses.
        """
        for name, get, arguments in self._getters:
            status = get(*arguments)
            if status > WARNING:
                self._fail(name, status)
        values: list[float] = self._reals[:]
        # The indices ascend, so each insertion leaves the later indices right.
        for i, array, j in self._not_real:
            values.insert(i, array[j])
        return values

    def statistics(self) -> dict[str, int]:
        """The integrator's counters since time 0, by the FMU's variable names."""
        names = [q.name for q in STATISTIC_QUANTITIES if q.kind == "integer"]
        return dict(zip(names, self._slave.getInteger([self._references[name] for name in names])))

    def peaks(self) -> dict[str, tuple[float, float]]:
        """Value [SI] and time [s] of each peak since time 0, by the FMU's variable names.

        Raises:
            LandingError: the FMU refuses, or has been freed.
        """
        if self._slave is None:
            raise LandingError(f"{self.path} has been freed; it has no peaks any more")
        names = [q.name for q in PEAK_QUANTITIES]
        numbers = self._call("getReal", [self._references[name] for name in names])
        values = dict(zip(names, numbers))
        return {p.value.name: (values[p.value.name], values[p.time.name]) for p in PEAKS}

    def is_compiled(self) -> bool:
        """Whether the FMU computes with its compiled core."""
        return bool(self._slave.getBoolean([self._references["solver.compiled"]])[0])

    def set_inputs(
        self, inputs: Mapping[str, float], rates: Mapping[str, float] | None = None
    ) -> None:
        """Sets inputs by name, SI, from the current time on; others keep their values.

        Args:
            inputs: their values.
            rates: their rates, per second; the others are constant.

        Raises:
            LandingError: an unknown name, or the FMU refuses a value.
        """
        for name in (*inputs, *(rates or {})):
            if name not in INPUT_NAMES:
                raise unknown("input", name, INPUT_NAMES)
        self._call("setReal", [self._references[name] for name in inputs], list(inputs.values()))
        if rates:
            self._set_rates(rates)

    def _set_rates(self, rates: Mapping[str, float]) -> None:
        # FMPy's own call of it takes nine inputs, neither more nor fewer
        name, count = "fmi2SetRealInputDerivatives", len(rates)
        wanted = (ctypes.c_uint * count)(*(self._references[n] for n in rates))
        orders = (ctypes.c_int * count)(*[1] * count)
        values = (ctypes.c_double * count)(*rates.values())
        status = self._function(name, SET_RATES)(self._component, wanted, count, orders, values)
        if status > WARNING:
            self._fail(name, status)

    def close(self) -> None:
        """Terminates and frees the instance, and removes its folder; may be called again."""
        from fmpy.fmi1 import FMICallException

        slave = self._forget_instance()
        folder, self._folder = self._folder, None
        try:
            if slave is not None:
                try:
                    # a slave that Ctrl-C has ended can be freed only
                    with suppress(FMICallException):
                        slave.terminate()
                finally:
                    slave.freeInstance()
        finally:
            if folder is not None:
                folder.remove()

    def __enter__(self) -> FmuRunner:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
