"""The landing in a log as a `History`, columns named as the FMU's variables.

Values are SI, in the paper's axes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence, Set
from pathlib import Path

from rlv_landing.figures.thinning import SPANS, joined, measured, thinned
from rlv_landing.history import History

from ..fmu.peaks import known_extremes
from ..messages.columns import readings_of
from ..messages.wire import NANOSECONDS
from .bag_reader import open_log
from .indexed import is_seekable, span_of
from .landing_record import read_landing
from .peaks import read_peaks
from .reader import LogReader
from .rows.instants import MARGIN, RowChoice
from .rows.parts import HistoryParts, with_parts

# What follows the last contact by more than this is no part of a first stroke [s].
MEASURED_SECONDS = 60.0
# The last rows of which none is left out, and those before and behind what a film shows [s].
TAIL_SECONDS = 1.0


def log_history(path: str | Path, topics: Sequence[str] = ()) -> History:
    """The landing in the log at `path`, one row for each instant, bit for bit as published.

    Its extremes are those of the log's record of peaks; None where it has none, as a cut log.
    Instants are the stamps of the messages. Those that lack one of the topics, such as the last of
    a cut log, are left out.

    Args:
        path: a log, or a rosbag2 recording of the same topics.
        topics: only the columns of these topics, full or relative to the namespace; none: all, as
            plots and measures need them.

    Raises:
        LandingError: no such log, no landing in it, unknown topics, or messages of another layout.
    """
    return read_history(open_log(path), topics)[0]


def history_of(reader: LogReader) -> History:
    """The landing in the log that `reader` has open; see `log_history`."""
    return read_history(reader)[0]


def read_history(reader: LogReader, topics: Sequence[str] = ()) -> tuple[History, list[str]]:
    """As `log_history`, with notes on what was left out."""

    def read(parts: HistoryParts) -> tuple[History, list[str]]:
        return parts.joined(), parts.notes()

    return with_parts(reader, topics, RowChoice(), read)


def drawn_history(
    reader: LogReader,
    choice: RowChoice | None = None,
    columns: Set[str] | None = None,
    shown: tuple[float, float] | None = None,
) -> tuple[History, list[str]]:
    """As `read_history`, for a picture: of a long landing some rows, with every curve's peaks.

    Args:
        reader: the log.
        choice: the rows to take; None: all, or those around `shown` where they are quickly found.
        shown: as in `figures.thinning.thinned`; the last time may be infinite, for the log's end.
        columns: the columns that are needed; None: all. Others may be there.
    """
    if shown is not None:
        around, shown = _around(reader, *shown)
        choice = choice or around

    def read(parts: HistoryParts) -> tuple[History, list[str]]:
        return parts.complete(thinned(parts, shown)), parts.notes()

    def needed() -> list[str]:
        return [
            relative
            for relative, (names, _) in readings_of(reader.interface).items()
            if columns is None or not columns.isdisjoint(names)
        ]

    topics = needed if columns is not None else ()
    return with_parts(reader, topics, choice or RowChoice(), read)


def _around(
    reader: LogReader, start: float, end: float
) -> tuple[RowChoice | None, tuple[float, float] | None]:
    """The rows from `start` to `end` [s] and some more, and these times where they are known.

    No rows where the log does not have them all, or has no summary. Who then needs all rows says
    what it has.
    """
    span = span_of(reader) if reader.read_summary() and is_seekable(reader) else None
    if span is None:
        return None, (start, end) if math.isfinite(end) else None
    if not math.isfinite(end):
        end = span[1] / NANOSECONDS
    if not span[0] <= start * NANOSECONDS < end * NANOSECONDS <= span[1]:
        return None, (start, end)
    return RowChoice(start=start - TAIL_SECONDS, end=end + TAIL_SECONDS), (start, end)


def measured_history(reader: LogReader) -> History:
    """As `history_of`, for a summary: of a landing of more than a minute some rows are left out.

    Those from the first contact on are there for a minute, and every curve's peaks. Where the log
    has a record of the peaks, no more of it is read than it takes.
    """

    def read(parts: HistoryParts) -> History:
        return parts.complete(measured(parts))

    until, last = _measured_span(reader)
    if until >= last:
        return with_parts(reader, (), RowChoice(), read)
    every = (last - until) / SPANS
    choices = (
        RowChoice(end=until),
        RowChoice(start=until + every, end=last - TAIL_SECONDS - MARGIN, every=every),
        RowChoice(start=last - TAIL_SECONDS),
    )
    history = joined([with_parts(reader, (), choice, read) for choice in choices])
    history.extremes = known_extremes(read_peaks(reader.peaks, str(reader.path))[0], history)
    return history


def _measured_span(reader: LogReader) -> tuple[float, float]:
    """Up to when each row is needed for measures, and the log's last time [s].

    The first is infinite where the log's records do not say what follows, or where little does.
    """
    span = span_of(reader) if reader.read_summary() and is_seekable(reader) else None
    landing = read_landing(reader.landing) if reader.peaks and not reader.gaps else None
    if span is None or landing is None:
        return math.inf, 0.0
    first, last = (nanoseconds / NANOSECONDS for nanoseconds in span)
    contacts = [leg["contact_time"] for leg in landing["legs"] if leg["contact_time"] is not None]
    until = max(contacts, default=first) + MEASURED_SECONDS
    return (until if until + MEASURED_SECONDS < last else math.inf), last
