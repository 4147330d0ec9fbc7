"""Repeats the run of a log and compares every field of every sample."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError

from ..fmu.builds import inexact_reason
from ..messages.fields import FIELDS, expected_fields, leaves
from ..messages.topics import resolve
from .reader import Decoder, LogMessage, LogReader
from .repeat import Run

# Share of a field's largest value that a repetition by another build may differ by. One unit in the
# last place of a parameter comes to 0.31 % within 3 s of the drop tests (a friction force that
# switches from stick to slip): contact magnifies the smallest difference.
TOLERANCE = 0.01


@dataclass(frozen=True)
class Difference:
    """Where log and repetition differ: topic, field, time [s], and both values (SI, ROS axes; None:
    not there).
    """

    topic: str
    field: str
    time: float
    recorded: Any
    repeated: Any

    def text(self) -> str:
        """As a line for people."""
        if self.recorded is None:
            return f"{self.topic} at {self.time:.9g} s{', ' + self.field if self.field else ''}: missing from the log"
        if self.repeated is None:
            return f"{self.topic} at {self.time:.9g} s: {self.recorded} than the repeated run has"
        return f"{self.topic} at {self.time:.9g} s, {self.field}: {self.recorded!r} in the log, {self.repeated!r} when repeated"


@dataclass
class Verification:
    """How a log compares: instants, messages and values compared, inputs repeated, values that are
    not the same bits, the largest difference as a share of its field's largest value; `not_exact`
    says why not all bits must be the same, or is empty; `first` is the first difference that
    counts.
    """

    path: str
    not_exact: str
    tolerance: float
    instants: int = 0
    messages: int = 0
    values: int = 0
    inputs: int = 0
    other_bits: int = 0
    largest: float = 0.0
    first: Difference | None = None
    end: float = 0.0
    stop_time: float = 0.0
    cut: bool = False

    @property
    def same(self) -> bool:
        """Whether nothing differs that counts."""
        return self.first is None

    def as_dict(self) -> dict[str, Any]:
        """As plain values, for JSON."""
        return {"same": self.same, **asdict(self)}

    def text(self) -> str:
        """As lines for people."""
        until = f"{self.instants} instants up to {self.end:g} s" + (
            "" if self.end >= self.stop_time else f" of {self.stop_time:g} s"
        )
        lines = [f"compared  {self.values} values of {self.messages} messages at {until}"]
        if self.inputs:
            lines.append(
                f"steered   by {self.inputs} input{'s' if self.inputs > 1 else ''}, repeated at their times"
            )
        if self.first is not None:
            lines.append(f"differs   first in {self.first.text()}")
        elif self.other_bits:
            lines.append(
                f"same      within {self.tolerance:g} of each field's largest value; {self.other_bits} values are not the same bits,"
            )
            lines.append(
                f"          the largest difference is {self.largest:.2g} of its field's largest value"
            )
        else:
            lines.append("same      bit for bit")
        if self.not_exact:
            lines.append(f"note      the bits need not be the same: {self.not_exact}")
        return "\n".join(lines)


def verify(reader: LogReader, fmu: Path | None = None) -> Verification:
    """Repeats the run of the log, by `Landing` or by the FMU `fmu`, and compares all that follows
    from it: every field of struts, pose, rpy, twist, accel, top/accel, contacts and odom (markers
    and diagnostics are not compared). Inputs that the log tells of act again at their times.

    Raises LandingError where the log cannot be repeated.
    """
    # A log has at least as many messages as instants, whatever its times say.
    most_instants = sum(1 for _ in reader.messages())
    run = Run(reader, fmu)
    not_exact = inexact_reason(reader.metadata, fmu)
    found = Verification(
        str(reader.path), not_exact, TOLERANCE if not_exact else 0.0, stop_time=run.stop_time
    )
    found.inputs = run.input_messages
    try:
        with closing(run.samples()) as samples:
            _Comparison(reader, run, found, most_instants).all(samples)
    except _DiffersError as e:
        found.first = e.difference
    found.cut = reader.cut
    return found


class _DiffersError(Exception):
    def __init__(self, difference: Difference) -> None:
        super().__init__(difference.text())
        self.difference = difference


class _Comparison:
    """One pass through a log beside one repetition."""

    def __init__(
        self, reader: LogReader, run: Run, found: Verification, most_instants: int
    ) -> None:
        self._reader = reader
        self._run = run
        self._found = found
        self._most_instants = most_instants
        self._topics = {resolve(reader.namespace, name): name for name in FIELDS}
        self._decode = Decoder(reader)
        self._recovered = "recovered_from" in reader.metadata
        self._scales: Mapping[tuple[str, str], float] | None = None

    def all(self, samples: Iterator[dict[str, float]]) -> None:
        """Compares all messages with `samples`, the repetition's from the start."""
        run, found = self._run, self._found
        k = -1
        missing = set(self._topics)
        values: dict[str, float] = {}
        for message in self._reader.messages(self._topics):
            at, rest = divmod(message.log_time, run.step_ns)
            if rest or at < max(k, 0) or (at == k and message.topic not in missing):
                self._differ(message.topic, "", message.log_time / 1e9, "a message more", None)
            while at > k:
                if k >= 0 and missing:
                    self._differ(min(missing), "", k * run.step, None, "a message")
                if k * run.step > run.stop_time + run.step:
                    self._differ(
                        message.topic,
                        "",
                        message.log_time / 1e9,
                        "a message after the stop time",
                        None,
                    )
                k += 1
                values = next(samples)
                missing = set(self._topics)
                found.instants += 1
            self._compare(message, values)
            missing.discard(message.topic)
        if found.instants == 0:
            raise LandingError(
                f"{self._reader.path} cannot be compared: it holds no message of {', '.join(self._topics)}"
            )
        if missing and not (self._reader.cut or self._recovered):
            self._differ(min(missing), "", k * run.step, None, "a message")
        found.end = k * run.step

    def _compare(self, message: LogMessage, values: Mapping[str, float]) -> None:
        expected = expected_fields(self._topics[message.topic], values, message.log_time)
        found = self._found
        found.messages += 1
        paths = set()
        for path, recorded in leaves(self._decode(message)):
            paths.add(path)
            found.values += 1
            repeated = expected.get(path, "" if isinstance(recorded, str) else type(recorded)(0))
            if isinstance(recorded, float) and isinstance(repeated, (float, int)):
                if struct.pack("<d", recorded) != struct.pack("<d", repeated):
                    found.other_bits += 1
                    self._judge(message, path, recorded, float(repeated))
            elif recorded != repeated:
                self._differ(message.topic, path, message.log_time / 1e9, recorded, repeated)
        for path in expected:
            if path not in paths:
                self._differ(message.topic, path, message.log_time / 1e9, None, expected[path])

    def _judge(self, message: LogMessage, path: str, recorded: float, repeated: float) -> None:
        scale = self._scale(self._topics[message.topic], path) if self._found.not_exact else 0.0
        share = (
            abs(recorded - repeated) / scale
            if scale > 0.0
            else (0.0 if recorded == repeated else math.inf)
        )
        if not (self._found.not_exact and share <= TOLERANCE):
            self._differ(message.topic, path, message.log_time / 1e9, recorded, repeated)
        self._found.largest = max(self._found.largest, share)

    def _scale(self, topic: str, path: str) -> float:
        """The largest value of a field in the repetition up to the log's end; it is made once more
        for that.
        """
        if self._scales is None:
            self._scales = _largest(
                self._run, min(self._most_instants, int(self._run.stop_time / self._run.step) + 1)
            )
        return self._scales.get((topic, path), 0.0)

    def _differ(self, topic: str, field: str, time: float, recorded: Any, repeated: Any) -> None:
        raise _DiffersError(Difference(topic, field, time, recorded, repeated))


def _largest(run: Run, count: int) -> dict[tuple[str, str], float]:
    scales: dict[tuple[str, str], float] = {}
    with closing(run.samples()) as samples:
        for values in islice(samples, count):
            for topic, fields in FIELDS.items():
                for path, value in fields(values).items():
                    if isinstance(value, float):
                        scales[topic, path] = max(scales.get((topic, path), 0.0), abs(value))
    return scales
