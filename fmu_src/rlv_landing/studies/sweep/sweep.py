"""The run of a study's landings, on all cores or a cluster.

Landings are made in any order; their rows are kept in the order of their index.
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
from .result_files import Results
from .row_table import LEADING
from .sweep_row import Plan, Task

Rows = list[list[Any]]
Failures = list[tuple[str, str]]
# landings in a task of a thread: few, so that Ctrl-C ends soon
THREAD_ROWS = 8


class LostError(RuntimeError):
    """Landings can no longer be made; the message says where and why."""


class Engine(Protocol):
    """Makes landings in tasks of `rows` landings each."""

    rows: int

    def submit(self, rows: Sequence[dict[str, Any]]) -> Any:
        """Submit a task that makes these landings."""

    def result(self, task: Any) -> Rows:
        """Wait for a task's rows."""

    def capacity(self) -> int:
        """The number of tasks that may wait at once."""

    def stop(self, tasks: Sequence[Any]) -> list[Rows]:
        """Start no more landings.

        Returns:
            The rows of the tasks that are done or were started, from the first on without a gap.
        """


class Threads:
    """Makes landings in threads of this process; a landing runs without the GIL."""

    rows = THREAD_ROWS

    def __init__(self, plan: Plan, workers: int, pool: ThreadPoolExecutor) -> None:
        self._plan = plan
        self._workers = workers
        self._pool = pool
        self._stopped = Event()

    def submit(self, rows: Sequence[dict[str, Any]]) -> Future[Rows]:
        """Submit a task; where it is stopped in between, it returns its first landings."""
        return self._pool.submit(self._run, rows)

    def _run(self, rows: Sequence[dict[str, Any]]) -> Rows:
        made: Rows = []
        for values in rows:
            if self._stopped.is_set():
                break
            made.append(self._plan.sweep_row(values))
        return made

    def result(self, task: Future[Rows]) -> Rows:
        """Wait for a task's rows."""
        return task.result()

    def capacity(self) -> int:
        """The number of tasks that may wait: no thread runs out of work while one is slow."""
        return 4 * self._workers + 4

    def stop(self, tasks: Sequence[Future[Rows]]) -> list[Rows]:
        """Stop each thread after its present landing; the rows as in `Engine.stop`."""
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
    """An engine of `workers` threads [default: all cores that this process may use]."""
    count = workers or default_workers()
    with ThreadPoolExecutor(count) as pool:
        engine = Threads(plan, count, pool)
        try:
            yield engine
        finally:
            engine.stop(())


class Sweep:
    """One run of a study.

    Args:
        task: The landings.
        results: Takes the rows.
        progress: Called with the number of landings done since the last call, and label and reason
            of those that failed.
        strict: Whether to end at the first landing that fails.
    """

    def __init__(
        self,
        task: Task,
        results: Results,
        progress: Callable[[int, Failures], object],
        *,
        strict: bool = False,
    ) -> None:
        self._task = task
        self._results = results
        self._progress = progress
        self._strict = strict
        self._error = len(LEADING) + len(task.names) + 1

    def run(self, engine: Engine) -> None:
        """Make every landing that the results lack.

        The rows that are done are in the results whatever happens.

        Raises:
            LandingError: With `strict`, a landing failed.
            LostError: The cluster is lost.
            OSError: The disk refuses.
            KeyboardInterrupt: The user interrupted.
        """
        waiting: deque[tuple[int, Any]] = deque()
        try:
            for begin, end in self._results.missing():
                for first in range(begin, end, engine.rows):
                    rows = self._task.rows(first, min(first + engine.rows, end))
                    waiting.append((first, engine.submit(rows)))
                    while len(waiting) >= engine.capacity():
                        self._keep_first(waiting, engine)
            while waiting:
                self._keep_first(waiting, engine)
        except KeyboardInterrupt:
            for (first, _), made in zip(waiting, engine.stop([task for _, task in waiting])):
                self._keep(first, made)
            raise

    def _keep_first(self, waiting: deque[tuple[int, Any]], engine: Engine) -> None:
        made = engine.result(waiting[0][1])
        # an interrupt from here on may lose rows, which `--resume` makes again; it keeps none twice
        first, _ = waiting.popleft()
        self._keep(first, made)

    def _keep(self, first: int, made: Rows) -> None:
        """Add the rows of the landings from `first` on to the results."""
        task = self._task
        values = task.rows(first, first + len(made))
        rows = [
            [first + i, task.sample(first + i), task.study.seed, *v.values(), *row]
            for i, (v, row) in enumerate(zip(values, made))
        ]
        failed = [i for i, row in enumerate(rows) if row[self._error] is not None]
        failures = [(task.label(first + i), str(rows[i][self._error])) for i in failed]
        if self._strict and failed:
            self._results.add(rows[: failed[0]])
            raise LandingError(f"{failures[0][0]}: {failures[0][1]}")
        self._results.add(rows)
        self._progress(len(rows), failures)


def check_all(task: Task) -> None:
    """Set up every landing of a study without running it.

    Raises:
        LandingError: Landings are refused; the message names the first of them.
    """
    refused: Failures = []
    for index in range(len(task)):
        try:
            task.plan.landing(task.rows(index, index + 1)[0])
        except LandingError as e:
            refused.append((task.label(index), str(e)))
    if refused:
        first = "; ".join(f"{label}: {reason}" for label, reason in refused[:5])
        raise LandingError(
            f"{len(refused)} of {len(task)} landings are refused: {first}"
            + ("; ..." if len(refused) > 5 else "")
        )
