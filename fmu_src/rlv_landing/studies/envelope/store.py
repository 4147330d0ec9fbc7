"""The landings of an envelope, kept so that none is made twice and an interrupted study can be
taken up again.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import TextIO

from ... import __version__
from ...errors import LandingError
from .boundary import Point
from .landed import Landed
from .study import EnvelopeStudy


class Store:
    """Every landing made so far, by family and place; in a file as well, a line each, so that a
    study can be taken up again.

    Raises LandingError for a file of another study or version, or one that exists and is not to be
    resumed.
    """

    def __init__(
        self, study: EnvelopeStudy, path: Path | None = None, resume: bool = False
    ) -> None:
        told = json.dumps({"version": __version__, **study.record()}, sort_keys=True)
        header = json.dumps({"study": hashlib.sha256(told.encode()).hexdigest()})
        self.found: dict[tuple[int, Point], Landed] = {}
        self._file: TextIO | None = None
        if path is None:
            return
        if path.exists() and not resume:
            raise LandingError(f"{path} exists; --resume goes on with it, or name another folder")
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
            # it was being written when the last run was killed
            self._file.truncate(sum(map(len, lines[:-1])))
            del lines[-1]
        for line in lines[1:]:
            record = json.loads(line)
            self.found[record["family"], (record["i"], record["j"])] = Landed.from_record(
                record["landed"]
            )

    def add(self, family: int, place: Point, landed: Landed) -> None:
        """Keep a landing."""
        self.found[family, place] = landed
        if self._file is not None:
            self._file.write(
                json.dumps(
                    {"family": family, "i": place[0], "j": place[1], "landed": asdict(landed)}
                )
                + "\n"
            )
            self._file.flush()

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
