"""The runs of a Monte Carlo: in threads or on a cluster, until there are enough."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ... import __version__
from ..criteria import FAILED, is_lost
from ..sweep.parts import opened, part_files
from ..sweep.result_files import PARTS, RESULTS, Results
from ..sweep.row_table import LEADING
from ..sweep.sweep import Engine, Failures, Sweep
from ..sweep.sweep_row import Task
from .dispersions import Runs
from .intervals import wilson
from .study import MonteCarlo

# runs after which it is looked whether there are enough: the file does not depend on the threads
STEP = 200
JUDGED = ("outcome", "outcome.first_limit", "error")


class MonteCarloTask(Task):
    """The landings of a Monte Carlo, as many as are wanted next."""

    def __init__(self, study: MonteCarlo) -> None:
        first = study.samples if study.width is None else min(STEP, study.samples)
        self.runs = Runs(study.dispersions, first)
        super().__init__(study.sweep, self.runs)
        self.montecarlo = study

    def about(self) -> dict[str, Any]:
        """Everything that decides the rows, their number apart."""
        points = self.design.digest()
        return {"version": __version__, **self.montecarlo.record(), "points": points}


class Tally(Results):
    """The rows of a Monte Carlo, and how many of them were not lost."""

    def __init__(self, folder: Path, task: MonteCarloTask, *, resume: bool = False) -> None:
        self._criterion = task.montecarlo.criterion
        columns = [q.name for q in (*LEADING, *task.quantities())]
        self._places = [columns.index(name) for name in JUDGED]
        self.runs = self.successes = 0
        super().__init__(folder, task, resume=resume, grows=True)
        self._count_kept()

    def _count_kept(self) -> None:
        """Count the rows that are on the disk."""
        whole = self.folder / RESULTS
        paths = [whole] if whole.exists() else part_files(self.folder / PARTS)
        for path in paths:
            with opened(path) as file:
                table = file.read(columns=list(JUDGED))
            for values in zip(*(table[name].to_pylist() for name in JUDGED)):
                self._count(*values)

    def _count(self, outcome: str | None, limit: str | None, error: str | None) -> None:
        self.runs += 1
        name = FAILED if error is not None else str(outcome)
        self.successes += not is_lost(self._criterion, name, limit_passed=limit is not None)

    def add(self, rows: Sequence[list[Any]]) -> None:
        """Append rows, and count them; as `Results.add`."""
        for row in rows:
            self._count(*(row[i] for i in self._places))
        super().add(rows)

    def enough(self, study: MonteCarlo) -> bool:
        """Whether the interval of the rate of success is as narrow as wanted, or all are made."""
        if self.runs >= study.samples:
            return True
        low, high = wilson(self.successes, self.runs, study.level)
        return study.width is not None and high - low <= study.width


def run_all(
    task: MonteCarloTask,
    results: Tally,
    engine: Engine,
    progress: Callable[[int, Failures], object],
    *,
    strict: bool = False,
) -> None:
    """Make the runs that the results lack, in steps of STEP, until there are enough.

    Raises:
        LandingError, LostError, OSError, KeyboardInterrupt: As `Sweep.run`.
    """
    study = task.montecarlo
    while True:
        Sweep(task, results, progress, strict=strict).run(engine)
        if results.enough(study):
            return
        task.runs.count = min(results.count + STEP, study.samples)
        results.count = task.runs.count


def values_of(task: MonteCarloTask, run: int) -> Mapping[str, Any]:
    """The values of a run, without those before it."""
    return task.rows(run, run + 1)[0]
