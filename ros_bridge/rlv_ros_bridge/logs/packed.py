"""Recordings each of whose messages rosbag2 compressed by itself (`--compression-mode message`)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..messages.qos import read_yaml
from .mcap_files.chunks import CHUNK_BYTES, CHUNK_RATIO, Allowance
from .mcap_files.records import (
    CHUNK,
    MAGIC,
    MESSAGE,
    METADATA,
    RECORD_HEAD,
    DamageError,
    decode_record,
    read_record,
)
from .reader import LogMessage, LogReader

LONGEST_METADATA = 4 * 1024 * 1024
# rosbag2's description stands among the first records of its files.
FIRST_RECORDS = 16
# Of very many damaged messages the first are listed.
LISTED = 100


def is_packed(description: object) -> bool:
    """Whether rosbag2's description of a recording says so.

    Args:
        description: what stands in its record `rosbag2` or under `rosbag2_bagfile_information`.
    """
    mode = description.get("compression_mode") if isinstance(description, dict) else None
    return str(mode).lower() == "message"


def says_packed(text: str) -> bool:
    """The same of a description's YAML; what cannot be read says nothing."""
    try:
        return is_packed(read_yaml(text, LONGEST_METADATA))
    except ValueError:
        return False


def file_is_packed(file: Path) -> bool:
    """Whether an MCAP file says so by itself, in a record before its first chunk."""
    position = len(MAGIC)
    with file.open("rb") as stream:
        size = os.fstat(stream.fileno()).st_size
        for _ in range(FIRST_RECORDS):
            try:
                opcode, body = read_record(stream, position, size)
                if opcode in (CHUNK, MESSAGE):
                    break
                record = decode_record(opcode, body) if opcode == METADATA else None
            except DamageError:
                break
            if record is not None and record.name == "rosbag2":
                return says_packed(record.metadata.get("serialized_metadata", ""))
            position += RECORD_HEAD.size + len(body)
    return False


class Unpacker:
    """Decompresses the messages of one file, no further than its size can justify.

    Args:
        size: of the file [bytes].
    """

    def __init__(self, size: int) -> None:
        self._allowance = Allowance(size)

    def __call__(self, data: bytes) -> bytes:
        """A message's bytes.

        Raises:
            ValueError: they are not whole, or claim more than they, or the file, can hold.
        """
        import zstandard

        try:
            size = zstandard.frame_content_size(data)
            most = CHUNK_BYTES + CHUNK_RATIO * len(data)
            if size > most:
                raise ValueError(f"a message of {len(data)} bytes claims to hold {size}")
            self._allowance.take(max(size, 0))
            whole = zstandard.ZstdDecompressor().decompress(data, max_output_size=most)
            if size < 0:
                self._allowance.take(len(whole))
        except zstandard.ZstdError as e:
            raise ValueError(f"a message cannot be decompressed: {e}") from None
        except DamageError:
            raise ValueError("its messages claim more than a file of this size can hold") from None
        return bytes(whole)


class PackedReader(LogReader):
    """Such a recording in MCAP. Messages that cannot be decompressed are damage, and left out."""

    # By its summary bytes are found, not messages.
    summaries = None

    def __init__(self, path: str | Path) -> None:
        super().__init__(path)
        self._unpack = Unpacker(self.size)

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[LogMessage]:
        """The whole messages of all topics, or of `topics`, in the log's order."""
        self._unpack = Unpacker(self.size)
        for message in super().messages(topics):
            try:
                data = self._unpack(message.data)
            except ValueError as e:
                self.cut = True
                if len(self.damage) < LISTED:
                    self.damage.append(f"{message.place}: {' '.join(str(e).split())}")
                continue
            yield LogMessage(message.topic, message.log_time, data)
