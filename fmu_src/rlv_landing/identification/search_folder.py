"""The folder of an identification: its best point, and the state of its global search."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

from ..errors import LandingError, reason_of
from ..text.durable import ANOTHER_WORK, FolderLock, refuse_no_files, write_durably
from ..text.files import check_sum, read_record
from .global_search import GlobalSearch
from .objective import Objective

T = TypeVar("T")
NAN = float("nan")
RESULTS = ("identified.toml", "report.md")


@dataclass
class Best:
    """The best point so far, and how it came about.

    Attributes:
        z: The point, on the unit cube.
        loss: Its loss.
        evaluations: The evaluations of the landings so far.
        stage: The part of the identification that found it.
        seed: The seed.
        missed: Its softly counted misses, by which points are judged once the counting search has
            begun; None before.
        counted: The evaluations of the counting search.
        rounds: The rounds of the counting search that have ended.
        start_loss: The loss at the start.
        start_missed: The softly counted misses at the start.
    """

    z: list[float]
    loss: float
    evaluations: int
    stage: str
    seed: int
    missed: float | None = None
    counted: int = 0
    rounds: int = 0
    start_loss: float = NAN
    start_missed: float = NAN

    @property
    def counting(self) -> bool:
        """Whether the counting search has begun."""
        return self.missed is not None

    @property
    def improved(self) -> bool:
        """Whether it is better than the start: by the count once that has begun, else by loss."""
        if self.missed is None:
            return self.loss < self.start_loss
        return self.missed < self.start_missed


class SearchFolder:
    """The files of one identification, each written whole or not at all.

    Args:
        folder: The folder.
        objective: What the identification makes small.
    """

    def __init__(self, folder: Path, objective: Objective) -> None:
        self.folder = folder
        self._best = folder / "best.json"
        self._state = folder / "search.json"
        self._lock: FolderLock | None = None
        free = objective.free
        self._search: dict[str, Any] = {
            "free numbers": {n: [p.lo, p.hi] for n, (p, _) in zip(free.labels, free.columns)},
            "targets": {t.label: [t.value, t.scale, t.weight] for t in objective.targets},
            "misfits": objective.labels,
            "sensors": objective.sensors,
            "curves or values that are not free": objective.fingerprint(),
        }

    def create(self) -> None:
        """Make the folder, and lock it.

        Raises:
            LandingError: It holds an identification already, or files that have the names of an
                identification's, or it is in use or cannot be written.
        """
        self._lock = FolderLock(self.folder, ANOTHER_WORK)
        try:
            if os.path.lexists(self._best):
                raise LandingError(
                    f"{self.folder} holds an identification; --resume goes on with it, "
                    "--work names another folder"
                )
            for name in (self._state.name, *RESULTS):
                if os.path.lexists(self.folder / name):
                    raise LandingError(
                        f"{self.folder / name} is there without {self._best.name}; {ANOTHER_WORK}"
                    )
        except LandingError:
            self.release()
            raise

    def release(self) -> None:
        """Give the folder free."""
        if self._lock is not None:
            self._lock.release()

    def load(self) -> tuple[Best, GlobalSearch | None]:
        """The best point, and the global search where it has begun and no other search followed.

        Raises:
            LandingError: There is nothing to resume, a file is torn, or it is of another search.
        """
        # a folder that is not there is not made
        if not self._best.is_file():
            raise LandingError(
                f"there is no {self._best}; there is nothing to resume: leave --resume out, "
                f"or {ANOTHER_WORK}"
            )
        self._lock = FolderLock(self.folder, ANOTHER_WORK)
        try:
            refuse_no_files(self.folder, RESULTS, ANOTHER_WORK)
            return self._load()
        except LandingError:
            self.release()
            raise

    def _load(self) -> tuple[Best, GlobalSearch | None]:
        try:
            best = self._read(self._best, self._best_of)
        except (OSError, ValueError, TypeError) as e:
            if isinstance(e, LandingError):
                raise
            raise LandingError(
                f"{self._best} cannot be read ({reason_of(e)}); "
                f"there is nothing to resume: {ANOTHER_WORK}"
            ) from None
        if best.counting or not os.path.lexists(self._state):
            return best, None
        try:
            return best, self._read(self._state, self._search_of)
        except (OSError, ValueError) as e:
            if isinstance(e, LandingError):
                raise
            raise LandingError(
                f"{self._state} cannot be resumed ({reason_of(e)}); "
                f"remove it, and --resume searches anew from {self._best.name}"
            ) from None

    def _read(self, path: Path, content: Callable[[dict[str, Any]], T]) -> T:
        """The content of a file of this search, whose check sum is right."""
        kept = read_record(path)
        whole, check = check_sum(kept), kept.pop("check", None)
        own = kept.pop("search", None)
        if not isinstance(own, dict) or own.keys() != self._search.keys():
            raise ValueError("it does not say of which search it is")
        for what, wanted in self._search.items():
            if own[what] != wanted:
                raise LandingError(
                    f"{path} is of another search, with other {what}; "
                    f"resume with the same, or {ANOTHER_WORK}"
                )
        found = content(kept)
        if check != whole:
            raise ValueError("its check sum is another: it was changed")
        return found

    def save_best(self, best: Best) -> None:
        """Write the best point."""
        self._write(self._best, asdict(best), indent=1)

    def save_state(self, search: GlobalSearch) -> None:
        """Write the state of the global search."""
        self._write(self._state, search.state())

    def _write(self, path: Path, content: Mapping[str, Any], indent: int | None = None) -> None:
        record = {**content, "search": self._search}
        text = json.dumps({**record, "check": check_sum(record)}, indent=indent)
        write_durably(path, text.encode())

    def _best_of(self, kept: dict[str, Any]) -> Best:
        best = Best(**kept)
        size = len(self._search["free numbers"])
        if not isinstance(best.z, list) or len(best.z) != size or not all(map(_finite, best.z)):
            raise ValueError("its point is incomplete")
        if type(best.loss) not in (int, float) or not best.loss >= 0.0:
            raise ValueError(f"its loss {best.loss} is none")
        for name in ("evaluations", "counted", "rounds", "seed"):
            value = getattr(best, name)
            if type(value) is not int or value < 0:
                raise ValueError(f"its {name} = {value!r} is no whole number from 0 on")
        if best.missed is not None and not (_finite(best.missed) and best.missed >= 0.0):
            raise ValueError(f"its missed = {best.missed!r} is no number from 0 on")
        if not all(type(v) in (int, float) for v in (best.start_loss, best.start_missed)):
            raise ValueError("its loss at the start is none")
        if not isinstance(best.stage, str):
            raise ValueError(f"its stage = {best.stage!r} is no text")
        return best

    def _search_of(self, kept: dict[str, Any]) -> GlobalSearch:
        size = len(self._search["free numbers"])
        start = kept.get("start")
        if not isinstance(start, list) or len(start) != size:
            raise ValueError("its start is incomplete")
        return GlobalSearch.restored(kept)


def _finite(value: Any) -> bool:
    return type(value) in (int, float) and isfinite(value)
