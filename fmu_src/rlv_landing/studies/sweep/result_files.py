"""The results folder of a study: rows in Parquet parts while it runs, one file at the end.

- study.json: everything that decides the rows, and its fingerprint.
- study.toml: the study as it was read.
- parts/: the rows so far. Each file is renamed into place whole: after `kill -9` all but the last
  seconds are there.
- results.parquet: every row in the order of its index, when all are done; the parts are then
  removed.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any

from ...errors import LandingError, reason_of
from ...text.durable import LOCK, PART, FolderLock, unwritable, whole_file, write_durably
from ...text.files import read_record
from .factors import LARGEST
from .parts import (
    check_part,
    check_results,
    part_files,
    part_name,
    remove_unfinished,
)
from .row_table import RowTable
from .sweep_row import Task

STUDY, COPY, PARTS, RESULTS = "study.json", "study.toml", "parts", "results.parquet"
# what a sweep that was killed before its first file leaves
OWN = (LOCK, COPY, f"{COPY}{PART}", f"{STUDY}{PART}")
ANOTHER = "name another folder by --results"
PART_ROWS = 1000
PART_SECONDS = 1.0


class Results:
    """The rows of a study in `folder`, which is created, or continued by `resume`.

    It is a context manager: on leaving, the rows in memory are written. Those of a study that
    `grows` may be more than its landings; a file of fewer is continued.

    Raises:
        LandingError: The folder has a study and `resume` is not given, or another study or other
            files; or it is in use, damaged or cannot be written.
    """

    def __init__(
        self, folder: Path, task: Task, *, resume: bool = False, grows: bool = False
    ) -> None:
        self.folder = folder
        self._most = LARGEST if grows else len(task)
        self.count = len(task)
        about = task.about()
        self._about = {"fingerprint": fingerprint(about), **about}
        self._text = task.study.text
        self._table = RowTable(task.quantities(), self._about, self._text)
        self._rows: list[list[Any]] = []
        self._since = time.monotonic()
        self._check_folder(resume=resume)
        self._lock = FolderLock(folder, ANOTHER)
        try:
            # another sweep may have begun here before the folder was locked
            self._check_study(resume=resume)
            self.done = self._load()
        except BaseException as e:
            self._lock.release()
            if isinstance(e, OSError):
                raise unwritable(folder, e, ANOTHER) from None
            raise

    def _check_folder(self, *, resume: bool) -> None:
        try:
            self._check_study(resume=resume)
            if self.folder.exists() and not self.folder.is_dir():
                raise LandingError(f"{self.folder} is no folder; {ANOTHER}")
            # a killed sweep may have left its lock, and the first file that it was writing
            strange = (
                not (self.folder / STUDY).exists()
                and self.folder.exists()
                and any(path.name not in OWN for path in self.folder.iterdir())
            )
        except OSError as e:
            raise unwritable(self.folder, e, ANOTHER) from None
        if strange:
            raise LandingError(f"{self.folder} holds other files and no study; {ANOTHER}")

    def _check_study(self, *, resume: bool) -> None:
        if (self.folder / STUDY).exists():
            if not resume:
                raise LandingError(
                    f"{self.folder} holds a study's results; --resume continues with it, "
                    "--results names another folder"
                )
            self._compare()

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
            self._lock.release()

    def _compare(self) -> None:
        path = self.folder / STUDY
        try:
            kept = read_record(path)
        except (OSError, ValueError) as e:
            raise LandingError(
                f"{path} cannot be read ({reason_of(e)}); there is nothing to resume: {ANOTHER}"
            ) from None
        kept_fingerprint = kept.get("fingerprint")
        if not isinstance(kept_fingerprint, str) or "points" not in kept:
            raise LandingError(f"{path} says of no study; there is nothing to resume: {ANOTHER}")
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
            f"or {ANOTHER}"
        )

    def _load(self) -> list[tuple[int, int]]:
        """The ranges of indices that are done already; a new study's files are written."""
        parts = self.folder / PARTS
        if (self.folder / RESULTS).exists():
            rows = check_results(
                self.folder / RESULTS,
                self._about["fingerprint"],
                self._table.schema,
                (self.count, self._most),
            )
            if rows >= self.count:
                self.count = rows
                self._remove_parts()
                return [(0, rows)]
            parts.mkdir(exist_ok=True)
            (self.folder / RESULTS).replace(parts / part_name(0))
        if not (self.folder / STUDY).exists():
            write_durably(self.folder / COPY, self._text.encode())
            write_durably(self.folder / STUDY, json.dumps(self._about, indent=1).encode())
        parts.mkdir(exist_ok=True)
        remove_unfinished(parts)
        ranges: list[tuple[int, int]] = []
        for path in part_files(parts):
            after = ranges[-1][1] if ranges else 0
            ranges.append(
                check_part(path, self._about["fingerprint"], self._table.schema, self._most, after)
            )
        self.count = max([self.count, *(last for _, last in ranges)])
        return ranges

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
            part = self.folder / PARTS / part_name(self._rows[0][0])
            write_durably(part, self._table.content(self._rows))
            self.done = sorted({*self.done, (self._rows[0][0], self._rows[-1][0] + 1)})
            self._rows = []
        self._since = time.monotonic()

    def finish(self) -> Path:
        """Join the parts to one file, in the order of the indices, and remove them.

        Returns:
            The file.

        Raises:
            OSError: The disk refuses; the parts stay.
            LandingError: A part is damaged.
        """
        path = self.folder / RESULTS
        if path.exists():
            return path
        self.flush()
        with whole_file(path) as file:
            self._table.join(part_files(self.folder / PARTS), file)
        self._remove_parts()
        return path

    def _remove_parts(self) -> None:
        parts = self.folder / PARTS
        with suppress(OSError, LandingError):
            remove_unfinished(parts)
            for part in part_files(parts):
                part.unlink()
            parts.rmdir()


def fingerprint(about: Mapping[str, Any]) -> str:
    """The SHA-256 of everything that decides a study's rows."""
    return sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()
