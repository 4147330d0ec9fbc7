"""Reads rosbag2 recordings in sqlite3, `.db3`, of one file or several. Needs no ROS 2.

A database may be made to hold no table but a program. So its tables must be plain ones, and what
sqlite3 does for them is counted against the file's size.
"""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import quote

from rlv_landing.errors import LandingError

from .lost import Gap
from .packed import Unpacker
from .reader import Channel, LogMessage, LogReader

TABLES = ("topics", "messages")
# A table of rows that are computed when they are read.
COMPUTED = re.compile(r"\b(?:AS|VIRTUAL)\b", re.IGNORECASE)
# Steps of sqlite3's machine: between two looks, in any case, and for each byte of the file.
STEPS, LEAST_STEPS, STEPS_PER_BYTE = 10_000, 2_000_000, 100


class SqliteReader(LogReader):
    """A recording in sqlite3, with the interface of `LogReader`.

    Args:
        path: the recording as it was named.
        files: its `.db3` files in their order.
        compressed: whether each message is compressed by zstd.

    Raises:
        LandingError: sqlite3 cannot read one of them, or it is no recording.
    """

    def __init__(self, path: Path, files: Sequence[Path], *, compressed: bool = False) -> None:
        self.path = path
        self.files = list(files)
        self.metadata: dict[str, str] = {}
        self.peaks: dict[str, str] = {}
        self.landing: dict[str, str] = {}
        self.attachments: dict[str, bytes] = {}
        self.gaps: list[Gap] = []
        self.cut = False
        self.damage: list[str] = []
        self.channels: dict[str, Channel] = {}
        self._compressed = compressed
        for file in self.files:
            try:
                with closing(_connect(file)) as database:
                    for channel in _topics(database).values():
                        self.channels.setdefault(channel.topic, channel)
            except (sqlite3.Error, ValueError, OSError) as e:
                raise self._error(file, e) from None

    def _error(self, file: Path, e: Exception) -> LandingError:
        return LandingError(
            f"{file} cannot be read as a rosbag2 recording: {' '.join(str(e).split())}"
        )

    def read_summary(self) -> bool:
        """False: such a recording has nothing of a landing in its metadata."""
        return False

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The messages of all topics, or of `topics`, file by file in the order of their times."""
        wanted = None if topics is None else set(topics)
        self.cut, self.damage = False, []
        for file in self.files:
            size = file.stat().st_size
            unpacked = Unpacker(size) if self._compressed else bytes
            try:
                with closing(_connect(file)) as database:
                    names = {
                        number: c.topic
                        for number, c in _topics(database).items()
                        if wanted is None or c.topic in wanted
                    }
                    numbers = ", ".join(map(str, names))
                    rows = database.execute(
                        "SELECT topic_id, timestamp, data FROM messages "
                        f"WHERE topic_id IN ({numbers}) AND length(data) <= ? ORDER BY timestamp",
                        (size,),
                    )
                    for number, time, data in rows:
                        yield LogMessage(names[number], int(time), unpacked(bytes(data)))
            except (sqlite3.Error, ValueError, TypeError) as e:
                # What sqlite3 cannot read ends the file; the rows before are whole.
                self.cut = True
                self.damage.append(f"{file.name}: {' '.join(str(e).split())}")

    def decoder(self, topic: str) -> Any:
        """A function from bytes to messages of `topic`, by ROS 2's own definition of its type.

        Raises:
            LandingError: the type is not known.
        """
        type_name = self.channels[topic].type_name
        types = _known_types()
        if type_name not in types.types:
            raise LandingError(
                f"{self.path}: {topic} is of the type {type_name}, which is not known here; "
                "leave it out by --topics"
            )
        return lambda data: types.deserialize_cdr(data, type_name)


@cache
def _known_types() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


def _connect(file: Path) -> sqlite3.Connection:
    """A database, to be read only, whose tables are plain ones.

    Raises:
        sqlite3.Error: it cannot be read.
        ValueError: its tables are none, or are computed.
    """
    database = sqlite3.connect(f"file:{quote(str(file.absolute()))}?mode=ro", uri=True)
    try:
        database.set_progress_handler(_limit(file.stat().st_size), STEPS)
        database.execute("PRAGMA trusted_schema = OFF")
        found = database.execute(
            "SELECT name, type, sql FROM sqlite_master WHERE name IN (?, ?)", TABLES
        ).fetchall()
        if sorted(name for name, *_ in found) != sorted(TABLES):
            raise ValueError(f"it has no tables {' and '.join(TABLES)}")
        if any(kind != "table" or COMPUTED.search(str(sql)) for _, kind, sql in found):
            raise ValueError("its tables are computed, not stored")
    except BaseException:
        database.close()
        raise
    return database


def _limit(size: int) -> Callable[[], bool]:
    """Whether sqlite3 is to stop, asked from time to time: after more than `size` can justify."""
    left = LEAST_STEPS + STEPS_PER_BYTE * size

    def is_over() -> bool:
        nonlocal left
        left -= STEPS
        return left < 0

    return is_over


def _topics(database: sqlite3.Connection) -> dict[int, Channel]:
    """The topics of CDR messages by their numbers."""
    columns = {row[1] for row in database.execute("PRAGMA table_info(topics)")}
    qos = "offered_qos_profiles" if "offered_qos_profiles" in columns else "''"
    return {
        int(number): Channel(str(name), str(kind), str(profiles))
        for number, name, kind, profiles in database.execute(
            f"SELECT id, name, type, {qos} FROM topics WHERE serialization_format = 'cdr'"
        )
    }
