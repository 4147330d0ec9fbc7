"""Recordings of rosbag2 that are not plain MCAP (sqlite3 `.db3`, compressed files), read by rosbags
as `LogReader` reads ours.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError

from .reader import FINISHED, UNFINISHED, Channel, LogMessage, LogReader

METADATA_FILE = "metadata.yaml"


def open_log(path: str | Path) -> LogReader:
    """The log at `path`: ours, any rosbag2 recording, or one MCAP file.

    Raises LandingError where there is none.
    """
    folder = Path(path)
    if folder.is_file() and folder.suffix == ".db3":
        raise LandingError(
            f"{folder} is only the messages of a recording; name its folder, where {METADATA_FILE} is"
        )
    ours = any(any(folder.glob(f"*{ending}")) for ending in (FINISHED, UNFINISHED))
    return (
        LogReader(folder) if ours or not (folder / METADATA_FILE).is_file() else BagReader(folder)
    )


class BagReader(LogReader):
    """A recording's folder. Raises LandingError where rosbags cannot read it."""

    def __init__(self, path: Path) -> None:
        from rosbags.rosbag2 import Reader
        from rosbags.typesys import Stores, get_typestore

        self.path = path
        self.metadata: dict[str, str] = {}
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
        return LandingError(
            f"{self.path} cannot be read as a rosbag2 recording: {' '.join(str(e).split())}"
        )

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The messages in the order of their times, of all topics or of `topics`."""
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
        """What makes messages of `topic` from bytes, by the definition that ROS 2 has of its type."""
        type_name = self.channels[topic].type_name
        if type_name not in self._types.types:
            raise LandingError(
                f"{self.path}: {topic} is of the type {type_name}, which is not known here; leave it out by --topics"
            )
        return lambda data: self._types.deserialize_cdr(data, type_name)
