"""Repeats the run of a log: the model's samples from the log's parameters and inputs."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from functools import partial
from itertools import count, islice
from pathlib import Path
from typing import Any

from rlv_landing import Landing, Parameters
from rlv_landing.core import SpatialInputs
from rlv_landing.errors import LandingError
from rlv_landing.figures.ground.shape import deck_of
from rlv_landing.text.units import parse_number

from ...messages.fields import Vehicle
from ...messages.inputs import READINGS, input_table_of
from ...messages.tables import table_of
from ...messages.topics import APPLIED, resolve
from ...messages.wire import NANOSECONDS
from ..indexed import messages_of
from ..peaks import landing_peaks
from ..reader import Decoder, LogReader

# Inputs by the number of the sample from which on they act.
Inputs = dict[int, list[dict[str, float]]]


class RepeatedRun:
    """The data needed to repeat the run of a log.

    `step` and `stop_time` are in s. `vehicle` is what messages tell beside the outputs.
    `input_messages` counts the inputs.

    Args:
        reader: the log, read to its end.
        fmu: the FMU that repeats the run; None: `Landing`.

    Raises:
        LandingError: the log lacks something, which the text names.
    """

    def __init__(self, reader: LogReader, fmu: Path | None = None) -> None:
        refusal = f"{reader.path} cannot be repeated: "
        parameters = reader.parameters()
        if parameters is None:
            raise LandingError(
                refusal + "it carries no parameters.toml; "
                "logs of `rlv-landing node` carry it, other recordings do not"
            )
        self.parameters: Parameters = parameters
        self.step = _seconds(reader, "step_size", refusal)
        self.step_ns = round(self.step * 1e9)
        if self.step_ns < 1:
            raise LandingError(
                refusal + f"its step_size = {self.step:g} s is not a step of 1 ns or more"
            )
        self.stop_time = _seconds(reader, "stop_time", refusal)
        mode = reader.metadata.get("mode", parameters.drop.mode)
        if mode != parameters.drop.mode:
            raise LandingError(
                refusal + f"its metadata say mode {mode}, its parameters.toml "
                f"{parameters.drop.mode}; one was changed"
            )
        self.vehicle = Vehicle.of(parameters, reader.metadata.get("frame_prefix", ""))
        self._inputs = _inputs(reader, self.step_ns, refusal)
        self.input_messages = sum(map(len, self._inputs.values()))
        self._fmu = fmu
        self._peaks: Callable[[], dict[str, tuple[float, float]]] = dict

    def peaks(self) -> dict[str, tuple[float, float]]:
        """Value [SI] and time [s] of each peak until the last of `samples`, by `peak.OUTPUT.SIDE`.

        Those that an FMU of an older version lacks are left out.
        Only while `samples` is not closed.
        """
        return self._peaks()

    def samples(self) -> Generator[dict[str, float], None, None]:
        """The model's outputs by name at 0, one step, two steps, and so on without end.

        The inputs act at their times, those at 0 before the first sample.
        """
        if self._fmu is None:
            landing = Landing(self.parameters)
            self._peaks = lambda: landing_peaks(landing)

            def step(k: int) -> None:
                landing.advance_to((k + 1) * self.step)

            yield from self._samples(landing.outputs, landing.set_inputs, step)
            return
        from ...fmu.runner import FmuRunner

        # it may be of an older version, which lacks quantities that no message has
        needed = table_of(self.vehicle.interface).needed
        with FmuRunner(self._fmu, dict(self.parameters.items()), needed) as runner:
            self._peaks = runner.peaks
            yield from self._samples(
                lambda: dict(zip(runner.output_names, runner.values())),
                runner.set_inputs,
                lambda k: runner.step(k, self.step),
            )

    def decks(self, times: Sequence[float]) -> list[SpatialInputs]:
        """Where the ground is at the samples nearest to `times` [s], which grow.

        Raises:
            LandingError: the landing cannot be repeated up to the last of them.
        """
        landing = Landing(self.parameters)
        found: list[SpatialInputs] = []

        def step(k: int) -> None:
            found.append(deck_of(landing.ground_places()))
            landing.advance_to((k + 1) * self.step)

        wanted = [round(time / self.step) for time in times]
        for _ in islice(self._samples(dict, landing.set_inputs, step), wanted[-1] + 2):
            pass
        return [found[k] for k in wanted]

    def _samples(
        self,
        outputs: Callable[[], dict[str, float]],
        set_inputs: Callable[[dict[str, float]], None],
        step: Callable[[int], None],
    ) -> Generator[dict[str, float], None, None]:
        """The samples of a model that `step` integrates from sample k to k + 1."""
        for k in count():
            if k == 0:
                self._set(0, set_inputs)
            yield outputs()
            if k > 0:
                self._set(k, set_inputs)
            step(k)

    def _set(self, k: int, set_inputs: Callable[[dict[str, float]], None]) -> None:
        for values in self._inputs.get(k, ()):
            set_inputs(values)


def _inputs(reader: LogReader, step_ns: int, refusal: str) -> Inputs:
    """The inputs in the log, in its order.

    Raises:
        LandingError: an input is out of bounds, or its time is not that of a sample.
    """
    names = {resolve(reader.namespace, name): read for name, read in READINGS.items()}
    for topic in (t for t in APPLIED if resolve(reader.namespace, t.name) in reader.channels):
        found_type = reader.channels[resolve(reader.namespace, topic.name)].type_name
        if found_type != topic.type_name:
            raise LandingError(
                f"{refusal}its topic {topic.name} is {found_type}, not {topic.type_name}; "
                "another program has written it"
            )
    decode = Decoder(reader)
    table = input_table_of(reader.interface)
    found: Inputs = {}
    for message in messages_of(reader, names):
        at = f"{refusal}its input {message.topic} at {message.log_time / 1e9:.9g} s "
        seconds, nanoseconds = decode.read(message, _stamp)
        k, rest = divmod(message.log_time, step_ns)
        if seconds * NANOSECONDS + nanoseconds != message.log_time:
            raise LandingError(
                at + f"has the stamp {seconds}.{nanoseconds:09d} s; one of the two was changed"
            )
        if rest or k < 0:
            raise LandingError(
                at + f"is not at a sample: those are {step_ns / 1e9:g} s apart; it was changed"
            )
        try:
            values = decode.read(message, partial(names[message.topic], table=table))
            found.setdefault(k, []).append(values)
        except LandingError as e:
            raise LandingError(at + f"cannot be: {e}") from None
    return found


def _stamp(message: Any) -> tuple[int, int]:
    """Seconds and nanoseconds of the stamp in a message's header."""
    stamp = message.header.stamp
    return int(stamp.sec), int(stamp.nanosec)


def _seconds(reader: LogReader, name: str, refusal: str) -> float:
    try:
        value = parse_number(reader.metadata[name])
    except KeyError:
        raise LandingError(
            refusal + f"its metadata do not say {name}; "
            "logs of `rlv-landing node` do, other recordings do not"
        ) from None
    except ValueError:
        raise LandingError(
            refusal + f"its {name} = {reader.metadata[name]!r} is not a number of seconds"
        ) from None
    if not 0.0 < value < 1e9:
        raise LandingError(refusal + f"its {name} = {value:g} s is not a time above 0 s")
    return value
