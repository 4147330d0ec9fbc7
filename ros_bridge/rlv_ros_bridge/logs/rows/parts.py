"""The rows of a log's landing in parts: a long log takes no more memory than a short one."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from rlv_landing.errors import LandingError
from rlv_landing.history import History
from rlv_landing.text.units import parse_number

from ...fmu.peaks import Found, known_extremes
from ...messages.columns import readings_of
from ...messages.topics import resolve, topics_of
from ...messages.wire import NANOSECONDS
from ..indexed import is_seekable, messages_between, span_of
from ..lost import lost_text
from ..mcap_files.summary import ChunkPlace
from ..peaks import read_peaks
from ..reader import Decoder, LogMessage, LogReader
from .instants import OrderError, RowChoice, instants

# Rows of a part of a history.
ROWS_AT_ONCE = 1000
# Instants by which messages of our own logs may be out of order.
FEW_INSTANTS = 4
Result = TypeVar("Result")


def with_parts(
    reader: LogReader,
    topics: Sequence[str] | Callable[[], Sequence[str]],
    choice: RowChoice,
    use: Callable[[HistoryParts], Result],
) -> Result:
    """What `use` makes of the landing in parts, as `log_history` reads them.

    Parts are some thousand rows each, so that a long log takes no more memory than a short one. If
    the instants of a log are too far out of order for that, `use` is called once more, with one
    part of all rows.

    Args:
        reader: the log.
        topics: as in `log_history`, or what gives them when the log's start has been read.
        choice: the rows to take; it is reset.
        use: what to do.
    """
    if not reader.read_summary():
        reader.read_through()
    chosen = choose_topics(reader, topics() if callable(topics) else topics)
    try:
        choice.reset()
        return use(HistoryParts(reader, chosen, choice, ROWS_AT_ONCE))
    except OrderError:
        choice.reset()
        return use(HistoryParts(reader, chosen, choice, sys.maxsize))


class HistoryParts:
    """The rows of a log in parts, each a `History`.

    Args:
        reader: the log, its summary or its whole read.
        chosen: the topics: full name -> name relative to the landing's namespace.
        choice: the rows to take.
        size: rows of a part, and instants by which messages may be out of order.
    """

    def __init__(
        self, reader: LogReader, chosen: Mapping[str, str], choice: RowChoice, size: int
    ) -> None:
        self._reader, self._chosen, self._choice, self._size = reader, chosen, choice, size
        self._incomplete = 0
        self._readings = readings_of(reader.interface)
        self.names = [
            name
            for relative, (names, _) in self._readings.items()
            if relative in chosen.values()
            for name in names
        ]
        self.parameters = reader.parameters()

    def __iter__(self) -> Iterator[History]:
        """The parts in the order of time.

        Raises:
            LandingError: there is no row, or a message is of another layout.
            OrderError: messages are out of order by more than the size of a part.
        """
        times: list[float] = []
        stamps: list[int] = []
        rows: list[list[float]] = []
        decode = Decoder(self._reader)
        self._incomplete, count = 0, 0
        found, window = self._messages()
        for nanoseconds, messages in instants(found, decode, window):
            time = _seconds(self._reader, nanoseconds)
            self._choice.note(time)
            if not self._choice.wants(time):
                continue
            if len(messages) < len(self._chosen):
                self._incomplete += 1
                continue
            self._choice.takes(time)
            row: dict[str, float] = {}
            for topic, message in messages.items():
                columns, reading = self._readings[self._chosen[topic]]
                row.update(zip(columns, decode.read(message, _floats_of(reading))))
            times.append(time)
            stamps.append(nanoseconds)
            rows.append([row[name] for name in self.names])
            count += 1
            if len(rows) >= self._size:
                yield self._history(times, stamps, rows)
                times, stamps, rows = [], [], []
        if rows:
            yield self._history(times, stamps, rows)
        if not count:
            self._choice.refuse()
            raise LandingError(
                f"{self._reader.path} holds no landing: no instant has all of "
                f"{', '.join(self._chosen.values())}"
            )

    def _messages(self) -> tuple[Iterator[LogMessage], int]:
        """The messages of the topics, and by how many instants they may be out of order.

        Of our logs, in which the time of each message is its stamp, only the chunks are read whose
        instants may be chosen.
        """
        reader, choice = self._reader, self._choice
        if choice.is_all or self._size > ROWS_AT_ONCE or not is_seekable(reader):
            return reader.messages(self._chosen), self._size
        for nanoseconds in span_of(reader) or ():
            choice.note(nanoseconds / NANOSECONDS)

        def is_not_needed(chunk: ChunkPlace) -> bool:
            return chunk.last < choice.first

        found = messages_between(reader, self._chosen, choice.first, choice.last, is_not_needed)
        return found, FEW_INSTANTS

    def _history(self, times: list[float], stamps: list[int], rows: list[list[float]]) -> History:
        history = History(np.array(times), self.names, np.array(rows), self.parameters)
        history.stamps = stamps
        return history

    def peaks(self) -> dict[str, Found]:
        """The peaks of the log's record by `OUTPUT.SIDE`; none where rows were chosen by time."""
        if not self._reader.peaks or self._choice.is_part:
            return {}
        return read_peaks(self._reader.peaks, str(self._reader.path))[0]

    def joined(self) -> History:
        """All rows as one history, with the extremes of the log's record."""
        parts = list(self)
        time = np.concatenate([p.time for p in parts])
        data = np.concatenate([p.data for p in parts])
        return self.complete(History(time, self.names, data, self.parameters))

    def complete(self, history: History) -> History:
        """A history of the log with the extremes of its record, where it has them."""
        if found := self.peaks():
            history.extremes = known_extremes(found, history)
        return history

    def notes(self) -> list[str]:
        """What was left out, after all parts have been read."""
        return _notes(self._reader, self._chosen, self._incomplete)


