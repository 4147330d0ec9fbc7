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
from .packed import LONGEST_METADATA, PackedReader, file_is_packed, is_packed
from .reader import LogReader
from .sqlite_reader import SqliteReader

METADATA_FILE = "metadata.yaml"
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
    packed = _is_packed(named)
    databases = _files(place, SQLITE)
    if databases and not _files(place, FINISHED) and not _files(place, UNFINISHED):
        return SqliteReader(named, in_order(databases), compressed=bool(packed))
    reader = LogReader(place)
    if packed or (packed is None and file_is_packed(reader.files[0])):
        reader = PackedReader(place)
    reader.path = named
    return reader


def _files(log: Path, ending: str) -> list[Path]:
    """The files of a log with this ending; for a file itself."""
    if log.is_file():
        return [log] if log.name.endswith(ending) else []
    return sorted(f for f in log.glob(f"*{ending}") if f.is_file())


def _is_packed(log: Path) -> bool | None:
    """Whether a recording's metadata say that each message is compressed; None without any."""
    metadata = (log if log.is_dir() else log.parent) / METADATA_FILE
    try:
        text = metadata.read_text(encoding="utf-8")
        found = read_yaml(text, LONGEST_METADATA)["rosbag2_bagfile_information"]
        return is_packed(found)
    except (OSError, ValueError, LookupError, TypeError):
        # It is not needed for anything else.
        return None


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
