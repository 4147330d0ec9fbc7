"""The landings of an envelope, kept so that none is made twice and a study can be resumed."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import TextIO

from ... import __version__
from ...errors import LandingError
from .boundary import Point
from .judged_landing import JudgedLanding
from .study import EnvelopeStudy


class Store:
    """Every landing made so far, by family and point.

    With a `path` they are also in a file, a line each, and `resume` reads what is there.

    Raises:
        LandingError: The file is of another study or version, or it exists and `resume` is not
            given.
    """

    def __init__(
        self, study: EnvelopeStudy, path: Path | None = None, *, resume: bool = False
    ) -> None:
        decisive = json.dumps({"version": __version__, **study.record()}, sort_keys=True)
        header = json.dumps({"study": hashlib.sha256(decisive.encode()).hexdigest()})
        self.found: dict[tuple[int, Point], JudgedLanding] = {}
        self._file: TextIO | None = None
        if path is None:
            return
        if path.exists() and not resume:
            raise LandingError(f"{path} exists; --resume continues with it, or name another folder")
        self._file = path.open("a+", encoding="ascii", newline="\n")
        self._file.seek(0)
        lines = self._file.read().splitlines(keepends=True)
        if not lines:
            self._file.write(header + "\n")
        elif lines[0] != header + "\n":
            self._file.close()
            raise LandingError(
                f"{path} holds landings of another study or version; name another folder"
            )
        elif not lines[-1].endswith("\n"):
            # the last run was killed while it wrote this line
            self._file.truncate(sum(map(len, lines[:-1])))
            del lines[-1]
        for line in lines[1:]:
            record = json.loads(line)
            self.found[record["family"], (record["i"], record["j"])] = JudgedLanding.from_record(
                record["landed"]
            )

    def add(self, family: int, point: Point, landing: JudgedLanding) -> None:
        """Add a landing; it is in the file when this returns."""
        self.found[family, point] = landing
        if self._file is not None:
            self._file.write(
                json.dumps(
                    {"family": family, "i": point[0], "j": point[1], "landed": asdict(landing)}
                )
                + "\n"
            )
            self._file.flush()

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