def _floats_of(reading: Callable[[Any], Iterable[Any]]) -> Callable[[Any], list[float]]:
    return lambda message: [float(value) for value in reading(message)]


def choose_topics(reader: LogReader, topics: Sequence[str]) -> dict[str, str]:
    """The topics to read: full name -> name relative to the landing's namespace."""
    interface = reader.interface
    types = {t.name: t.type_name for t in topics_of(interface.legs).sampled}
    full = {resolve(reader.namespace, name): name for name in readings_of(interface)}
    readable = {
        name: relative
        for name, relative in full.items()
        if name in reader.channels and reader.channels[name].type_name == types[relative]
    }
    if not topics:
        missing = [name for name in full if name not in readable]
        if missing:
            hint = (
                f"; export what is there by --topics {','.join(readable.values())}"
                if readable
                else ""
            )
            raise LandingError(
                f"{reader.path} holds no landing: it lacks {', '.join(missing)}{hint}"
            )
        return readable
    chosen = reader.select(topics)
    for name in chosen:
        if name not in readable:
            raise LandingError(
                f"topic {name!r} has no columns; those that have are "
                f"{', '.join(readable.values()) or 'not in this log'}"
            )
    return {name: relative for name, relative in readable.items() if name in chosen}


def _notes(reader: LogReader, chosen: Mapping[str, str], incomplete: int) -> list[str]:
    own = f"/{reader.namespace.strip('/')}/"
    ignored = [name.removeprefix(own) for name in reader.channels if name not in chosen]
    notes = [f"left aside: {', '.join(ignored)}"] if ignored else []
    if lost := lost_text(reader.gaps):
        notes.append(f"missing: {lost}, for which the disk was too slow")
    if incomplete:
        notes.append(f"left out: {incomplete} instants that lack one of the topics")
    return notes


def _seconds(reader: LogReader, nanoseconds: int) -> float:
    # The landing's own times are k * step; computed alike, they agree to the bit.
    try:
        step = parse_number(reader.metadata["step_size"])
        k, rest = divmod(nanoseconds, round(step * 1e9))
    except (KeyError, ValueError, OverflowError, ZeroDivisionError):
        return nanoseconds / 1e9
    return k * step if rest == 0 else nanoseconds / 1e9
