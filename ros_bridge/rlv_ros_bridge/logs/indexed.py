"""Messages of a log by topic and time: only the chunks that may hold them are read."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import closing

from .mcap_files.summary import ChunkPlace, Summary, open_chunks
from .reader import LogMessage, LogReader


def messages_between(
    reader: LogReader, topics: Collection[str], first: int, last: float
) -> Iterator[LogMessage]:
    """The messages of `topics` from the time `first` to `last` [ns], in the log's order.

    The reader's `cut` and `damage` are those of the chunks that were read.

    Args:
        reader: a log that has summaries.
        topics: full names.
        first: the first time [ns].
        last: the last time [ns], included; infinite: the log's end.
    """
    reader.cut, reader.damage = False, []
    for summary in reader.summaries or ():
        names = {n: topic for n, topic in summary.topics.items() if topic in topics}
        places = _places(summary, names, first, last)
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
