"""Compares a log with a repetition of its run, every field of every sample."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Mapping
from contextlib import closing
from itertools import islice
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError

from ...fmu.builds import inexact_reason
from ...messages import topics
from ...messages.tables import expected_fields, expected_numbers, leaves, table_of
from ...messages.topics import resolve
from ..mcap_files.chunks import FILE_RECORDS, RECORDS_PER_BYTE
from ..peaks import read_peaks
from ..reader import Decoder, LogMessage, LogReader
from .known_bytes import KnownBytes
from .repeat import RepeatedRun
from .result import Difference, Verification

# By this share of a field's largest value a rerun by another build may differ. Contact magnifies
# the smallest difference: one unit in the last place of a parameter makes 0.31 % within 3 s of the
# drop tests, where a friction force switches from stick to slip.
TOLERANCE = 0.01
# Topics that logs of earlier versions lack. In these, frames of contact forces and odometry have
# other names.
ADDED_LATER = {topics.IMU.name, topics.TOP_IMU.name}
FRAMES = {"header.frame_id", "child_frame_id"}
# A sample takes more than this in a log, however well it is compressed [bytes].
SAMPLE_BYTES = 64


def verify(reader: LogReader, fmu: Path | None = None) -> Verification:
    """Repeats the run of the log, and compares all messages that follow from it.

    These are those of every step, `LegTopics.sampled`; markers, transforms and diagnostics are not
    compared. Inputs in the log act again at their times.

    Args:
        reader: the log.
        fmu: the FMU that repeats the run; None: `Landing`.

    Raises:
        LandingError: the log cannot be repeated.
    """
    most_instants = _count_messages(reader)
    run = RepeatedRun(reader, fmu)
    not_exact = inexact_reason(reader.metadata, fmu)
    found = Verification(
        str(reader.path), not_exact, TOLERANCE if not_exact else 0.0, stop_time=run.stop_time
    )
    found.inputs = run.input_messages
    try:
        with closing(run.samples()) as samples:
            _Comparison(reader, run, found, most_instants).compare_with(samples)
    except _DifferenceError as e:
        found.first = e.difference
    found.cut = reader.cut
    return found


class _DifferenceError(Exception):
    def __init__(self, difference: Difference) -> None:
        super().__init__(difference.text())
        self.difference = difference


class _Comparison:
    """One pass through a log beside one repetition."""

    def __init__(
        self, reader: LogReader, run: RepeatedRun, found: Verification, most_instants: int
    ) -> None:
        self._reader = reader
        self._run = run
        self._found = found
        self._most_instants = most_instants
        carried = table_of(run.vehicle.interface).fields_of
        self._topics = {resolve(reader.namespace, name): name for name in carried}
        logged = {channel.topic for channel in reader.channels.values()}
        later = [t for t, name in self._topics.items() if name in ADDED_LATER and t not in logged]
        for topic in later:
            del self._topics[topic]
        self._frames_differ = found.older = bool(later)
        self._decode = Decoder(reader)
        self._recovered = "recovered_from" in reader.metadata
        self._scales: Mapping[tuple[str, str], float] | None = None
        # by topic; None where they cannot be known
        self._known: dict[str, KnownBytes | None] = {}

    def compare_with(self, samples: Iterator[dict[str, float]]) -> None:
        """Compares all messages with `samples`, the repetition's from time 0 on.

        Raises:
            _DifferenceError: a difference beyond the tolerance.
            LandingError: the log holds no message to compare.
        """
        run, found = self._run, self._found
        k = -1
        missing = set(self._topics)
        values: dict[str, float] = {}
        for message in self._reader.messages(self._topics):
            at, rest = divmod(message.log_time, run.step_ns)
            if rest or at < max(k, 0) or (at == k and message.topic not in missing):
                self._raise_difference(
                    message.topic, "", message.log_time / 1e9, "a message more", None
                )
            while at > k:
                if k >= 0 and missing and self._is_lost(k):
                    found.lost += 1
                elif k >= 0 and missing:
                    self._raise_difference(min(missing), "", k * run.step, None, "a message")
                if k * run.step > run.stop_time + run.step:
                    self._raise_difference(
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
                f"{self._reader.path} cannot be compared: "
                f"it holds no message of {', '.join(self._topics)}"
            )
        if missing and self._is_lost(k):
            found.lost += 1
        elif missing and not (self._reader.cut or self._recovered):
            self._raise_difference(min(missing), "", k * run.step, None, "a message")
        found.end = k * run.step
        if self._reader.peaks:
            self._compare_peaks(samples, k)

    def _is_lost(self, k: int) -> bool:
        """Whether sample k is in a gap that the log tells of."""
        now = k * self._run.step_ns
        return any(gap.first <= now <= gap.last for gap in self._reader.gaps)

    def _compare_peaks(self, samples: Iterator[dict[str, float]], k: int) -> None:
        """Compares the log's record of peaks with the repetition's, which is at sample `k`.

        Raises:
            _DifferenceError: a value or a time differs, values beyond the tolerance.
            LandingError: the record cannot be read.
        """
        run, found = self._run, self._found
        recorded, until = read_peaks(self._reader.peaks, str(self._reader.path))
        # A damaged log may have lost its last messages, as many as fit into its file.
        last = k + self._reader.size // SAMPLE_BYTES
        while k * run.step < min(until, run.stop_time) - 0.5 * run.step:
            if k >= last:
                self._raise_difference(
                    "the record of peaks", "until", k * run.step, f"{until!r} s", f"{found.end:g} s"
                )
            next(samples)
            k += 1
        repeated = run.peaks()
        for name, (value, time) in recorded.items():
            if f"peak.{name}" not in repeated:
                continue  # of a version of the FMU before this peak
            expected, expected_time = repeated[f"peak.{name}"]
            found.peaks += 1
            if (value, time) == (expected, expected_time):
                continue
            found.other_bits += 1
            scale = max(abs(expected), abs(value))
            share = abs(value - expected) / scale if scale > 0.0 else 0.0
            if not (found.not_exact and share <= TOLERANCE):
                self._raise_difference(
                    "the record of peaks",
                    name,
                    time,
                    f"{value!r} at {time!r} s",
                    f"{expected!r} at {expected_time!r} s",
                )
            found.largest = max(found.largest, share)

    def _compare(self, message: LogMessage, values: Mapping[str, float]) -> None:
        """Compares a message, by its bytes if these are known and the same, else by its fields.

        Raises:
            _DifferenceError: a difference beyond the tolerance.
        """
        known = self._known.get(message.topic)
        if known is not None and message.data == known.of(message.log_time, values):
            self._found.messages += 1
            self._found.values += known.values
            return
        self._compare_fields(message, values)
        if message.topic not in self._known:
            self._known[message.topic] = self._learn(message)

    def _learn(self, message: LogMessage) -> KnownBytes | None:
        """The bytes of messages like one that is right; None where they cannot be known."""
        # Of a log that differs in bits or in frames, few messages have the bytes.
        if self._found.not_exact or self._frames_differ:
            return None
        fields = table_of(self._run.vehicle.interface).fields_of[self._topics[message.topic]]
        try:
            return KnownBytes(message, self._decode, fields, self._run.vehicle)
        except LandingError:
            return None

    def _compare_fields(self, message: LogMessage, values: Mapping[str, float]) -> None:
        expected = expected_fields(
            self._topics[message.topic], values, message.log_time, self._run.vehicle
        )
        found = self._found
        found.messages += 1
        paths = set()
        for path, recorded in leaves(self._decode(message)):
            paths.add(path)
            if self._frames_differ and path in FRAMES:
                continue
            found.values += 1
            repeated = expected.get(path, "" if isinstance(recorded, str) else 0)
            if isinstance(recorded, float) and isinstance(repeated, (float, int)):
                if struct.pack("<d", recorded) != struct.pack("<d", repeated):
                    found.other_bits += 1
                    self._check_tolerance(message, path, recorded, float(repeated))
            elif recorded != repeated:
                self._raise_difference(
                    message.topic, path, message.log_time / 1e9, recorded, repeated
                )
        for path in expected:
            if path not in paths:
                self._raise_difference(
                    message.topic, path, message.log_time / 1e9, None, expected[path]
                )

    def _check_tolerance(
        self, message: LogMessage, path: str, recorded: float, repeated: float
    ) -> None:
        scale = self._scale(self._topics[message.topic], path) if self._found.not_exact else 0.0
        share = (
            abs(recorded - repeated) / scale
            if scale > 0.0
            else (0.0 if recorded == repeated else math.inf)
        )
        if not (self._found.not_exact and share <= TOLERANCE):
            self._raise_difference(message.topic, path, message.log_time / 1e9, recorded, repeated)
        self._found.largest = max(self._found.largest, share)

    def _scale(self, topic: str, path: str) -> float:
        """The largest magnitude of a field in the repetition up to the log's end.

        It is found by one more repetition, when it is first needed.
        """
        if self._scales is None:
            self._scales = _largest_values(
                self._run, min(self._most_instants, int(self._run.stop_time / self._run.step) + 1)
            )
        return self._scales.get((topic, path), 0.0)

    def _raise_difference(
        self, topic: str, field: str, time: float, recorded: Any, repeated: Any
    ) -> None:
        raise _DifferenceError(Difference(topic, field, time, recorded, repeated))


def _count_messages(reader: LogReader) -> int:
    """The messages of a log, which are at least as many as its instants, whatever its times say.

    The summary tells them, as far as its chunks can hold so many. Without one the log is read.
    """
    if not reader.read_summary():
        return sum(1 for _ in reader.messages())
    told = sum(summary.statistics.message_count for summary in reader.summaries or ())
    return int(min(told, FILE_RECORDS + RECORDS_PER_BYTE * reader.size))


def _largest_values(run: RepeatedRun, count: int) -> dict[tuple[str, str], float]:
    scales: dict[tuple[str, str], float] = {}
    carried = table_of(run.vehicle.interface).fields_of
    with closing(run.samples()) as samples:
        for values in islice(samples, count):
            for topic in carried:
                for path, value in expected_numbers(topic, values, run.vehicle).items():
                    scales[topic, path] = max(scales.get((topic, path), 0.0), abs(value))
    return scales
