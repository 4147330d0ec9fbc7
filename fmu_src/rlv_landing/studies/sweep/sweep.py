"""Runs a study's landings on all cores or a cluster, in any order, and keeps their rows in the
order of their index.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from threading import Event
from typing import Any, Protocol

from ...errors import LandingError
from ...workers import default_workers
from .result_files import LEADING, Results
from .row import Plan, Task

Rows = list[list[Any]]
Failed = list[tuple[str, str]]
# landings that a thread takes at once: few, so that Ctrl-C is answered soon
THREAD_ROWS = 8


class LostError(RuntimeError):
    """Landings can no longer be made; the message says where and why."""


class Engine(Protocol):
    """Where landings are made. `rows` is how many go into one task."""

    rows: int

    def submit(self, rows: Sequence[dict[str, Any]]) -> Any:
        """Have these landings made: a task."""

    def result(self, task: Any) -> Rows:
        """Wait for a task's rows."""

    def room(self) -> int:
        """How many tasks may wait at once."""

    def stop(self, tasks: Sequence[Any]) -> list[Rows]:
        """Begin nothing more.

        The rows of those tasks, from the first on without a gap, that are there or were begun.
        """


class Threads:
    """Landings in threads of this process: a landing runs without the GIL."""

    rows = THREAD_ROWS

    def __init__(self, plan: Plan, workers: int, pool: ThreadPoolExecutor) -> None:
        self._plan = plan
        self._workers = workers
        self._pool = pool
        self._stopped = Event()

    def submit(self, rows: Sequence[dict[str, Any]]) -> Future[Rows]:
        """Have these landings made; of those that are stopped in between, the first ones."""
        return self._pool.submit(self._run, rows)

    def _run(self, rows: Sequence[dict[str, Any]]) -> Rows:
        made: Rows = []
        for values in rows:
            if self._stopped.is_set():
                break
            made.append(self._plan.row(values))
        return made

    def result(self, task: Future[Rows]) -> Rows:
        """Wait for a task's rows."""
        return task.result()

    def room(self) -> int:
        """Enough that no thread runs dry while one lands slowly."""
        return 4 * self._workers + 4

    def stop(self, tasks: Sequence[Future[Rows]]) -> list[Rows]:
        """Threads end with the landing that they are at."""
        self._stopped.set()
        begun = [task for task in tasks if not task.cancel()]
        whole: list[Rows] = []
        for task in begun:
            whole.append(task.result())
            if len(whole[-1]) < self.rows:
                break
        return whole


@contextmanager
def threads(plan: Plan, workers: int | None = None) -> Iterator[Engine]:
    """An engine of `workers` threads, default all cores."""
    count = workers or default_workers()
    with ThreadPoolExecutor(count) as pool:
        engine = Threads(plan, count, pool)
        try:
            yield engine
        finally:
            engine.stop(())


class Sweep:
    """One run of a study: `progress` is told how many more landings are done, and label and reason
    of those that failed.
    """

    def __init__(
        self,
        task: Task,
        results: Results,
        progress: Callable[[int, Failed], object],
        strict: bool = False,
    ) -> None:
        self._task = task
        self._results = results
        self._progress = progress
        self._strict = strict
        self._error = len(LEADING) + len(task.names) + 1

    def run(self, engine: Engine) -> None:
        """Make every landing that the results lack.

        What is done is in the results whatever happens: KeyboardInterrupt, a lost cluster, a disk
        that refuses (OSError). Raises LandingError, when strict, at the first landing that fails,
        and for a lost cluster.
        """
        waiting: deque[tuple[int, Any]] = deque()
        try:
            for begin, end in self._results.missing():
                for first in range(begin, end, engine.rows):
                    rows = self._task.rows(first, min(first + engine.rows, end))
                    waiting.append((first, engine.submit(rows)))
                    while len(waiting) >= engine.room():
                        self._keep_first(waiting, engine)
            while waiting:
                self._keep_first(waiting, engine)
        except KeyboardInterrupt:
            for (first, _), made in zip(waiting, engine.stop([task for _, task in waiting])):
                self._keep(first, made)
            raise

    def _keep_first(self, waiting: deque[tuple[int, Any]], engine: Engine) -> None:
        made = engine.result(waiting[0][1])
        # interrupted from here on, rows may be missing, for `--resume` to make, but none is kept
        # twice
        first, _ = waiting.popleft()
        self._keep(first, made)

    def _keep(self, first: int, made: Rows) -> None:
        """Put the landings from `first` on into the results."""
        task = self._task
        values = task.rows(first, first + len(made))
        rows = [
            [first + i, task.sample(first + i), task.study.seed, *v.values(), *row]
            for i, (v, row) in enumerate(zip(values, made))
        ]
        failed = [i for i, row in enumerate(rows) if row[self._error] is not None]
        told = [(task.label(first + i), str(rows[i][self._error])) for i in failed]
        if self._strict and failed:
            self._results.add(rows[: failed[0]])
            raise LandingError(f"{told[0][0]}: {told[0][1]}")
        self._results.add(rows)
        self._progress(len(rows), told)


def check_all(task: Task) -> None:
    """Set up every landing of a study without running it.

    Raises LandingError naming the first rows that are refused.
    """
    refused: Failed = []
    for index in range(len(task)):
        try:
            task.plan.landing(task.rows(index, index + 1)[0])
        except LandingError as e:
            refused.append((task.label(index), str(e)))
    if refused:
        told = "; ".join(f"{label}: {reason}" for label, reason in refused[:5])
        raise LandingError(
            f"{len(refused)} of {len(task)} landings are refused: {told}"
            + ("; ..." if len(refused) > 5 else "")
        )
