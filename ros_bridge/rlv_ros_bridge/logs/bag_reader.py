"""Reads rosbag2 recordings that are not plain MCAP: sqlite3 `.db3`, compressed files.

rosbags reads them; `BagReader` has the interface of `LogReader`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError, reason_of

from .log_files import FINISHED, UNFINISHED
from .reader import Channel, LogMessage, LogReader

METADATA_FILE = "metadata.yaml"


def open_log(path: str | Path) -> LogReader:
    """Opens the log at `path`: a log of ours, a rosbag2 recording, or one MCAP file.

    Raises:
        LandingError: there is no log, or it cannot be read.
    """
    folder = Path(path)
    if folder.is_file() and folder.suffix == ".db3":
        raise LandingError(
            f"{folder} is only a part of a recording; name its folder, in which {METADATA_FILE} is"
        )
    is_mcap = any(any(folder.glob(f"*{ending}")) for ending in (FINISHED, UNFINISHED))
    if is_mcap or not (folder / METADATA_FILE).is_file():
        return LogReader(folder)
    return BagReader(folder)


class BagReader(LogReader):
    """The folder of a rosbag2 recording, with the interface of `LogReader`.

    Raises:
        LandingError: rosbags cannot read it.
    """

    def __init__(self, path: Path) -> None:
        from rosbags.rosbag2 import Reader
        from rosbags.typesys import Stores, get_typestore

        self.path = path
        self.metadata: dict[str, str] = {}
        self.peaks: dict[str, str] = {}
        self.landing: dict[str, str] = {}
        self.attachments: dict[str, bytes] = {}
        self.cut = False
        self.damage: list[str] = []
        self._types = get_typestore(Stores.ROS2_JAZZY)
        try:
            self._reader = Reader(path)
            with self._reader as reader:
                self.channels = {
                    c.topic: Channel(c.topic, c.msgtype, "") for c in reader.connections
                }
            self.files = [f for f in path.iterdir() if f.is_file() and f.name != METADATA_FILE]
        except Exception as e:
            raise self._error(e) from None

    def _error(self, e: Exception) -> LandingError:
        return LandingError(f"{self.path} cannot be read as a rosbag2 recording: {reason_of(e)}")

    def read_summary(self) -> bool:
        """False: such a recording has nothing of a landing in its metadata."""
        return False

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The messages of all topics, or of `topics`, in the order of their times."""
        wanted = None if topics is None else set(topics)
        try:
            with self._reader as reader:
                chosen = [c for c in reader.connections if wanted is None or c.topic in wanted]
                if chosen:
                    yield from (
                        LogMessage(c.topic, time, bytes(data))
                        for c, time, data in reader.messages(chosen)
                    )
        except LandingError:
            raise
        except Exception as e:
            raise self._error(e) from None

    def decoder(self, topic: str) -> Any:
        """A function from bytes to messages of `topic`, by ROS 2's own definition of its type.

        Raises:
            LandingError: the type is not known.
        """
        type_name = self.channels[topic].type_name
        if type_name not in self._types.types:
            raise LandingError(
                f"{self.path}: {topic} is of the type {type_name}, which is not known here; "
                "leave it out by --topics"
            )
        return lambda data: self._types.deserialize_cdr(data, type_name)
