"""Writes a log folder in rosbag2's layout; until it is finished, the file's ending says so."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rlv_landing import __version__
from rlv_landing.errors import LandingError, reason_of
from rlv_landing.text.durable import write_durably
from rlv_landing.text.files import is_utf8

from ..log_files import FINISHED, UNFINISHED
from ..mcap_files.stream import LIBRARY
from .log_file import LogFile

# A sixth of a second of a landing at 1 kHz. With each chunk the threads hand Python's global lock
# over some ten times, which costs as much as ten samples; a larger one does not fit in the
# processor's cache, and of a smaller one less is read for an instant.
CHUNK_BYTES = 512 * 1024


@dataclass
class BagTopic:
    """A topic in `metadata.yaml`.

    `qos` holds the profiles that its publishers offer, as rosbag2 writes them.
    """

    name: str
    type_name: str
    qos: Sequence[Mapping[str, Any]] = ()
    type_hash: str = ""
    count: int = 0


@dataclass
class Span:
    """First and last time of a log's messages [ns]."""

    first: int | None = None
    last: int = 0

    def add(self, time: int) -> None:
        """Extends the span to a message's time [ns]."""
        if self.first is None or time < self.first:
            self.first = time
        if time > self.last:
            self.last = time


@dataclass
class Bag:
    """The contents of a log as `metadata.yaml` describes them: file, topics and times.

    `packed`: each message is compressed by itself (in zstd), as rosbag2 can do it.
    """

    file: str
    topics: list[BagTopic] = field(default_factory=list)
    span: Span = field(default_factory=Span)
    packed: bool = False

    def metadata(self) -> dict[str, Any]:
        """The `rosbag2_bagfile_information` of rosbag2, metadata version 9."""
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
            "compression_format": "zstd" if self.packed else "",
            "compression_mode": "MESSAGE" if self.packed else "",
            "relative_file_paths": [self.file],
            "files": [{"path": self.file, **span}],
            "custom_data": None,
            "ros_distro": ros_distro(),
        }


class BagWriter:
    """A new log folder with the file `<name>_0.mcap.part`.

    `finish` renames the file to `<name>_0.mcap` and writes `metadata.yaml`. `mcap` is MCAP's own
    writer of that file. All methods raise OSError where the disk refuses.

    Args:
        folder: the log folder, which must not exist.

    Raises:
        LandingError: the folder exists or cannot be made.
    """

    def __init__(self, folder: Path) -> None:
        from mcap.writer import CompressionType, Writer

        self.folder = folder
        name = f"{folder.absolute().name}_0"
        self.path = folder / (name + FINISHED)
        self.part = folder / (name + UNFINISHED)
        self.bag = Bag(self.path.name)
        self._made = make_folder(folder)
        self._file: LogFile | None = None
        try:
            self._file = LogFile(self.part)
            # With the data section's checksum, a later change of any byte is noticed.
            output: Any = self._file
            self.mcap: Any = Writer(
                output,
                chunk_size=CHUNK_BYTES,
                compression=CompressionType.ZSTD,
                enable_data_crcs=True,
            )
            self.mcap.start(profile="ros2", library=f"{LIBRARY} {__version__}")
            self._add_metadata()
        except BaseException:
            self.discard()
            raise

    def _add_metadata(self) -> None:
        """Adds rosbag2's record of what the log holds so far, which it has at both ends."""
        serialized = to_yaml(self.bag.metadata())
        self.mcap.add_metadata(
            "rosbag2", {"ROS_DISTRO": ros_distro(), "serialized_metadata": serialized}
        )

    @property
    def is_open(self) -> bool:
        """Whether it is neither finished nor abandoned."""
        return self._file is not None

    def file_exists(self) -> bool:
        """Whether the file still has its name.

        A file whose folder was removed accepts further bytes, and loses them.
        """
        if self._file is None:
            return False
        try:
            named, opened = self.part.stat(), os.fstat(self._file.fileno())
        except FileNotFoundError:
            return False
        return (named.st_dev, named.st_ino) == (opened.st_dev, opened.st_ino)

    def finish(self) -> None:
        """Completes the file and syncs it to the disk, renames it, and writes `metadata.yaml`."""
        file = self._file
        assert file is not None
        self._add_metadata()
        self.mcap.finish()
        file.flush()
        os.fsync(file.fileno())
        if not self.file_exists():
            raise FileNotFoundError(0, "the file was removed or moved away")
        file.close()
        self._file = None
        self.part.rename(self.path)
        write_durably(
            self.folder / "metadata.yaml",
            to_yaml({"rosbag2_bagfile_information": self.bag.metadata()}).encode("utf-8"),
        )

    def abandon(self) -> None:
        """Closes the file as it is: unfinished, under its temporary name."""
        file, self._file = self._file, None
        if file is not None:
            # On a full disk the flush on closing fails too; the first error has been reported.
            with suppress(OSError):
                file.close()

    def discard(self) -> None:
        """Closes the file, and removes it and the folders made for it."""
        self.abandon()
        made, self._made = self._made, []
        if made:
            for path in (self.part, self.path):
                # If the name is too long, even looking it up fails.
                with suppress(OSError):
                    path.unlink(missing_ok=True)
        for folder in made:
            # Another program may have put a file into a parent meanwhile: then it stays.
            with suppress(OSError):
                folder.rmdir()


def make_folder(folder: Path) -> list[Path]:
    """Makes `folder` and its missing parents; returns those made, innermost first.

    Raises:
        LandingError: it exists, or cannot be made.
    """
    made: list[Path] = []
    if not is_utf8(folder.name):
        raise LandingError(
            f"log folder {folder} has a name that is not UTF-8, which metadata.yaml cannot hold; "
            "name another"
        )
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
            f"log folder {folder} cannot be made: {reason_of(e)}; name one that can be written"
        ) from None


def media_type(name: str) -> str:
    """The media type of an attachment, by the ending of its name."""
    return "application/toml" if name.endswith(".toml") else "text/plain"


def ros_distro() -> str:
    """The ROS distribution of the environment."""
    return os.environ.get("ROS_DISTRO", "unknown")


def to_yaml(document: Mapping[str, Any]) -> str:
    """`document` as YAML."""
    import yaml

    class Plain(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]
        """Writes equal values out in full instead of as YAML aliases."""

        def ignore_aliases(self, data: Any) -> bool:
            return True

    text: str = yaml.dump(dict(document), Dumper=Plain, sort_keys=False)
    return text
