"""Steps the landing's FMU through FMPy: parameters in, all outputs out, cleaned up whatever happens."""

from __future__ import annotations

import ctypes
import zipfile
from collections.abc import Mapping
from operator import itemgetter
from pathlib import Path
from types import TracebackType
from typing import Any

from rlv_landing.errors import LandingError, unknown
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import INPUT_NAMES, OUTPUT_NAMES, OUTPUT_QUANTITIES

from .fmu_folder import FmuFolder

MODEL_NAME = "RlvLanding"
FATAL = 4


class FmuRunner:
    """One instance of the FMU at time 0, ready to step.

    Args:
        fmu_path: the `.fmu` file.
        values: parameters by name, SI; those not given keep the FMU's defaults.

    Raises:
        LandingError: no such file, not an FMU, not this model's, an unknown parameter, or one that the FMU refuses (with its reason).
    """

    def __init__(self, fmu_path: str | Path, values: Mapping[str, float | str]) -> None:
        self.path = Path(fmu_path)
        self._messages: list[tuple[int, str]] = []
        self._slave: Any = None
        self._folder: FmuFolder | None = None
        description = read_description(self.path)
        self.guid: str = description.guid
        self.version: str = description.version or ""
        self.made_by: str = description.generationTool or ""
        references = {v.name: v.valueReference for v in description.modelVariables}
        missing = [n for n in (*OUTPUT_NAMES, *INPUT_NAMES, *PARAMETER_QUANTITIES) if n not in references]
        if missing:
            raise LandingError(f"{self.path} (version {self.version}) has no variable {missing[0]!r}; build it again with ./build_fmu.sh")
        for name in values:
            if name not in PARAMETER_QUANTITIES:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
        self._references = references
        self._prepare_outputs(references)
        try:
            self._instantiate(description, values)
        except BaseException:
            self.close()
            raise

    def _prepare_outputs(self, references: Mapping[str, int]) -> None:
        self._reads: list[tuple[str, Any, Any]] = []
        order: list[int] = []
        for kind, getter, c_type in (
            ("real", "Real", ctypes.c_double),
            ("integer", "Integer", ctypes.c_int),
            ("boolean", "Boolean", ctypes.c_int),
        ):
            where = [i for i, q in enumerate(OUTPUT_QUANTITIES) if q.kind == kind]
            asked = (ctypes.c_uint * len(where))(*(references[OUTPUT_NAMES[i]] for i in where))
            self._reads.append((f"fmi2Get{getter}", asked, (c_type * len(where))()))
            order += where
        self._in_order = itemgetter(*(order.index(i) for i in range(len(order))))

    def _instantiate(self, description: Any, values: Mapping[str, float | str]) -> None:
        from fmpy import extract
        from fmpy.fmi2 import FMU2Slave

        self._folder = FmuFolder()
        unpacked = str(self._folder.path)
        extract(str(self.path), unzipdir=unpacked)
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
        self._slave = slave
        self._call("setupExperiment", startTime=0.0)
        self._call("enterInitializationMode")
        reals = {n: float(v) for n, v in values.items() if not isinstance(v, str)}
        texts = {n: v for n, v in values.items() if isinstance(v, str)}
        self._call("setReal", [self._references[n] for n in reals], list(reals.values()))
        self._call("setString", [self._references[n] for n in texts], list(texts.values()))
        self._call("exitInitializationMode")

    def _make_callbacks(self) -> Any:
        from fmpy import calloc, fmi2, free
        from fmpy.logging import addLoggerProxy

        def logger(_environment: Any, _instance: bytes, status: int, _category: bytes, message: bytes) -> None:
            self._messages.append((status, (message or b"").decode("utf-8", "replace").strip()))

        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(logger)
        callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(calloc)
        callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(free)
        # FMI's logger is variadic, which ctypes cannot be: the proxy formats the message first.
        addLoggerProxy(ctypes.byref(callbacks))
        self._callbacks = callbacks
        return callbacks

    def _call(self, function: str, *args: Any, **kwargs: Any) -> None:
        from fmpy.fmi1 import FMICallException

        try:
            getattr(self._slave, function)(*args, **kwargs)
        except FMICallException as e:
            if e.status == FATAL:
                # After Fatal the instance must not be touched again, not even to be freed.
                self._slave = None
            raise LandingError(f"{self.path}: {function} failed: {self._reason(str(e))}") from None

    def _reason(self, otherwise: str) -> str:
        texts = list(dict.fromkeys(text for _, text in self._messages if text))
        return " ".join("; ".join(texts or [otherwise]).split())

    def step(self, k: int, h: float) -> None:
        """Go from k*h to (k+1)*h [s]. The difference of the two, not h, is asked for, so that the time reached is (k+1)*h to the bit.

        Raises LandingError, with the FMU's reason, where the step is refused.
        """
        now = k * h
        self._messages.clear()
        self._call("doStep", currentCommunicationPoint=now, communicationStepSize=(k + 1) * h - now)

    def values(self) -> tuple[float, ...]:
        """All outputs at the present time, in the order of `OUTPUT_NAMES`."""
        slave = self._slave
        found: list[float] = []
        for function, asked, got in self._reads:
            getattr(slave, function)(slave.component, asked, len(got), got)
            found += got
        values: tuple[float, ...] = self._in_order(found)
        return values

    def set_inputs(self, inputs: Mapping[str, float]) -> None:
        """Inputs by name, SI, from now on; others go on as they were. Raises LandingError for an unknown name."""
        for name in inputs:
            if name not in INPUT_NAMES:
                raise unknown("input", name, INPUT_NAMES)
        self._call("setReal", [self._references[name] for name in inputs], list(inputs.values()))

    def close(self) -> None:
        """Terminate and free the instance, and remove the folder that it was unpacked to. May be called again."""
        slave, self._slave = self._slave, None
        folder, self._folder = self._folder, None
        try:
            if slave is not None:
                try:
                    slave.terminate()
                finally:
                    slave.freeInstance()
        finally:
            if folder is not None:
                folder.remove()

    def __enter__(self) -> FmuRunner:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


def read_description(path: Path) -> Any:
    """FMPy's description of the FMU at `path`. Raises LandingError: no such file, not an FMU, not this model's, FMPy missing."""
    if not path.is_file():
        raise LandingError(f"there is no FMU {path}; build it with ./build_fmu.sh or name one by --fmu")
    try:
        from fmpy import read_model_description
    except ImportError:
        raise LandingError('FMPy is missing; install it with pip install "rlv-landing[ros]"') from None
    try:
        description = read_model_description(str(path))
    except (zipfile.BadZipFile, KeyError):
        raise LandingError(f"{path} is not an FMU: it is no zip archive with a modelDescription.xml in it") from None
    except Exception as e:
        raise LandingError(f"{path} is not an FMU that can be read: {' '.join(str(e).split())}") from None
    if description.modelName != MODEL_NAME:
        raise LandingError(f"{path} holds the model {description.modelName!r}, not {MODEL_NAME!r}; build ours with ./build_fmu.sh")
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise LandingError(f"{path} is not an FMU for FMI 2.0 co-simulation; build ours with ./build_fmu.sh")
    return description
