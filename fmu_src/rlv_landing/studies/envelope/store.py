"""The landings of an envelope, kept so that none is made twice and a study can be resumed."""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ... import __version__
from ...errors import LandingError
from ...text.durable import ANOTHER_WORK, FolderLock, unwritable
from ...text.files import check_sum
from .boundary import Point
from .judged_landing import JudgedLanding
from .study import EnvelopeStudy

# of a line
KEYS = {"family", "i", "j", "landed", "check"}


class Store:
    """Every landing made so far, by family and point.

    With a `path` they are also in a file, a line each, and `resume` reads what is there. What a
    killed search left of its last line is cut off.

    Raises:
        LandingError: The file is of another study or version, or a line of it is damaged, or it
            exists and `resume` is not given; or its folder is in use or cannot be written.
    """

    def __init__(
        self, study: EnvelopeStudy, path: Path | None = None, *, resume: bool = False
    ) -> None:
        self._study = study
        self.found: dict[tuple[int, Point], JudgedLanding] = {}
        self._file = -1
        self._lock: FolderLock | None = None
        if path is None:
            return
        self._path = path
        self._lock = FolderLock(path.parent, ANOTHER_WORK)
        try:
            if path.exists() and not resume:
                raise LandingError(
                    f"{path} exists; --resume continues with it, or name another folder"
                )
            self._open()
        except BaseException as e:
            self.close()
            if isinstance(e, OSError):
                raise unwritable(path, e, ANOTHER_WORK) from None
            raise

    def _open(self) -> None:
        decisive = json.dumps({"version": __version__, **self._study.record()}, sort_keys=True)
        digest = hashlib.sha256(decisive.encode()).hexdigest()
        header = (json.dumps({"study": digest}) + "\n").encode()
        path = self._path
        if path.exists() and not path.is_file():
            raise LandingError(f"{path} is no file; {ANOTHER_WORK}")
        self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o666)
        with os.fdopen(os.dup(self._file), "rb") as file:
            whole, _, torn = file.read().rpartition(b"\n")
        lines = [line + b"\n" for line in whole.split(b"\n")] if whole else []
        if not lines:
            # a search that was killed before its first landing
            if torn.strip(b"\0") and not header.startswith(torn):
                raise self._of_another()
            os.ftruncate(self._file, 0)
            self._append(header)
            return
        if lines[0] != header:
            raise self._of_another()
        for number, line in enumerate(lines[1:], 2):
            self._read(number, line)
        os.ftruncate(self._file, sum(map(len, lines)))

    def _of_another(self) -> LandingError:
        return LandingError(
            f"{self._path} holds landings of another study or version; name another folder"
        )

    def _read(self, number: int, line: bytes) -> None:
        """Take up the landing of a line."""
        try:
            record = json.loads(line)
            key = self._key(record)
            landing = JudgedLanding.from_record(record["landed"], self._study.most_legs)
            if not _same(self.found.setdefault(key, landing), landing):
                raise ValueError("it contradicts a line before it")
            if record["check"] != check_sum(record):
                raise ValueError("its check sum is another")
        except (ValueError, RecursionError) as e:
            reason = str(e).split(": line")[0]
            raise LandingError(
                f"{self._path}, line {number}, is damaged ({reason}); "
                "remove the line, and --resume makes its landing anew"
            ) from None

    def _key(self, record: Any) -> tuple[int, Point]:
        """The family and the point of a line.

        Raises:
            ValueError: They are not in the line, or not in the study.
        """
        if not isinstance(record, dict) or record.keys() != KEYS:
            raise ValueError("it is no landing")
        family, i, j = (record[key] for key in ("family", "i", "j"))
        width, height = self._study.lattice.size
        for name, value, last in (
            ("family", family, len(self._study.families) - 1),
            ("i", i, width),
            ("j", j, height),
        ):
            if type(value) is not int or not 0 <= value <= last:
                raise ValueError(f"{name} = {value!r} is not from 0 to {last}")
        return family, (i, j)

    def add(self, family: int, point: Point, landing: JudgedLanding) -> None:
        """Add a landing; it is in the file when this returns.

        Raises:
            OSError: The disk refuses; the file holds the landings before.
        """
        if self._file >= 0:
            record: dict[str, Any] = {"family": family, "i": point[0], "j": point[1]}
            record["landed"] = asdict(landing)
            record["check"] = check_sum(record)
            self._append((json.dumps(record) + "\n").encode())
        self.found[family, point] = landing

    def _append(self, line: bytes) -> None:
        size = os.fstat(self._file).st_size
        try:
            while line:
                line = line[os.write(self._file, line) :]
        except OSError:
            with suppress(OSError):
                os.ftruncate(self._file, size)
            raise

    def close(self) -> None:
        """Close the file."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1
        if self._lock is not None:
            self._lock.release()


def _same(one: JudgedLanding, other: JudgedLanding) -> bool:
    """Whether two landings are the same; margins that are not known are."""
    return json.dumps(asdict(one)) == json.dumps(asdict(other))
