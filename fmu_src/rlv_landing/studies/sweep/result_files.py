"""The results folder of a study: rows in Parquet parts while it runs, one file at the end.

- study.json: everything that decides the rows, and its fingerprint.
- study.toml: the study as it was read.
- parts/: the rows so far. Each file is renamed into place whole: after `kill -9` all but the last
  seconds are there.
- results.parquet: every row in the order of its index, when all are done; the parts are then
  removed.
"""

from __future__ import annotations

import fcntl
import io
import json
import platform
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, TextIO

import numpy
import scipy

from ... import __version__
from ...errors import LandingError
from ...quantities import Quantity
from ...text.durable import write_durably
from .extras import arrow
from .sweep_row import Task

STUDY, COPY, PARTS, RESULTS = "study.json", "study.toml", "parts", "results.parquet"
LEADING = (
    Quantity("", "number of the landing, from 0", name="index", kind="integer"),
    Quantity(
        "",
        "number of the sample, from 0: landings of one sample differ in mode only",
        name="sample",
        kind="integer",
    ),
    Quantity("", "the study's seed", name="seed", kind="integer"),
)
PART_ROWS = 1000
PART_SECONDS = 1.0
GROUP_ROWS = 10_000


class Results:
    """The rows of a study in `folder`, which is created, or continued by `resume`.

    It is a context manager: on leaving, the rows in memory are written.

    Raises:
        LandingError: The folder has a study and `resume` is not given, or another study or other
            files; or it is in use, damaged or cannot be written.
    """

    def __init__(self, folder: Path, task: Task, *, resume: bool = False) -> None:
        self.folder = folder
        self.count = len(task)
        self._pyarrow, self._parquet = arrow()
        self._quantities = [*LEADING, *task.quantities()]
        about = task.about()
        self._about = {"fingerprint": fingerprint(about), **about}
        self._text = task.study.text
        self._rows: list[list[Any]] = []
        self._since = time.monotonic()
        self._check_folder(resume=resume)
        self._lock = self._locked()
        self.done = self._load()

    def _check_folder(self, *, resume: bool) -> None:
        study = self.folder / STUDY
        if study.exists():
            if not resume:
                raise LandingError(
                    f"{self.folder} holds a study's results; --resume continues with it, "
                    "--results names another folder"
                )
            self._compare()
        elif self.folder.exists() and any(self.folder.iterdir()):
            raise LandingError(
                f"{self.folder} holds other files and no study; --results names another folder"
            )

    def _locked(self) -> TextIO:
        """The folder's lock file, locked for this process."""
        try:
            (self.folder / PARTS).mkdir(parents=True, exist_ok=True)
            lock = (self.folder / ".lock").open("w")
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return lock
        except BlockingIOError:
            raise LandingError(
                f"{self.folder} is in use by another sweep; wait for it, "
                "or name another folder by --results"
            ) from None
        except OSError as e:
            raise LandingError(
                f"{self.folder} cannot be written: {e.strerror or e}; "
                "name another folder by --results"
            ) from None

    def __enter__(self) -> Results:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self.flush()
        except OSError:
            if error is None:
                raise
        finally:
            self._lock.close()

    def _compare(self) -> None:
        path = self.folder / STUDY
        try:
            kept = json.loads(path.read_text(encoding="utf-8"))
            kept_fingerprint = kept["fingerprint"]
        except (OSError, ValueError, KeyError, TypeError) as e:
            raise LandingError(f"{path} cannot be read ({e}); there is nothing to resume") from None
        if kept_fingerprint == self._about["fingerprint"]:
            return
        changed = [
            key
            for key in self._about
            if key != "fingerprint" and kept.get(key) != json.loads(json.dumps(self._about[key]))
        ]
        raise LandingError(
            f"{self.folder} holds rows of another study: {', '.join(changed)} changed since. "
            f"Resume with the study as it was ({self.folder / COPY} is a copy of it), "
            "or name another folder by --results"
        )

    def _load(self) -> list[tuple[int, int]]:
        """The ranges of indices that are done already; a new study's files are written."""
        if (self.folder / RESULTS).exists():
            self._remove_parts()
            return [(0, self.count)]
        try:
            if not (self.folder / STUDY).exists():
                write_durably(self.folder / COPY, self._text.encode())
                write_durably(self.folder / STUDY, json.dumps(self._about, indent=1).encode())
        except OSError as e:
            raise LandingError(
                f"{self.folder} cannot be written: {e.strerror or e}; "
                "make room, or name another folder"
            ) from None
        ranges: list[tuple[int, int]] = []
        for path in self._parts():
            try:
                rows = self._parquet.read_metadata(path).num_rows
            except Exception as e:
                raise LandingError(
                    f"{path} is damaged ({e}); remove it, and --resume makes its rows anew"
                ) from None
            first = int(path.stem)
            if ranges and first < ranges[-1][1]:
                raise LandingError(
                    f"{path} has rows that the part before it has, too; "
                    "remove it, and --resume makes its rows anew"
                )
            ranges.append((first, first + rows))
        return ranges

    def _parts(self) -> list[Path]:
        return sorted((self.folder / PARTS).glob("*.parquet"))

    @property
    def rows_done(self) -> int:
        """The number of rows on the disk."""
        return sum(last - first for first, last in self.done)

    def missing(self) -> list[tuple[int, int]]:
        """The ranges of indices that are still to be made."""
        gaps, at = [], 0
        for first, last in [*self.done, (self.count, self.count)]:
            if at < first:
                gaps.append((at, first))
            at = last
        return gaps

    def add(self, rows: Sequence[list[Any]]) -> None:
        """Append rows, whose indices rise.

        Raises:
            OSError: The disk refuses; the rows stay in memory.
        """
        for row in rows:
            if self._rows and row[0] != self._rows[-1][0] + 1:
                self.flush()
            self._rows.append(row)
        if len(self._rows) >= PART_ROWS or time.monotonic() - self._since > PART_SECONDS:
            self.flush()

    def flush(self) -> None:
        """Write the rows in memory to a part."""
        if self._rows:
            buffer = io.BytesIO()
            self._parquet.write_table(self._table(self._rows), buffer)
            write_durably(
                self.folder / PARTS / f"{self._rows[0][0]:012d}.parquet", buffer.getvalue()
            )
            self.done = sorted({*self.done, (self._rows[0][0], self._rows[-1][0] + 1)})
            self._rows = []
        self._since = time.monotonic()

    def _schema(self) -> Any:
        pa = self._pyarrow
        kinds = {
            "real": pa.float64(),
            "integer": pa.int64(),
            "boolean": pa.bool_(),
            "string": pa.string(),
        }
        fields = [
            pa.field(q.name, kinds[q.kind], metadata={"unit": q.unit, "meaning": q.meaning})
            for q in self._quantities
        ]
        metadata = {
            "study.json": json.dumps(self._about),
            "study.toml": self._text,
            "versions": json.dumps(versions()),
        }
        return pa.schema(fields, metadata=metadata)

    def _table(self, rows: Sequence[Sequence[Any]]) -> Any:
        columns = []
        for field, values in zip(self._schema(), zip(*rows)):
            if self._pyarrow.types.is_floating(field.type):
                values = tuple(None if isinstance(v, str) else v for v in values)
            columns.append(self._pyarrow.array(values, field.type))
        return self._pyarrow.table(columns, schema=self._schema())

    def finish(self) -> Path:
        """Join the parts to one file, in the order of the indices, and remove them.

        Returns:
            The file.

        Raises:
            OSError: The disk refuses; the parts stay.
        """
        path = self.folder / RESULTS
        if path.exists():
            return path
        self.flush()
        temporary = path.with_name(path.name + ".part")
        try:
            with (
                temporary.open("wb") as file,
                self._parquet.ParquetWriter(file, self._schema()) as writer,
            ):
                for table in self._groups():
                    writer.write_table(table, row_group_size=GROUP_ROWS)
            temporary.replace(path)
        except BaseException:
            with suppress(OSError):
                temporary.unlink()
            raise
        self._remove_parts()
        return path

    def _groups(self) -> Iterator[Any]:
        """All rows in tables of GROUP_ROWS.

        The size does not depend on the parts: neither does the file.
        """
        pending = self._schema().empty_table()
        for part in self._parts():
            pending = self._pyarrow.concat_tables(
                [pending, self._parquet.read_table(part, schema=self._schema())]
            )
            while pending.num_rows >= GROUP_ROWS:
                yield pending.slice(0, GROUP_ROWS).combine_chunks()
                pending = pending.slice(GROUP_ROWS)
        if pending.num_rows:
            yield pending.combine_chunks()

    def _remove_parts(self) -> None:
        for part in self._parts():
            part.unlink()
        with suppress(OSError):
            (self.folder / PARTS).rmdir()


def fingerprint(about: Mapping[str, Any]) -> str:
    """The SHA-256 of everything that decides a study's rows."""
    return sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()


def versions() -> dict[str, str]:
    """The versions of the software that made the rows."""
    return {
        "rlv-landing": __version__,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }
