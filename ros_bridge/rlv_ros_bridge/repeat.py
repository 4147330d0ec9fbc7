"""A log's run once more: the model's samples from what the log carries."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

from rlv_landing import Landing, Parameters
from rlv_landing.errors import LandingError
from rlv_landing.quantities import OUTPUT_NAMES

from .log_reader import LogReader
from .topics import resolve

# Topics by which a run may be steered. No node of ours takes any yet; with them a landing follows from its parameters only together
# with what they brought, to be given to `Landing.set_inputs` in `Run.samples` at the times of the messages.
INPUT_TOPICS = ("external_wrench", "ground")


class Run:
    """What it takes to repeat the run of a log that has been read: parameters, step [s], and the FMU to use instead of `Landing`, if any.

    Raises LandingError, naming what is missing and what would be needed.
    """

    def __init__(self, reader: LogReader, fmu: Path | None = None) -> None:
        cannot = f"{reader.path} cannot be repeated: "
        parameters = reader.parameters()
        if parameters is None:
            raise LandingError(cannot + "it carries no parameters.toml; logs of `rlv-landing node` carry it, other recordings do not")
        self.parameters: Parameters = parameters
        self.step = _number(reader, "step_size", cannot)
        self.step_ns = round(self.step * 1e9)
        if self.step_ns < 1:
            raise LandingError(cannot + f"its step_size = {self.step:g} s is not a step of 1 ns or more")
        self.stop_time = _number(reader, "stop_time", cannot)
        mode = reader.metadata.get("mode", parameters.drop.mode)
        if mode != parameters.drop.mode:
            raise LandingError(cannot + f"its metadata say mode {mode}, its parameters.toml {parameters.drop.mode}; one was changed")
        steered = [name for name in INPUT_TOPICS if resolve(reader.namespace, name) in reader.channels]
        if steered:
            raise LandingError(
                cannot + f"it was steered by {', '.join(steered)}, which this version cannot repeat; use the one that recorded it"
            )
        self._fmu = fmu

    def samples(self) -> Generator[dict[str, float], None, None]:
        """All outputs by name at 0, one step, two steps, and so on without end."""
        if self._fmu is None:
            landing = Landing(self.parameters)
            k = 0
            while True:
                landing.advance_to(k * self.step)
                yield landing.outputs()
                k += 1
        from .fmu_runner import FmuRunner

        with FmuRunner(self._fmu, dict(self.parameters.items())) as runner:
            k = 0
            while True:
                yield dict(zip(OUTPUT_NAMES, runner.values()))
                runner.step(k, self.step)
                k += 1


def _number(reader: LogReader, name: str, cannot: str) -> float:
    try:
        value = float(reader.metadata[name])
    except KeyError:
        raise LandingError(cannot + f"its metadata do not say {name}; logs of `rlv-landing node` do, other recordings do not") from None
    except ValueError:
        raise LandingError(cannot + f"its {name} = {reader.metadata[name]!r} is not a number of seconds") from None
    if not 0.0 < value < 1e9:
        raise LandingError(cannot + f"its {name} = {value:g} s is not a time above 0 s")
    return value
