"""A study's landings on a Dask cluster.

Tasks are small, some landings each. The tasks of a worker that dies are made anew.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from ... import __version__
from ...errors import LandingError, reason_of
from .extras import dask
from .scheduler import ask_scheduler, disable_dask_logs, no_scheduler
from .sweep import Engine, LostError, Rows
from .sweep_row import Plan, sweep_rows

# landings in a task: some tenths of a second, against a scheduler's millisecond
CLUSTER_ROWS = 25
# time between checks that the cluster is still there [s]
CHECK_EVERY = 1.0


def worker_version() -> str:
    """The version of rlv-landing in a worker, where this runs."""
    return __version__


class Cluster:
    """Landings on a cluster's workers."""

    rows = CLUSTER_ROWS

    def __init__(self, plan: Plan, client: Any, address: str, timeout: float) -> None:
        self._plan = plan
        self._client = client
        self._address = address
        self._timeout = timeout
        self._checked = -CHECK_EVERY
        self._thread_count = 0

    def submit(self, rows: Sequence[dict[str, Any]]) -> Any:
        """Submit a task that makes these landings.

        Raises:
            LostError: The scheduler is gone.
        """
        try:
            return self._client.submit(sweep_rows, self._plan, list(rows), pure=False)
        except Exception as e:
            raise self._lost(e) from None

    def _lost(self, error: BaseException) -> LostError:
        return LostError(
            f"the cluster at {self._address} gave up: {type(error).__name__}: {reason_of(error)}"
        )

    def result(self, task: Any) -> Rows:
        """Wait for a task's rows.

        Raises:
            LostError: The scheduler is gone, or every worker has been for longer than the timeout.
        """
        distributed = dask()
        idle_since: float | None = None
        while True:
            try:
                rows: Rows = task.result(timeout=CHECK_EVERY)
                return rows
            except (TimeoutError, distributed.TimeoutError):
                if self._client.status != "running":
                    raise LostError(f"the scheduler at {self._address} is gone") from None
                if self._threads():
                    idle_since = None
                elif idle_since is None:
                    idle_since = time.monotonic()
                elif time.monotonic() - idle_since > self._timeout:
                    raise LostError(
                        f"the scheduler at {self._address} has had no worker "
                        f"for {self._timeout:g} s"
                    ) from None
            except KeyboardInterrupt:
                raise
            except BaseException as e:
                raise self._lost(e) from None

    def capacity(self) -> int:
        """The number of tasks that may wait: enough that no worker runs out of work."""
        return 4 * self._threads() + 8

    def _threads(self) -> int:
        """The number of the workers' threads, at most a second old.

        Asking the scheduler costs as much as a task.

        Raises:
            LostError: The scheduler does not answer within the timeout, or is gone.
        """
        if time.monotonic() - self._checked >= CHECK_EVERY:
            distributed = dask()
            try:
                found = self._client.sync(
                    self._client.scheduler.identity, callback_timeout=self._timeout
                )
            except (TimeoutError, distributed.TimeoutError):
                raise LostError(
                    f"the scheduler at {self._address} has not answered for {self._timeout:g} s"
                ) from None
            except Exception as e:
                raise self._lost(e) from None
            workers: dict[str, dict[str, Any]] = found.get("workers", {})
            self._thread_count = sum(int(worker["nthreads"]) for worker in workers.values())
            self._checked = time.monotonic()
        return self._thread_count

    def stop(self, tasks: Sequence[Any]) -> list[Rows]:
        """The rows of tasks that are done, from the first on without a gap.

        The other tasks are cancelled.
        """
        done: list[Rows] = []
        for task in tasks:
            if task.status != "finished":
                break
            try:
                done.append(task.result(timeout=self._timeout))
            except Exception:
                break
        with suppress(Exception):
            self._client.sync(self._client._cancel, list(tasks), callback_timeout=self._timeout)
        return done


@contextmanager
def cluster(plan: Plan, address: str, timeout: float) -> Iterator[Engine]:
    """The engine of the cluster whose scheduler is at `address`.

    Args:
        plan: The plan of the landings.
        address: The scheduler's address.
        timeout: The longest wait for scheduler and workers [s].

    Raises:
        LandingError: No scheduler answers, no worker is there, or a worker lacks rlv-landing or has
            another version of it.
    """
    distributed = dask()
    disable_dask_logs()
    ask_scheduler(address, timeout)
    try:
        client = distributed.Client(address, timeout=timeout, set_as_default=False)
    except Exception as e:
        raise no_scheduler(address, timeout, e) from None
    try:
        try:
            client.wait_for_workers(1, timeout=timeout)
        except (TimeoutError, distributed.TimeoutError):
            raise LandingError(
                f"the scheduler at {address} has no worker after {timeout:g} s; "
                f"start some: dask worker {address}"
            ) from None
        _check_versions(client)
        yield Cluster(plan, client, address, timeout)
    finally:
        # a scheduler that is gone does not say goodbye
        with suppress(Exception):
            client.close(timeout=timeout)


def _check_versions(client: Any) -> None:
    try:
        found = client.run(worker_version)
    except Exception as e:
        raise LandingError(
            f"a worker cannot run rlv-landing ({type(e).__name__}: {reason_of(e)}); "
            "install it in the workers' Python"
        ) from None
    for worker, version in found.items():
        if version != __version__:
            raise LandingError(
                f"worker {worker} has rlv-landing {version}, here is {__version__}; "
                "rows would differ: install the same"
            )
