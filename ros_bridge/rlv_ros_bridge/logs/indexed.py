"""Messages of a log by topic and time: only the chunks that may hold them are read."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import closing
from itertools import filterfalse

from .mcap_files.summary import ChunkPlace, Summary, open_chunks
from .reader import LogMessage, LogReader


def messages_between(
    reader: LogReader,
    topics: Collection[str],
    first: int,
    last: float,
    leaves_out: Callable[[ChunkPlace], bool] | None = None,
) -> Iterator[LogMessage]:
    """The messages of `topics` from the time `first` to `last` [ns], in the log's order.

    The reader's `cut` and `damage` are those of the chunks that were read.

    Args:
        reader: a log that has summaries.
        topics: full names.
        first: the first time [ns].
        last: the last time [ns], included; infinite: the log's end.
        leaves_out: whether a chunk is not needed; asked for each shortly before its turn.
    """
    reader.cut, reader.damage = False, []
    for summary in reader.summaries or ():
        names = {n: topic for n, topic in summary.topics.items() if topic in topics}
        places: Iterable[ChunkPlace] = _places(summary, names, first, last)
        if leaves_out is not None:
            places = filterfalse(leaves_out, places)
        with closing(open_chunks(summary, places)) as chunks:
            for place, chunk in chunks:
                if chunk is None:
                    reader.cut = True
                    reader.damage.append(
                        f"{summary.file.name}, byte {place.position}: a chunk's bytes were changed"
                    )
                    continue
                for m in chunk.messages(names.__contains__):
                    if first <= m.log_time <= last:
                        yield LogMessage(names[m.channel_id], m.log_time, m.data)


def messages_of(reader: LogReader, topics: Collection[str]) -> Iterator[LogMessage]:
    """The messages of `topics` in the log's order; by its summaries if it has them.

    Of these `messages_between` holds, of others `reader.messages`.
    """
    if reader.summaries is None:
        return reader.messages(topics)
    return messages_between(reader, topics, 0, math.inf)


def is_seekable(reader: LogReader) -> bool:
    """Whether rows of a log are found by time: it is one of ours, whole, and indexed.

    In these the time of each message is its stamp.
    """
    summaries = reader.summaries or ()
    return "step_size" in reader.metadata and bool(summaries) and all(s.ours for s in summaries)


def span_of(reader: LogReader) -> tuple[int, int] | None:
    """The first and the last time of a log by its summaries [ns]; None where it has no message."""
    times = [
        time
        for s in reader.summaries or ()
        if s.statistics.message_count
        for time in (s.statistics.message_start_time, s.statistics.message_end_time)
    ]
    return (min(times), max(times)) if times else None


def holds(reader: LogReader, topic: str) -> bool:
    """Whether a log has a message of the topic of this full name; by its summaries if it can."""
    if reader.summaries is None:
        return next(iter(reader.messages([topic])), None) is not None
    return any(
        summary.statistics.channel_message_counts.get(number, 0)
        for summary in reader.summaries or ()
        for number, name in summary.topics.items()
        if name == topic
    )


def last_time(reader: LogReader, topics: Collection[str], first: int, last: float) -> int | None:
    """The largest time of a message of `topics` from `first` to `last` [ns]; None: no message.

    The arguments are those of `messages_between`.
    """
    found: int | None = None
    for summary in reader.summaries or ():
        names = {n: topic for n, topic in summary.topics.items() if topic in topics}
        places = _places(summary, names, first, last)
        for place in sorted(places, key=lambda c: c.last, reverse=True):
            if found is not None and found >= place.last:
                break
            for _, chunk in open_chunks(summary, [place]):
                for m in chunk.messages(names.__contains__) if chunk is not None else ():
                    if first <= m.log_time <= last and (found is None or m.log_time > found):
                        found = m.log_time
    return found


def _places(
    summary: Summary, channels: Mapping[int, str], first: int, last: float
) -> list[ChunkPlace]:
    """The chunks that may hold messages of `channels` from `first` to `last` [ns]."""
    return [
        c
        for c in summary.chunks
        if c.first <= last and c.last >= first and (not c.channels or c.channels & channels.keys())
    ]
