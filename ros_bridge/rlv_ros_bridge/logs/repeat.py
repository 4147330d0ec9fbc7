"""A log's run once more: the model's samples from what the log carries."""

from __future__ import annotations

from collections.abc import Callable, Generator
from itertools import count
from pathlib import Path

from rlv_landing import Landing, Parameters
from rlv_landing.errors import LandingError
from rlv_landing.quantities import OUTPUT_NAMES

from ..messages.inputs import READINGS
from ..messages.topics import APPLIED, resolve
from .reader import Decoder, LogReader

# Inputs by the number of the sample from which on they act.
Inputs = dict[int, list[dict[str, float]]]


class Run:
    """What it takes to repeat the run of a log that has been read: parameters, step [s], inputs
    with their times, and the FMU to use instead of `Landing`, if any. `input_messages` counts the
    inputs.

    Raises LandingError, naming what is missing and what would be needed.
    """

    def __init__(self, reader: LogReader, fmu: Path | None = None) -> None:
        cannot = f"{reader.path} cannot be repeated: "
        parameters = reader.parameters()
        if parameters is None:
            raise LandingError(
                cannot
                + "it carries no parameters.toml; logs of `rlv-landing node` carry it, other recordings do not"
            )
        self.parameters: Parameters = parameters
        self.step = _number(reader, "step_size", cannot)
        self.step_ns = round(self.step * 1e9)
        if self.step_ns < 1:
            raise LandingError(
                cannot + f"its step_size = {self.step:g} s is not a step of 1 ns or more"
            )
        self.stop_time = _number(reader, "stop_time", cannot)
        mode = reader.metadata.get("mode", parameters.drop.mode)
        if mode != parameters.drop.mode:
            raise LandingError(
                cannot
                + f"its metadata say mode {mode}, its parameters.toml {parameters.drop.mode}; one was changed"
            )
        self._inputs = _inputs(reader, self.step_ns, cannot)
        self.input_messages = sum(map(len, self._inputs.values()))
        self._fmu = fmu

    def samples(self) -> Generator[dict[str, float], None, None]:
        """All outputs by name at 0, one step, two steps, and so on without end; the inputs act at
        their times, those at 0 before the first sample.
        """
        if self._fmu is None:
            landing = Landing(self.parameters)

            def go_on(k: int) -> None:
                landing.advance_to((k + 1) * self.step)

            yield from self._samples(landing.outputs, landing.set_inputs, go_on)
            return
        from ..fmu.runner import FmuRunner

        with FmuRunner(self._fmu, dict(self.parameters.items())) as runner:
            yield from self._samples(
                lambda: dict(zip(OUTPUT_NAMES, runner.values())),
                runner.set_inputs,
                lambda k: runner.step(k, self.step),
            )

    def _samples(
        self,
        outputs: Callable[[], dict[str, float]],
        set_inputs: Callable[[dict[str, float]], None],
        go_on: Callable[[int], None],
    ) -> Generator[dict[str, float], None, None]:
        """The same of any model that goes on from step k to k + 1."""
        for k in count():
            if k == 0:
                self._set(0, set_inputs)
            yield outputs()
            if k > 0:
                self._set(k, set_inputs)
            go_on(k)

    def _set(self, k: int, set_inputs: Callable[[dict[str, float]], None]) -> None:
        for values in self._inputs.get(k, ()):
            set_inputs(values)


def _inputs(reader: LogReader, step_ns: int, cannot: str) -> Inputs:
    """What the log says of inputs, in its order.

    Raises LandingError for one that cannot be, or whose time is not that of a sample.
    """
    names = {resolve(reader.namespace, name): read for name, read in READINGS.items()}
    for topic in (t for t in APPLIED if resolve(reader.namespace, t.name) in reader.channels):
        found_type = reader.channels[resolve(reader.namespace, topic.name)].type_name
        if found_type != topic.type_name:
            raise LandingError(
                f"{cannot}its topic {topic.name} is {found_type}, not {topic.type_name}; another program has written it"
            )
    decode = Decoder(reader)
    found: Inputs = {}
    for message in reader.messages(names):
        at = f"{cannot}its input {message.topic} at {message.log_time / 1e9:.9g} s "
        decoded = decode(message)
        stamp = decoded.header.stamp
        k, rest = divmod(message.log_time, step_ns)
        if stamp.sec * 1_000_000_000 + stamp.nanosec != message.log_time:
            raise LandingError(
                at + f"has the stamp {stamp.sec}.{stamp.nanosec:09d} s; one of the two was changed"
            )
        if rest or k < 0:
            raise LandingError(
                at + f"is not at a sample: those are {step_ns / 1e9:g} s apart; it was changed"
            )
        try:
            found.setdefault(k, []).append(names[message.topic](decoded))
        except LandingError as e:
            raise LandingError(at + f"cannot be: {e}") from None
    return found


def _number(reader: LogReader, name: str, cannot: str) -> float:
    try:
        value = float(reader.metadata[name])
    except KeyError:
        raise LandingError(
            cannot
            + f"its metadata do not say {name}; logs of `rlv-landing node` do, other recordings do not"
        ) from None
    except ValueError:
        raise LandingError(
            cannot + f"its {name} = {reader.metadata[name]!r} is not a number of seconds"
        ) from None
    if not 0.0 < value < 1e9:
        raise LandingError(cannot + f"its {name} = {value:g} s is not a time above 0 s")
    return value
