"""Records the published bytes to MCAP in rosbag2's layout, so that what was written survives the writer's death."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from rlv_landing import __version__
from rlv_landing.errors import LandingError

from .definitions import definition
from .qos import Qos

# A killed writer loses at most the open chunk and what was not yet flushed.
CHUNK_BYTES = 60 * 1024
FLUSH_SECONDS = 0.25


@dataclass(frozen=True)
class RecordedTopic:
    """A topic of a log: its full name, its type `pkg/msg/Type`, and what its publisher offers."""

    name: str
    type_name: str
    qos: Qos


class Recorder:
    """One log being written: `<folder>/<folder's name>_0.mcap`, and `<folder>/metadata.yaml` once it is closed.

    Args:
        folder: made here, with its parents; it must not exist.
        topics: what will be recorded.
        metadata: texts by name, kept in the log's record `rlv_landing`.
        attachments: files by name that the log carries.

    Raises:
        LandingError: the folder exists or cannot be written, or a topic's type is not installed; nothing is left behind then.

    A disk that fills up later does not raise: `error` is set, writing stops, and what was written stays readable.
    """

    def __init__(
        self,
        folder: str | Path,
        topics: Sequence[RecordedTopic],
        metadata: Mapping[str, str] | None = None,
        attachments: Mapping[str, bytes] | None = None,
    ) -> None:
        self.folder = Path(folder)
        self.path = self.folder / f"{self.folder.absolute().name}_0.mcap"
        self.topics = tuple(topics)
        self.counts = dict.fromkeys((t.name for t in self.topics), 0)
        self.error: str = ""
        self._first: int | None = None
        self._last = 0
        self._flushed = time.monotonic()
        definitions = {t.type_name: definition(t.type_name) for t in self.topics}
        self._hashes = {name: d.type_hash for name, d in definitions.items()}
        self._made = make_folder(self.folder)
        self._file: IO[bytes] | None = None
        try:
            self._file = self.path.open("xb")
            self._writer = self._start(self._file)
            for name, data in (attachments or {}).items():
                self._writer.add_attachment(create_time=0, log_time=0, name=name, media_type=_media_type(name), data=data)
            if metadata:
                self._writer.add_metadata("rlv_landing", dict(metadata))
            schemas = {name: self._writer.register_schema(name, "ros2msg", d.text.encode("utf-8")) for name, d in definitions.items()}
            self._channels = {t.name: self._register(t, schemas[t.type_name]) for t in self.topics}
            self._writer.flush()
        except BaseException as e:
            self.discard()
            if isinstance(e, OSError):
                raise LandingError(f"log folder {self.folder} cannot be written: {e.strerror or e}") from None
            raise

    def _start(self, file: IO[bytes]) -> Any:
        from mcap.writer import CompressionType, Writer

        writer = Writer(file, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library=f"rlv-landing {__version__}")
        writer.add_metadata("rosbag2", {"ROS_DISTRO": _distro()})
        return writer

    def _register(self, topic: RecordedTopic, schema: int) -> int:
        import yaml

        channel: int = self._writer.register_channel(
            topic=topic.name,
            message_encoding="cdr",
            schema_id=schema,
            metadata={
                "offered_qos_profiles": yaml.safe_dump([topic.qos.record()], sort_keys=False),
                "topic_type_hash": self._hashes[topic.type_name],
            },
        )
        return channel

    @property
    def count(self) -> int:
        """Messages recorded so far."""
        return sum(self.counts.values())

    def write(self, topic: str, log_time_ns: int, data: bytes) -> None:
        """Record the serialised message `data` of `topic` at the simulation time `log_time_ns`. After an error it does nothing."""
        if self.error:
            return
        try:
            self._writer.add_message(self._channels[topic], log_time_ns, data, log_time_ns, self.counts[topic] & 0xFFFFFFFF)
            self.counts[topic] += 1
            if self._first is None or log_time_ns < self._first:
                self._first = log_time_ns
            if log_time_ns > self._last:
                self._last = log_time_ns
        except OSError as e:
            self._fail(e)

    def flush(self) -> None:
        """Hand what is recorded to the operating system if the last time is a quarter of a second ago. To be called now and then."""
        now = time.monotonic()
        if self.error or now - self._flushed < FLUSH_SECONDS:
            return
        self._flushed = now
        try:
            self._writer.flush()
        except OSError as e:
            self._fail(e)

    def close(self) -> None:
        """Finish the file and write `metadata.yaml`. After an error only closes the file, which stream readers still read."""
        file, self._file = self._file, None
        if file is None:
            return
        try:
            if not self.error:
                from_messages = _dump(self._bag())
                self._writer.add_metadata("rosbag2", {"ROS_DISTRO": _distro(), "serialized_metadata": from_messages})
                self._writer.finish()
                file.close()
                self._write_metadata_file()
        except OSError as e:
            self._fail(e)
        finally:
            _close_quietly(file)

    def discard(self) -> None:
        """Close and remove everything that this recorder has made."""
        file, self._file = self._file, None
        if file is not None:
            _close_quietly(file)
            self.path.unlink(missing_ok=True)
        made, self._made = self._made, []
        for folder in made:
            # Somebody else may have put something into a parent meanwhile: that stays.
            with suppress(OSError):
                folder.rmdir()

    def _fail(self, e: OSError) -> None:
        self.error = f"recording to {self.path} stopped after {self.count} messages: {e.strerror or e}"

    def _write_metadata_file(self) -> None:
        target = self.folder / "metadata.yaml"
        temporary = self.folder / "metadata.yaml.tmp"
        temporary.write_text(_dump({"rosbag2_bagfile_information": self._bag()}), encoding="utf-8")
        temporary.replace(target)

    def _bag(self) -> dict[str, Any]:
        start = self._first if self._first is not None else 0
        span = {
            "duration": {"nanoseconds": max(0, self._last - start)},
            "starting_time": {"nanoseconds_since_epoch": start},
            "message_count": self.count,
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
                        "offered_qos_profiles": [t.qos.record()],
                        "type_description_hash": self._hashes[t.type_name],
                    },
                    "message_count": self.counts[t.name],
                }
                for t in self.topics
            ],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [self.path.name],
            "files": [{"path": self.path.name, **span}],
            "custom_data": None,
            "ros_distro": _distro(),
        }


def make_folder(folder: Path) -> list[Path]:
    """Make `folder` and its missing parents; those made, innermost first. Raises LandingError: it exists, or cannot be made."""
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
        raise LandingError(f"log folder {folder} exists; logs are never overwritten: name another") from None
    except OSError as e:
        for path in made:
            path.rmdir()
        raise LandingError(f"log folder {folder} cannot be made: {e.strerror or e}; name one that can be written") from None


def _media_type(name: str) -> str:
    return "application/toml" if name.endswith(".toml") else "text/plain"


def _distro() -> str:
    return os.environ.get("ROS_DISTRO", "unknown")


def _dump(document: Mapping[str, Any]) -> str:
    import yaml

    class Plain(yaml.SafeDumper):
        """Writes equal values out again instead of pointing back to them."""

        def ignore_aliases(self, data: Any) -> bool:
            return True

    text: str = yaml.dump(dict(document), Dumper=Plain, sort_keys=False)
    return text


def _close_quietly(file: IO[bytes]) -> None:
    # A full disk makes even the closing flush fail; the error is known by then.
    with suppress(OSError):
        file.close()
