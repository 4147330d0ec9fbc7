"""A log folder in rosbag2's layout, written so that it is either finished or can be told to be
unfinished.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from rlv_landing import __version__
from rlv_landing.durable import write_durably
from rlv_landing.errors import LandingError

from .mcap_stream import LIBRARY
from .reader import FINISHED, UNFINISHED

# A killed writer loses at most the open chunk and what was not yet flushed.
CHUNK_BYTES = 60 * 1024


@dataclass
class BagTopic:
    """What `metadata.yaml` tells of a topic; `qos` as rosbag2 writes the profiles that its
    publishers offered.
    """

    name: str
    type_name: str
    qos: Sequence[Mapping[str, Any]] = ()
    type_hash: str = ""
    count: int = 0


@dataclass
class Span:
    """The times of a log's messages [ns]."""

    first: int | None = None
    last: int = 0

    def add(self, time: int) -> None:
        """Takes a message's time in."""
        if self.first is None or time < self.first:
            self.first = time
        if time > self.last:
            self.last = time


@dataclass
class Bag:
    """What `metadata.yaml` says of a log: its file, topics and times."""

    file: str
    topics: list[BagTopic] = field(default_factory=list)
    span: Span = field(default_factory=Span)

    def record(self) -> dict[str, Any]:
        """As rosbag2 has it, metadata version 9."""
        start = self.span.first or 0
        span = {
            "duration": {"nanoseconds": max(0, self.span.last - start)},
            "starting_time": {"nanoseconds_since_epoch": start},
            "message_count": sum(t.count for t in self.topics),
        }
        return {
            "version": 9,
            "storage_identifier": "mcap",
            **span,
            "topics_with_message_count": [
                {
                    "topic_metadata": {
                        "name": t.name,
                        "type": t.type_name,
                        "serialization_format": "cdr",
                        "offered_qos_profiles": [dict(q) for q in t.qos],
                        "type_description_hash": t.type_hash,
                    },
                    "message_count": t.count,
                }
                for t in self.topics
            ],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [self.file],
            "files": [{"path": self.file, **span}],
            "custom_data": None,
            "ros_distro": distro(),
        }


class BagWriter:
    """The folder `folder`, made here, and in it `<name>_0.mcap.part`, which `finish` turns into
    `<name>_0.mcap` and `metadata.yaml`.

    `mcap` is MCAP's own writer of that file. All raise OSError where the disk does; `__init__`
    raises LandingError where the folder exists or cannot be made.
    """

    def __init__(self, folder: Path) -> None:
        from mcap.writer import CompressionType, Writer

        self.folder = folder
        name = f"{folder.absolute().name}_0"
        self.path = folder / (name + FINISHED)
        self.part = folder / (name + UNFINISHED)
        self.bag = Bag(self.path.name)
        self._made = make_folder(folder)
        self._file: IO[bytes] | None = None
        try:
            self._file = self.part.open("xb")
            # With the data's own checksum, any byte that is changed later is noticed.
            self.mcap: Any = Writer(
                self._file,
                chunk_size=CHUNK_BYTES,
                compression=CompressionType.ZSTD,
                enable_data_crcs=True,
            )
            self.mcap.start(profile="ros2", library=f"{LIBRARY} {__version__}")
            self.mcap.add_metadata("rosbag2", {"ROS_DISTRO": distro()})
        except BaseException:
            self.discard()
            raise

    @property
    def open(self) -> bool:
        """Whether it is neither finished nor given up."""
        return self._file is not None

    def is_there(self) -> bool:
        """Whether the file still has its name; a file whose folder was removed takes bytes all the
        same, and loses them.
        """
        if self._file is None:
            return False
        try:
            found, mine = self.part.stat(), os.fstat(self._file.fileno())
        except FileNotFoundError:
            return False
        return (found.st_dev, found.st_ino) == (mine.st_dev, mine.st_ino)

    def finish(self) -> None:
        """Writes the end of the file, makes sure that all is on the disk, gives the file its name,
        and writes `metadata.yaml`.
        """
        file = self._file
        assert file is not None
        self.mcap.add_metadata(
            "rosbag2", {"ROS_DISTRO": distro(), "serialized_metadata": dump(self.bag.record())}
        )
        self.mcap.finish()
        file.flush()
        os.fsync(file.fileno())
        if not self.is_there():
            raise FileNotFoundError(0, "the file was removed or moved away")
        file.close()
        self._file = None
        self.part.rename(self.path)
        write_durably(
            self.folder / "metadata.yaml",
            dump({"rosbag2_bagfile_information": self.bag.record()}).encode("utf-8"),
        )

    def give_up(self) -> None:
        """Closes the file as it is: unfinished, under its temporary name."""
        file, self._file = self._file, None
        if file is not None:
            # A full disk makes even the closing flush fail; the error is known by then.
            with suppress(OSError):
                file.close()

    def discard(self) -> None:
        """Closes and removes all that was made here."""
        self.give_up()
        made, self._made = self._made, []
        if made:
            for path in (self.part, self.path):
                # Where its name was too long, even asking for it fails.
                with suppress(OSError):
                    path.unlink(missing_ok=True)
        for folder in made:
            # Somebody else may have put something into a parent meanwhile: that stays.
            with suppress(OSError):
                folder.rmdir()


def make_folder(folder: Path) -> list[Path]:
    """Make `folder` and its missing parents; those made, innermost first.

    Raises LandingError: it exists, or cannot be made.
    """
    made: list[Path] = []
    try:
        if folder.exists() or folder.is_symlink():
            raise FileExistsError
        missing = [folder]
        while not missing[-1].parent.exists():
            missing.append(missing[-1].parent)
        for path in reversed(missing):
            path.mkdir()
            made.insert(0, path)
        return made
    except FileExistsError:
        raise LandingError(
            f"log folder {folder} exists; logs are never overwritten: name another"
        ) from None
    except OSError as e:
        for path in made:
            path.rmdir()
        raise LandingError(
            f"log folder {folder} cannot be made: {e.strerror or e}; name one that can be written"
        ) from None


def media_type(name: str) -> str:
    """The media type of an attachment by its name."""
    return "application/toml" if name.endswith(".toml") else "text/plain"


def distro() -> str:
    """The ROS distribution of the environment."""
    return os.environ.get("ROS_DISTRO", "unknown")


def dump(document: Mapping[str, Any]) -> str:
    """As YAML."""
    import yaml

    class Plain(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]
        """Writes equal values out again instead of pointing back to them."""

        def ignore_aliases(self, data: Any) -> bool:
            return True

    text: str = yaml.dump(dict(document), Dumper=Plain, sort_keys=False)
    return text
