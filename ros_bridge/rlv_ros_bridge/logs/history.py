"""The landing in a log as a `History`, columns named as the FMU's variables.

Values are SI, in the paper's axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rlv_landing.errors import LandingError
from rlv_landing.history import History
from rlv_landing.text.units import parse_number

from ..fmu.peaks import known_extremes
from ..messages.columns import READINGS
from ..messages.topics import RECORDED, resolve
from .bag_reader import open_log
from .peaks import read_peaks
from .reader import Decoder, LogReader

TYPES = {t.name: t.type_name for t in RECORDED}
NANOSECONDS = 1_000_000_000


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
    reader.read_through()
    chosen = choose_topics(reader, topics)
    names = [
        name
        for relative in READINGS
        if relative in chosen.values()
        for name in READINGS[relative][0]
    ]
    rows: dict[int, dict[str, Any]] = {}
    decode = Decoder(reader)
    for message in reader.messages(chosen):
        columns, reading = READINGS[chosen[message.topic]]
        decoded = decode(message)
        rows.setdefault(_stamp(decoded), {}).update(zip(columns, reading(decoded)))
    complete = [(t, row) for t, row in sorted(rows.items()) if len(row) == len(names)]
    if not complete:
        raise LandingError(
            f"{reader.path} holds no landing: no instant has all of {', '.join(chosen.values())}"
        )
    times = np.array([_seconds(reader, t) for t, _ in complete])
    data = np.array([[float(row[name]) for name in names] for _, row in complete])
    history = History(times, names, data, reader.parameters())
    if reader.peaks:
        found, _ = read_peaks(reader.peaks, str(reader.path))
        history.extremes = known_extremes(found, history)
    return history, _notes(reader, chosen, len(rows) - len(complete))


def choose_topics(reader: LogReader, topics: Sequence[str]) -> dict[str, str]:
    """The topics to read: full name -> name relative to the landing's namespace."""
    full = {resolve(reader.namespace, relative): relative for relative in READINGS}
    readable = {
        name: relative
        for name, relative in full.items()
        if name in reader.channels and reader.channels[name].type_name == TYPES[relative]
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


def _notes(reader: LogReader, chosen: dict[str, str], incomplete: int) -> list[str]:
    own = f"/{reader.namespace.strip('/')}/"
    ignored = [name.removeprefix(own) for name in reader.channels if name not in chosen]
    notes = [f"left aside: {', '.join(ignored)}"] if ignored else []
    if incomplete:
        notes.append(f"left out: {incomplete} instants that lack one of the topics")
    return notes


def _stamp(message: Any) -> int:
    stamp = message.header.stamp
    return int(stamp.sec) * NANOSECONDS + int(stamp.nanosec)


def _seconds(reader: LogReader, nanoseconds: int) -> float:
    # The landing's own times are k * step; computed alike, they agree to the bit.
    try:
        step = parse_number(reader.metadata["step_size"])
        k, rest = divmod(nanoseconds, round(step * 1e9))
    except (KeyError, ValueError, OverflowError, ZeroDivisionError):
        return nanoseconds / 1e9
    return k * step if rest == 0 else nanoseconds / 1e9
