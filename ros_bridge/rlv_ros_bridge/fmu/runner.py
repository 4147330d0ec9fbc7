"""Steps the landing's FMU through FMPy."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from contextlib import suppress
from operator import itemgetter
from pathlib import Path
from tempfile import gettempdir
from types import TracebackType
from typing import Any, NoReturn, TypeVar

from rlv_landing import MODEL_NAME
from rlv_landing.errors import LandingError, unknown
from rlv_landing.parameters import PARAMETER_QUANTITIES, parameters_of
from rlv_landing.quantities import MODES, SPACE, STATISTIC_QUANTITIES, Interface
from rlv_landing.text.durable import writing

from .description import check_size, interface_in, places, read_description, without
from .fmi2 import Fmi2
from .fmi3 import Fmi3, with_ground_rates
from .folder import ProcessFolder
from .library import check_library
from .reader import Reader

FOLDER_PREFIX = "rlv-landing-fmu-"
# fmi2Status.
WARNING, FATAL = 1, 4
Value = TypeVar("Value", float, str)


class FmuRunner:
    """One instance of the FMU at time 0, ready to step.

    Args:
        fmu_path: the `.fmu` file.
        values: parameters by name, SI; others keep the FMU's defaults.
        needed: quantities that the FMU must have; None: all of its interface. One of an older
            version may lack others; parameters that it lacks must have their defaults.

    Attributes:
        interface: its inputs and outputs.
        output_names: the outputs of `values()`: those of its interface that it has.

    Raises:
        LandingError: no such file, not an FMU, another model, an unknown parameter, or one that the
            FMU lacks or refuses (with its reason), or there is no room to unpack it.
    """

    def __init__(
        self,
        fmu_path: str | Path,
        values: Mapping[str, float | str],
        needed: Container[str] | None = None,
    ) -> None:
        self.path = Path(fmu_path)
        self._messages: list[tuple[int, str]] = []
        self._instance: Fmi2 | Fmi3 | None = None
        self._readers: list[Reader] = []
        # that of the integrator's counters, once they have been read
        self._counters: Reader | None = None
        # Integer and Boolean outputs: index in a sample, reader, index in what it reads.
        self._not_real: list[tuple[int, int, int]] = []
        self._folder: ProcessFolder | None = None
        description = read_description(self.path)
        self.guid: str = description.guid
        self.version: str = description.version or ""
        self.made_by: str = description.generationTool or ""
        self._places = places(description, self.path, needed)
        self.interface: Interface = interface_in(description)
        names = self.interface.output_names
        self.output_names = tuple(name for name in names if name in self._places)
        try:
            self._instantiate(description, self._own_parameters(values))
            self._prepare_outputs()
        except BaseException:
            self.close()
            raise

    def _own_parameters(self, values: Mapping[str, float | str]) -> dict[str, float | str]:
        """The parameters without the defaults of those that the FMU lacks.

        Without those of landings in space, too, where it is of others, which they do not change.
        """
        own = {}
        counting = parameters_of(SPACE if self.interface.in_space else min(MODES))
        for name, value in values.items():
            if name not in PARAMETER_QUANTITIES:
                raise unknown("parameter", name, PARAMETER_QUANTITIES)
            if name in self._places:
                own[name] = value
            elif name in counting and value != PARAMETER_QUANTITIES[name].default:
                raise without(self.path, self.version, name)
        return own

    def _instantiate(self, description: Any, values: Mapping[str, float | str]) -> None:
        from fmpy import extract

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
        check_library(description, Path(unpacked), self.path)
        kind = Fmi3 if description.fmiVersion == "3.0" else Fmi2
        try:
            self._instance = kind(description, unpacked, MODEL_NAME, self._log)
        except Exception as e:
            raise LandingError(f"{self.path} does not load here: {self._reason(str(e))}") from None
        reals = {n: float(v) for n, v in values.items() if not isinstance(v, str)}
        texts = {n: v for n, v in values.items() if isinstance(v, str)}
        self._instance.initialise(self._call, self._by_reference(reals), self._by_reference(texts))

    def _by_reference(self, values: Mapping[str, Value]) -> dict[int, Value]:
        return {self._places[name].reference: value for name, value in values.items()}

    def _reader(self, kind: str, names: Sequence[str]) -> Reader:
        return Reader(self._own(), kind, [self._places[name] for name in names])

    def _read(self, reader: Reader) -> list[Any]:
        status = reader.read()
        if status > WARNING:
            self._fail(reader.name, status)
        return reader.values()

    def _prepare_outputs(self) -> None:
        kinds = {q.name: q.kind for q in self.interface.outputs}
        for k, kind in enumerate(("real", "integer", "boolean")):
            indices = [i for i, name in enumerate(self.output_names) if kinds[name] == kind]
            self._readers.append(self._reader(kind, [self.output_names[i] for i in indices]))
            if kind != "real":
                self._not_real += [(i, k, j) for j, i in enumerate(indices)]
        self._not_real.sort(key=itemgetter(0))

    def _log(self, status: int, message: str) -> None:
        self._messages.append((status, message))

    def _call(self, function: str, *args: Any, **kwargs: Any) -> Any:
        from fmpy.fmi1 import FMICallException

        try:
            return getattr(self._own().slave, function)(*args, **kwargs)
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
        instance, self._instance = self._instance, None
        self._readers, self._not_real, self._counters = [], [], None
        return instance and instance.slave

    def _own(self) -> Fmi2 | Fmi3:
        if self._instance is None:
            raise LandingError(f"{self.path} has been freed; it has no values any more")
        return self._instance

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
        status = self._own().step(now, end - now)
        if status > WARNING:
            self._fail("doStep", status)

    def values(self) -> list[float]:
        """All outputs at the current time, SI, in the order of `output_names`.

        Raises:
            LandingError: the FMU refuses.
        """
        self._own()
        samples = []
        for reader in self._readers:
            if (status := reader.read()) > WARNING:
                self._fail(reader.name, status)
            samples.append(reader.values())
        values: list[float] = samples[0]
        # The indices ascend, so each insertion leaves the later indices right.
        for i, k, j in self._not_real:
            values.insert(i, samples[k][j])
        return values

    def statistics(self) -> dict[str, int]:
        """The integrator's counters since time 0, by the FMU's variable names."""
        names = [q.name for q in STATISTIC_QUANTITIES if q.kind == "integer"]
        if self._counters is None:
            self._counters = self._reader("integer", names)
        return dict(zip(names, self._read(self._counters)))

    def peaks(self) -> dict[str, tuple[float, float]]:
        """Value [SI] and time [s] of each peak since time 0, by the FMU's variable names.

        Raises:
            LandingError: the FMU refuses, or has been freed.
        """
        names = [q.name for q in self.interface.peak_quantities if q.name in self._places]
        if not names:
            return {}
        values = dict(zip(names, self._read(self._reader("real", names))))
        return {
            p.value.name: (values[p.value.name], values[p.time.name])
            for p in self.interface.peaks
            if p.value.name in values
        }

    def is_compiled(self) -> bool:
        """Whether the FMU computes with its compiled core."""
        return bool(self._read(self._reader("boolean", ["solver.compiled"]))[0])

    @property
    def takes_rates(self) -> bool:
        """Whether inputs other than the ground's positions can have rates."""
        return isinstance(self._instance, Fmi2)

    def set_inputs(
        self, inputs: Mapping[str, float], rates: Mapping[str, float] | None = None
    ) -> None:
        """Sets inputs by name, SI, from the current time on; others keep their values.

        Args:
            inputs: their values.
            rates: their rates, per second; the others are constant.

        Raises:
            LandingError: an unknown name, a rate that the FMU's version of FMI cannot carry, or the
                FMU refuses a value.
        """
        for name in (*inputs, *(rates or {})):
            if name not in self.interface.input_names:
                raise unknown("input", name, self.interface.input_names)
            if name not in self._places:
                raise without(self.path, self.version, name)
        instance = self._own()
        if isinstance(instance, Fmi3):
            inputs, rates = with_ground_rates(inputs, rates or {}), None
        values = self._by_reference(inputs)
        self._call(instance.SET_REAL, list(values), list(values.values()))
        if rates and isinstance(instance, Fmi2):
            status = instance.set_rates(self._by_reference(rates))
            if status > WARNING:
                self._fail(instance.SET_RATES, status)

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
