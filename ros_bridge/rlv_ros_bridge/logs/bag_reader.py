"""Opens logs of every kind: ours, rosbag2's in MCAP or sqlite3, split, compressed."""

from __future__ import annotations

import shutil
import weakref
from pathlib import Path
from tempfile import gettempdir

from rlv_landing.errors import LandingError
from rlv_landing.text.durable import writing

from ..fmu.folder import ProcessFolder
from ..messages.qos import read_yaml
from .log_files import FINISHED, UNFINISHED, in_order
from .mcap_files.chunks import FILE_BYTES, FILE_RATIO
from .reader import LogReader
from .sqlite_reader import SqliteReader

METADATA_FILE = "metadata.yaml"
LONGEST_METADATA = 4 * 1024 * 1024
SQLITE, COMPRESSED = ".db3", ".zstd"
FOLDER_PREFIX = "rlv-landing-log-"
COPY_BYTES = 1024 * 1024


def open_log(path: str | Path) -> LogReader:
    """Opens the log at `path`: a log of ours, a rosbag2 recording, or one file of one.

    Files that are compressed as a whole are decompressed into a temporary folder, which lasts as
    long as the reader.

    Raises:
        LandingError: there is no log, or it cannot be read.
    """
    log = Path(path)
    files = _files(log, COMPRESSED)
    if not files or _files(log, FINISHED) or _files(log, UNFINISHED) or _files(log, SQLITE):
        return _open(log, log)
    with writing(Path(gettempdir()), "name another folder by TMPDIR"):
        folder = ProcessFolder(FOLDER_PREFIX)
        try:
            for file in files:
                _decompress(file, folder.path / file.name.removesuffix(COMPRESSED))
            reader = _open(folder.path, log)
        except BaseException:
            folder.remove()
            raise
    weakref.finalize(reader, folder.remove)
    return reader


def _open(place: Path, named: Path) -> LogReader:
    """The log whose files are at `place`, and which was named `named`."""
    mode = _compression(named)
    databases = _files(place, SQLITE)
    if databases and not _files(place, FINISHED) and not _files(place, UNFINISHED):
        return SqliteReader(named, in_order(databases), compressed=mode == "message")
    reader = LogReader(place)
    reader.path = named
    if mode == "message":
        raise LandingError(
            f"{named} has each message compressed by itself, which is read of sqlite3 only; "
            "convert it by `ros2 bag convert`"
        )
    return reader


def _files(log: Path, ending: str) -> list[Path]:
    """The files of a log with this ending; for a file itself."""
    if log.is_file():
        return [log] if log.name.endswith(ending) else []
    return sorted(f for f in log.glob(f"*{ending}") if f.is_file())


def _compression(log: Path) -> str:
    """What a recording's metadata say is compressed: `file`, `message`, or nothing."""
    metadata = (log if log.is_dir() else log.parent) / METADATA_FILE
    try:
        text = metadata.read_text(encoding="utf-8")
        found = read_yaml(text, LONGEST_METADATA)["rosbag2_bagfile_information"]
        return str(found.get("compression_mode", "")).lower()
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        # It is not needed for anything else.
        return ""


def _decompress(source: Path, target: Path) -> None:
    """Decompresses a file, no further than its size can justify.

    Raises:
        LandingError: it is damaged, or holds more.
        OSError: the disk refuses.
    """
    import zstandard

    left = FILE_BYTES + FILE_RATIO * source.stat().st_size
    with source.open("rb") as packed, target.open("wb") as file:
        # No window of gigabytes, whatever the file says.
        reader = zstandard.ZstdDecompressor(max_window_size=2**27).stream_reader(
            packed, read_across_frames=True
        )
        try:
            while data := reader.read(COPY_BYTES):
                left -= len(data)
                if left < 0 or shutil.disk_usage(target.parent).free < COPY_BYTES:
                    raise LandingError(
                        f"{source} holds more than a file of its size, or this disk, can; "
                        f"decompress it by zstd -d {source.name}"
                    )
                file.write(data)
        except zstandard.ZstdError as e:
            raise LandingError(
                f"{source} cannot be decompressed: {e}; it is cut or damaged"
            ) from None
